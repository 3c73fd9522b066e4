"use strict";
// Tables that a click on a heading sorts, and plots to zoom into.

// What a cell is sorted by: a number, a text, or null where it is empty.
function cellValue(cell) {
  const raw = cell.dataset.v !== undefined ? cell.dataset.v : cell.textContent;
  if (raw === "" || raw === "\u2014") return null;
  const number = Number(raw);
  return Number.isNaN(number) ? raw : number;
}

// Numbers before texts; what is missing stands last in either direction.
function compareValues(a, b, direction) {
  if (a === null || b === null) return (a === null) - (b === null);
  if (typeof a !== typeof b) return typeof a === "number" ? -direction : direction;
  if (typeof a === "number") return direction * (a - b);
  return direction * a.localeCompare(b, "en", { numeric: true });
}

function sortTable(table, column, direction) {
  const body = table.tBodies[0];
  const rows = Array.from(body.rows, (row, place) => ({ row, place, value: cellValue(row.cells[column]) }));
  rows.sort((a, b) => compareValues(a.value, b.value, direction) || a.place - b.place);
  body.append(...rows.map((each) => each.row));
}

function makeSortable(table) {
  const heads = Array.from(table.tHead.rows[0].cells);
  heads.forEach((head, column) => {
    head.querySelector("button").addEventListener("click", () => {
      const direction = head.getAttribute("aria-sort") === "ascending" ? -1 : 1;
      heads.forEach((each) => each.removeAttribute("aria-sort"));
      head.setAttribute("aria-sort", direction > 0 ? "ascending" : "descending");
      sortTable(table, column, direction);
    });
  });
}

// Gnuplot's numbers of the markers in the drawn figures.
const markers = {
  7: ["circle", 0], 5: ["rect", 0], 9: ["triangle", 0], 13: ["rectRot", 0], 11: ["triangle", 180], 15: ["rectRounded", 0],
};

function superscript(exponent) {
  const digits = "\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079";
  return String(exponent).replace("-", "\u207b").replace(/\d/g, (digit) => digits[digit]);
}

// Ticks of a logarithmic axis: powers of ten, not more than ten of them, or 1, 2 and 5 times them on a short axis.
function logTicks(scale) {
  const from = Math.log10(scale.min), to = Math.log10(scale.max);
  if (!Number.isFinite(from) || !Number.isFinite(to)) return;
  const factors = to - from < 1.5 ? [1, 2, 5] : [1], every = Math.max(1, Math.ceil((to - from) / 10));
  const ticks = [];
  for (let exponent = Math.floor(from); exponent <= Math.ceil(to); ++exponent)
    for (const factor of factors) {
      const value = Number(`${factor}e${exponent}`);
      if (exponent % every === 0 && value >= scale.min && value <= scale.max) ticks.push({ value, major: factor === 1 });
    }
  if (ticks.length > 1) scale.ticks = ticks;
}

function logLabel(value) {
  const exponent = Math.log10(value);
  return Math.abs(exponent - Math.round(exponent)) > 1e-6 ? Number(value.toPrecision(2)).toString() : "10" + superscript(Math.round(exponent));
}

function dashOf(dash) {
  return dash === "solid" ? [] : dash.replace(/[()]/g, "").split(",").map(Number);
}

function datasetOf(series, logX, logY) {
  const [pointStyle, rotation] = markers[series.marker] || ["circle", 0];
  const usable = (value, log) => value !== null && (!log || value > 0);
  const points = series.x.map((x, k) => ({ x, y: series.y[k], hollow: series.hollow[k] === true, bar: series.bars[k] }))
    .filter((point) => usable(point.x, logX) && usable(point.y, logY));
  return {
    label: series.label, data: points, borderColor: series.colour, borderWidth: 1.6, borderDash: dashOf(series.dash),
    pointStyle, rotation, pointRadius: 4, pointHoverRadius: 6, pointBorderColor: series.colour,
    pointBackgroundColor: points.map((point) => (point.hollow ? "#ffffff" : series.colour)), tension: 0,
    // No line between two hollow points.
    segment: { borderColor: (c) => (points[c.p0DataIndex].hollow && points[c.p1DataIndex].hollow ? "transparent" : undefined) },
  };
}

function axis(label, log) {
  return {
    type: log ? "logarithmic" : "linear", title: { display: true, text: label, color: "#1a1a1a" },
    grid: { color: "#e6e6e6" }, ticks: log ? { callback: logLabel, autoSkip: false, maxRotation: 0, color: "#1a1a1a" } : {},
    afterBuildTicks: log ? logTicks : undefined,
  };
}

