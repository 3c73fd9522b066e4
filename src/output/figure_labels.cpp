#include "src/output/figure_labels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace gnomon::output {
namespace {

constexpr double cell_size = 3.0;

Box text_box(Point centre_left, double width, double height) {
  return {centre_left.x, centre_left.y - 0.5 * height, centre_left.x + width, centre_left.y + 0.5 * height};
}

Box grown(const Box& box, double by) {
  return {box.left - by, box.bottom - by, box.right + by, box.top + by};
}

}  // namespace

Occupied::Occupied(const Box& area)
    : area_(area),
      columns_(static_cast<std::size_t>(std::max(1.0, std::ceil((area.right - area.left) / cell_size)))),
      rows_(static_cast<std::size_t>(std::max(1.0, std::ceil((area.top - area.bottom) / cell_size)))),
      cells_(columns_ * rows_, false) {}

void Occupied::add_line(Point from, Point to) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  const int steps = static_cast<int>(std::ceil(std::min(length, 1e5) / (0.5 * cell_size))) + 1;
  for (int i = 0; i <= steps; ++i) {
    const double s = static_cast<double>(i) / steps;
    const double x = from.x + s * (to.x - from.x);
    const double y = from.y + s * (to.y - from.y);
    add_box({x, y, x, y});
  }
}

void Occupied::add_box(const Box& box) {
  if (!(box.right >= area_.left && box.left <= area_.right && box.top >= area_.bottom &&
        box.bottom <= area_.top)) {
    return;
  }
  const auto clamped = [](double value, std::size_t count) {
    return static_cast<std::size_t>(std::clamp(value / cell_size, 0.0, static_cast<double>(count - 1)));
  };
  for (std::size_t row = clamped(box.bottom - area_.bottom, rows_);
       row <= clamped(box.top - area_.bottom, rows_); ++row) {
    for (std::size_t column = clamped(box.left - area_.left, columns_);
         column <= clamped(box.right - area_.left, columns_); ++column) {
      cells_[index(column, row)] = true;
    }
  }
}

bool Occupied::is_free(const Box& box) const {
  if (box.left < area_.left || box.bottom < area_.bottom || box.right > area_.right || box.top > area_.top) {
    return false;
  }
  const auto first_column = static_cast<std::size_t>((box.left - area_.left) / cell_size);
  const auto last_column =
      std::min(columns_ - 1, static_cast<std::size_t>((box.right - area_.left) / cell_size));
  const auto first_row = static_cast<std::size_t>((box.bottom - area_.bottom) / cell_size);
  const auto last_row = std::min(rows_ - 1, static_cast<std::size_t>((box.top - area_.bottom) / cell_size));
  for (std::size_t row = first_row; row <= last_row; ++row) {
    for (std::size_t column = first_column; column <= last_column; ++column) {
      if (cells_[index(column, row)]) return false;
    }
  }
  return true;
}

bool Occupied::is_free_along(Point from, Point to) const {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  const int steps = static_cast<int>(std::ceil(length / (0.5 * cell_size))) + 1;
  for (int i = 0; i <= steps; ++i) {
    const double s = static_cast<double>(i) / steps;
    const double x = from.x + s * (to.x - from.x);
    const double y = from.y + s * (to.y - from.y);
    if (!is_free({x, y, x, y})) return false;
  }
  return true;
}

std::optional<std::vector<double>> spread(const std::vector<double>& wanted, double gap, double low,
                                          double high, double longest_move) {
  const std::size_t count = wanted.size();
  if (count == 0) return std::vector<double>{};
  if (static_cast<double>(count - 1) * gap > high - low) return std::nullopt;
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return wanted[a] < wanted[b]; });

  // Blocks of labels that touch stand at the mean of where their members would like the block to stand;
  // blocks that overlap are joined (isotonic regression by pooling adjacent violators).
  struct Block {
    std::size_t members;
    double sum;  // of wanted[k] - k * gap
  };
  std::vector<Block> blocks;
  const auto mean = [](const Block& block) { return block.sum / static_cast<double>(block.members); };
  for (std::size_t k = 0; k < count; ++k) {
    blocks.push_back({1, wanted[order[k]] - static_cast<double>(k) * gap});
    while (blocks.size() > 1 && mean(blocks[blocks.size() - 2]) > mean(blocks.back())) {
      const Block last = blocks.back();
      blocks.pop_back();
      blocks.back().members += last.members;
      blocks.back().sum += last.sum;
    }
  }
  std::vector<double> placed(count);
  std::size_t k = 0;
  for (const Block& block : blocks) {
    for (std::size_t member = 0; member < block.members; ++member, ++k) {
      const double offset = static_cast<double>(k) * gap;
      const double highest = high - static_cast<double>(count - 1) * gap;
      const double y = std::clamp(mean(block), low, highest) + offset;
      if (std::abs(y - wanted[order[k]]) > longest_move) return std::nullopt;
      placed[order[k]] = y;
    }
  }
  return placed;
}

