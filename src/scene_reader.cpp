#include "src/scene_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>

#include "src/output/text.hpp"

namespace gnomon {

namespace {

/// A text in quotes, with control characters as escapes.
std::string quoted(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      result += {'\\', c};
    else if (c == '\n')
      result += "\\n";
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F)
      result += fmt::format("\\u{:04X}", static_cast<int>(c));
    else
      result += c;
  }
  return result + '"';
}

/// A value of a scene as a message shows it; written here because the library's own way depends on its
/// version.
std::string shown_value(const toml::node& node) {
  const auto list = [](const auto& entries, auto&& text) {
    std::string joined;
    for (const auto& entry : entries) joined += (joined.empty() ? "" : ", ") + text(entry);
    return joined;
  };
  if (const auto* text = node.as_string()) return gnomon::quoted(text->get());
  if (const auto* whole = node.as_integer()) return fmt::format("{}", whole->get());
  if (const auto* real = node.as_floating_point()) {
    const std::string digits = fmt::format("{}", real->get());
    return digits.find_first_of(".einf") == std::string::npos ? digits + ".0" : digits;
  }
  if (const auto* truth = node.as_boolean()) return truth->get() ? "true" : "false";
  if (const auto* array = node.as_array())
    return fmt::format("[{}]", list(*array, [](const toml::node& entry) { return shown_value(entry); }));
  if (const auto* table = node.as_table())
    return table->empty() ? "{}" : fmt::format("{{ {} }}", list(*table, [](const auto& entry) {
                                                 return fmt::format("{} = {}", entry.first.str(),
                                                                    shown_value(entry.second));
                                               }));
  return "a date or time";
}

}  // namespace

Section::Section(const toml::table& table, std::string path, const SceneSource& source)
    : table_(&table), path_(std::move(path)), source_(&source) {}

std::string Section::full(std::string_view key) const {
  return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
}

std::string Section::where(std::string_view key, std::optional<std::size_t> entry) const {
  const std::string path = full(key);
  const auto within = [](const std::string& inner, const std::string& outer) {
    return inner == outer || inner.starts_with(outer + ".");
  };
  const std::string* option = nullptr;
  std::size_t length = 0;  // the longest path at or above this one is the last that wrote it
  for (const auto& [overridden, text] : source_->overrides) {
    const bool above = within(path, overridden);
    if (above ? overridden.size() >= length : !option && within(overridden, path)) option = &text;
    if (above) length = overridden.size();
  }
  if (option) return fmt::format("{}: {}", *option, path);
  const toml::node* node = table_->get(key);
  if (const toml::array* list = node && entry ? node->as_array() : nullptr)
    if (const toml::node* one = list->get(*entry)) node = one;
  toml::source_index line = node ? node->source().begin.line : table_->source().begin.line;
  return line > 0 ? fmt::format("{}:{}: {}", source_->file, line, path)
                  : fmt::format("{}: {}", source_->file, path);
}

void Section::fail(std::string_view key, std::string_view found, std::string_view expected) const {
  throw UsageError(fmt::format("{}: found {}, expected {}", where(key), found, expected));
}

void Section::refuse(std::string_view key, std::string_view why, std::optional<std::size_t> entry) const {
  throw UsageError(fmt::format("{}: {}", where(key, entry), why));
}

std::string Section::shown(std::string_view key) const {
  const toml::node* node = table_->get(key);
  if (!node) return "nothing";
  const std::string text = output::plain_text(shown_value(*node));
  return output::display_columns(text) > 60 ? output::first_columns(text, 57) + "..." : text;
}

