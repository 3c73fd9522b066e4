// Beam scenes on the command line: malformed ones, saved states, probes.
#include "tests/cli/document.hpp"
#include "tests/cli/refusal.hpp"

namespace fs = std::filesystem;
using namespace gnomon::test;
using namespace gnomon::test::cli;

namespace {

// Lines 1 to 3, and 4 to 12.
const std::string top = "name = \"a\"\nmodel = \"planar_beam\"\nt_end = 1.0\n";
const std::string beam =
    "[beam]\nlength = 1.0\nelements = 2\norder = 1\nEA = 10.0\nGA = 10.0\nEI = 1.0\nrhoA = 1.0\nrhoI = 0.1\n";
const std::string whole = top + beam;
const std::string load = "[[loads]]\nat = \"end\"\n";
const std::string what = "a file written by gnomon run --json for the same beam";

std::string without(const std::string& key) {
  const std::size_t begin = whole.find("\n" + key + " =") + 1;
  return whole.substr(0, begin) + whole.substr(whole.find('\n', begin) + 1);
}
std::string with(const std::string& key, const std::string& value) {
  const std::size_t begin = whole.find("\n" + key + " =") + 1;
  return whole.substr(0, begin) + key + " = " + value + whole.substr(whole.find('\n', begin));
}

Words run_beam_of(const std::string& scene, const Words& more = {}) {
  Words words{"run",    scene, "--integrator",   "beam-midpoint",
              "--step", "0.1", "--no-reference", "--no-timing"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

Json saved(const std::string& text) {
  const TemporaryFolder folder;
  write_text(folder.path() / "s.toml", text);
  const Outcome outcome = run_program(run_beam_of("s.toml", {"--json", "-"}), folder.path());
  INFO(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  return Json::parse(outcome.out);
}

}  // namespace

TEST_CASE("cli: the beam scene that the malformed ones are made from is right", "[cli][planar_beam]") {
  for (const std::string& text :
       {whole, whole + "[supports]\nstart = { kind = \"pinned\" }\n",
        whole +
            "[supports]\nend = { kind = \"rotated\", rotation = { kind = \"ramp\", to = 1, over = 2 } }\n",
        whole + load + "profile = { kind = \"ramp\", over = 1 }\n",
        whole + load + "follower = true\nprofile = { kind = \"table\", t = [0, 1], value = [1, 2] }\n",
        whole + "damping = 1\n[[beam.bends]]\nat = 0.5\nangle = 1\n[[loads]]\nat = 0.5\n",
        whole + "[[beam.hinges]]\nat = 0.5\nspring = 2\n[[beam.bends]]\nat = 0.5\nangle = 1\n[[loads]]\nat = "
                "0.5\nforce = [1, 2]\n",
        whole + "[supports]\nstart = { kind = \"sliding\", along = \"z\", spring = 1 }\nend = { kind = "
                "\"moved\", z = { kind = \"half-sine\", to = 1, over = 2 }, rotation = \"clamped\" }\n",
        whole + "[supports]\nend = { kind = \"moved\", x = { kind = \"spin-up\", rate = 1, over = 2 }, "
                "rotation = { kind = \"table\", t = [0, 1], value = [0, 1] } }\n",
        whole + "[supports]\nstart = \"clamped\"\n[initial]\nstate = \"static\"\n" + load +
            "force = [0, 1]\n",
        whole + "[initial]\nvelocity = [1, 2]\nangular_velocity = 3\n"}) {
    const TemporaryFolder folder;
    write_text(folder.path() / "s.toml", text);
    const Outcome outcome = run_program(run_beam_of("s.toml"), folder.path());
    INFO(text << outcome.err);
    CHECK(outcome.exit_code == 0);
    CHECK(outcome.err.empty());
  }
}

TEST_CASE(
    "cli: a malformed beam scene is refused with file, line, key, what was found and what would be right",
    "[cli][planar_beam]") {
  struct Case {
    std::string scene, message;
  };
  const std::string supports = whole + "[supports]\n", rotated = "start = { kind = \"rotated\", ";
  const std::string ends = "one of free, pinned, clamped, or a table { kind = .., .. }";
  const std::string bend = "[[beam.bends]]\n";
  const std::string meeting = "a multiple of 0.5 m, where two elements meet, inside the beam of 1 m";
  const std::string hinge = "[[beam.hinges]]\n";
  const std::string times = "at least two ascending numbers, the first 0 (s)";
  const std::vector<Case> cases{
      {top,
       "s.toml:1: beam: found nothing, expected a table [beam] with length, elements, order and the "
       "section's data"},
      {top + "[baem]\n", "s.toml:4: baem: found an unknown key, expected beam"},
      {whole + "[load]\n", "s.toml:13: load: found an unknown key, expected loads"},
      {whole + "[body]\n",
       "s.toml:13: body: found an unknown key, expected one of beam, description, execution, initial, "
       "loads, model, name, supports, t_end"},
      {whole + "width = 1\n",
       "s.toml:13: beam.width: found an unknown key, expected one of length, elements, order, EA, GA, EI, "
       "rhoA, rhoI, start, angle, curvature, gravity, damping, bends, hinges, geometry"},
      {with("length", "0"), "s.toml:5: beam.length: found 0, expected a positive number (m)"},
      {without("length"), "s.toml:4: beam.length: found nothing, expected a positive number (m)"},
      {with("elements", "1") + "[supports]\nstart = \"clamped\"\nend = \"clamped\"\n",
       "s.toml:13: supports: found supports that hold all 6 unknowns of the beam, expected an end that can "
       "move, "
       "or more elements or a higher order ([beam] elements, order)"},
      {with("elements", "0"), "s.toml:6: beam.elements: found 0, expected a whole number from 1 to 1000000"},
      {with("elements", "2.5"),
       "s.toml:6: beam.elements: found 2.5, expected a whole number from 1 to 1000000"},
      {with("order", "5"),
       "s.toml:7: beam.order: found 5, expected a whole number from 1 to 4 (polynomial order of an element)"},
      {with("EA", "-1.0"), "s.toml:8: beam.EA: found -1.0, expected a positive number (axial stiffness, N)"},
      {with("GA", "\"1\""),
       "s.toml:9: beam.GA: found \"1\", expected a positive number (shear stiffness, N)"},
      {with("EI", "nan"),
       "s.toml:10: beam.EI: found nan, expected a positive number (bending stiffness, N m^2)"},
      {with("rhoA", "0.0"),
       "s.toml:11: beam.rhoA: found 0.0, expected a positive number (mass per length, kg/m)"},
      {without("rhoI"),
       "s.toml:4: beam.rhoI: found nothing, expected a positive number (rotary inertia per length, kg m)"},
      {whole + "start = [0, 0, 0]\n",
       "s.toml:13: beam.start: found [0, 0, 0], expected two finite numbers (x, z of the start, m)"},
      {whole + "angle = inf\n",
       "s.toml:13: beam.angle: found inf, expected a finite number (rad, from x towards z)"},
      {whole + "curvature = 4\n",
       "s.toml:13: beam.curvature: found 4, 2 rad an element, expected at most 1.5 rad an element"},
      {whole + "geometry = \"curved\"\n",
       "s.toml:13: beam.geometry: found \"curved\", expected one of interpolated, exact"},
      {whole + "damping = -1\n",
       "s.toml:13: beam.damping: found -1, expected a number that is not negative (1/s, proportional to "
       "mass)"},
      {whole + "bends = 3\n", "s.toml:13: beam.bends: found 3, expected tables [[beam.bends]]"},
      {whole + bend + "angle = 1\n", "s.toml:13: beam.bends[0].at: found nothing, expected " + meeting},
      {whole + bend + "at = 0.3\nangle = 1\n", "s.toml:14: beam.bends[0].at: found 0.3, expected " + meeting},
      {whole + bend + "at = 0.5\nangle = 4\n",
       "s.toml:15: beam.bends[0].angle: found 4, expected a number between -pi and pi (rad, from x towards "
       "z)"},
      {whole + bend + "at = 0.5\nangle = 1\n" + bend + "at = 0.5\nangle = 1\n",
       "s.toml:17: beam.bends[1].at: found 0.5, expected " + meeting + ", behind the bend before it"},
      {whole + bend + "at = 0.5\nangel = 1\n",
       "s.toml:15: beam.bends[0].angel: found an unknown key, expected angle"},
      {whole + "hinges = 3\n", "s.toml:13: beam.hinges: found 3, expected tables [[beam.hinges]]"},
      {whole + hinge, "s.toml:13: beam.hinges[0].at: found nothing, expected " + meeting},
      {whole + hinge + "at = 0.3\n", "s.toml:14: beam.hinges[0].at: found 0.3, expected " + meeting},
      {whole + hinge + "at = 0.0\n", "s.toml:14: beam.hinges[0].at: found 0.0, expected " + meeting},
      {whole + hinge + "at = 1.0\n", "s.toml:14: beam.hinges[0].at: found 1.0, expected " + meeting},
      {whole + hinge + "at = \"middle\"\n",
       "s.toml:14: beam.hinges[0].at: found \"middle\", expected " + meeting},
      {whole + hinge + "at = 0.5\n" + hinge + "at = 0.5\n",
       "s.toml:16: beam.hinges[1].at: found 0.5, expected " + meeting + ", behind the hinge before it"},
      {whole + hinge + "at = 0.5\nspring = 0\n",
       "s.toml:15: beam.hinges[0].spring: found 0, expected a positive number (torsion spring between both "
       "sides, N m/rad)"},
      {whole + hinge + "at = 0.5\nangle = 1\n",
       "s.toml:15: beam.hinges[0].angle: found an unknown key, expected one of at, spring"},
      {whole + hinge + "at = 0.5\n[[loads]]\nat = 0.5\nmoment = 2\n",
       "s.toml:17: loads[0].moment: found 2 at a hinge, expected a moment elsewhere, as a hinge bears none"},
      {whole + hinge +
           "at = 0.5\n[supports]\nstart = \"pinned\"\nend = \"pinned\"\n[initial]\nstate = "
           "\"static\"\n",
       "s.toml:18: initial: found a beam whose pieces can move freely as rigid bodies, expected supports "
       "that "
       "hold the beam where it is to start in equilibrium"},
      // Supports.
      {supports + "left = \"free\"\n",
       "s.toml:14: supports.left: found an unknown key, expected one of start, end"},
      {supports + "start = \"fixed\"\n", "s.toml:14: supports.start: found \"fixed\", expected " + ends},
      {supports + "start = \"rotated\"\n", "s.toml:14: supports.start: found \"rotated\", expected " + ends},
      {supports + "start = 3\n", "s.toml:14: supports.start: found 3, expected " + ends},
      {supports + "start = { kind = \"turned\" }\n",
       "s.toml:14: supports.start.kind: found \"turned\", expected one of free, pinned, clamped, rotated, "
       "sliding, "
       "moved"},
      {supports + "start = { kind = \"clamped\", rotation = {} }\n",
       "s.toml:14: supports.start.rotation: found a key unknown to kind \"clamped\", expected kind"},
      {supports + "start = { kind = \"rotated\" }\n",
       "s.toml:14: supports.start.rotation: found nothing, expected a table { kind = \"ramp\", to = .., over "
       "= .. } (rad, s)"},
      {supports + rotated + "rotation = 1.5 }\n",
       "s.toml:14: supports.start.rotation: found 1.5, expected a table"},
      {supports + rotated + "rotation = { kind = \"sine\" } }\n",
       "s.toml:14: supports.start.rotation.kind: found \"sine\", expected one of ramp, half-sine, spin-up, "
       "table"},
      {supports + rotated + "rotation = { kind = \"ramp\", to = 1 } }\n",
       "s.toml:14: supports.start.rotation.over: found nothing, expected a positive number (s)"},
      {supports + rotated + "rotation = { kind = \"ramp\", to = 1, over = -1 } }\n",
       "s.toml:14: supports.start.rotation.over: found -1, expected a positive number (s)"},
      {supports + rotated + "rotation = { kind = \"ramp\", to = \"1\", over = 1 } }\n",
       "s.toml:14: supports.start.rotation.to: found \"1\", expected a finite number (about +y, rad)"},
      {supports + rotated + "rotation = { kind = \"ramp\", to = 1, over = 1, until = 2 } }\n",
       "s.toml:14: supports.start.rotation.until: found a key unknown to kind \"ramp\", expected one of "
       "kind, "
       "to, over"},
      {supports + rotated + "rotation = { kind = \"spin-up\", to = 1, over = 1 } }\n",
       "s.toml:14: supports.start.rotation.to: found a key unknown to kind \"spin-up\", expected one of "
       "kind, "
       "rate, over"},
      {supports + rotated + "rotation = { kind = \"spin-up\", rate = nan, over = 1 } }\n",
       "s.toml:14: supports.start.rotation.rate: found nan, expected a finite number (about +y, rad/s)"},
      {supports + rotated + "rotation = { kind = \"table\", t = [0, 1], value = [1, 1] } }\n",
       "s.toml:14: supports.start.rotation.value: found [1, 1], expected as many numbers as t has, the first "
       "0 (about +y, rad)"},
      {supports + "start = { kind = \"sliding\" }\n",
       "s.toml:14: supports.start.along: found nothing, expected one of x, z"},
      {supports + "start = { kind = \"sliding\", along = \"y\" }\n",
       "s.toml:14: supports.start.along: found \"y\", expected one of x, z"},
      {supports + "start = { kind = \"sliding\", along = \"x\", rotation = {} }\n",
       "s.toml:14: supports.start.rotation: found {}, expected one of free, clamped"},
      {supports + "start = { kind = \"moved\" }\n",
       "s.toml:14: supports.start.x: found nothing, expected x or z: a table { kind = \"ramp\", to = .., "
       "over "
       "= .. } (m, s)"},
      {supports + "start = { kind = \"moved\", x = 1 }\n",
       "s.toml:14: supports.start.x: found 1, expected a table"},
      {supports + "start = { kind = \"moved\", y = 1 }\n",
       "s.toml:14: supports.start.y: found a key unknown to kind \"moved\", expected x"},
      {supports + "start = { kind = \"moved\", z = { kind = \"ramp\", to = 1, over = 1 }, rotation = 1 }\n",
       "s.toml:14: supports.start.rotation: found 1, expected one of free, clamped, or a table { kind = "
       "\"ramp\", to = .., over = .. } (rad, s)"},
      {supports + "start = { kind = \"pinned\", spring = 0 }\n",
       "s.toml:14: supports.start.spring: found 0, expected a positive number (torsion spring, N m/rad)"},
      {supports + "start = { kind = \"sliding\", along = \"x\", rotation = \"clamped\", spring = 2 }\n",
       "s.toml:14: supports.start.spring: found 2 at an end whose rotation is held, expected a spring at an "
       "end that turns freely"},
      // Loads.
      {whole + "[loads]\n", "s.toml:13: loads: found {}, expected tables [[loads]]"},
      {whole + "[[loads]]\n",
       "s.toml:13: loads[0].at: found nothing, expected one of start, end, distributed"},
      {whole + load + "[[loads]]\nat = \"middle\"\n",
       "s.toml:16: loads[1].at: found \"middle\", expected one of start, end, distributed"},
      {whole + "[[loads]]\nat = 0.3\n", "s.toml:14: loads[0].at: found 0.3, expected " + meeting},
      {whole + "[[loads]]\nat = 1.0\n", "s.toml:14: loads[0].at: found 1.0, expected " + meeting},
      {whole + load + "follower = 1\n", "s.toml:15: loads[0].follower: found 1, expected true or false"},
      {whole + "[[loads]]\nat = \"distributed\"\nfollower = true\n",
       "s.toml:15: loads[0].follower: found true for a load that is not at an end, expected false, or at = "
       "\"start\" or \"end\""},
      {whole + load + "profile = { kind = \"table\", t = [0], value = [1] }\n",
       "s.toml:15: loads[0].profile.t: found [0], expected " + times},
      {whole + load + "profile = { kind = \"table\", t = [0, 2, 1], value = [1, 1, 1] }\n",
       "s.toml:15: loads[0].profile.t: found [0, 2, 1], expected " + times},
      {whole + load + "profile = { kind = \"table\", t = [1, 2], value = [1, 1] }\n",
       "s.toml:15: loads[0].profile.t: found [1, 2], expected " + times},
      {whole + load + "profile = { kind = \"table\", t = [0, 2], value = [1] }\n",
       "s.toml:15: loads[0].profile.value: found [1], expected as many numbers as t has (factors of the "
       "load)"},
      {whole + load + "profile = { kind = \"table\", t = [0, 2], value = [1, nan] }\n",
       "s.toml:15: loads[0].profile.value: found [1, nan], expected as many numbers as t has (factors of the "
       "load)"},
      {whole + load + "profile = { kind = \"table\", t = 3, value = [1] }\n",
       "s.toml:15: loads[0].profile.t: found 3, expected " + times},
      {whole + load + "force = 3\n",
       "s.toml:15: loads[0].force: found 3, expected two finite numbers (x, z, N or N/m)"},
      {whole + load + "moment = [1]\n",
       "s.toml:15: loads[0].moment: found [1], expected a finite number (about +y, N m or N m/m)"},
      {whole + load + "profile = \"ramp\"\n",
       "s.toml:15: loads[0].profile: found \"ramp\", expected a table"},
      {whole + load + "profile = { kind = \"step\", over = 1 }\n",
       "s.toml:15: loads[0].profile.over: found a key unknown to kind \"step\", expected one of kind, until"},
      {whole + load + "profile = { kind = \"half-sine\", over = 0 }\n",
       "s.toml:15: loads[0].profile.over: found 0, expected a positive number (s)"},
      // The motion at t = 0.
      {whole + "[initial]\nvelocity = [1]\n",
       "s.toml:14: initial.velocity: found [1], expected two finite numbers (x, z, m/s)"},
      {whole + "[initial]\nspin = 1\n",
       "s.toml:14: initial.spin: found an unknown key, expected one of velocity, angular_velocity, state"},
      {whole + "[initial]\nvelocity = [1, 0]\n[supports]\nend = \"pinned\"\n",
       "s.toml:13: initial: found { velocity = [1, 0] }, expected a rigid motion in which the supported ends "
       "do not move"},
      {whole + "[initial]\nvelocity = [1, 0]\nstate = \"x.json\"\n",
       "s.toml:14: initial.velocity: found both state and velocity, expected only one of them (the motion at "
       "t = 0)"},
      {whole + "[initial]\nstate = 3\n",
       "s.toml:14: initial.state: found 3, expected \"static\", or the path of a file written by gnomon "
       "run --json, in quotes"},
      {whole + "[initial]\nstate = \"static\"\n",
       "s.toml:13: initial: found a beam that can move freely as a rigid body, expected supports that hold "
       "the "
       "beam where it is to start in equilibrium"},
      {whole + "[initial]\nstate = \"x.json\"\n",
       "s.toml:14: initial.state: found 'x.json', which cannot be read, expected " + what},
  };
  REQUIRE(cases.size() >= 40);
  for (const Case& each : cases) {
    INFO(each.scene);
    check_refused({{"s.toml", each.scene}}, run_beam_of("s.toml"), each.message);
  }
}

TEST_CASE("cli: a saved state is where the next run begins", "[cli][planar_beam]") {
  const std::string moving = whole + "[initial]\nangular_velocity = 1\n" + load + "force = [1, 0]\n";
  const std::string from = whole + "[initial]\nstate = \"state/x.json\"\n" + load + "force = [1, 0]\n";
  const Json first = saved(moving);
  const auto run_from = [&](const Json& file) {
    const TemporaryFolder folder;
    fs::create_directories(folder.path() / "scenes/state");
    write_text(folder.path() / "scenes/state/x.json", file.dump());
    write_text(folder.path() / "scenes/s.toml", from);
    const Outcome outcome = run_program(run_beam_of("scenes/s.toml", {"--json", "-"}), folder.path());
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    return Json::parse(outcome.out);
  };
  // Two seconds at once are one second and another.
  const Json second = run_from(first);
  const Json both = saved(std::string(moving).replace(moving.find("t_end = 1.0"), 11, "t_end = 2.0"));
  for (const char* key : {"u", "v"})
    for (std::size_t i = 0; i < 9; ++i)
      CHECK(std::abs(second["runs"][0]["state"][key][i].get<double>() -
                     both["runs"][0]["state"][key][i].get<double>()) <= 1e-6);
  // The content decides the physics.
  Json other = first;
  other["runs"][0]["state"]["u"][0] = 0.1;
  const Json third = run_from(other);
  CHECK(second["scenes"][0]["initial"]["state"] == "state/x.json");
  CHECK(second["scenes"][0]["initial"]["state_hash"] != third["scenes"][0]["initial"]["state_hash"]);
  CHECK(run_from(first)["scenes"][0]["initial"] == second["scenes"][0]["initial"]);
}

TEST_CASE("cli: a state with a hinge is saved with both sides of it", "[cli][planar_beam]") {
  const std::string hinged = whole + "[[beam.hinges]]\nat = 0.5\n", from = "[initial]\nstate = \"x.json\"\n";
  const std::string push = load + "force = [0, 1]\n";
  const Json first = saved(hinged + push);
  CHECK(first["runs"][0]["state"]["u"].size() == 12);
  CHECK(first["runs"][0]["probes"]["hinge1"]["jump"].get<double>() ==
        first["runs"][0]["state"]["u"][8].get<double>() - first["runs"][0]["state"]["u"][5].get<double>());
  CHECK(std::abs(first["runs"][0]["probes"]["hinge1"]["jump"].get<double>()) >= 0.1);
  const TemporaryFolder folder;
  write_text(folder.path() / "s.toml", hinged + from + push);
  write_text(folder.path() / "x.json", first.dump());
  const Outcome outcome = run_program(run_beam_of("s.toml", {"--json", "-"}), folder.path());
  INFO(outcome.err);
  CHECK(outcome.exit_code == 0);
  Json apart = first;
  apart["runs"][0]["state"]["u"][3] = 0.25;
  check_refused({{"s.toml", hinged + from}, {"x.json", apart.dump()}}, run_beam_of("s.toml"),
                "s.toml:15: initial: found { state = \"x.json\" }, expected a state in which both sides of a "
                "hinge are in one place");
  check_refused(
      {{"s.toml", hinged + from}, {"x.json", saved(whole).dump()}}, run_beam_of("s.toml"),
      "s.toml:16: initial.state: found 'x.json', a beam with hinges = [], expected one with hinges = "
      "[{\"at\":0.5}]");
}

TEST_CASE("cli: a saved state of another beam is refused", "[cli][planar_beam]") {
  const Json right = saved(whole);
  const auto refused = [&](const std::string& file, const std::string& found, const std::string& expected,
                           const std::string& more = "") {
    check_refused({{"s.toml", whole + more + "[initial]\nstate = \"x.json\"\n"}, {"x.json", file}},
                  run_beam_of("s.toml"),
                  "s.toml:" + std::to_string(more.empty() ? 14 : 16) + ": initial.state: found 'x.json', " +
                      found + ", expected " + expected);
  };
  refused("{", "which is not JSON", what);
  refused("[]", "which has no scenes", what);
  refused("{}", "which has no scenes", what);
  Json wrong = right;
  wrong.erase("runs");
  refused(wrong.dump(), "which has no runs", what);
  wrong = right;
  wrong["scenes"][0]["model"] = "rigid_body";
  refused(wrong.dump(), "a state of model rigid_body", "a state of model planar_beam");
  wrong = right;
  wrong["scenes"][0]["beam"]["elements"] = 3;
  refused(wrong.dump(), "a beam with elements = 3", "one with elements = 2");
  wrong = right;
  wrong["runs"][0]["status"] = "diverged";
  refused(wrong.dump(), "a run that ended with status \"diverged\"", "a run with status \"ok\"");
  wrong = right;
  wrong["runs"][0]["state"]["u"].push_back(1.0);
  refused(wrong.dump(), "10 numbers in state.u", "9 numbers (ux, uz, phi of every node)");
  wrong = right;
  wrong["runs"][0]["state"].erase("v");
  refused(wrong.dump(), "which has no list state.v", "9 numbers (ux, uz, phi of every node)");
  wrong = right;
  wrong["runs"][0]["state"]["v"][2] = nullptr;
  refused(wrong.dump(), "null in state.v", "finite numbers");
  wrong = saved(whole + "[initial]\nvelocity = [1, 0]\n");
  check_refused({{"s.toml", whole + "[supports]\nstart = \"pinned\"\n[initial]\nstate = \"x.json\"\n"},
                 {"x.json", wrong.dump()}},
                run_beam_of("s.toml"),
                "s.toml:15: initial: found { state = \"x.json\" }, expected a state in which the supported "
                "ends are at rest in place");
}

TEST_CASE("cli: probes are the displacements of the ends", "[cli][planar_beam]") {
  const Json json = json_of({"run", "soft-beam", "--integrator", "beam-midpoint", "--step", "0.1",
                             "--samples", "4", "--no-timing", "--no-reference"});
  const Json& run = json["runs"][0];
  const Json &u = run["state"]["u"], &probes = run["probes"], &series = run["series"];
  REQUIRE(u.size() == 27);
  CHECK(keys_of(probes) == Keys{"start", "end"});
  CHECK(keys_of(probes["end"]) == Keys{"x", "z", "phi"});
  const char* names[3] = {"x", "z", "phi"};
  for (std::size_t k = 0; k < 3; ++k) {
    CHECK(probes["start"][names[k]] == 0.0);
    CHECK(probes["end"][names[k]] == u[24 + k]);
    CHECK(probes["end"][names[k]] != 0.0);
    REQUIRE(series["probes"]["end"][names[k]].size() == 5);
    CHECK(series["probes"]["end"][names[k]][0] == 0.0);
    CHECK(series["probes"]["end"][names[k]][4] == u[24 + k]);
  }
  const TemporaryFolder folder;
  const Outcome outcome =
      run_program({"run", "soft-beam", "--integrator", "beam-midpoint", "--step", "0.1", "--samples", "4",
                   "--no-timing", "--no-reference", "--csv", "x.csv", "--quiet"},
                  folder.path());
  REQUIRE(outcome.exit_code == 0);
  const std::string csv = content_of(folder.path() / "x.csv");
  CHECK(csv.find("start_x,start_z,start_phi,end_x,end_z,end_phi") != std::string::npos);
  const Json rigid = json_of({"run", "asymmetric-free-top", "--integrator", "rkmk4", "--step", "0.1",
                              "--no-timing", "--no-reference"});
  CHECK(rigid["runs"][0]["probes"] == Json::object());
}

TEST_CASE("cli: gnomon static prints the path of equilibria and keeps the last one", "[cli][planar_beam]") {
  const Json json = json_of({"static", "elastica", "--load-steps", "5"});
  const Json& run = json["runs"][0];
  CHECK(json["command"] == "static");
  CHECK(run["status"] == "ok");
  REQUIRE(run["path"].size() == 5);
  CHECK(run["path"][0]["load_factor"] == 0.2);
  CHECK(run["path"][4]["load_factor"] == 1.0);
  CHECK(run["path"][4]["probes"] == run["probes"]);
  for (const Json& point : run["path"]) CHECK(point["newton_iterations"].get<int>() >= 2);
  CHECK(std::abs(run["probes"]["end"]["z"].get<double>() - .811609024880) <= 1e-7);
  CHECK(json["scenes"][0]["loads"][0]["follower"] == false);
  // The equilibrium is where a dynamic run may begin.
  const std::string scene = whole + "[supports]\nstart = \"clamped\"\n" + load + "force = [0, 0.5]\n";
  const TemporaryFolder folder;
  write_text(folder.path() / "s.toml", scene);
  REQUIRE(run_program({"static", "s.toml", "--json", "x.json", "--quiet"}, folder.path()).exit_code == 0);
  write_text(folder.path() / "d.toml", scene + "[initial]\nstate = \"x.json\"\n");
  const Outcome outcome = run_program(run_beam_of("d.toml", {"--json", "-"}), folder.path());
  INFO(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  const Json first = Json::parse(content_of(folder.path() / "x.json"))["runs"][0],
             later = Json::parse(outcome.out)["runs"][0];
  CHECK(std::abs(first["probes"]["end"]["z"].get<double>()) >= 0.1);
  CHECK(std::abs(first["probes"]["end"]["z"].get<double>() - later["probes"]["end"]["z"].get<double>()) <=
        1e-10);
  // As text.
  const Outcome text = run_program({"static", "elastica", "--arc-length"}, folder.path());
  CHECK(text.exit_code == 0);
  CHECK(text.out.find("load factor") != std::string::npos);
  CHECK(text.out.find("end phi [rad]") != std::string::npos);
}

TEST_CASE("cli: gnomon static says why there is no equilibrium", "[cli][planar_beam]") {
  check_refused(
      {}, {"static", "flying-beam"},
      "static: found in scene flying-beam a beam that can move freely as a rigid body, expected one "
      "that is held in place");
  check_refused(
      {}, {"static", "spin-up"},
      "static: found in scene spin-up a beam whose support does not come to rest, expected one that "
      "is held in place");
  check_refused({}, {"static", "asymmetric-free-top"},
                "static: found scene asymmetric-free-top of model rigid_body, expected a model with statics");
  check_refused({}, {"static", "elastica", "roll-up"}, "static: found 2 scenes, expected one");
  check_refused({}, {"static", "elastica", "--load-steps", "0"},
                "--load-steps: found '0', expected a whole number from 1 to 1000000, in digits");
  const TemporaryFolder folder;
  const Outcome outcome = run_program({"static", "shallow-arch", "--json", "x.json"}, folder.path());
  CHECK(outcome.exit_code == 1);
  CHECK(outcome.err.starts_with("gnomon: shallow-arch / static: newton_failed: "));
  CHECK(Json::parse(content_of(folder.path() / "x.json"))["runs"][0]["status"] == "newton_failed");
}
