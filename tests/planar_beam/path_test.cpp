// Paths of equilibria with limit points, and the scenes made for statics.
#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/planar_beam/beams.hpp"

using namespace gnomon;
using namespace gnomon::test;

namespace {

StaticPath path_of(const Scene& scene, bool arc_length, int load_steps = 10) {
  StaticsOptions options;
  options.arc_length = arc_length;
  options.load_steps = load_steps;
  return follow_equilibrium(*scene.model->statics(), options);
}

/// The first maximum of the load factor along a path.
double limit_of(const StaticPath& path) {
  for (std::size_t k = 1; k + 1 < path.points.size(); ++k) {
    const double a = path.points[k - 1].factor, b = path.points[k].factor, c = path.points[k + 1].factor;
    if (b > a && b >= c) return b;
  }
  return 1.0;
}

}  // namespace

TEST_CASE("planar beam: a shallow arch snaps through, load control stops at the limit point",
          "[planar_beam]") {
  const Catalogue catalogue = full_catalogue();
  const Scene scene = load_scene(catalogue, "shallow-arch");
  const StaticPath by_load = path_of(scene, false);
  CHECK(by_load.status == Status::newton_failed);
  CHECK(by_load.message.find("--arc-length") != std::string::npos);
  const StaticPath by_length = path_of(scene, true, 40);
  INFO(by_length.message);
  REQUIRE(by_length.status == Status::ok);
  const double limit = limit_of(by_length);
  REQUIRE(limit < 1.0);
  // Load control comes to the limit point and not beyond.
  REQUIRE_FALSE(by_load.points.empty());
  INFO(by_load.points.back().factor << " of " << limit);
  CHECK(std::abs(by_load.points.back().factor - limit) <= 0.02 * limit);
  // Behind it the load falls and rises again, on the other side of the pins.
  const auto lowest = std::min_element(by_length.points.begin(), by_length.points.end(),
                                       [](const auto& a, const auto& b) { return a.factor < b.factor; });
  CHECK(lowest->factor < 0.5 * limit);
  CHECK(by_length.points.back().factor == 1.0);
  const double crown = scene.model->probes(by_length.points.back().state)[1].components[1].second;
  CHECK(crown < -1.0);
}

TEST_CASE("planar beam: no step of the arc length is larger than a part of the loads", "[planar_beam]") {
  const Catalogue catalogue = full_catalogue();
  const auto largest_step = [&](const char* name, int load_steps) {
    const StaticPath path = path_of(load_scene(catalogue, name), true, load_steps);
    INFO(name << ", " << load_steps << ": " << path.message);
    REQUIRE(path.status == Status::ok);
    CHECK(path.points.back().factor == 1.0);
    double before = 0.0, largest = 0.0;
    for (const Equilibrium& point : path.points)
      largest = std::max(largest, std::abs(point.factor - std::exchange(before, point.factor)));
    return largest;
  };
  for (int n : {3, 10}) CHECK(largest_step("elastica", n) <= (1.0 + 1e-9) / n);
  CHECK(largest_step("elastica", 3) >= 0.1);
  // Whatever the steps, the limit point is seen.
  const Scene arch = load_scene(catalogue, "shallow-arch");
  const double limit = limit_of(path_of(arch, true, 40));
  const StaticPath coarse = path_of(arch, true, 1);
  REQUIRE(coarse.status == Status::ok);
  const auto by_factor = [](const Equilibrium& x, const Equilibrium& y) { return x.factor < y.factor; };
  const auto lowest = std::min_element(coarse.points.begin(), coarse.points.end(), by_factor);
  REQUIRE(lowest != coarse.points.begin());
  CHECK(lowest->factor < 0.5 * limit);
  CHECK(std::abs(std::max_element(coarse.points.begin(), lowest, by_factor)->factor - limit) <= 0.03);
}

TEST_CASE("planar beam: Lee's frame snaps through and back", "[planar_beam]") {
  const Catalogue catalogue = full_catalogue();
  const Scene scene = load_scene(catalogue, "lee-frame");
  CHECK(path_of(scene, false).status == Status::newton_failed);
  const StaticPath path = path_of(scene, true, 100);
  INFO(path.message << ", limit " << limit_of(path));
  REQUIRE(path.status == Status::ok);
  // The same on a mesh twice as fine.
  const StaticPath fine = path_of(load_scene(catalogue, "lee-frame", {{}, {"beam.elements=40"}}), true, 100);
  REQUIRE(fine.status == Status::ok);
  CHECK(std::abs(limit_of(path) * 2.5e4 - 18545.0) <= 2.0);
  CHECK(std::abs(limit_of(fine) - limit_of(path)) <= 1e-4);
  // The load comes down to below zero, and the displacement under it turns back on the way.
  double lowest = 1.0, back = 0.0, before = 0.0;
  for (const Equilibrium& point : path.points) {
    lowest = std::min(lowest, point.factor);
    const double under = point.state[3 * 24 + 1];
    back = std::max(back, under - before);
    before = under;
  }
  CHECK(std::abs(lowest * 2.5e4 + 9393.0) <= 5.0);
  CHECK(back > 0.1);
}

