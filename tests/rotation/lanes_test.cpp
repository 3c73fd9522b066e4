// One body in the lanes of one core: eight step counts extrapolated.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "integrators/rotation/lanes/lanes.hpp"
#include "integrators/rotation/lanes/sequence.hpp"
#include "src/study/study.hpp"
#include "tests/catch.hpp"
#include "tests/support/allocations.hpp"
#include "tests/support/scenes.hpp"

namespace lanes = gnomon::rotation::lanes;

namespace {
namespace lanes_test {

using namespace gnomon;
using namespace gnomon::test;

constexpr double eps = std::numeric_limits<double>::epsilon();
using Numbers = std::array<double, 7>;

constexpr std::array<int, 8> even_counts{2, 4, 6, 8, 10, 12, 14, 16};
constexpr std::array<int, 8> all_counts{1, 2, 3, 4, 5, 6, 7, 8};

enum class Rule { free, gravity, space_moment, body_moment, strang };
constexpr std::array<Rule, 5> rules{Rule::free, Rule::gravity, Rule::space_moment, Rule::body_moment,
                                    Rule::strang};

struct Case {
  lanes::Body body{{1.0 / 0.6, 1.0 / 0.8, 1.0}, {0.2, 0.1, -0.3}};
  lanes::Top top{1.0 / (2.0 * 0.6), 0.7};
  Numbers y{0.8, 0.4, -0.4, 0.2, 1.8, 0.4, -0.9};
};

lanes::Sequence sequence_for(Rule rule) {
  return lanes::sequence_of(rule == Rule::strang ? all_counts : even_counts);
}

lanes::Rows rows_of(const lanes::Kernels& kernels, Rule rule, const Case& c, const lanes::Sequence& sequence,
                    double H) {
  lanes::Rows rows;
  switch (rule) {
    case Rule::free:
      kernels.free(c.body, sequence, c.y.data(), H, rows);
      break;
    case Rule::gravity:
      kernels.gravity(c.body, sequence, c.y.data(), H, rows);
      break;
    case Rule::space_moment:
      kernels.space_moment(c.body, sequence, c.y.data(), H, rows);
      break;
    case Rule::body_moment:
      kernels.body_moment(c.body, sequence, c.y.data(), H, rows);
      break;
    case Rule::strang:
      kernels.strang(c.top, sequence, c.y.data(), H, rows);
      break;
  }
  return rows;
}

lanes::Extrapolated step_of(const lanes::Kernels& kernels, Rule rule, const Case& c, double H) {
  const lanes::Sequence sequence = sequence_for(rule);
  const lanes::Rows rows = rows_of(kernels, rule, c, sequence, H);
  lanes::Extrapolated result;
  kernels.extrapolate(sequence, c.y.data(), rows, result);
  return result;
}

// The same by six short steps, which leaves rounding alone.
Numbers fine(Rule rule, const Case& start, double H) {
  Case c = start;
  for (int k = 0; k < 6; ++k) {
    const lanes::Extrapolated result = step_of(lanes::widest_kernels(), rule, c, H / 6.0);
    std::copy(result.value, result.value + 7, c.y.begin());
  }
  return c.y;
}

double apart(const double* a, const double* b) {
  double worst = 0.0;
  for (int k = 0; k < 7; ++k) worst = std::max(worst, std::abs(a[k] - b[k]));
  return worst;
}

// The value extrapolated from the first `columns` rows, by Aitken and Neville.
Numbers column(const lanes::Rows& rows, const lanes::Sequence& sequence, int columns) {
  Numbers result{};
  for (std::size_t c = 0; c < 7; ++c) {
    std::array<double, 8> t{};
    for (int j = 0; j < columns; ++j) t[static_cast<std::size_t>(j)] = rows.value[c][j];
    for (int k = 1; k < columns; ++k)
      for (int j = columns - 1; j >= k; --j) {
        const double ratio = sequence.steps[j] / sequence.steps[j - k];
        const std::size_t i = static_cast<std::size_t>(j);
        t[i] += (t[i] - t[i - 1]) / (ratio * ratio - 1.0);
      }
    result[c] = t[static_cast<std::size_t>(columns - 1)];
  }
  return result;
}

RunResult run_with(const Catalogue& catalogue, const Scene& scene, double tol) {
  RunSpec spec;
  spec.t_end = scene.t_end;
  spec.tol = tol;
  return run_scheme(catalogue, "lanes-extrapolated-strang", *scene.model, spec);
}

// A fast top whose axis is the k-th of the body.
RigidBody<Gravity> top_about(int axis, double side) {
  Eigen::Vector3d inertia = Eigen::Vector3d::Constant(0.1), centre = Eigen::Vector3d::Zero(), m = centre;
  inertia[axis] = 0.05;
  centre[axis] = side;
  m[axis] = 2.5;
  m[(axis + 1) % 3] = 0.3;
  const Eigen::Matrix3d A = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).matrix();
  return {inertia, {A, m}, {1.0, centre}, 2.0};
}

}  // namespace lanes_test
}  // namespace