std::string Section::beside(const std::string& name) const {
  return (std::filesystem::path(source_->folder) / name).string();
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

int Section::integer(std::string_view key, int least, int most, std::string_view expected) {
  const double value = number(key, expected);
  if (value != std::floor(value) || value < least || value > most) fail(key, shown(key), expected);
  return static_cast<int>(value);
}

std::vector<double> Section::numbers(std::string_view key, std::size_t count, std::string_view expected) {
  const toml::array* list = require(key, expected).as_array();
  if (!list || list->size() != count) fail(key, shown(key), expected);
  std::vector<double> values;
  for (const toml::node& node : *list) values.push_back(finite(node, key, expected));
  return values;
}

std::vector<double> Section::positives(std::string_view key, std::string_view expected) {
  const toml::array* list = require(key, expected).as_array();
  if (!list || list->size() < 2) fail(key, shown(key), expected);
  std::vector<double> values;
  for (const toml::node& node : *list) {
    values.push_back(finite(node, key, expected));
    if (values.back() <= 0.0) fail(key, shown(key), expected);
  }
  return values;
}

std::vector<double> Section::numbers_or(std::string_view key, std::vector<double> fallback,
                                        std::string_view expected) {
  return find(key) ? numbers(key, fallback.size(), expected) : fallback;
}

std::vector<double> Section::list(std::string_view key, std::string_view expected) {
  const toml::array* array = require(key, expected).as_array();
  if (!array) fail(key, shown(key), expected);
  std::vector<double> values;
  for (const toml::node& node : *array) values.push_back(finite(node, key, expected));
  return values;
}

bool Section::flag(std::string_view key) {
  const toml::node* node = find(key);
  if (!node) return false;
  if (!node->is_boolean()) fail(key, shown(key), "true or false");
  return node->as_boolean()->get();
}

std::string Section::text(std::string_view key, std::string_view expected) {
  const auto* value = require(key, expected).as_string();
  if (!value || value->get().empty()) fail(key, shown(key), expected);
  return value->get();
}

std::string Section::text_or(std::string_view key, std::string_view fallback, std::string_view expected) {
  return find(key) ? text(key, expected) : std::string(fallback);
}

std::vector<std::string> Section::texts(std::string_view key, std::string_view expected) {
  std::vector<std::string> list;
  const toml::node* node = find(key);
  if (!node) return list;
  const toml::array* array = node->as_array();
  if (!array) fail(key, shown(key), expected);
  for (const toml::node& entry : *array) {
    if (!entry.is_string()) fail(key, shown(key), expected);
    list.push_back(entry.as_string()->get());
  }
  return list;
}

std::vector<std::string> Section::values(std::string_view key, std::string_view expected) {
  const toml::array* array = require(key, expected).as_array();
  if (!array || array->empty()) fail(key, shown(key), expected);
  std::vector<std::string> list;
  for (const toml::node& entry : *array) {
    list.push_back(shown_value(entry));
    // The shorter of the spellings 10000000000.0 and 1e+10.
    const std::optional<double> number = entry.is_floating_point() ? entry.value<double>() : std::nullopt;
    const std::string brief = number ? fmt::format("{:g}", *number) : "";
    if (brief.find('e') != std::string::npos && brief.size() < list.back().size() &&
        std::stod(brief) == *number)
      list.back() = brief;
  }
  return list;
}

std::string Section::one_of(std::string_view key, const std::vector<std::string>& choices) {
  const std::string expected = choices_text(choices);
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

std::vector<Section> Section::sections(std::string_view key) {
  const toml::node* node = find(key);
  std::vector<Section> tables;
  if (!node) return tables;
  const toml::array* list = node->as_array();
  if (!list) fail(key, shown(key), fmt::format("tables [[{}]]", full(key)));
  for (const toml::node& entry : *list) {
    if (!entry.is_table()) fail(key, shown(key), fmt::format("tables [[{}]]", full(key)));
    tables.emplace_back(*entry.as_table(), fmt::format("{}[{}]", full(key), tables.size()), *source_);
  }
  return tables;
}

bool Section::is_table(std::string_view key) const {
  const toml::node* node = table_->get(key);
  return node && node->is_table();
}

bool Section::is_number(std::string_view key) const {
  const toml::node* node = table_->get(key);
  return node && node->is_number();
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

std::string Section::nearest_absent(std::string_view name, const std::vector<std::string>& keys) const {
  std::vector<std::string> absent;
  std::copy_if(keys.begin(), keys.end(), std::back_inserter(absent),
               [&](const std::string& key) { return !has(key); });
  return nearest(name, absent);
}

void Section::only(const std::vector<std::string>& keys, std::string_view owner) const {
  for (const auto& [key, node] : *table_) {
    const std::string name(key.str());
    if (std::find(keys.begin(), keys.end(), name) != keys.end()) continue;
    const std::string near = nearest_absent(name, keys);
    fail(name, owner.empty() ? "an unknown key" : fmt::format("a key unknown to {}", owner),
         near.empty() ? choices_text(keys) : near);
  }
}

void Section::refuse_misspelt(const std::vector<std::string>& keys) const {
  for (const auto& [key, node] : *table_) {
    const std::string name(key.str());
    if (std::find(keys.begin(), keys.end(), name) != keys.end()) continue;
    if (const std::string near = nearest_absent(name, keys); !near.empty())
      fail(name, "an unknown key", near);
  }
}

void Section::finish() const {
  std::vector<std::string> keys = known_;
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  only(keys);
}

}  // namespace gnomon
