// Studies of `bench` that cannot be made.
#include "src/study/study_file.hpp"
#include "tests/cli/refusal.hpp"

namespace fs = std::filesystem;
using namespace gnomon::test;
using namespace gnomon::test::cli;

namespace {

void check_study_refused(const std::string& study, const std::string& message) {
  check_refused({{"bad.toml", study}, {"s.toml", good}}, {"bench", "--study", "bad.toml", "--out", "out"},
                "bad.toml:" + message);
}

}  // namespace

TEST_CASE("bench: the studies that are shipped can be made", "[cli]") {
  REQUIRE(catalogue().study_files.size() >= 3);
  for (const std::string& file : catalogue().study_files)
    CHECK_NOTHROW(gnomon::read_study(file, &catalogue()));
}

TEST_CASE("bench: a study with a wrong name is refused before anything is written", "[cli]") {
  check_study_refused("converge = [\"s.toml\"]\nintegrators = [\"rkmk4\",\n \"munjizza\"]\n",
                      "3: integrators: found the unknown name 'munjizza', expected munjiza");
  check_study_refused("integrators = [\"rkmk4\", \"rkmk4\"]\n",
                      "1: integrators: found 'rkmk4' twice, expected every name once");
  check_study_refused(
      "\nconverge = [\"s.toml\",\n\"asymetric-free-top\"]\n",
      "3: converge: scene 'asymetric-free-top': found no shipped scene of that name, expected "
      "asymmetric-free-top or a path that ends in .toml");
  check_study_refused("compare = [\"none.toml\"]\n",
                      "1: compare: none.toml: found no such file, expected a scene file");
  check_study_refused("scorecard = [\"space-moment\"]\nintegrators = [\"exact-free-top\"]\n",
                      "2: integrators: found none that runs on scene 'space-moment' (model rigid_body, load "
                      "space_moment), expected at least " +
                          integrators_for("space-moment"));
  for (const char* none : {"", "# nothing\n", "converge = []\nintegrators = [\"rkmk4\"]\n"})
    check_study_refused(
        none,
        " found no part, expected lists of scenes (converge, compare, scorecard or the same with quick_) or "
        "tables [[drift]], [[work]], [[speed]], [[survey]], [[peers]], [[vary]] or [[refine]]");
  check_study_refused("\nconverge = ]\n", "2: found what is not TOML, expected valid TOML (");
}

