#pragma once
// What the tests of wrong scenes and command lines share.

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "tests/catch.hpp"
#include "tests/cli/program.hpp"
#include "tests/support/scenes.hpp"

namespace gnomon::test::cli {

using Words = std::vector<std::string>;

/// As messages list what is allowed.
inline std::string one_of(const Words& names) {
  if (names.size() == 1) return names[0];
  std::string text = "one of ";
  for (const std::string& name : names) text += (text.size() == 7 ? "" : ", ") + name;
  return text;
}

inline const gnomon::Catalogue& catalogue() {
  static const gnomon::Catalogue all = full_catalogue();
  return all;
}

inline std::string integrators_for(const std::string& scene) {
  Words names;
  for (const gnomon::SchemeInfo* info :
       catalogue().schemes_for(*gnomon::load_scene(catalogue(), scene).model))
    names.emplace_back(info->name);
  return one_of(names);
}

inline std::string shipped_scene_names() {
  Words names;
  for (const gnomon::ShippedScene& scene : gnomon::shipped_scenes(catalogue())) names.push_back(scene.name);
  return one_of(names);
}

inline std::string model_names() {
  Words names;
  for (const gnomon::ModelEntry& model : catalogue().models) names.emplace_back(model.name);
  return one_of(names);
}

inline const std::string commands =
    "one of list, run, converge, compare, drift, stability, scorecard, static, survey, reference, bench, "
    "report, "
    "doctor";
inline const std::string name_text =
    "a name in quotes: at most 100 letters, digits, - _ and . that begin with a letter or digit";
inline const std::string inertia_text = "three positive numbers (principal moments, kg m^2)";
inline const std::string velocity_text = "three finite numbers (body components, rad/s)";
inline const std::string quaternion_text = "four finite numbers (unit quaternion w, x, y, z, body -> space)";
inline const std::string value_text = "a TOML value: a number, a \"text\" in double quotes, a [list] or true";

// Lines 1 to 3, 4 and 5, and 6 of a scene that is right.
inline const std::string head = "name = \"a\"\nmodel = \"rigid_body\"\nt_end = 1.0\n";
inline const std::string body = "[body]\ninertia = [1, 2, 3]\n";
inline const std::string spin = "angular_velocity = [0.3, 1, 0.3]\n";
inline const std::string good = head + body + spin;

/// Calls the program in a folder that holds the given scenes and must hold nothing else afterwards. A message
/// that ends in "(" is a beginning: what follows is the TOML library's.
inline void check_refused(const std::vector<std::pair<std::string, std::string>>& files,
                          const Words& arguments, const std::string& message) {
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

inline Words run_of(const std::string& scene, const Words& more = {}) {
  Words words{"run", scene, "--integrator", "rkmk4", "--step", "0.1", "--no-reference", "--no-timing"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

}  // namespace gnomon::test::cli