TEST_CASE("planar beam: the scenes made for statics give the published numbers", "[planar_beam]") {
  const Catalogue catalogue = full_catalogue();
  const Scene elastica = load_scene(catalogue, "elastica"), roll = load_scene(catalogue, "roll-up");
  struct Row {
    double factor, deflection, shortening, angle;
  };
  const StaticPath path = path_of(elastica, false);
  REQUIRE(path.status == Status::ok);
  for (const Row& row : {Row{.1, .301720773800, .056433236283, .461351949712},
                         Row{.2, .493457480397, .160641720825, .781749831557},
                         Row{.5, .713791523612, .387628360724, 1.215368117612},
                         Row{1., .810609024880, .554995597754, 1.430285538804}}) {
    const auto point = std::find_if(path.points.begin(), path.points.end(), [&](const Equilibrium& one) {
      return std::abs(one.factor - row.factor) <= 1e-12;
    });
    REQUIRE(point != path.points.end());
    const auto tip = elastica.model->probes(point->state)[1].components;
    INFO(row.factor << ": " << tip[0].second << " " << tip[1].second << " " << tip[2].second);
    CHECK(std::abs(tip[0].second + row.shortening) <= 1e-7);
    CHECK(std::abs(tip[1].second - row.factor * 10.0 / 1e4 - row.deflection) <= 1e-7);
    CHECK(std::abs(tip[2].second + row.angle) <= 1e-7);
  }
  const StaticPath half_circle = path_of(roll, false);
  REQUIRE(half_circle.status == Status::ok);
  const auto tip = roll.model->probes(half_circle.points.back().state)[1].components;
  CHECK(std::abs(tip[0].second + 1.0) <= 1e-4);
  CHECK(std::abs(tip[1].second + 2.0 / 3.141592653589793) <= 1e-4);
  CHECK(std::abs(tip[2].second - 3.141592653589793) <= 1e-9);
}

TEST_CASE("planar beam: a scene may start in equilibrium, and vibrates when let go", "[planar_beam]") {
  const Catalogue catalogue = full_catalogue();
  const Scene scene = load_scene(catalogue, "released-cantilever");
  const auto& model = typed<PlanarBeam<3>>(scene);
  const double deflection = model.initial().u[model.unknowns() - 2];
  // P L^3/3 EI + P L/GA
  CHECK(std::abs(deflection - (0.01 * 1e3 / 1500.0 + 0.1 / 1e4)) <= 1e-6);
  const RunResult rest = run_beam("beam-energy-momentum", model, 1.0, 0.05);
  CHECK((model.restore(rest.state).u - model.initial().u).norm() <= 1e-10);
  // The tip's motion a period of the lowest mode later, at a small step: 2 pi/0.646852 = 9.713482 s.
  const double period = 2.0 * 3.141592653589793 / 0.646852;
  const auto tip_at = [&](double t) {
    RunSpec spec;
    spec.t_end = t;
    spec.tol = 1e-9;
    const auto state = model.restore(run_scheme(catalogue, "cvode-bdf", *scene.model, spec).state);
    return state.v[model.unknowns() - 2];
  };
  // The velocity of the lowest mode passes zero upwards after each period.
  CHECK(std::abs(tip_at(1.0 + period)) <= 0.05 * std::abs(tip_at(1.0 + 0.75 * period)));
}

TEST_CASE("planar beam: the spin-up arm ends stretched by its own inertia", "[planar_beam]") {
  const Catalogue catalogue = full_catalogue();
  const Scene scene = load_scene(catalogue, "spin-up");
  const auto& model = typed<PlanarBeam<2>>(scene);
  CHECK(scene.model->invariant_info().empty());
  CHECK(model.prescribed(2)->kind == planar_beam::MotionKind::spin_up);
  const RunResult result = run_beam("beam-energy-momentum", model, 20.0, 0.005, 2000);
  INFO(result.message);
  REQUIRE(result.status == Status::ok);
  // The published figure is the closed form of a rod that turns steadily, EA u'' + rhoA w^2 (x + u) = 0: the
  // arm comes to it in the mean. It still vibrates in bending, which moves the tip's distance by 3e-7 either
  // way (order 4 at this step: between 5.1407e-4 and 5.1457e-4, mean 5.1427e-4, the same on a finer mesh),
  // and the error of the step, 0.03 rad of rotation, adds 0.8e-7 (twice the step: 3.1e-7). Three digits
  // stand.
  const double wave = 6.0 * std::sqrt(1.2 / 2.8e7), steady = std::tan(10.0 * wave) / wave - 10.0;
  CHECK(std::abs(steady - 5.14317e-4) <= 5e-10);
  // The mean of the tip's distance over the last four seconds.
  double sum = 0.0;
  int count = 0;
  for (std::size_t k = 0; k < result.samples.size(); ++k) {
    if (result.sample_times[k] < 16.0) continue;
    const auto state = model.restore(result.samples[k]);
    sum += std::hypot(10.0 + state.u[model.unknowns() - 3], state.u[model.unknowns() - 2]) - 10.0;
    ++count;
  }
  const double extension = sum / count;
  INFO(extension);
  CHECK(std::abs(extension - steady) <= 1e-7);
}
