#include "src/output/figure_labels.hpp"

#include <cmath>
#include <random>
#include <vector>

#include "tests/catch.hpp"

using namespace gnomon::output;

TEST_CASE("output: places are free unless something is drawn there or they are outside") {
  Occupied occupied({100.0, 50.0, 400.0, 250.0});
  CHECK(occupied.is_free({150.0, 100.0, 200.0, 120.0}));
  CHECK_FALSE(occupied.is_free({90.0, 100.0, 200.0, 120.0}));
  occupied.add_line({100.0, 50.0}, {400.0, 250.0});
  CHECK_FALSE(occupied.is_free({240.0, 140.0, 260.0, 160.0}));
  CHECK(occupied.is_free({240.0, 170.0, 255.0, 185.0}));
  occupied.add_box({110.0, 200.0, 150.0, 240.0});
  CHECK_FALSE(occupied.is_free({145.0, 220.0, 170.0, 230.0}));
  CHECK(occupied.is_free({160.0, 220.0, 200.0, 230.0}));
  occupied.add_box({-500.0, -500.0, -400.0, -400.0});  // outside: of no effect
  CHECK(occupied.is_free({160.0, 220.0, 200.0, 230.0}));
}

TEST_CASE("output: labels are spread as little as their distance needs") {
  const auto apart = spread({100.0, 10.0, 50.0}, 17.0, 0.0, 200.0, 1.0);
  REQUIRE(apart);
  CHECK(*apart == std::vector<double>{100.0, 10.0, 50.0});
  const auto pushed = spread({50.0, 52.0}, 10.0, 0.0, 200.0, 20.0);
  REQUIRE(pushed);
  CHECK(std::abs((*pushed)[0] - 46.0) < 1e-12);
  CHECK(std::abs((*pushed)[1] - 56.0) < 1e-12);
  const auto edge = spread({198.0, 199.0}, 10.0, 0.0, 200.0, 20.0);
  REQUIRE(edge);
  CHECK(std::abs((*edge)[0] - 190.0) < 1e-12);
  CHECK(std::abs((*edge)[1] - 200.0) < 1e-12);
  CHECK_FALSE(spread({50.0, 52.0}, 10.0, 0.0, 200.0, 3.0));      // would move too far
  CHECK_FALSE(spread({1.0, 2.0, 3.0}, 10.0, 0.0, 19.0, 100.0));  // no room
  CHECK(spread({}, 10.0, 0.0, 1.0, 1.0)->empty());
}

TEST_CASE("output: spread labels keep their distance, order and bounds") {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> height(0.0, 500.0);
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<double> wanted(12);
    for (double& y : wanted) y = height(generator);
    const auto placed = spread(wanted, 17.0, 0.0, 500.0, 1e9);
    REQUIRE(placed);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      REQUIRE((*placed)[i] >= -1e-9);
      REQUIRE((*placed)[i] <= 500.0 + 1e-9);
      for (std::size_t j = 0; j < wanted.size(); ++j) {
        if (wanted[i] < wanted[j]) REQUIRE((*placed)[j] - (*placed)[i] >= 17.0 - 1e-9);
      }
    }
  }
}

TEST_CASE("output: names stand at line ends only where all fit") {
  const Box area = {0.0, 0.0, 400.0, 300.0};
  Occupied occupied(area);
  occupied.add_line({50.0, 50.0}, {250.0, 200.0});
  occupied.add_line({50.0, 250.0}, {250.0, 100.0});
  const std::vector<LineEnds> lines = {{{50.0, 50.0}, {250.0, 200.0}, 80.0},
                                       {{50.0, 250.0}, {250.0, 100.0}, 80.0}};
  const auto places = labels_at_ends(occupied, lines, 15.0);
  REQUIRE(places);
  CHECK((*places)[0].x == 262.0);
  CHECK((*places)[0].y == 200.0);
  CHECK((*places)[1].y == 100.0);
  CHECK_FALSE(occupied.is_free({270.0, 195.0, 290.0, 205.0}));  // now taken by the first name
  Occupied narrow({0.0, 0.0, 400.0, 300.0});
  const std::vector<LineEnds> wide = {{{50.0, 50.0}, {250.0, 200.0}, 390.0}};
  CHECK_FALSE(labels_at_ends(narrow, wide, 15.0));
}

