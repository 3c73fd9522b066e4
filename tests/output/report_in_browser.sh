#!/usr/bin/env bash
# report_in_browser.sh PROGRAM [SCREENSHOT.png]: makes a small study, opens its page in headless Chromium and checks that
# nothing is logged, that every plot has data, that every table sorts by every column both ways, that the scorecard comes
# first and that the page prints. Exit code 77 where there is no Chromium, no Chart.js or no gnuplot.
set -euo pipefail
program=$(realpath "$1")
screenshot=${2:-}
browser=${GNOMON_BROWSER:-}
for name in chromium chromium-headless-shell google-chrome; do
  [[ $browser ]] || browser=$(command -v "$name" || true)
done
[[ $browser && -e /usr/share/javascript/chart.js ]] && command -v gnuplot >/dev/null ||
  { echo "skipped: needs Chromium, libjs-chart.js and gnuplot" && exit 77; }

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat >"$folder/small.toml" <<'END'
quick_scorecard = ["asymmetric-free-top", "space-moment"]
quick_converge = ["asymmetric-free-top"]
quick_compare = ["space-moment"]
integrators = ["munjiza", "rkmk4", "cvode-adams"]
[[drift]]
scene = "asymmetric-free-top"
t_end = 50.0
quick_t_end = 50.0
step = 0.05
tol = 1e-6
integrators = ["munjiza", "rkmk4"]
END
(cd "$folder" && "$program" bench --study small.toml --quick --quiet --out out >/dev/null)

open_page() { # OPTION.. PAGE: the document on standard output, what is logged in log.txt
  HOME=$folder timeout 120 "$browser" --headless --no-sandbox --disable-gpu --enable-logging=stderr \
    --user-data-dir="$folder/profile" "$@" 2>"$folder/log.txt"
}
fail() { echo "report_in_browser: $*" >&2 && exit 1; }

# The page reports on itself in place of its content.
cat >"$folder/check.js" <<'END'
const result = { tables: 0, columns: 0, unsorted: [], plots: 0, empty: [], bars: 0, first: "" };
result.first = document.querySelector("#summary h3").textContent;
const show = (cell) => (cell.dataset.v !== undefined ? cell.dataset.v : cell.textContent);
for (const table of document.querySelectorAll("table.sortable")) {
  ++result.tables;
  const rows = table.tBodies[0].rows;
  const content = () => Array.from(rows, (row) => row.textContent).sort().join("\n");
  const before = content();
  Array.from(table.tHead.rows[0].cells).forEach((head, column) => {
    ++result.columns;
    for (const direction of [1, -1]) {
      head.querySelector("button").click();
      const values = Array.from(rows, (row) => show(row.cells[column])).filter((text) => text !== "" && text !== "\u2014");
      const numbers = values.map(Number).filter((value) => !Number.isNaN(value));
      const sorted = numbers.every((value, k) => k === 0 || direction * (value - numbers[k - 1]) >= 0);
      const mark = head.getAttribute("aria-sort") === (direction > 0 ? "ascending" : "descending");
      if (!sorted || !mark || content() !== before) result.unsorted.push(head.textContent);
    }
  });
}
for (const plot of gnomonPlots) {
  ++result.plots;
  const sizes = plot.data.datasets.map((each) => each.data.length);
  const area = plot.chartArea;
  if (sizes.length === 0 || sizes.includes(0) || !(area.width > 100 && area.height > 100)) result.empty.push(plot.canvas.ariaLabel);
  for (const each of plot.data.datasets) result.bars += each.data.filter((point) => point.bar && point.bar[1] > point.bar[0]).length;
}
result.figures = document.querySelectorAll("figure").length;
document.body.innerHTML = "";
const box = document.createElement("pre");
box.textContent = `RESULT ${JSON.stringify(result)} END`;
document.body.append(box);
END
python3 - "$folder" <<'END'
import pathlib, sys
folder = pathlib.Path(sys.argv[1])
page = (folder / "out/report.html").read_text()
script = "<script>\n" + (folder / "check.js").read_text() + "</script>\n"
(folder / "checked.html").write_text(page.replace("</body>", script + "</body>"))
END
open_page --window-size=1300,1000 --dump-dom "file://$folder/checked.html" >"$folder/dom.html"
result=$(grep -o 'RESULT {.*} END' "$folder/dom.html") || fail "the page did not run to its end: $(cat "$folder/log.txt")"
echo "$result"
grep -q CONSOLE "$folder/log.txt" && fail "the browser logged: $(grep CONSOLE "$folder/log.txt")"
for wanted in '"unsorted":\[\]' '"empty":\[\]' '"figures":3' '"plots":5' '"first":"Scorecard, small"' '"tables":1[0-9]' '"bars":[1-9]'; do
  grep -q "$wanted" <<<"$result" || fail "expected $wanted"
done
# An error is seen where there is one.
sed 's/^const gnomonPlots = \[\];/noSuchName();\n&/' "$folder/out/report.html" >"$folder/broken.html"
open_page --dump-dom "file://$folder/broken.html" >/dev/null
grep -q 'CONSOLE.*noSuchName' "$folder/log.txt" || fail "an error of a script is not seen"

open_page --no-pdf-header-footer --print-to-pdf="$folder/page.pdf" "file://$folder/out/report.html"
grep -q '^%PDF-' <(head -c 8 "$folder/page.pdf") || fail "the page does not print"
pages=$(grep -ac '/Type */Page$\|/Type */Page[^s]' "$folder/page.pdf" || true)
size=$(stat -c %s "$folder/page.pdf")
[[ $pages -ge 3 && $pages -le 40 && $size -gt 50000 ]] || fail "the print has $pages pages and $size bytes"
echo "printed: $pages pages"
[[ ! $screenshot ]] || open_page --window-size=1300,2600 --screenshot="$screenshot" "file://$folder/out/report.html"