TEST_CASE("lanes: the columns of the extrapolation have orders 2, 4, 6, ..", "[rotation][lanes]") {
  using namespace lanes_test;
  for (Rule rule : rules) {
    const Case c;
    const lanes::Sequence sequence = sequence_for(rule);
    for (int columns = 1; columns <= 4; ++columns) {
      const double H = rule == Rule::strang ? 0.25 : 0.2;
      const auto error = [&](double step) {
        const Numbers exact = fine(rule, c, step);
        const Numbers found =
            column(rows_of(lanes::widest_kernels(), rule, c, sequence, step), sequence, columns);
        return apart(found.data(), exact.data());
      };
      const double coarse = error(H), halved = error(0.5 * H);
      INFO("rule " << static_cast<int>(rule) << ", column " << columns << ": " << coarse << ", " << halved);
      REQUIRE(halved > 1e-13);
      CHECK(std::abs(std::log2(coarse / halved) - (2.0 * columns + 1.0)) <= 0.5);
    }
    // The weights are the last column's, and the defect its difference from the one without the last row.
    const lanes::Rows rows = rows_of(lanes::widest_kernels(), rule, c, sequence, 1.5);
    const lanes::Extrapolated result = step_of(lanes::widest_kernels(), rule, c, 1.5);
    CHECK(apart(result.value, column(rows, sequence, 8).data()) <= 1e3 * eps);
    const Numbers before = column(rows, sequence, 7);
    double defect[7];
    for (std::size_t k = 0; k < 7; ++k) defect[k] = result.value[k] - before[k];
    CHECK(apart(result.defect, defect) <= 1e3 * eps);
  }
}

TEST_CASE("lanes: the defect covers the error", "[rotation][lanes]") {
  using namespace lanes_test;
  std::mt19937_64 generator(3);
  const auto uniform = [&] { return 2.0 * static_cast<double>(generator() >> 11) * 0x1p-53 - 1.0; };
  int seen = 0;
  double loosest = 0.0;
  for (Rule rule : rules)
    for (int k = 0; k < 40; ++k) {
      Case c;
      for (double& value : c.y) value = uniform();
      double norm = 0.0;
      for (std::size_t i = 0; i < 4; ++i) norm += c.y[i] * c.y[i];
      for (std::size_t i = 0; i < 4; ++i) c.y[i] /= std::sqrt(norm);
      const double H = 2.0 + 1.5 * uniform();
      const lanes::Extrapolated result = step_of(lanes::widest_kernels(), rule, c, H);
      const Numbers zero{}, exact = fine(rule, c, H);
      const double error = apart(result.value, exact.data()), defect = apart(result.defect, zero.data());
      if (!(defect < 1e-2)) continue;
      INFO("rule " << static_cast<int>(rule) << ", H " << H << ", error " << error << ", defect " << defect);
      CHECK(error <= defect + 1e-12);
      if (defect > 1e-10) {
        ++seen;
        loosest = std::max(loosest, error / defect);
      }
    }
  CHECK(seen >= 40);
  CHECK(loosest >= 1e-3);  // it does not cover everything by far
}

TEST_CASE("lanes: every instruction set gives the same bits", "[rotation][lanes]") {
  using namespace lanes_test;
  REQUIRE(lanes::kernels(InstructionSet::baseline));
  for (InstructionSet set : instruction_sets()) {
    const lanes::Kernels* kernels = lanes::kernels(set);
    if (!kernels) continue;
    for (Rule rule : rules) {
      Case a, b;
      for (int n = 0; n < 20; ++n) {
        const lanes::Extrapolated one = step_of(*lanes::kernels(InstructionSet::baseline), rule, a, 0.9);
        const lanes::Extrapolated other = step_of(*kernels, rule, b, 0.9);
        CHECK(std::memcmp(&one, &other, sizeof one) == 0);
        std::copy(one.value, one.value + 7, a.y.begin());
        std::copy(other.value, other.value + 7, b.y.begin());
      }
      CHECK(apart(a.y.data(), Case{}.y.data()) > 1e-3);
    }
  }
}

TEST_CASE("lanes: the error follows the tolerance", "[rotation][lanes]") {
  using namespace lanes_test;
  const Catalogue catalogue = full_catalogue();
  for (const char* name : {"asymmetric-free-top", "symmetric-free-top", "space-moment", "body-moment",
                           "rest-then-pushed", "asymmetric-heavy-top", "heavy-axis-fast", "fast-heavy-top"}) {
    const Scene scene = load_scene(catalogue, name);
    const ReferenceStates reference = scene.model->reference({scene.t_end});
    REQUIRE(!reference.states.empty());
    double before = 0.0, first = 0.0, last = 0.0;
    for (double tol : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
      const RunResult result = run_with(catalogue, scene, tol);
      REQUIRE(result.status == Status::ok);
      const double error = scene.model->distance(result.state, reference.states.back())[0];
      INFO(name << ", tol " << tol << ": error " << error << ", steps " << result.cost.steps << " + "
                << result.cost.rejected);
      CHECK(error <= 100.0 * tol + 1e-10);
      CHECK(result.cost.rejected <= result.cost.steps / 2 + 4);
      if (before > 0.0) CHECK(error <= std::max(before, 10.0 * tol + 1e-11));
      if (first == 0.0) first = error;
      before = last = error;
    }
    CHECK((last <= 1e-3 * first || last <= 1e-11));
  }
}