// A rectangle drawn with the mouse becomes the range of the axes; a double click gives back all.
const dragZoom = {
  id: "dragZoom",
  afterEvent(chart, args) {
    const event = args.event, area = chart.chartArea;
    const inside = event.x >= area.left && event.x <= area.right && event.y >= area.top && event.y <= area.bottom;
    if (event.type === "mousedown" && inside) chart.$drag = { from: event, to: event };
    if (event.type === "mousemove" && chart.$drag) { chart.$drag.to = event; args.changed = true; }
    if (event.type === "mouseup" && chart.$drag) {
      const { from, to } = chart.$drag;
      chart.$drag = null;
      args.changed = true;
      if (Math.abs(from.x - to.x) > 8 && Math.abs(from.y - to.y) > 8) zoom(chart, from, to);
    }
    if (event.type === "dblclick") zoom(chart, null, null);
  },
  afterDraw(chart) {
    if (!chart.$drag) return;
    const { from, to } = chart.$drag;
    chart.ctx.save();
    chart.ctx.fillStyle = "rgba(0, 88, 138, 0.12)";
    chart.ctx.fillRect(from.x, from.y, to.x - from.x, to.y - from.y);
    chart.ctx.restore();
  },
};

function zoom(chart, from, to) {
  for (const [name, place] of [["x", "x"], ["y", "y"]]) {
    const options = chart.options.scales[name];
    if (from === null) {
      Object.assign(options, chart.$whole[name]);
      continue;
    }
    const ends = [from[place], to[place]].map((pixel) => chart.scales[name].getValueForPixel(pixel)).sort((a, b) => a - b);
    options.min = ends[0];
    options.max = ends[1];
  }
  chart.update("none");
}

// The least and the most of repeated times, as lines with ends.
const errorBars = {
  id: "errorBars",
  beforeDatasetsDraw(chart) {
    const { ctx, chartArea: area, scales: { x, y } } = chart;
    ctx.save();
    ctx.beginPath();
    ctx.rect(area.left, area.top, area.width, area.height);
    ctx.clip();
    chart.data.datasets.forEach((each, k) => {
      if (!chart.isDatasetVisible(k)) return;
      ctx.strokeStyle = each.borderColor;
      for (const point of each.data) {
        if (!point.bar || point.bar[0] === null || !(point.bar[0] > 0) || !(point.bar[0] < point.bar[1])) continue;
        const [from, to] = point.bar.map((value) => x.getPixelForValue(value)), at = y.getPixelForValue(point.y);
        ctx.beginPath();
        ctx.moveTo(from, at), ctx.lineTo(to, at);
        for (const end of [from, to]) ctx.moveTo(end, at - 3), ctx.lineTo(end, at + 3);
        ctx.stroke();
      }
    });
    ctx.restore();
  },
};

// The ends of an axis, a little beyond the data on a logarithmic one; else the library chooses them.
function rangeOf(values, log) {
  if (!log || values.length === 0) return { min: undefined, max: undefined };
  const least = Math.min(...values), most = Math.max(...values), factor = Math.max(1.1, Math.pow(most / least, 0.04));
  return { min: least / factor, max: most * factor };
}

// The corners of a Pareto front as steps from the top of the data to their right.
function frontSteps(front, mostX, mostY) {
  const steps = [];
  let y = mostY;
  for (const [x, at] of front.slice().sort((a, b) => a[0] - b[0] || a[1] - b[1])) {
    if (steps.length > 0 && at >= y) continue;
    steps.push({ x, y }, { x, y: at });
    y = at;
  }
  if (steps.length > 0) steps.push({ x: Math.max(mostX, steps[steps.length - 1].x), y });
  return steps;
}

