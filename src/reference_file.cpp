#include "src/reference_file.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <sstream>

#include "src/output/text.hpp"

namespace gnomon {
namespace {

constexpr std::size_t most_numbers = 20'000;
constexpr const char* ending = ".toml";

std::optional<double> to_number(const std::string& text) {
  double value = 0.0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::string reference_file(const Scene& scene, const std::vector<double>& times) {
  if (!scene.file.ends_with(ending) || times != std::vector<double>{scene.t_end} || scene.model->has_exact())
    return "";
  return scene.file.substr(0, scene.file.size() - std::string(ending).size()) + ".reference.txt";
}

std::string reference_text(const Scene& scene, const ReferenceStates& reference) {
  if (reference.states.size() != 1 || reference.states[0].size() > most_numbers) return "";
  std::string text = fmt::format(
      "# What errors on the scene {} are measured against. Written by `gnomon reference {}`; one that does "
      "not\n"
      "# belong to the scene as it is now is not used.\n"
      "format {}\nscene {}\nhash {}\nkind {}\n",
      scene.name, scene.name, reference_format, scene.name, scene.physics_hash(), reference.kind);
  for (const std::string& method : reference.methods)
    text += fmt::format("method {}\n", output::plain_text(method));
  if (!reference.message.empty()) text += fmt::format("message {}\n", output::plain_text(reference.message));
  text += fmt::format("t {:.17g}\n", reference.times[0]);
  const std::vector<MetricInfo> metrics = scene.model->metrics();
  for (std::size_t k = 0; k < metrics.size(); ++k)
    text += fmt::format("bound {:.17g} {} [{}]\n", reference.bounds[0][k], metrics[k].name, metrics[k].unit);
  for (const double value : reference.states[0]) text += fmt::format("state {:.17g}\n", value);
  return text + fmt::format("checksum {}\n", hash_text(text));
}

std::optional<ReferenceStates> read_reference_text(const std::string& text, const Scene& scene) {
  const std::size_t end = text.rfind("checksum ");
  if (end == std::string::npos ||
      text.substr(end) != fmt::format("checksum {}\n", hash_text(text.substr(0, end))))
    return std::nullopt;
  ReferenceStates reference;
  reference.states.emplace_back();
  reference.bounds.emplace_back();
  std::string format, hash;
  std::istringstream lines(text.substr(0, end));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t space = line.find(' ');
    if (space == std::string::npos || line.starts_with("#")) continue;
    const std::string key = line.substr(0, space), value = line.substr(space + 1);
    const auto number = to_number(value.substr(0, value.find(' ')));
    if (key == "format") format = value;
    if (key == "hash") hash = value;
    if (key == "kind") reference.kind = value;
    if (key == "method") reference.methods.push_back(value);
    if (key == "message") reference.message = value;
    if (key != "t" && key != "bound" && key != "state") continue;
    if (!number) return std::nullopt;
    if (key == "t") reference.times.push_back(*number);
    if (key == "bound") reference.bounds[0].push_back(*number);
    if (key == "state") reference.states[0].push_back(*number);
  }
  const bool fits = format == std::to_string(reference_format) && hash == scene.physics_hash() &&
                    reference.kind == "certified" && !reference.methods.empty() &&
                    reference.times == std::vector<double>{scene.t_end} &&
                    reference.bounds[0].size() == scene.model->metrics().size() &&
                    !reference.states[0].empty();
  return fits ? std::optional(std::move(reference)) : std::nullopt;
}

}  // namespace gnomon