TEST_CASE("bench: every part of a study is checked before anything is written", "[cli]") {
  const std::string misfit =
      "found 'exact-free-top', which does not run on scene 'space-moment' (model rigid_body, load "
      "space_moment), expected " +
      integrators_for("space-moment");
  const std::string scene = "scene = \"space-moment\"\n", names = "integrators = [\"exact-free-top\"]\n";
  check_study_refused("[[drift]]\nt_end = 1\nstep = 0.1\n" + scene + names,
                      "5: drift[0].integrators: " + misfit);
  for (const char* times : {"[]", "[0.0]", "[0.5, 1.5]", "[0.5, 0.5]"})
    check_study_refused(
        "[[drift]]\nt_end = 1\nstep = 0.1\nerror_times = " + std::string(times) + "\n" + scene + names,
        "4: drift[0].error_times: found " + std::string(times) +
            ", expected different times from above 0 to t_end = 1 (s)");
  check_study_refused("[[work]]\nsteps = [0.1, 0.2]\ntols = [1e-3, 1e-4]\n" + scene + names,
                      "5: work[0].integrators: " + misfit);
  check_study_refused("[[speed]]\nstep = 0.1\n" + scene + names, "4: speed[0].integrators: " + misfit);
  check_study_refused(
      "[[speed]]\nstep = 0.1\n" + scene + "set = [\"t_end=1\", \"body.inertias=1\"]\n",
      "4: speed[0].set: body.inertias=1: body.inertias: found an unknown key, expected one of "
      "inertia, orientation, rotation_vector, angular_momentum, angular_velocity");
  check_study_refused(
      "[[survey]]\nlabel = \"a\"\nscene = \"spacemoment\"\nstep = 1\nt_end = 1\n",
      "3: survey[0].scene: scene 'spacemoment': found no shipped scene of that name, expected "
      "space-moment or a path that ends in .toml");
  check_study_refused(
      "[[survey]]\nlabel = \"a\"\nstep = 1\nt_end = 1\n" + scene + "closed_form_scene = \"spacemoment\"\n",
      "6: survey[0].closed_form_scene: scene 'spacemoment': found no shipped scene of that "
      "name, expected space-moment or a path that ends in .toml");
  check_study_refused("[[peers]]\nlevels = [1, 2, 3, 4]\ngoals = [1, 1, 1, 1]\n" + scene + names,
                      "5: peers[0].integrators: " + misfit);
  const std::string vary = "[[vary]]\nlabel = \"a\"\n" + scene;
  check_study_refused(
      vary + "key = \"load.moment\"\nvalues = [[1, 2, 3], [1, 2]]\n",
      "5: vary[0].values: load.moment=[1, 2]: load.moment: found [1, 2], expected three finite "
      "numbers (N m)");
  check_study_refused(
      vary +
          "key = \"t_end\"\nvalues = [1, 2]\nwhat = \"stability\"\nintegrators = "
          "[\"rkmk4\", \"cvode-bdf\"]\n",
      "7: vary[0].integrators: found 'cvode-bdf' (adaptive), expected schemes that take equal "
      "steps, as what = \"stability\"");
  const auto refine = [](const std::string& of, const std::string& component, const std::string& mesh) {
    return "[[refine]]\nlabel = \"a\"\nscene = \"" + of +
           "\"\nrow_key = \"beam.order\"\nrow_values = [1, 2]\nkey = \"beam.elements\"\nvalues = [2, 4]\n"
           "probe = \"end\"\ncomponents = [\"" +
           component + "\"]\nreference = [\"" + mesh + "\"]\ncoarser = [\"beam.elements=6\"]\n";
  };
  check_study_refused(
      refine("elastica", "y", "beam.elements=8"),
      "9: refine[0].components: found 'end y', expected some of start x, start z, start phi, end x, "
      "end z, end phi");
  check_study_refused(refine("elastica", "x", "beam.element=8"),
                      "10: refine[0].reference: beam.element=8: beam.element: found an unknown key, expected "
                      "one of length, elements, order, EA, GA, EI, rhoA, rhoI, start, angle, curvature, "
                      "gravity, damping, bends, hinges, geometry");
  check_study_refused(refine("flying-beam", "x", "beam.elements=8"),
                      "3: refine[0].scene: found in scene flying-beam a beam that can move freely as a rigid "
                      "body, expected one that is held in place");
}

TEST_CASE("bench: a study that is refused leaves an earlier store alone", "[cli]") {
  const std::string record = "{\"key\":\"session a\",\"kind\":\"session\",\"code\":\"another\"}\n";
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "out");
  write_text(folder.path() / "out" / "runs.jsonl", record);
  const auto refused = [&](const std::string& study, const Words& more) {
    write_text(folder.path() / "bad.toml", study);
    Words words{"bench", "--study", "bad.toml", "--quick", "--out", "out"};
    words.insert(words.end(), more.begin(), more.end());
    CHECK(run_program(words, folder.path()).exit_code == 2);
    CHECK(content_of(folder.path() / "out" / "runs.jsonl") == record);
    CHECK(folder.entries() == 2);
    CHECK(std::distance(fs::directory_iterator(folder.path() / "out"), {}) == 1);
  };
  refused("quick_converge = [\"space-moment\"]\nintegrators = [\"munjizza\"]\n", {});
  refused("[[drift]]\nscene = \"spacemoment\"\nt_end = 1\nstep = 0.1\nintegrators = [\"rkmk4\"]\n",
          {"--fresh"});
  refused("quick_converge = [\"space-moment\"]\nintegrators = [\"rkmk4\"]\n", {"--jobs", "none"});
}