std::optional<std::vector<Point>> labels_at_ends(Occupied& occupied, const std::vector<LineEnds>& lines,
                                                 double text_height) {
  Occupied trial = occupied;
  std::vector<Point> labels;
  for (const LineEnds& line : lines) {
    std::optional<Point> found;
    for (const Point end : {line.last, line.first}) {
      const double beside = 12.0;
      const double above = 0.5 * text_height + 9.0;
      const std::array<Point, 8> places = {{{end.x + beside, end.y},
                                            {end.x - beside - line.text_width, end.y},
                                            {end.x + 6.0, end.y - above},
                                            {end.x + 6.0, end.y + above},
                                            {end.x - 6.0 - line.text_width, end.y - above},
                                            {end.x - 6.0 - line.text_width, end.y + above},
                                            {end.x - 0.5 * line.text_width, end.y - above},
                                            {end.x - 0.5 * line.text_width, end.y + above}}};
      for (const Point place : places) {
        if (!found && trial.is_free(grown(text_box(place, line.text_width, text_height), 2.0))) found = place;
      }
      if (found) break;
    }
    if (!found) return std::nullopt;
    trial.add_box(text_box(*found, line.text_width, text_height));
    labels.push_back(*found);
  }
  occupied = trial;
  return labels;
}

namespace {

struct Candidate {
  LabelPlace place;
  double badness = 0.0;
};

/// The best place for one label; `lines` is what the curves occupy, `labels` what labels and leaders do.
std::optional<Candidate> best_place(const Occupied& lines, const Occupied& labels, const LabelledLine& line,
                                    double height) {
  constexpr int directions = 16;
  constexpr double clear_of_marker = 8.0;
  std::optional<Candidate> best;
  for (std::size_t a = 0; a < line.anchors.size(); ++a) {
    const Point anchor = line.anchors[a];
    const bool end = a == 0 || a + 1 == line.anchors.size();
    for (const double radius : {10.0, 18.0, 27.0, 38.0, 50.0, 64.0, 80.0}) {
      for (int k = 0; k < directions; ++k) {
        const double angle = 2.0 * 3.14159265358979323846 * k / directions;
        const Point away{std::cos(angle), std::sin(angle)};
        const Point tip{anchor.x + radius * away.x, anchor.y + radius * away.y};
        // The box touches the tip from outside, by a side or a corner.
        Candidate each;
        each.place.text = {tip.x - 0.5 * (1.0 - away.x) * line.text_width, tip.y + 0.5 * away.y * height};
        each.place.leader = radius > 12.0;
        each.place.from = {anchor.x + clear_of_marker * away.x, anchor.y + clear_of_marker * away.y};
        each.place.to = tip;
        each.badness = radius + (end ? 0.0 : 12.0);
        if (best && each.badness >= best->badness) continue;
        const Box box = grown(text_box(each.place.text, line.text_width, height), 2.0);
        if (!lines.is_free(box) || !labels.is_free(box)) continue;
        if (each.place.leader) {
          if (!labels.is_free_along(each.place.from, each.place.to)) continue;
          if (!lines.is_free_along(each.place.from, each.place.to)) each.badness += 60.0;
        }
        if (!best || each.badness < best->badness) best = each;
      }
    }
  }
  return best;
}

}  // namespace

