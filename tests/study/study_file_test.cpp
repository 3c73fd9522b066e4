#include "src/study/study_file.hpp"

#include <algorithm>
#include <fstream>
#include <string>

#include "src/error.hpp"
#include "src/study/published.hpp"
#include "tests/catch.hpp"
#include "tests/output/temporary_folder.hpp"

using namespace gnomon;

namespace {

std::string refusal(const std::string& text) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "study.toml";
  std::ofstream(path) << text;
  try {
    read_study(path.string());
  } catch (const UsageError& error) {
    const std::string message = error.what();
    return message.substr(message.find(".toml:") + 6);
  }
  return "nothing";
}

}  // namespace

TEST_CASE("study file: what it says is read", "[study]") {
  const StudyPlan plan = read_study(GNOMON_SOURCE_DIR "/models/rigid_body/study.toml");
  CHECK(plan.converge.size() >= 11);
  CHECK(plan.compare.size() >= plan.quick_compare.size());
  REQUIRE(!plan.drift.empty());
  CHECK(plan.drift[0].scene == "asymmetric-free-top");
  CHECK(plan.drift[0].t_end == 1e4);
  CHECK(plan.drift[0].quick_t_end == 1e3);
  CHECK(!plan.drift[1].quick_t_end);
  CHECK(plan.drift[0].integrators.front() == "munjiza");
  CHECK(plan.drift[0].steps == std::vector<double>{0.1});
  CHECK(plan.drift[0].tol == 1e-8);
  const StudyPlan beams = read_study(GNOMON_SOURCE_DIR "/models/planar_beam/study.toml");
  REQUIRE(beams.drift.size() == 3);
  CHECK(beams.drift[1].steps == std::vector<double>{0.05, 0.1, 0.25, 0.5});
  CHECK(!beams.drift[1].tol);
  CHECK(beams.drift[1].error_times == std::vector<double>{20.0, 50.0});
  CHECK(plan.drift[0].label == "asymmetric-free-top");
  const auto longest = std::ranges::find(plan.drift, "asymmetric-free-top-1e8-steps", &DriftPlan::label);
  REQUIRE(longest != plan.drift.end());
  CHECK(longest->t_end / longest->steps.front() == 1e8);
  CHECK(!longest->quick_t_end);
  const auto box = std::ranges::find(plan.drift, "tumbling-box", &DriftPlan::scene);
  REQUIRE(box != plan.drift.end());
  REQUIRE(box->published.size() == 4);
  CHECK(box->published[2].name == "Simbody");
  CHECK(box->published[2].max_drift == 6.7e-4);
  output::Table drifts;
  drifts.columns = {{"integrator", "integrator"}, {"setting", "setting"}, {"max_drift", "largest drift"}};
  add_published(*box, drifts);
  REQUIRE(drifts.rows.size() == 4);
  CHECK(drifts.rows[3][0].text == "DART (published)");
  CHECK(drifts.rows[3][1].raw.empty());
  CHECK(drifts.rows[3][2].text == "1.90");
  CHECK(drifts.notes.size() == 1);
  REQUIRE(!plan.vary.empty());
  CHECK(plan.vary[0].variation.key == "body.angular_momentum");
  CHECK(plan.vary[0].variation.values.front() == "[0.0, 2.0, 0.01]");
  CHECK(plan.vary[0].steps == std::vector<double>{0.05});
  CHECK(plan.vary[0].tols == std::vector<double>{1e-10});
  CHECK(plan.vary[0].full_only);
  CHECK(!plan.vary[0].stability);
  REQUIRE(beams.work.size() == 2);
  CHECK(beams.work[1].scene == "spin-up-short");
  CHECK(beams.work[1].tols.front() == 1e-3);
  CHECK(beams.work[1].timing_budget < 1e3);
  REQUIRE(beams.vary.size() >= 2);
  CHECK(beams.vary[0].variation.key == "beam.EA,beam.GA");
  CHECK(beams.vary[0].variation.numbers().value().back() == 1e10);
  CHECK(beams.vary[0].variation.values.back() == "1e+10");
  CHECK(beams.vary[0].time_limit == 2.0);
  REQUIRE(beams.refine.size() == 2);
  CHECK(beams.refine[0].orders == std::vector<double>{2, 4, 6, 8});
  CHECK(beams.refine[1].row_set.size() == 4);
  for (const StudyPlan* each : {&plan, &beams}) {
    const auto map = std::ranges::find(each->vary, true, &VaryPlan::stability);
    REQUIRE(map != each->vary.end());
    CHECK(map->label.ends_with("-stability"));
    CHECK(map->full_only);
  }
  REQUIRE(beams.speed.size() >= 3);
  CHECK(beams.speed[0].scalar);
  CHECK(beams.speed[0].integrators.size() == 2);
  CHECK(plan.speed.size() >= 4);
  CHECK(!plan.speed[0].scalar);
  REQUIRE(plan.survey.size() >= 4);
  CHECK(plan.survey[1].label == "space moment");
  CHECK(plan.survey[1].key() == "space_moment");
  CHECK(plan.survey[0].t_end >= 1e4);
}