function makePlot(holder, panel, figure) {
  const box = document.createElement("div");
  box.className = "plot";
  const canvas = document.createElement("canvas");
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", `${panel.y_label} against ${panel.x_label}`);
  box.append(canvas);
  holder.append(box);
  const datasets = panel.series.map((series) => datasetOf(series, panel.log_x, panel.log_y)).filter((each) => each.data.length > 0);
  const xs = datasets.flatMap((each) => each.data.map((point) => point.x));
  const ys = datasets.flatMap((each) => each.data.map((point) => point.y));
  for (const line of panel.lines) {
    // One far below the data would only squeeze them.
    if (xs.length === 0 || (panel.log_y && line.y < 1e-3 * Math.min(...ys))) continue;
    datasets.push({
      label: line.label, data: [{ x: Math.min(...xs), y: line.y }, { x: Math.max(...xs), y: line.y }],
      borderColor: "#777777", borderDash: [2, 3], borderWidth: 1.2, pointRadius: 0, pointHitRadius: 0, pointStyle: "line",
    });
  }
  const usable = (value, log) => value !== null && (!log || value > 0);
  const front = panel.front.filter(([x, y]) => usable(x, panel.log_x) && usable(y, panel.log_y));
  if (front.length > 0 && xs.length > 0)
    datasets.push({
      label: figure.front_note, data: frontSteps(front, Math.max(...xs), Math.max(...ys)), borderColor: "#b4b4b4", borderWidth: 3,
      pointRadius: 0, pointHitRadius: 0, pointStyle: "line", order: 1,
    });
  // Runs that failed have no error: crosses above all data, those of one place above each other; at the left where their
  // place is not known.
  const failures = panel.failures.filter((each) => each.x === null || usable(each.x, panel.log_x));
  const failedXs = failures.map((each) => each.x).concat(xs).filter((x) => x !== null);
  if (failures.length > 0 && ys.length > 0 && failedXs.length > 0) {
    const most = Math.max(...ys), least = Math.min(...ys), lowest = Math.min(...failedXs), stacked = new Map();
    const raised = (by) => panel.log_y ? most * Math.pow(Math.max(10, most / least), by) : most + by * (most - least || 1);
    datasets.push({
      label: figure.failure_note.split(":")[0], showLine: false,
      data: failures.map((each) => {
        const x = each.x === null ? lowest : each.x, place = stacked.get(x) || 0;
        stacked.set(x, place + 1);
        return { x, y: raised(0.06 + 0.025 * place), what: each.label };
      }),
      borderColor: "#777777", pointStyle: "crossRot", pointRadius: 5, pointHoverRadius: 7, pointBorderWidth: 1.6,
      pointBorderColor: failures.map((each) => each.colour),
    });
  }
  const every = datasets.flatMap((each) => each.data);
  const whole = {
    x: rangeOf(every.map((point) => point.x), panel.log_x), y: rangeOf(every.map((point) => point.y), panel.log_y),
  };
  const title = [panel.title, datasets.some((each) => each.data.some((point) => point.hollow)) ? figure.hollow_note : ""];
  const chart = new Chart(canvas, {
    type: "line", data: { datasets }, plugins: [dragZoom, errorBars],
    options: {
      animation: false, maintainAspectRatio: false, parsing: false, normalized: false, events:
        ["mousemove", "mouseout", "click", "mousedown", "mouseup", "dblclick", "touchstart", "touchmove"],
      interaction: { mode: "nearest", intersect: true },
      scales: { x: { ...axis(panel.x_label, panel.log_x), ...whole.x }, y: { ...axis(panel.y_label, panel.log_y), ...whole.y } },
      plugins: {
        title: { display: title.join("") !== "", text: title.filter((line) => line !== ""), color: "#1a1a1a" },
        legend: { position: "bottom", labels: { usePointStyle: true, boxWidth: 8, boxHeight: 8, font: { size: 11 }, color: "#1a1a1a" } },
        tooltip: {
          callbacks: {
            label: (item) => item.raw.what ? item.raw.what : `${item.dataset.label}: ${Number(item.raw.x.toPrecision(4))}, ${Number(item.raw.y.toPrecision(3))}` +
              (item.raw.hollow ? " (at the bound)" : ""),
          },
        },
      },
    },
  });
  chart.$whole = whole;
  return chart;
}

const gnomonPlots = [];

function makeFigure(figure) {
  const data = figure.querySelector("script[type='application/json']");
  if (!data || figure.classList.contains("live")) return;
  figure.classList.add("live");
  if (figure.querySelector("img.drawn")) figure.classList.add("has-drawn");
  const content = JSON.parse(data.textContent);
  for (const panel of content.panels) gnomonPlots.push(makePlot(figure.querySelector(".plots"), panel, content));
}

document.querySelectorAll("table.sortable").forEach(makeSortable);
if (typeof Chart !== "undefined") {
  Chart.defaults.font.family = '"DejaVu Sans", Verdana, sans-serif';
  document.documentElement.classList.add("interactive");
  document.querySelectorAll("figure").forEach(makeFigure);
}