std::optional<std::vector<LabelPlace>> labels_along(Occupied& occupied,
                                                    const std::vector<LabelledLine>& lines,
                                                    double text_height) {
  Occupied labels = occupied.emptied();
  std::vector<LabelPlace> places(lines.size());
  std::vector<std::optional<Candidate>> best(lines.size());
  std::vector<std::size_t> left(lines.size());
  std::iota(left.begin(), left.end(), std::size_t{0});
  const auto still_free = [&](const Candidate& each, double width) {
    return labels.is_free(grown(text_box(each.place.text, width, text_height), 2.0)) &&
           (!each.place.leader || labels.is_free_along(each.place.from, each.place.to));
  };
  while (!left.empty()) {
    for (const std::size_t c : left) {
      if (best[c] && still_free(*best[c], lines[c].text_width)) continue;
      best[c] = best_place(occupied, labels, lines[c], text_height);
      if (!best[c]) return std::nullopt;
    }
    // The one for which the best place left is the worst goes first.
    const auto next = std::max_element(left.begin(), left.end(), [&](std::size_t a, std::size_t b) {
      return best[a]->badness < best[b]->badness;
    });
    const std::size_t c = *next;
    left.erase(next);
    places[c] = best[c]->place;
    labels.add_box(text_box(places[c].text, lines[c].text_width, text_height));
    if (places[c].leader) labels.add_line(places[c].from, places[c].to);
  }
  for (std::size_t c = 0; c < lines.size(); ++c) {
    occupied.add_box(text_box(places[c].text, lines[c].text_width, text_height));
    if (places[c].leader) occupied.add_line(places[c].from, places[c].to);
  }
  return places;
}

std::optional<GuidePlace> place_guides(Occupied& occupied, const Box& area, const std::vector<double>& slopes,
                                       const std::vector<double>& text_widths, double text_height) {
  if (slopes.empty()) return std::nullopt;
  const double least = *std::min_element(slopes.begin(), slopes.end());
  const double greatest = *std::max_element(slopes.begin(), slopes.end());
  const double steepest_up = std::max(0.0, greatest);
  const double steepest_down = std::min(0.0, least);
  const double area_width = area.right - area.left;
  const double area_height = area.top - area.bottom;
  const double label_width = *std::max_element(text_widths.begin(), text_widths.end()) + 6.0;

  const auto labels_overlap = [&](double width) {
    for (std::size_t i = 0; i < slopes.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (std::abs(slopes[i] - slopes[j]) * width < 0.9 * text_height) return true;
      }
    }
    return false;
  };
  const auto fits = [&](Point origin, double width, double clearance) {
    const double strip = 8.0;
    for (double x = 0.0; x < width; x += strip) {
      const double to = std::min(x + strip, width);
      const Box box = {origin.x + x, origin.y + std::min(least * x, least * to), origin.x + to,
                       origin.y + std::max(greatest * x, greatest * to)};
      if (!occupied.is_free(grown(box, clearance))) return false;
    }
    const Box labels = {origin.x + width, origin.y + least * width - 0.5 * text_height,
                        origin.x + width + label_width, origin.y + greatest * width + 0.5 * text_height};
    return occupied.is_free(grown(labels, clearance));
  };

  // Large is easier to compare with than small, but not at the price of standing close to something.
  for (const double clearance : {14.0, 8.0}) {
    for (double width = 0.30 * area_width; width >= 18.0; width *= 0.85) {
      if ((steepest_up - steepest_down) * width > 0.45 * area_height) continue;
      if (labels_overlap(width)) break;
      for (double x = area.right - width - label_width - clearance; x >= area.left + clearance; x -= 10.0) {
        for (double y = area.bottom + clearance - steepest_down * width; y <= area.top; y += 10.0) {
          if (!fits({x, y}, width, clearance)) continue;
          GuidePlace place;
          for (const double slope : slopes) {
            const Point end = {x + width, y + slope * width};
            place.from.push_back({x, y});
            place.to.push_back(end);
            place.labels.push_back({end.x + 5.0, end.y});
            occupied.add_line({x, y}, end);
          }
          for (std::size_t i = 0; i < slopes.size(); ++i) {
            occupied.add_box(text_box(place.labels[i], text_widths[i], text_height));
          }
          return place;
        }
      }
    }
  }
  return std::nullopt;
}

Point label_on_horizontal(Occupied& occupied, const Box& area, double y, double text_width,
                          double text_height) {
  const double rightmost = area.right - text_width - 8.0;
  Point chosen = {rightmost, y + 0.5 * text_height + 1.3 * cell_size};
  bool found = false;
  // Where it is tight, with no more than the letters themselves need.
  for (const double height : {text_height, 0.7 * text_height}) {
    // More than a cell from the line, which is an obstacle itself.
    const double offset = 0.5 * height + 1.3 * cell_size;
    for (const double side : {offset, -offset}) {
      for (double x = rightmost; x >= area.left + 8.0 && !found; x -= 6.0) {
        found = occupied.is_free(text_box({x, y + side}, text_width, height));
        if (found) chosen = {x, y + side};
      }
    }
  }
  occupied.add_box(text_box(chosen, text_width, text_height));
  return chosen;
}

}  // namespace gnomon::output