TEST_CASE("lanes: a tolerance below rounding is met as well as it can be", "[rotation][lanes]") {
  using namespace lanes_test;
  const Catalogue catalogue = full_catalogue();
  for (const char* name : {"slow-heavy-top", "steady-precession", "heavy-symmetric-top", "fast-heavy-top",
                           "asymmetric-heavy-top", "asymmetric-free-top"}) {
    const Scene scene = load_scene(catalogue, name);
    const ReferenceStates reference = scene.model->reference({scene.t_end});
    REQUIRE(!reference.states.empty());
    const long enough = run_with(catalogue, scene, 1e-12).cost.steps;
    for (double tol : {1e-13, 1e-14}) {
      const RunResult result = run_with(catalogue, scene, tol);
      INFO(name << ", tol " << tol << ": " << result.message << ", steps " << result.cost.steps << " + "
                << result.cost.rejected);
      REQUIRE(result.status == Status::ok);
      const double error = scene.model->distance(result.state, reference.states.back())[0];
      CHECK(error <= 1e-10);
      CHECK(error >= 1e-15);
      CHECK(result.cost.steps + result.cost.rejected <= 2 * enough + 8);
    }
  }
}

TEST_CASE("lanes: what the motion keeps is kept to the tolerance", "[rotation][lanes]") {
  using namespace lanes_test;
  const Catalogue catalogue = full_catalogue();
  for (const char* name : {"asymmetric-free-top", "heavy-axis-fast", "heavy-symmetric-top", "kovalevskaya"}) {
    const Scene scene = load_scene(catalogue, name);
    const RunResult result = run_with(catalogue, scene, 1e-10);
    REQUIRE(result.status == Status::ok);
    for (const InvariantSummary& summary : summarise_invariants(*scene.model, result.invariants)) {
      INFO(name << ", " << summary.info.name);
      CHECK(summary.max_drift <= (summary.info.name == "orthonormality" ? 4e-15 : 1e-9));
    }
    // Steps chosen by a loose tolerance show in what is kept, but not in the norm of the orientation.
    const RunResult loose = run_with(catalogue, scene, 1e-3);
    const auto kept = summarise_invariants(*scene.model, loose.invariants);
    CHECK(kept[0].max_drift <= 4e-15);
    CHECK(kept[1].max_drift >= 1e-12);
  }
}

TEST_CASE("lanes: tops about any axis of the body", "[rotation][lanes]") {
  using namespace lanes_test;
  const Catalogue catalogue = full_catalogue();
  for (int axis = 0; axis < 3; ++axis)
    for (double side : {1.0, -1.0}) {
      const auto model = box(top_about(axis, side));
      const ReferenceStates reference = model->reference({2.0});
      REQUIRE(!reference.states.empty());
      RunSpec spec;
      spec.t_end = 2.0;
      spec.tol = 1e-11;
      const RunResult top = run_scheme(catalogue, "lanes-extrapolated-strang", *model, spec);
      const auto error = model->distance(top.state, reference.states.back());
      INFO("axis " << axis << ", side " << side);
      CHECK(error[0] <= 1e-10);
      CHECK(error[1] <= 1e-10);
      CHECK(top.cost.steps <= 16);  // by kicks and drifts, which do not resolve the spin
    }
}

TEST_CASE("lanes: steps allocate nothing", "[rotation][lanes][allocation]") {
  using namespace lanes_test;
  const Catalogue catalogue = full_catalogue();
  for (const char* name :
       {"asymmetric-free-top", "asymmetric-heavy-top", "heavy-axis-fast", "space-moment"}) {
    const Scene scene = load_scene(catalogue, name);
    with_rigid_body(scene, [&]<class M>(const M& model) {
      RunSpec spec;
      spec.t_end = scene.t_end;
      spec.tol = 1e-9;
      if constexpr (!rotation::lanes::LaneBody<M>) {
        FAIL("the lanes do not know this load");
      } else {
        const auto system = rotation::LanesExtrapolated::system(model);
        const auto solver = rotation::LanesExtrapolated::make(*system, spec);
        Status status = Status::unsupported;
        CHECK(allocations_of([&] { status = solver->advance(spec.t_end, false); }) == 0);
        CHECK(status == Status::ok);
        CHECK(solver->t() == spec.t_end);
        CHECK(solver->cost().steps >= 2);
      }
    });
  }
}
