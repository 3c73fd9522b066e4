#include "src/output/figure_notes.hpp"

#include <algorithm>

#include "src/output/text.hpp"

namespace gnomon::output {
namespace {

constexpr double note_distance = 20.0;  // of lines
constexpr double note_gap = 30.0;       // between two notes of one line
constexpr const char* note_colour = "#555555";

/// The words of `text` in lines not wider than `width`, unless a single word is.
std::vector<std::string> wrapped(const std::string& text, double width) {
  std::vector<std::string> lines(1);
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find(' ', from), text.size());
    const std::string word = text.substr(from, end - from);
    from = end + 1;
    if (word.empty()) continue;
    std::string& line = lines.back();
    if (line.empty())
      line = word;
    else if (text_width(line + ' ' + word, text_size) <= width)
      line += ' ' + word;
    else
      lines.push_back(word);
  }
  return lines;
}

double sample_width(const PlacedNote& note) { return note.steps ? 34.0 : note.mark != 0 ? 18.0 : 0.0; }

template <class Has>
bool any_panel(const Figure& figure, Has&& has) {
  return std::any_of(figure.panels.begin(), figure.panels.end(), has);
}

}  // namespace

std::vector<PlacedNote> notes_of(const Figure& figure, const std::vector<std::vector<Curve>>& curves,
                                 double width) {
  const bool hollow = std::any_of(curves.begin(), curves.end(), [](const std::vector<Curve>& panel) {
    return std::any_of(panel.begin(), panel.end(), [](const Curve& curve) { return !curve.hollow.empty(); });
  });
  std::vector<PlacedNote> samples;
  if (hollow) samples.push_back({figure.hollow_note, 0.0, 0, 6});
  if (any_panel(figure, [](const Panel& panel) { return !panel.front.empty(); }))
    samples.push_back({figure.front_note, 0.0, 0, 0, true});
  if (any_panel(figure, [](const Panel& panel) { return !panel.levels.empty(); }))
    samples.push_back({figure.floor_note});
  if (any_panel(figure, [](const Panel& panel) { return !panel.failures.empty(); }))
    samples.push_back({figure.failure_note, 0.0, 0, 2});

  std::vector<PlacedNote> notes;
  double at = 0.0;
  std::size_t line = 0;
  for (PlacedNote& note : samples) {
    const std::string text = plain_text(note.text);
    if (text.empty()) continue;
    const double sample = sample_width(note);
    if (at > 0.0 && at + sample + text_width(text, text_size) > width) at = 0.0, ++line;
    const std::vector<std::string> lines = wrapped(text, width - sample);
    for (std::size_t k = 0; k < lines.size(); ++k) {
      if (k > 0) ++line;
      notes.push_back({lines[k], at + sample, line, k == 0 ? note.mark : 0, k == 0 && note.steps});
    }
    at += sample + text_width(lines.back(), text_size) + note_gap;
  }
  return notes;
}

double height_of(const std::vector<PlacedNote>& notes) {
  return notes.empty() ? 0.0 : 6.0 + note_distance * static_cast<double>(notes.back().line + 1);
}

void add_notes(Decoration& decoration, const std::vector<PlacedNote>& notes, double left) {
  if (notes.empty()) return;
  for (const PlacedNote& note : notes) {
    const double y = 15.0 + note_distance * static_cast<double>(notes.back().line - note.line);
    const double x = left + note.left;
    if (note.mark != 0) decoration.marks.push_back({{x - 12.0, y}, note.mark, note_colour});
    if (note.steps) decoration.strokes.push_back({{x - 34.0, y}, {x - 8.0, y}, front_colour, front_width});
    decoration.texts.push_back({{x, y}, Anchor::left, note.text, text_size, note_colour});
  }
}

}  // namespace gnomon::output