TEST_CASE("output: labels along lines keep off lines and labels") {
  const Box area = {0.0, 0.0, 400.0, 300.0};
  Occupied occupied(area);
  std::vector<LabelledLine> lines;
  // A fan: at its left end all lines are close to each other.
  for (int k = 0; k < 6; ++k) {
    const Point from{20.0, 150.0}, to{300.0, 30.0 + 48.0 * k};
    occupied.add_line(from, to);
    lines.push_back({{from, {160.0, 0.5 * (from.y + to.y)}, to}, 80.0});
  }
  const Occupied before = occupied;
  const auto places = labels_along(occupied, lines, 15.0);
  REQUIRE(places);
  Occupied labels(area);
  for (const LabelPlace& place : *places) {
    const Box box = {place.text.x, place.text.y - 7.5, place.text.x + 80.0, place.text.y + 7.5};
    CHECK(before.is_free(box));
    CHECK(labels.is_free(box));
    labels.add_box(box);
    CHECK_FALSE(occupied.is_free(box));
    if (place.leader) CHECK(std::hypot(place.to.x - place.from.x, place.to.y - place.from.y) <= 80.0);
  }
  // The right ends are the freest.
  CHECK((*places)[0].text.x > 250.0);
  Occupied full(area);
  full.add_box(area);
  CHECK_FALSE(labels_along(full, lines, 15.0));
  const std::vector<LabelledLine> same(30, lines[0]);
  Occupied crowded(area);
  CHECK_FALSE(labels_along(crowded, same, 15.0));
}

TEST_CASE("output: what lies on a line is seen") {
  Occupied occupied({0.0, 0.0, 100.0, 100.0});
  CHECK(occupied.is_free_along({10.0, 10.0}, {90.0, 80.0}));
  occupied.add_box({48.0, 40.0, 52.0, 50.0});
  CHECK_FALSE(occupied.is_free_along({10.0, 10.0}, {90.0, 80.0}));
  CHECK(occupied.is_free_along({10.0, 80.0}, {90.0, 80.0}));
  CHECK_FALSE(occupied.is_free_along({10.0, 80.0}, {190.0, 80.0}));
}

TEST_CASE("output: guides stand in free space, with their slopes") {
  const Box area = {0.0, 0.0, 600.0, 500.0};
  Occupied occupied(area);
  occupied.add_line({0.0, 0.0}, {600.0, 500.0});
  const Occupied before = occupied;
  const std::vector<double> slopes = {0.25, 0.5, 1.0};
  const auto place = place_guides(occupied, area, slopes, {50.0, 50.0, 50.0}, 15.0);
  REQUIRE(place);
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    const Point from = place->from[i];
    const Point to = place->to[i];
    CHECK(std::abs((to.y - from.y) / (to.x - from.x) - slopes[i]) < 1e-12);
    for (double s = 0.0; s <= 1.0; s += 0.05) {
      const double x = from.x + s * (to.x - from.x);
      const double y = from.y + s * (to.y - from.y);
      CHECK(before.is_free({x - 3.0, y - 3.0, x + 3.0, y + 3.0}));
    }
    const Point label = place->labels[i];
    CHECK(before.is_free({label.x, label.y - 7.5, label.x + 50.0, label.y + 7.5}));
  }
  Occupied full(area);
  full.add_box(area);
  CHECK_FALSE(place_guides(full, area, slopes, {50.0, 50.0, 50.0}, 15.0));
  Occupied empty(area);
  CHECK_FALSE(place_guides(empty, area, {1.0, 1.001}, {50.0, 50.0}, 15.0));  // labels would overlap
  CHECK_FALSE(place_guides(empty, area, {}, {}, 15.0));
}

TEST_CASE("output: the name of a horizontal line avoids what crosses it") {
  const Box area = {0.0, 0.0, 400.0, 300.0};
  Occupied occupied(area);
  const Point first = label_on_horizontal(occupied, area, 100.0, 120.0, 15.0);
  CHECK(first.x == 272.0);
  CHECK(first.y > 100.0);
  Occupied crossed(area);
  crossed.add_box({300.0, 0.0, 400.0, 300.0});
  const Point moved = label_on_horizontal(crossed, area, 100.0, 120.0, 15.0);
  CHECK(moved.x + 120.0 < 300.0);
  Occupied above(area);
  above.add_box({0.0, 101.0, 400.0, 300.0});
  CHECK(label_on_horizontal(above, area, 100.0, 120.0, 15.0).y < 100.0);
}
