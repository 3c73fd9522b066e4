#include "models/planar_beam/saved_state.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "src/output/text.hpp"
#include "src/scene.hpp"

namespace gnomon::planar_beam {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* what = "a file written by gnomon run --json for the same beam";

}  // namespace

void read_saved_state(Section& initial, const Json& beam, Data& data) {
  const std::string name = output::plain_text(initial.text("state", what));
  const auto refuse = [&](const std::string& found, const std::string& expected = what) {
    initial.fail("state", fmt::format("'{}', {}", name, found), expected);
  };
  std::ifstream in(initial.beside(initial.text("state", what)), std::ios::binary);
  if (!in) refuse("which cannot be read");
  const Json file = Json::parse(in, nullptr, false);
  if (file.is_discarded()) refuse("which is not JSON");
  const auto first = [&](const char* key) -> Json {
    const auto list = file.is_object() ? file.find(key) : file.end();
    if (!file.is_object() || list == file.end() || !list->is_array() || list->empty() ||
        !list->front().is_object())
      refuse(fmt::format("which has no {}", key));
    return list->front();
  };
  const Json scene = first("scenes"), run = first("runs");
  const Json model = scene.value("model", Json());
  if (model != "planar_beam")
    refuse(model.is_string()
               ? fmt::format("a state of model {}", output::plain_text(model.get<std::string>()))
               : "which names no model",
           "a state of model planar_beam");
  const Json other = scene.value("beam", Json::object());
  const auto value_of = [](const Json& of, const char* key) {
    const bool list = key == std::string("bends") || key == std::string("hinges");
    return of.is_object() ? of.value(key, list ? Json::array() : Json()) : Json();
  };
  for (const char* key : {"length", "elements", "order", "start", "angle", "curvature", "bends", "hinges"})
    if (const Json value = value_of(other, key), own = value_of(beam, key); value != own)
      refuse(fmt::format("a beam with {} = {}", key, output::plain_text(value.dump())),
             fmt::format("one with {} = {}", key, own.dump()));
  if (const Json status = run.value("status", Json()); status != "ok")
    refuse(fmt::format("a run that ended with status {}", output::plain_text(status.dump())),
           "a run with status \"ok\"");
  const std::size_t count =
      3 *
      (beam.at("elements").get<std::size_t>() * beam.at("order").get<std::size_t>() + 1 + data.hinges.size());
  const Json state = run.value("state", Json::object());
  const auto values = [&](const char* key) {
    const Json list = state.is_object() ? state.value(key, Json()) : Json();
    if (!list.is_array() || list.size() != count)
      refuse(list.is_array() ? fmt::format("{} numbers in state.{}", list.size(), key)
                             : fmt::format("which has no list state.{}", key),
             fmt::format("{} numbers (ux, uz, phi of every node{})", count,
                         data.hinges.empty() ? "" : ", of a hinge's on both sides"));
    std::vector<double> numbers;
    for (const Json& value : list) {
      if (!value.is_number() || !std::isfinite(value.get<double>()))
        refuse(fmt::format("{} in state.{}", output::plain_text(value.dump()), key), "finite numbers");
      numbers.push_back(value.get<double>());
    }
    return numbers;
  };
  data.u = values("u");
  data.v = values("v");
}

std::string hash_of(const Data& data) {
  std::string text;
  for (const auto* values : {&data.u, &data.v})
    for (double value : *values) text += fmt::format("{:.17g} ", value);
  return hash_text(text);
}

}  // namespace gnomon::planar_beam
