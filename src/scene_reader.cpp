#include "src/scene_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

namespace gnomon {

std::string nearest(std::string_view word, const std::vector<std::string>& known) {
  const auto distance = [](std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), 0U);
    for (std::size_t i = 1; i <= a.size(); ++i) {
      std::size_t diagonal = row[0];
      row[0] = i;
      for (std::size_t j = 1; j <= b.size(); ++j) {
        const std::size_t change = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
        diagonal = row[j];
        row[j] = std::min({change, row[j] + 1, row[j - 1] + 1});
      }
    }
    return row.back();
  };
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : known) {
    const std::size_t d = distance(word, candidate);
    if (d < best_distance) {
      best_distance = d;
      best = candidate;
    }
  }
  return best;
}

Section::Section(const toml::table& table, std::string path, const SceneSource& source)
    : table_(&table), path_(std::move(path)), source_(&source) {}

std::string Section::full(std::string_view key) const {
  return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
}

std::string Section::where(std::string_view key) const {
  const std::string path = full(key);
  for (const auto& [overridden, option] : source_->overrides)
    if (path == overridden || path.starts_with(overridden + ".")) return fmt::format("{}: {}", option, path);
  const toml::node* node = table_->get(key);
  toml::source_index line = node ? node->source().begin.line : table_->source().begin.line;
  return line > 0 ? fmt::format("{}:{}: {}", source_->file, line, path)
                  : fmt::format("{}: {}", source_->file, path);
}

void Section::fail(std::string_view key, std::string_view found, std::string_view expected) const {
  throw UsageError(fmt::format("{}: found {}, expected {}", where(key), found, expected));
}

std::string Section::shown(std::string_view key) const {
  const toml::node* node = table_->get(key);
  if (!node) return "nothing";
  std::ostringstream stream;
  node->visit([&](const auto& value) { stream << value; });
  std::string text = stream.str();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.size() > 60 ? text.substr(0, 57) + "..." : text;
}

bool Section::has(std::string_view key) const { return table_->contains(key); }

const toml::node* Section::find(std::string_view key) {
  known_.emplace_back(key);
  return table_->get(key);
}

const toml::node& Section::require(std::string_view key, std::string_view expected) {
  const toml::node* node = find(key);
  if (!node) fail(key, "nothing", expected);
  return *node;
}

double Section::finite(const toml::node& node, std::string_view key, std::string_view expected) const {
  double value = 0.0;
  if (const auto* real = node.as_floating_point())
    value = real->get();
  else if (const auto* whole = node.as_integer())
    value = static_cast<double>(whole->get());
  else
    fail(key, shown(key), expected);
  if (!std::isfinite(value)) fail(key, shown(key), expected);
  return value;
}

double Section::number(std::string_view key, std::string_view expected) {
  return finite(require(key, expected), key, expected);
}

double Section::number_or(std::string_view key, double fallback, std::string_view expected) {
  const toml::node* node = find(key);
  return node ? finite(*node, key, expected) : fallback;
}

double Section::positive(std::string_view key, std::string_view expected) {
  const double value = number(key, expected);
  if (value <= 0.0) fail(key, shown(key), expected);
  return value;
}

std::vector<double> Section::numbers(std::string_view key, std::size_t count, std::string_view expected) {
  const toml::array* list = require(key, expected).as_array();
  if (!list || list->size() != count) fail(key, shown(key), expected);
  std::vector<double> values;
  for (const toml::node& node : *list) values.push_back(finite(node, key, expected));
  return values;
}

std::vector<double> Section::numbers_or(std::string_view key, std::vector<double> fallback,
                                        std::string_view expected) {
  return find(key) ? numbers(key, fallback.size(), expected) : fallback;
}

std::string Section::text(std::string_view key, std::string_view expected) {
  const auto* value = require(key, expected).as_string();
  if (!value || value->get().empty()) fail(key, shown(key), expected);
  return value->get();
}

std::string Section::one_of(std::string_view key, const std::vector<std::string>& choices) {
  const std::string expected = fmt::format("one of {}", fmt::join(choices, ", "));
  const std::string value = text(key, expected);
  if (std::find(choices.begin(), choices.end(), value) == choices.end()) fail(key, shown(key), expected);
  return value;
}

std::optional<Section> Section::section(std::string_view key) {
  const toml::node* node = find(key);
  if (!node) return std::nullopt;
  if (!node->is_table()) fail(key, shown(key), "a table");
  return Section(*node->as_table(), full(key), *source_);
}

std::string Section::exactly_one(std::string_view first, std::string_view second, std::string_view meaning) {
  known_.emplace_back(first);
  known_.emplace_back(second);
  if (has(first) && has(second))
    fail(second, fmt::format("both {} and {}", first, second), fmt::format("only one of them ({})", meaning));
  if (!has(first) && !has(second))
    fail(first, "nothing", fmt::format("{} or {} ({})", first, second, meaning));
  return std::string(has(first) ? first : second);
}

void Section::finish() const {
  for (const auto& [key, node] : *table_) {
    const std::string name(key.str());
    if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
    const std::string near = nearest(name, known_);
    std::vector<std::string> sorted = known_;
    std::sort(sorted.begin(), sorted.end());
    sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
    fail(name, "an unknown key",
         near.empty() ? fmt::format("one of {}", fmt::join(sorted, ", ")) : fmt::format("{} perhaps", near));
  }
}

}  // namespace gnomon
