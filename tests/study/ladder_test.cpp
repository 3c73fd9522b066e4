#include <cmath>
#include <vector>

#include "src/run.hpp"
#include "src/study/compare.hpp"
#include "src/study/study.hpp"
#include "tests/catch.hpp"
#include "tests/example/pendulum.hpp"

using namespace gnomon;

namespace {

/// A pendulum whose data jump at one time.
struct JerkedPendulum : example::Pendulum {
  double jerk;
  JerkedPendulum(double g, double at) : Pendulum(g), jerk(at) {}
  std::vector<double> breaks() const { return {jerk}; }
};

Scene jerked_scene(double t_end, double at) {
  Scene scene;
  scene.t_end = t_end;
  scene.model = box(JerkedPendulum(1.0, at));
  return scene;
}

SchemeInfo scheme_of_order(double order) {
  SchemeInfo info{};
  info.orders = {{{"gravity", order}}};
  return info;
}

int missing(const Scene& scene, const std::vector<double>& steps) {
  int count = 0;
  for (const double step : steps) count += plan_steps(scene.t_end, step, scene.model->breaks()).misses_break;
  return count;
}

}  // namespace

TEST_CASE("study: a ladder of steps meets the breaks where it can, and its steps fall", "[study]") {
  const SchemeInfo scheme = scheme_of_order(2.0);
  for (const double at : {5.0, 2.5, 1.0, 8.1, 0.09}) {  // of 9
    const Scene scene = jerked_scene(9.0, at);
    const std::vector<double> steps = step_ladder(scene, scheme, 21, 0.5);
    INFO(at);
    REQUIRE(steps.size() == 21);
    CHECK((missing(scene, steps) == 0) == (at != 0.09));  // that needs multiples of 100, the first has 18
    for (std::size_t k = 1; k < steps.size(); ++k) CHECK(steps[k] < steps[k - 1]);
    CHECK(std::abs(steps.back() / steps.front() - std::exp2(-10.0)) <= 0.6 * std::exp2(-10.0));
  }
  // A number of steps that no small multiple meets is left alone.
  const Scene scene = jerked_scene(9.0, std::sqrt(2.0));
  CHECK(missing(scene, step_ladder(scene, scheme, 21, 0.5)) == 21);
  CHECK(step_ladder(scene, scheme, 21, 0.5).front() == 9.0 / 18.0);
}

TEST_CASE("study: schemes of order 6 and more begin at steps eight times as large", "[study]") {
  const Scene scene = jerked_scene(100.0, 200.0);
  const double usual = step_ladder(scene, scheme_of_order(4.0), 5, 0.5).front();
  CHECK(usual == 0.5);
  CHECK(step_ladder(scene, scheme_of_order(5.9), 5, 0.5).front() == usual);
  CHECK(step_ladder(scene, scheme_of_order(6.0), 5, 0.5).front() == 8.0 * usual);
  SchemeInfo other = scheme_of_order(8.0);
  other.orders = {{{"none", 8.0}}};
  CHECK(step_ladder(scene, other, 5, 0.5).front() == usual);
}

TEST_CASE("study: looser settings halve the number of steps and meet the breaks", "[study]") {
  const auto counts = [](const Scene& scene, long from) {
    std::vector<long> list;
    std::optional<Setting> setting = Setting{scene.t_end / static_cast<double>(from), std::nullopt};
    while ((setting = looser(scene, *setting))) list.push_back(std::lround(scene.t_end / *setting->step));
    return list;
  };
  CHECK(counts(jerked_scene(9.0, 100.0), 18) == std::vector<long>{9, 4, 2, 1});
  CHECK(counts(jerked_scene(9.0, 3.0), 18) == std::vector<long>{9, 3});
  CHECK(counts(jerked_scene(9.0, std::sqrt(2.0)), 8) == std::vector<long>{4, 2, 1});
  const auto tol = [](double from) {
    const auto next = looser(jerked_scene(9.0, 100.0), {std::nullopt, from});
    return next ? next->tol.value() : 0.0;
  };
  CHECK(std::abs(tol(1e-3) - 1e-2) <= 1e-12);
  CHECK(tol(0.03) == 0.1);
  CHECK(tol(0.1) == 0.0);
}
