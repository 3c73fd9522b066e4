// Wrong command lines: exit code 2, one exact line on standard error, nothing written.
#include "tests/cli/refusal.hpp"

namespace fs = std::filesystem;
using namespace gnomon::test;
using namespace gnomon::test::cli;

TEST_CASE("cli: a wrong command line is refused before anything is written", "[cli]") {
  struct Case {
    Words arguments;
    std::string message;
  };
  const std::string step = "a positive number (s)",
                    tol = "a tolerance from 1e-15 (about the precision of numbers) to below 1";
  const std::string samples = "a whole number from 1 to 1000000, in digits";
  const auto with = [](const Words& more) {
    Words words{"run", "s.toml", "--integrator", "rkmk4"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  const auto converge = [](const Words& more) {
    Words words{"converge", "s.toml", "--out", "out", "--json", "out.json"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  const std::vector<Case> cases{
      // Commands.
      {{}, "found no command, expected " + commands + " (gnomon --help explains them)"},
      {{"rnu"}, "found the unknown command 'rnu', expected run"},
      {{"solve"}, "found the unknown command 'solve', expected " + commands},
      {{""}, "found the unknown command '', expected " + commands},
      {{"--quiet", "run"},
       "found '--quiet' where the command stands, expected " + commands + " (or --help, --version)"},
      {{"--version", "run"}, "--version: found 'run', expected no further argument"},
      {{"list", "foo"}, "list: found 'foo', expected scenes, models or integrators"},
      {{"list", "run"}, "list: found 'run', expected scenes, models or integrators"},
      {{"list", "scenes", "models"}, "list: found 'models', expected no further argument"},
      {{"doctor", "s.toml"}, "doctor: found 's.toml', expected no further argument"},
      // Scenes.
      {{"run"}, "SCENE: found nothing, expected the name of a shipped scene or a .toml file"},
      {{"run", ""}, "SCENE: found '', expected the name of a shipped scene or a .toml file"},
      {run_of("none.toml"), "none.toml: found no such file, expected a scene file"},
      {run_of("/tmp/."), "scene '/tmp/.': found no shipped scene of that name, expected " +
                             shipped_scene_names() + " or a path that ends in .toml"},
      {run_of("asymetric-free-top"),
       "scene 'asymetric-free-top': found no shipped scene of that name, expected "
       "asymmetric-free-top or a path that ends in .toml"},
      {run_of("s.toml", {"space-moment"}), "run: found 2 scenes, expected one"},
      {run_of("s.toml", {"list"}), "run: found 2 scenes, expected one"},
      {{"compare", "s.toml", "none.toml", "--steps", "0.1"},
       "none.toml: found no such file, expected a scene file"},
      {{"compare", "s.toml", "s.toml"},
       "SCENE: found two scenes with the name 'a', expected different names"},
      // Options.
      {{"converge", "s.toml", "--refine", "beam.elements"},
       "--refine: found 'beam.elements', expected KEY=V1,V2,.. with at least two ascending numbers, as in "
       "beam.elements=4,8,16,32"},
      {{"converge", "s.toml", "--refine", "beam.elements=8,4"},
       "--refine: found 'beam.elements=8,4', expected KEY=V1,V2,.. with at least two ascending numbers, as "
       "in "
       "beam.elements=4,8,16,32"},
      {{"converge", "s.toml", "--refine", "beam.elements=4,x"},
       "--refine: found 'x', expected positive numbers in KEY=V1,V2,.."},
      {{"converge", "s.toml", "space-moment", "--refine", "beam.elements=4,8"},
       "--refine: found 2 scenes, expected one"},
      {{"converge", "s.toml", "--refine", "t_end=1,2"},
       "--refine: found scene 'a' of model rigid_body, expected a model with a mesh"},
      {run_of("s.toml", {"--smaples", "3"}), "run: found the unknown option '--smaples', expected --samples"},
      {run_of("s.toml", {"-x"}),
       "run: found the unknown option '-x', expected one of --integrator, --step, --tol, --t-end, --set, "
       "--max-steps, --time-limit, --newton-tol, --spectral-radius, --modified-newton, --linear-solver, "
       "--samples, --json, --csv, --latex, --out, --no-reference, "
       "--no-timing, "
       "--quiet, "
       "--help"},
      {run_of("s.toml", {"--steps", "1"}), "run: found the unknown option '--steps', expected --step"},
      {run_of("s.toml", {"--step", "0.2"}), "--step: found twice, as '0.1' and '0.2', expected once"},
      {run_of("s.toml", {"--samples"}), "--samples: found no value, expected --samples N"},
      {run_of("s.toml", {"--samples", "--quiet"}), "--samples: found no value, expected --samples N"},
      {run_of("s.toml", {"--samples="}), "--samples: found no value, expected --samples N"},
      {run_of("s.toml", {"--set", ""}), "--set: found no value, expected --set KEY.PATH=VALUE"},
      {run_of("s.toml", {"--quiet=yes"}), "--quiet: found the value 'yes', expected none"},
      // What the library would read in another way, or each of its versions in its own.
      {run_of("s.toml", {"--json=", "t.toml"}), "--json: found no value, expected --json FILE"},
      {run_of("s.toml", {"--", "--quiet"}), "run: found 2 scenes, expected one"},
      {run_of("s.toml", {"++", "list"}), "run: found 3 scenes, expected one"},
      {run_of("s.toml", {"--samples", "[1,2]"}), "--samples: found '[1,2]', expected " + samples},
      {run_of("s.toml", {"--samples={}"}), "--samples: found '{}', expected " + samples},
      {with({"--step", "-h"}), "--step: found '-h', expected " + step},
      {{"run.list"}, "found the unknown command 'run.list', expected " + commands},
      // Integrators.
      {{"run", "s.toml", "--step", "1"}, "--integrator: found nothing, expected the name of one integrator"},
      {{"run", "s.toml", "--integrator", "rkmk4,munjiza", "--step", "1"},
       "--integrator: found 'rkmk4,munjiza', expected the name of one integrator"},
      {{"run", "s.toml", "--integrator", "rkkm4", "--step", "1"},
       "--integrator: found the unknown name 'rkkm4', expected rkmk4"},
      {{"run", "s.toml", "--integrator", "euler", "--step", "1"},
       "--integrator: found the unknown name 'euler', expected " + integrators_for("asymmetric-free-top")},
      {{"run", "space-moment", "--integrator", "exact-free-top"},
       "--integrator: found 'exact-free-top', which does not run on scene 'space-moment' (model rigid_body, "
       "load "
       "space_moment), expected " +
           integrators_for("space-moment")},
      {converge({"--integrators", "rkmk4,,munjiza"}),
       "--integrators: found 'rkmk4,,munjiza', expected names with one comma between them"},
      {converge({"--integrators", "rkmk4,munjiza,rkmk4"}),
       "--integrators: found 'rkmk4' twice, expected every name once"},
      {converge({"--integrators", "rkmk4,exact-fre-top"}),
       "--integrators: found the unknown name 'exact-fre-top', expected exact-free-top"},
      // Steps and tolerances.
      {with({}), "--step: found nothing, expected --step H because rkmk4 takes equal steps"},
      {with({"--tol", "1e-3"}), "--step: found --tol, expected --step H because rkmk4 takes equal steps"},
      {with({"--tol", "1e-3", "--step", "0.1"}),
       "--tol: found both --step and --tol, expected only one of them"},
      {with({"--step", "0"}), "--step: found '0', expected " + step},
      {with({"--step", "-0.1"}), "--step: found '-0.1', expected " + step},
      {with({"--step=-0.1"}), "--step: found '-0.1', expected " + step},
      {with({"--step=abc"}), "--step: found 'abc', expected " + step},
      {with({"--step", "0.1s"}), "--step: found '0.1s', expected " + step},
      {with({"--step", "0,1"}), "--step: found '0,1', expected " + step},
      {with({"--step", "inf"}), "--step: found 'inf', expected " + step},
      {with({"--step", "nan"}), "--step: found 'nan', expected " + step},
      {with({"--step", "1e400"}), "--step: found '1e400', expected " + step},
      {with({"--step", ""}), "--step: found no value, expected --step H"},
      {with({"--step", "1\n2"}), "--step: found '1 2', expected " + step},
      {with({"--step", "1e-16"}), "--step: found '1e-16', expected at least 1e-15 s, 1 s / 1e15"},
      {{"run", "s.toml", "--integrator", "cvode-bdf"},
       "--tol: found nothing, expected --tol X because cvode-bdf chooses its own steps"},
      {{"run", "s.toml", "--integrator", "cvode-bdf", "--step", "0.1"},
       "--tol: found --step, expected --tol X because cvode-bdf chooses its own steps"},
      {{"run", "s.toml", "--integrator", "cvode-bdf", "--tol", "1"}, "--tol: found '1', expected " + tol},
      {{"run", "s.toml", "--integrator", "cvode-bdf", "--tol", "0"}, "--tol: found '0', expected " + tol},
      {{"run", "s.toml", "--integrator", "ida-bdf", "--tol", "1e-300"},
       "--tol: found '1e-300', expected " + tol},
      {{"run", "s.toml", "--integrator", "exact-free-top", "--step", "0.1"},
       "--step: found --step, expected neither --step nor --tol because exact-free-top is a closed form"},
      {{"drift", "s.toml", "--integrators", "rkmk4", "--step", "0.1", "--steps", "0.1,0.2"},
       "--step: found '0.1' beside --steps, expected only one of them"},
      {{"drift", "s.toml", "--integrators", "cvode-bdf", "--tol", "1e-3", "--tols", "1e-3,1e-4"},
       "--tol: found '1e-3' beside --tols, expected only one of them"},
      {{"drift", "s.toml", "--integrators", "rkmk4", "--error-at", "0.5,0"},
       "--error-at: found '0', expected positive numbers (s) with one comma between them"},
      {{"drift", "s.toml", "--integrators", "rkmk4", "--error-at", "0.5,0.5"},
       "--error-at: found '0.5' twice, expected every value once"},
      {{"drift", "s.toml", "--integrators", "rkmk4", "--error-at", "0.5,3"},
       "--error-at: found '0.5,3', expected times up to the end of a, t = 1 s"},
      {converge({"--steps", "0.1,-0.2"}),
       "--steps: found '-0.2', expected positive numbers (s) with one comma between them"},
      {converge({"--steps", "0.1,"}),
       "--steps: found '', expected positive numbers (s) with one comma between them"},
      {converge({"--steps", "0.1,0.10"}), "--steps: found '0.10' twice, expected every value once"},
      {converge({"--steps", "0.1,1e-20"}), "--steps: found '1e-20', expected at least 1e-15 s, 1 s / 1e15"},
      {converge({"--tols", "1e-3,2"}),
       "--tols: found '2', expected tolerances from 1e-15 (about the precision of numbers) to below 1, with "
       "one "
       "comma between them"},
      {converge({"--integrators", "cvode-adams,exact-free-top", "--steps", "0.1"}),
       "--steps: found '0.1', expected --tols because no chosen integrator takes equal steps"},
      {converge({"--integrators", "rkmk4,munjiza", "--tols", "1e-3"}),
       "--tols: found '1e-3', expected --steps because no chosen integrator chooses its own steps"},
      {{"drift", "s.toml", "--integrators", "rkmk4", "--tol", "1e-3"},
       "--tol: found '1e-3', expected --step because no chosen integrator chooses its own steps"},
      {converge({"--integrators", "exact-free-top", "--steps", "0.1"}),
       "--steps: found '0.1', expected nothing because only closed forms are to run"},
      // Numbers.
      {run_of("s.toml", {"--t-end", "0"}), "--t-end: found '0', expected " + step},
      {run_of("s.toml", {"--t-end", "-1"}), "--t-end: found '-1', expected " + step},
      {run_of("s.toml", {"--t-end", "ten"}), "--t-end: found 'ten', expected " + step},
      {run_of("s.toml", {"--t-end", "1e-300"}),
       "--t-end: found 1e-300 s, 1.09e-300 times the time scale of the motion, expected at least 1e-100 "
       "times"},
      {run_of("s.toml", {"--t-end", "1e20"}),
       "--t-end: found 1e+20 s, 1.09e+20 times the time scale of the motion, expected at most 1e15 times"},
      {run_of("s.toml", {"--samples", "0"}), "--samples: found '0', expected " + samples},
      {run_of("s.toml", {"--samples", "-1"}), "--samples: found '-1', expected " + samples},
      {run_of("s.toml", {"--samples", "1.5"}), "--samples: found '1.5', expected " + samples},
      {run_of("s.toml", {"--samples", "4294967297"}), "--samples: found '4294967297', expected " + samples},
      {run_of("s.toml", {"--max-steps", "0"}),
       "--max-steps: found '0', expected a whole number from 1 to 1000000000000000, in digits"},
      {run_of("s.toml", {"--max-steps", "99999999999999999999"}),
       "--max-steps: found '99999999999999999999', expected a whole number from 1 to 1000000000000000, in "
       "digits"},
      {run_of("s.toml", {"--time-limit", "0"}), "--time-limit: found '0', expected " + step},
      {run_of("s.toml", {"--newton-tol", "1"}),
       "--newton-tol: found '1', expected a tolerance between 0 and 1"},
      {run_of("s.toml", {"--spectral-radius", "1.1"}),
       "--spectral-radius: found '1.1', expected a number from 0 to 1"},
      {run_of("s.toml", {"--spectral-radius=-0.1"}),
       "--spectral-radius: found '-0.1', expected a number from 0 to 1"},
      {run_of("s.toml", {"--spectral-radius", "high"}),
       "--spectral-radius: found 'high', expected a number from 0 to 1"},
      {run_of("s.toml", {"--spectral-radius"}),
       "--spectral-radius: found no value, expected --spectral-radius X"},
      {with({"--step", "0.1", "--spectral-radius", "0.9"}),
       "--spectral-radius: found '0.9', expected nothing because no chosen integrator takes it"},
      {{"compare", "soft-beam", "--integrators", "beam-midpoint", "--spectral-radius", "0.9"},
       "--spectral-radius: found '0.9', expected nothing because no chosen integrator takes it"},
      {{"run", "soft-beam", "--integrator", "beam-hht", "--step", "0.1", "--spectral-radius", "0.4"},
       "--spectral-radius: found '0.4', expected 0.5 to 1 for beam-hht"},
      {{"drift", "soft-beam", "--spectral-radius", "0.4"},
       "--spectral-radius: found '0.4', expected 0.5 to 1 for beam-hht"},
      {with({"--step", "0.1", "--modified-newton"}),
       "--modified-newton: found --modified-newton, expected nothing because no chosen integrator takes it"},
      {with({"--step", "0.1", "--linear-solver", "klu"}),
       "--linear-solver: found 'klu', expected nothing because no chosen integrator takes it"},
      {{"run", "soft-beam", "--integrator", "beam-verlet", "--step", "0.1", "--modified-newton"},
       "--modified-newton: found --modified-newton, expected nothing because no chosen integrator takes it"},
      {{"run", "soft-beam", "--integrator", "beam-bathe", "--step", "0.1", "--linear-solver", "band"},
       "--linear-solver: found 'band', expected nothing because no chosen integrator takes it"},
      {{"stability", "s.toml", "--integrators", "rkmk4", "--spectral-radius", "0.9"},
       "--spectral-radius: found '0.9', expected nothing because no chosen integrator takes it"},
      {{"converge", "soft-beam", "--integrators", "beam-hht", "--modified-newton=1"},
       "--modified-newton: found the value '1', expected none"},
      {{"compare", "soft-beam", "--integrators", "beam-trapezoidal", "--linear-solver", "klu"},
       "--linear-solver: found 'klu', expected nothing because no chosen integrator takes it"},
      {{"converge", "soft-beam", "--integrators", "beam-midpoint", "--linear-solver", "gauss"},
       "--linear-solver: found 'gauss', expected block, band, lapack, klu or sparselu"},
      // Files.
      {run_of("s.toml", {"--json", "none/a.json"}),
       "--json: found 'none/a.json', expected a file in a folder that exists"},
      {run_of("s.toml", {"--json", "."}), "--json: found the folder '.', expected a file"},
      {run_of("s.toml", {"--csv", "s.toml/a.csv"}),
       "--csv: found 's.toml/a.csv', expected a file in a folder that exists"},
      {run_of("s.toml", {"--latex", "none/a.tex"}),
       "--latex: found 'none/a.tex', expected a file in a folder that exists"},
      {run_of("s.toml", {"--csv", "a", "--latex", "a"}),
       "--latex: found 'a' as in --csv, expected another file"},
      {run_of("s.toml", {"--json", "-", "--csv", "-"}),
       "--csv: found '-' as in --json, expected another file"},
      {{"converge", "s.toml", "--out", "s.toml"}, "--out: found the file 's.toml', expected a folder"},
  };
  REQUIRE(cases.size() >= 55);
  for (const Case& each : cases) check_refused({{"s.toml", good}}, each.arguments, each.message);
}

TEST_CASE("cli: a folder is not a scene", "[cli]") {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "s.toml");
  const Outcome outcome = run_program(run_of("s.toml"), folder.path());
  CHECK(outcome.exit_code == 2);
  CHECK(outcome.err == "gnomon: s.toml: found a folder, expected a scene file\n");
  CHECK(folder.entries() == 1);
}

TEST_CASE("cli: a file where compare writes by default is found before it runs", "[cli]") {
  check_refused({{"s.toml", good}, {"gnomon-out", "kept"}},
                {"compare", "s.toml", "--integrators", "rkmk4", "--steps", "0.1"},
                "--out: found the file 'gnomon-out', expected a folder");
}

TEST_CASE("cli: one wrong scene among several stops a comparison before it writes", "[cli]") {
  check_refused(
      {{"a.toml", good}, {"b.toml", head + body}}, {"compare", "a.toml", "b.toml", "--out", "out"},
      "b.toml:4: body.angular_momentum: found nothing, expected angular_momentum or angular_velocity "
      "(the motion at t = 0)");
}