TEST_CASE("study file: what does not fit is refused", "[study]") {
  CHECK(refusal("converge = [\"kovalevskaya\"]\n") == "nothing");
  CHECK(refusal("converge = []\n").starts_with(" found no part"));
  CHECK(refusal("convurge = []\n") == "1: convurge: found an unknown key, expected converge");
  CHECK(refusal("converge = \"a\"\n") == "1: converge: found \"a\", expected names of scenes");
  CHECK(refusal("compare = [1]\n") == "1: compare: found [1], expected names of scenes");
  CHECK(refusal("drift = 1\n") == "1: drift: found 1, expected tables [[drift]]");
  const std::string drift = "[[drift]]\nscene = \"a\"\nt_end = 1\n";
  CHECK(refusal(drift + "integrators = []\nsteps = [0.1, 0.2]\n") == "nothing");
  CHECK(refusal(drift) ==
        "1: drift[0].step: found nothing, expected step or steps (one step, or several as a list)");
  CHECK(refusal(drift + "step = 1\nsteps = [1, 2]\n") ==
        "5: drift[0].steps: found both step and steps, expected only one of them (one step, or several as a "
        "list)");
  for (const char* steps : {"[1]", "[1, -2]", "1"})
    CHECK(refusal(drift + "steps = " + steps + "\n") ==
          std::string("4: drift[0].steps: found ") + steps + ", expected positive numbers (s), at least two");
  CHECK(refusal(
            drift +
            "step = 1\nintegrators = []\npublished = [{name = \"x\", invariant = \"y\", max_drift = 1}]\n") ==
        "1: drift[0].source: found nothing, expected where it was published");
  CHECK(refusal("[[speed]]\nscene = \"a\"\nstep = -1\n") ==
        "3: speed[0].step: found -1, expected a positive number (s)");
  CHECK(refusal("[[speed]]\nscene = \"a\"\nstep = 1\ntol = 1\n") ==
        "4: speed[0].tol: found an unknown key, expected one of scene, step, steps, parts, newton_tol, set, "
        "instructions_key, scalar, integrators, full_only");
  const std::string work = "[[work]]\nscene = \"a\"\nintegrators = []\ntols = [1e-3, 1e-5]\n";
  CHECK(refusal(work + "steps = [0.1, 0.2]\ntime_limit = 1\ntiming_budget = 2\n") == "nothing");
  CHECK(refusal(work + "steps = [0.1]\n") ==
        "5: work[0].steps: found [0.1], expected positive numbers (s), at least two");
  CHECK(refusal(work + "steps = [0.1, 0.2]\ntime_limit = 0\n") ==
        "6: work[0].time_limit: found 0, expected a positive number (s)");
  const std::string vary = "[[vary]]\nlabel = \"a\"\nscene = \"a\"\nkey = \"b\"\n";
  CHECK(refusal(vary + "values = [1, \"none\", [2]]\nwhat = \"stability\"\n") == "nothing");
  CHECK(refusal(vary) == "1: vary[0].values: found nothing, expected values of the key, every one once");
  CHECK(refusal(vary + "values = [1, 1.0]\n") ==
        "5: vary[0].values: found 1.0 twice, expected values of the key, every one once");
  CHECK(refusal(vary + "values = [1]\nwhat = \"speed\"\n") ==
        "6: vary[0].what: found \"speed\", expected one of errors, stability");
  CHECK(refusal(vary + "values = [1]\nsteps = [0.1, 0]\n") ==
        "6: vary[0].steps: found [0.1, 0], expected one or more positive numbers (s)");
  CHECK(refusal(vary + "values = [1]\ntiming_budget = -1\n") ==
        "6: vary[0].timing_budget: found -1, expected a positive number (s)");
  const std::string refine =
      "[[refine]]\nlabel = \"a\"\nscene = \"a\"\nrow_key = \"p\"\nrow_values = [1, 2]\nkey = \"n\"\n"
      "probe = \"end\"\ncomponents = [\"x\"]\nreference = [\"n=9\"]\n";
  const std::string fine = "coarser = [\"n=8\"]\n", numbers = "values = [2, 4]\n";
  CHECK(refusal(refine + fine + numbers + "orders = [2, 4]\nrow_set = [\"a=1\", \"a=2\"]\n") == "nothing");
  CHECK(refusal(refine + numbers) ==
        "1: refine[0].coarser: found nothing, expected texts key.path=value that make another fine mesh");
  CHECK(refusal(refine + fine + "values = [2, \"a\"]\n") ==
        "11: refine[0].values: found [2, \"a\"], expected positive numbers");
  CHECK(refusal(refine + fine + numbers + "orders = [2]\n") ==
        "12: refine[0].orders: found [2], expected one a row, 2 of them");
  CHECK(refusal(refine + fine + numbers + "orders = [2, -4]\n") ==
        "12: refine[0].orders: found [2, -4], expected positive numbers, one a row");
  CHECK(refusal(refine + fine + numbers + "row_set = [\"a=1\"]\n") ==
        "12: refine[0].row_set: found [\"a=1\"], expected one a row, 2 of them");
  CHECK(refusal("[[vary]]\nlabel = \"a/b\"\n") ==
        "2: vary[0].label: found \"a/b\", expected a name of letters, digits, - and _");
}
