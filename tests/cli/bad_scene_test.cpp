// Wrong scenes: exit code 2, one exact line on standard error, nothing written.
#include <random>
#include <sstream>

#include "tests/cli/refusal.hpp"

namespace fs = std::filesystem;
using namespace gnomon::test;
using namespace gnomon::test::cli;

TEST_CASE("cli: the scene that the malformed ones are made from is right", "[cli]") {
  // Also: whole numbers where numbers are asked for, line ends of DOS, a byte order mark, no load, nearly a
  // unit quaternion.
  std::string dos;
  for (const char c : good) dos += c == '\n' ? "\r\n" : std::string(1, c);
  for (const std::string& text :
       {good, dos, "\xEF\xBB\xBF" + good, head + "body.inertia=[1,2,3]\nbody." + spin,
        good + "[load]\nkind = \"none\"\n", good + "orientation = [1.0000005, 0, 0, 0]\n"}) {
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
      {"name = \"a\"\nt_end = 1\n", "s.toml:1: model: found nothing, expected " + model_names()},
      {"name = \"a\"\nmodel = \"rigid\"\n", "s.toml:2: model: found \"rigid\", expected " + model_names()},
      {"name = \"a\"\nmodel = true\n", "s.toml:2: model: found true, expected " + model_names()},
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
      {good + "orientation = [1.000002, 0, 0, 0]\n",
       "s.toml:7: body.orientation: found [1.000002, 0, 0, 0] with norm 1.000002, expected a unit quaternion "
       "(norm 1 to 1e-6)"},
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
       "s.toml:7: load.kind: found nothing, expected one of none, gravity, space_moment, "
       "body_moment, attitude_potential"},
      {good + "[load]\nkind = \"gravty\"\n",
       "s.toml:8: load.kind: found \"gravty\", expected one of none, gravity, space_moment, "
       "body_moment, attitude_potential"},
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
      {good + "[load]\nkind = \"attitude_potential\"\nstiffness = 1\n",
       "s.toml:7: load.attractor: found nothing, expected three finite numbers (rotation vector of the "
       "attractor, rad)"},
      {good + "[load]\nkind = \"attitude_potential\"\nattractor = [1, 0, 0]\nrest = inf\n",
       "s.toml:10: load.rest: found inf, expected a finite number (length of the spring at rest)"},
      {good + "[load]\nkind = \"attitude_potential\"\nattraction = 1\nattractor = [0, 0, 0]\n",
       "s.toml:10: load.attractor: found [0, 0, 0], expected another attitude than the one at t = 0: the "
       "potential is infinite at the attractor"},
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
  CHECK(run >= 10);
  CHECK(refused >= 100);
}
