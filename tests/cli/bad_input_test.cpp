// Wrong scenes and command lines: exit code 2, one exact line on standard error, nothing written.
#include <algorithm>
#include <random>
#include <sstream>

#include "tests/catch.hpp"
#include "tests/cli/program.hpp"

namespace {

namespace fs = std::filesystem;
using namespace gnomon::test;
using Words = std::vector<std::string>;

const std::string integrators =
    "munjiza, munjiza-half-impulse, munjiza-stage-moments, rkmk4, exact-free-top, cvode-adams, cvode-bdf, "
    "arkode-erk4, arkode-erk5, arkode-erk8, arkode-dirk, ida-bdf";
const std::string scenes =
    "asymmetric-free-top, asymmetric-heavy-top, body-moment, dzhanibekov, fast-heavy-top, "
    "heavy-symmetric-top, "
    "kovalevskaya, rest-then-pushed, space-moment, spiral-cylinder, symmetric-free-top";
const std::string commands = "one of list, run, converge, compare, drift, bench, doctor";
const std::string name_text =
    "a name in quotes: at most 100 letters, digits, - _ and . that begin with a letter or digit";
const std::string inertia_text = "three positive numbers (principal moments, kg m^2)";
const std::string velocity_text = "three finite numbers (body components, rad/s)";
const std::string quaternion_text = "four finite numbers (unit quaternion w, x, y, z, body -> space)";
const std::string value_text = "a TOML value: a number, a \"text\" in double quotes, a [list] or true";

// Lines 1 to 3, 4 and 5, and 6 of a scene that is right.
const std::string head = "name = \"a\"\nmodel = \"rigid_body\"\nt_end = 1.0\n";
const std::string body = "[body]\ninertia = [1, 2, 3]\n";
const std::string spin = "angular_velocity = [0.3, 1, 0.3]\n";
const std::string good = head + body + spin;

/// Calls the program in a folder that holds the given scenes and must hold nothing else afterwards. A message
/// that ends in "(" is a beginning: what follows is the TOML library's.
void check_refused(const std::vector<std::pair<std::string, std::string>>& files, const Words& arguments,
                   const std::string& message) {
  const TemporaryFolder folder;
  for (const auto& [name, text] : files) write_text(folder.path() / name, text);
  const Outcome outcome = run_program(arguments, folder.path());
  INFO("arguments: " << Catch::StringMaker<Words>::convert(arguments));
  INFO("expected:  gnomon: " << message);
  INFO("found:     " << outcome.err);
  CHECK(outcome.exit_code == 2);
  CHECK(outcome.out.empty());
  if (message.ends_with("(")) {
    CHECK(outcome.err.starts_with("gnomon: " + message));
    CHECK(outcome.err.ends_with(")\n"));
    CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
  } else {
    CHECK(outcome.err == "gnomon: " + message + "\n");
  }
  CHECK(folder.entries() == files.size());
  for (const auto& [name, text] : files) CHECK(content_of(folder.path() / name) == text);
}

Words run_of(const std::string& scene, const Words& more = {}) {
  Words words{"run", scene, "--integrator", "rkmk4", "--step", "0.1", "--no-reference", "--no-timing"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

}  // namespace

TEST_CASE("cli: the scene that the malformed ones are made from is right", "[cli]") {
  // Also: whole numbers where numbers are asked for, line ends of DOS, a byte order mark, no load.
  std::string dos;
  for (const char c : good) dos += c == '\n' ? "\r\n" : std::string(1, c);
  for (const std::string& text :
       {good, dos, "\xEF\xBB\xBF" + good, head + "body.inertia=[1,2,3]\nbody." + spin,
        good + "[load]\nkind = \"none\"\n"}) {
    const TemporaryFolder folder;
    write_text(folder.path() / "s.toml", text);
    const Outcome outcome = run_program(run_of("s.toml"), folder.path());
    INFO(text << outcome.err);
    CHECK(outcome.exit_code == 0);
    CHECK(outcome.err.empty());
    CHECK(outcome.out.starts_with("a / rkmk4, step 0.1: ok\n"));
  }
}

TEST_CASE("cli: a malformed scene is refused with file, line, key, what was found and what would be right",
          "[cli]") {
  struct Case {
    std::string scene, message;
  };
  const std::string moment = "[load]\nkind = \"body_moment\"\n", gravity = "[load]\nkind = \"gravity\"\n";
  const std::vector<Case> cases{
      // Not TOML.
      {"", "s.toml: found an empty file, expected a scene file"},
      {head + "body\n", "s.toml:4: found 'body', expected valid TOML ("},
      {"name = a\n", "s.toml:1: found 'name = a', expected valid TOML ("},
      {"name =\n", "s.toml:1: found 'name =', expected valid TOML ("},
      {head + "[body\n", "s.toml:4: found '[body', expected valid TOML ("},
      {head + "t_end = 2\n", "s.toml:4: found 't_end = 2', expected valid TOML ("},
      {good + "[body]\n", "s.toml:7: found '[body]', expected valid TOML ("},
      {head + body + spin + spin,
       "s.toml:7: found 'angular_velocity = [0.3, 1, 0.3]', expected valid TOML ("},
      {head + "t_end.x = 1\n", "s.toml:4: found 't_end.x = 1', expected valid TOML ("},
      {"name = \"\xFF\"\n", "s.toml:1: found 'name = \"?\"', expected valid TOML ("},
      {"name = \"a\"\r\nmodel = \r\n", "s.toml:2: found 'model =', expected valid TOML ("},
      {"name = \"a\"\nt_end = 1e400\n", "s.toml:2: found 't_end = 1e400', expected valid TOML ("},
      {"t_end = 9223372036854775808\n",
       "s.toml:1: found 't_end = 9223372036854775808', expected valid TOML ("},
      // Keys of the scene.
      {"\n", "s.toml:1: name: found nothing, expected " + name_text},
      {"name = 1\n", "s.toml:1: name: found 1, expected " + name_text},
      {"name = \"\"\n", "s.toml:1: name: found \"\", expected " + name_text},
      {"name = \"../a\"\n", "s.toml:1: name: found \"../a\", expected " + name_text},
      {"\nname = \"a\\nb\"\n", "s.toml:2: name: found \"a\\nb\", expected " + name_text},
      {"name = \"" + std::string(101, 'a') + "\"\n",
       "s.toml:1: name: found \"" + std::string(56, 'a') + "..., expected " + name_text},
      {"description = \"a\\nb\"\n" + good,
       "s.toml:1: description: found \"a\\nb\", expected a text in quotes on one line"},
      {"description = 1\n" + good, "s.toml:1: description: found 1, expected a text in quotes on one line"},
      {"name = \"a\"\nt_end = 1\n", "s.toml:1: model: found nothing, expected rigid_body"},
      {"name = \"a\"\nmodel = \"rigid\"\n", "s.toml:2: model: found \"rigid\", expected rigid_body"},
      {"name = \"a\"\nmodel = true\n", "s.toml:2: model: found true, expected rigid_body"},
      {"name = \"a\"\nmodel = \"rigid_body\"\n",
       "s.toml:1: t_end: found nothing, expected a positive number (s)"},
      {"name = \"a\"\nmodel = \"rigid_body\"\nt_end = \"1\"\n",
       "s.toml:3: t_end: found \"1\", expected a positive number (s)"},
      {"name = \"a\"\nmodel = \"rigid_body\"\nt_end = 0\n",
       "s.toml:3: t_end: found 0, expected a positive number (s)"},
      {"name = \"a\"\nmodel = \"rigid_body\"\nt_end = -1.0\n",
       "s.toml:3: t_end: found -1.0, expected a positive number (s)"},
      {"name = \"a\"\nmodel = \"rigid_body\"\nt_end = nan\n",
       "s.toml:3: t_end: found nan, expected a positive number (s)"},
      {"name = \"a\"\nmodel = \"rigid_body\"\nt_end = -inf\n",
       "s.toml:3: t_end: found -inf, expected a positive number (s)"},
      {"name = \"a\"\nmodel = \"rigid_body\"\nt_end = 2020-01-01\n",
       "s.toml:3: t_end: found a date or time, expected a positive number (s)"},
      {"name = \"a\"\nmodel = \"rigid_body\"\nt_edn = 1\n",
       "s.toml:3: t_edn: found an unknown key, expected t_end"},
      {head + "horizon = 1\n" + body + spin,
       "s.toml:4: horizon: found an unknown key, expected one of body, description, load, model, name, "
       "t_end"},
      {head,
       "s.toml:1: body: found nothing, expected a table [body] with inertia and angular_momentum or "
       "angular_velocity"},
      {head + "body = 3\n", "s.toml:4: body: found 3, expected a table"},
      {head + "[[body]]\ninertia = [1, 2, 3]\n",
       "s.toml:4: body: found [{ inertia = [1, 2, 3] }], expected a table"},
      {head + "[bdoy]\n", "s.toml:4: bdoy: found an unknown key, expected body"},
      {good + "[loads]\n", "s.toml:7: loads: found an unknown key, expected load"},
      // The body.
      {head + "[body]\n" + spin, "s.toml:4: body.inertia: found nothing, expected " + inertia_text},
      {head + "[body]\ninertia = 1\n", "s.toml:5: body.inertia: found 1, expected " + inertia_text},
      {head + "[body]\ninertia = [1, 2]\n", "s.toml:5: body.inertia: found [1, 2], expected " + inertia_text},
      {head + "[body]\ninertia = [1, 2, 3, 4]\n",
       "s.toml:5: body.inertia: found [1, 2, 3, 4], expected " + inertia_text},
      {head + "[body]\ninertia = [1, 2, \"3\"]\n",
       "s.toml:5: body.inertia: found [1, 2, \"3\"], expected " + inertia_text},
      {head + "[body]\ninertia = [1, [2], 3]\n",
       "s.toml:5: body.inertia: found [1, [2], 3], expected " + inertia_text},
      {head + "[body]\ninertia = [1, 2, -3]\n",
       "s.toml:5: body.inertia: found [1, 2, -3], expected " + inertia_text},
      {head + "[body]\ninertia = [0, 2, 3]\n",
       "s.toml:5: body.inertia: found [0, 2, 3], expected " + inertia_text},
      {head + "[body]\ninertia = [1,\n  2,\n  inf]\n",
       "s.toml:5: body.inertia: found [1, 2, inf], expected " + inertia_text},
      {head + "[body]\ninertai = [1, 2, 3]\n",
       "s.toml:5: body.inertai: found an unknown key, expected inertia"},
      {good + "mass = 3\n",
       "s.toml:7: body.mass: found an unknown key, expected one of inertia, orientation, rotation_vector, "
       "angular_momentum, angular_velocity"},
      {head + body,
       "s.toml:4: body.angular_momentum: found nothing, expected angular_momentum or "
       "angular_velocity (the motion at t = 0)"},
      {good + "angular_momentum = [1, 2, 3]\n",
       "s.toml:6: body.angular_velocity: found both angular_momentum and angular_velocity, expected only one "
       "of them (the motion at t = 0)"},
      {head + body + "angular_velocity = [1, nan, 3]\n",
       "s.toml:6: body.angular_velocity: found [1, nan, 3], expected " + velocity_text},
      {head + body + "angular_velocity = \"[1, 2, 3]\"\n",
       "s.toml:6: body.angular_velocity: found \"[1, 2, 3]\", expected " + velocity_text},
      {head + body + "angular_momentum = [1, 2]\n",
       "s.toml:6: body.angular_momentum: found [1, 2], expected three finite numbers (body components, "
       "kg m^2/s)"},
      {head + "[body]\ninertia = [1e200, 2, 3]\nangular_velocity = [1e200, 0, 0]\n",
       "s.toml:6: body.angular_velocity: found [1e+200, 0, 0], expected three numbers whose products with "
       "the "
       "inertia are finite (rad/s)"},
      {head + body + "angular_velocity = [1e30, 0, 0]\n",
       "s.toml:3: t_end: found 1 s, 1e+30 times the time scale of the motion, expected at most 1e15 times"},
      {good + "orientation = [1, 0, 0]\n",
       "s.toml:7: body.orientation: found [1, 0, 0], expected " + quaternion_text},
      {good + "orientation = [1, 0, 0, 1e-2]\n",
       "s.toml:7: body.orientation: found [1, 0, 0, 0.01] with norm 1.00005, expected a unit quaternion "
       "(norm "
       "1 to 1e-6)"},
      {good + "orientation = [0, 0, 0, 0]\n",
       "s.toml:7: body.orientation: found [0, 0, 0, 0] with norm 0, expected a unit quaternion (norm 1 to "
       "1e-6)"},
      {good + "orientation = [1, 0, 0, 0]\nrotation_vector = [0, 0, 0]\n",
       "s.toml:8: body.rotation_vector: found both orientation and rotation_vector, expected only one of "
       "them "
       "(the attitude at t = 0)"},
      {good + "rotation_vector = [0, 0]\n",
       "s.toml:7: body.rotation_vector: found [0, 0], expected three finite numbers (rotation vector, rad)"},
      {good + "rotation_vector = [1e200, 0, 0]\n",
       "s.toml:7: body.rotation_vector: found [1e+200, 0, 0], expected three numbers with a finite norm "
       "(rotation vector, rad)"},
      // The load.
      {good + "[load]\n",
       "s.toml:7: load.kind: found nothing, expected one of none, gravity, space_moment, body_moment"},
      {good + "[load]\nkind = \"gravty\"\n",
       "s.toml:8: load.kind: found \"gravty\", expected one of none, gravity, space_moment, body_moment"},
      {good + gravity + "centre = [0, 0, 1]\n",
       "s.toml:7: load.weight: found nothing, expected a positive number (weight, N, along -z of space)"},
      {good + gravity + "weight = 0\ncentre = [0, 0, 1]\n",
       "s.toml:9: load.weight: found 0, expected a positive number (weight, N, along -z of space)"},
      {good + gravity + "weight = 1\n",
       "s.toml:7: load.centre: found nothing, expected three finite numbers (body point, m)"},
      {good + gravity + "weight = 1\ncentre = [0, 0, 1]\nmoment = [0, 0, 1]\n",
       "s.toml:11: load.moment: found a key unknown to kind \"gravity\", expected one of kind, weight, "
       "centre"},
      {good + gravity + "weight = 1\ncenter = [0, 0, 1]\n",
       "s.toml:10: load.center: found a key unknown to kind \"gravity\", expected centre"},
      {good + moment, "s.toml:7: load.moment: found nothing, expected three finite numbers (N m)"},
      {good + moment + "moment = [1, 2]\n",
       "s.toml:9: load.moment: found [1, 2], expected three finite numbers (N m)"},
      {good + moment + "moment = [1, 2, 3]\nweight = 1\n",
       "s.toml:10: load.weight: found a key unknown to kind \"body_moment\", expected one of kind, moment"},
      {good + "[load]\nkind = \"none\"\nmoment = [1, 2, 3]\n",
       "s.toml:9: load.moment: found a key unknown to kind \"none\", expected kind"},
  };
  REQUIRE(cases.size() >= 55);
  for (const Case& each : cases) {
    INFO(each.scene);
    check_refused({{"s.toml", each.scene}}, run_of("s.toml"), each.message);
  }
}

TEST_CASE("cli: a wrong --set is refused and names the option", "[cli]") {
  struct Case {
    Words set;
    std::string message;
  };
  const std::vector<Case> cases{
      {{"t_end"}, "--set t_end: found no '=', expected key.path=value"},
      {{"=1"}, "--set =1: found '' as the key, expected key.path=value"},
      {{"body.=1"}, "--set body.=1: found 'body.' as the key, expected key.path=value"},
      {{"a..b=1"}, "--set a..b=1: found 'a..b' as the key, expected key.path=value"},
      {{"t_end="}, "--set t_end=: found '', expected " + value_text},
      {{"name=b"}, "--set name=b: found 'b', expected " + value_text},
      {{"t_end=1\nname=\"b\""}, "--set t_end=1 name=\"b\": found '1 name=\"b\"', expected " + value_text},
      {{"t_end=1e400"}, "--set t_end=1e400: found '1e400', expected " + value_text},
      {{"t_end=-1"}, "--set t_end=-1: t_end: found -1, expected a positive number (s)"},
      {{"t_end=\"1\""}, "--set t_end=\"1\": t_end: found \"1\", expected a positive number (s)"},
      {{"horizon=1"},
       "--set horizon=1: horizon: found an unknown key, expected one of body, description, load, "
       "model, name, t_end"},
      {{"laod.kind=\"none\""}, "--set laod.kind=\"none\": laod: found an unknown key, expected load"},
      {{"body.inertia=[1, 2, 0]"},
       "--set body.inertia=[1, 2, 0]: body.inertia: found [1, 2, 0], expected " + inertia_text},
      {{"body.inertia.0=1"},
       "--set body.inertia.0=1: found 'inertia', which is not a table of the scene, expected key.path=value"},
      {{"body={inertia=[1,2,3]}"},
       "--set body={inertia=[1,2,3]}: body.angular_momentum: found nothing, expected angular_momentum or "
       "angular_velocity (the motion at t = 0)"},
      // The last of several counts, and only a wrong one is named.
      {{"t_end=1", "t_end=2", "t_end=0"}, "--set t_end=0: t_end: found 0, expected a positive number (s)"},
      {{"body.inertia=[1,2,3]", "body={inertia=[1,2]}"},
       "--set body={inertia=[1,2]}: body.inertia: found [1, 2], expected " + inertia_text},
      {{"body={inertia=[1,2,3]}", "body.inertia=[1,2]"},
       "--set body.inertia=[1,2]: body.inertia: found [1, 2], expected " + inertia_text},
  };
  for (const Case& each : cases) {
    Words more;
    for (const std::string& option : each.set) more.insert(more.end(), {"--set", option});
    check_refused({{"s.toml", good}}, run_of("s.toml", more), each.message);
  }
}

TEST_CASE("cli: a wrong command line is refused before anything is written", "[cli]") {
  struct Case {
    Words arguments;
    std::string message;
  };
  const std::string step = "a positive number (s)", tol = "a tolerance between 0 and 1";
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
      {run_of("/tmp/."), "scene '/tmp/.': found no shipped scene of that name, expected one of " + scenes +
                             " or a path that ends in .toml"},
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
      {run_of("s.toml", {"--smaples", "3"}), "run: found the unknown option '--smaples', expected --samples"},
      {run_of("s.toml", {"-x"}),
       "run: found the unknown option '-x', expected one of --integrator, --step, --tol, --t-end, --set, "
       "--max-steps, --time-limit, --newton-tol, --samples, --json, --csv, --no-reference, --no-timing, "
       "--quiet, "
       "--help"},
      {run_of("s.toml", {"--steps", "1"}), "run: found the unknown option '--steps', expected --step"},
      {run_of("s.toml", {"--step", "0.2"}), "--step: found twice, as '0.1' and '0.2', expected once"},
      {run_of("s.toml", {"--samples"}), "--samples: found no value, expected --samples N"},
      {run_of("s.toml", {"--samples", "--quiet"}), "--samples: found no value, expected --samples N"},
      {run_of("s.toml", {"--samples="}), "--samples: found no value, expected --samples N"},
      {run_of("s.toml", {"--set", ""}), "--set: found no value, expected --set KEY.PATH=VALUE"},
      {run_of("s.toml", {"--quiet=yes"}), "--quiet: found the value 'yes', expected none"},
      // Integrators.
      {{"run", "s.toml", "--step", "1"}, "--integrator: found nothing, expected the name of one integrator"},
      {{"run", "s.toml", "--integrator", "rkmk4,munjiza", "--step", "1"},
       "--integrator: found 'rkmk4,munjiza', expected the name of one integrator"},
      {{"run", "s.toml", "--integrator", "rkkm4", "--step", "1"},
       "integrator 'rkkm4': there is none of that name, expected rkmk4"},
      {{"run", "s.toml", "--integrator", "euler", "--step", "1"},
       "integrator 'euler': there is none of that name, expected one of " + integrators},
      {{"run", "space-moment", "--integrator", "exact-free-top"},
       "integrator 'exact-free-top' does not run on scene 'space-moment' (model rigid_body, load "
       "space_moment), "
       "expected one of " +
           std::string(integrators).erase(integrators.find("exact-free-top, "), 16)},
      {converge({"--integrators", "rkmk4,,munjiza"}),
       "--integrators: found 'rkmk4,,munjiza', expected names with one comma between them"},
      {converge({"--integrators", "rkmk4,munjiza,rkmk4"}),
       "--integrators: found 'rkmk4' twice, expected every name once"},
      {converge({"--integrators", "rkmk4,exact-fre-top"}),
       "integrator 'exact-fre-top': there is none of that name, expected exact-free-top"},
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
      {{"run", "s.toml", "--integrator", "exact-free-top", "--step", "0.1"},
       "--step: exact-free-top is a closed form, expected neither --step nor --tol"},
      {converge({"--steps", "0.1,-0.2"}),
       "--steps: found '-0.2', expected positive numbers (s) with one comma between them"},
      {converge({"--steps", "0.1,"}),
       "--steps: found '', expected positive numbers (s) with one comma between them"},
      {converge({"--steps", "0.1,0.10"}), "--steps: found '0.10' twice, expected every value once"},
      {converge({"--steps", "0.1,1e-20"}), "--steps: found '1e-20', expected at least 1e-15 s, 1 s / 1e15"},
      {converge({"--tols", "1e-3,2"}),
       "--tols: found '2', expected tolerances between 0 and 1 with one comma between them"},
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
      {run_of("s.toml", {"--newton-tol", "1"}), "--newton-tol: found '1', expected " + tol},
      // Files.
      {run_of("s.toml", {"--json", "none/a.json"}),
       "--json: found 'none/a.json', expected a file in a folder that exists"},
      {run_of("s.toml", {"--json", "."}), "--json: found the folder '.', expected a file"},
      {run_of("s.toml", {"--csv", "s.toml/a.csv"}),
       "--csv: found 's.toml/a.csv', expected a file in a folder that exists"},
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

TEST_CASE("cli: one wrong scene among several stops a comparison before it writes", "[cli]") {
  check_refused(
      {{"a.toml", good}, {"b.toml", head + body}}, {"compare", "a.toml", "b.toml", "--out", "out"},
      "b.toml:4: body.angular_momentum: found nothing, expected angular_momentum or angular_velocity "
      "(the motion at t = 0)");
}

TEST_CASE("cli: shipped scenes with random damage are run or refused, never a crash", "[cli]") {
  std::vector<std::string> sources;
  for (const auto& entry : fs::directory_iterator(GNOMON_SOURCE_DIR "/models/rigid_body/scenes"))
    sources.push_back(content_of(entry.path()));
  std::sort(sources.begin(), sources.end());
  REQUIRE(sources.size() >= 10);
  // mt19937 gives the same numbers everywhere; the distributions of the standard library do not.
  std::mt19937 random(20240607);
  const auto below = [&](std::size_t bound) { return static_cast<std::size_t>(random() % bound); };
  const std::string characters = "[]{}=\"'.,#-+eE0123456789 \n\tinfa\\\xC3\x01";
  const auto damage = [&](std::string& text) {
    const std::size_t begin = below(text.size());
    std::size_t line = text.rfind('\n', begin);
    line = line == std::string::npos ? 0 : line + 1;
    const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
    const std::string copy = text.substr(line, end - line);
    switch (below(6)) {
      case 0:
        text.erase(begin, 1 + below(3));
        break;
      case 1:
        text.insert(begin, 1, text[begin]);
        break;
      case 2:
        text[begin] = characters[below(characters.size())];
        break;
      case 3:
        text.erase(line, end - line);
        break;
      case 4:
        text.insert(line, copy);
        break;
      default:
        text.insert(begin, 1, characters[below(characters.size())]);
        break;
    }
  };
  int run = 0, refused = 0;
  for (int k = 0; k < 200; ++k) {
    std::string text = sources[below(sources.size())];
    for (std::size_t times = 1 + below(3); times > 0 && !text.empty(); --times) damage(text);
    const TemporaryFolder folder;
    write_text(folder.path() / "s.toml", text);
    const Outcome outcome = run_program(
        {"drift", "s.toml", "--no-reference", "--max-steps", "50", "--quiet", "--json", "out.json"},
        folder.path());
    INFO(k << ":\n" << text << "\n" << outcome.err);
    REQUIRE(outcome.signal == 0);
    REQUIRE((outcome.exit_code == 0 || outcome.exit_code == 2));
    std::istringstream lines(outcome.err);
    int messages = 0;
    for (std::string line; std::getline(lines, line);) {
      CHECK(line.starts_with("gnomon: "));
      if (!line.starts_with("gnomon: warning: ")) ++messages;
    }
    CHECK(messages == (outcome.exit_code == 2 ? 1 : 0));
    CHECK(folder.entries() == (outcome.exit_code == 2 ? 1U : 2U));
    if (outcome.exit_code == 2) CHECK(outcome.out.empty());
    ++(outcome.exit_code == 0 ? run : refused);
  }
  // Neither kind of damage is rare.
  CHECK(run >= 20);
  CHECK(refused >= 100);
}
