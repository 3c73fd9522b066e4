// Newton's method of the implicit rotation schemes: exact tangents, and what they are needed for.
#include <cmath>
#include <vector>

#include "integrators/rotation/liemid_ea.hpp"
#include "integrators/rotation/simo_wong.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

using namespace gnomon;
using namespace gnomon::rotation;
using namespace gnomon::test;

namespace {

struct SimoWongResidual {
  Vector3 inertia, momentum;
  double h;
  Vector3 turned(const Vector3& angle) const { return Rotation(angle).inverse(momentum); }
  Vector3 operator()(const Vector3& angle) const {
    return inertia.cwiseProduct(angle) - 0.5 * h * (momentum + turned(angle));
  }
  Matrix3 tangent(const Vector3& angle) const {
    return SimoWongC1::tangent(inertia, angle, turned(angle), h);
  }
};

/// Central differences of order 6.
template <class F>
Matrix3 differences(const F& f, const Vector3& x, double d) {
  Matrix3 derivative;
  for (int k = 0; k < 3; ++k) {
    const auto odd = [&](int n) {
      const Vector3 shift = n * d * Vector3::Unit(k);
      return Vector3(f(x + shift) - f(x - shift));
    };
    derivative.col(k) = (45.0 * odd(1) - 9.0 * odd(2) + odd(3)) / (60.0 * d);
  }
  return derivative;
}

/// The corrections of Newton's method, D of its tangent to the second order in the angle if `approximate`.
std::vector<double> newton_corrections(const SimoWongResidual& residual, bool approximate) {
  Vector3 angle = residual.h * residual.momentum.cwiseQuotient(residual.inertia);
  std::vector<double> corrections;
  for (int k = 0; k < 8; ++k) {
    Matrix3 matrix = residual.tangent(angle);
    if (approximate) {
      const Matrix3 X = cross_matrix(-angle);
      matrix = -0.5 * residual.h *
               (cross_matrix(residual.turned(angle)) * (Matrix3::Identity() + 0.5 * X + X * X / 6.0));
      matrix.diagonal() += residual.inertia;
    }
    const Vector3 change = solve(matrix, residual(angle));
    angle -= change;
    corrections.push_back(change.cwiseAbs().maxCoeff());
  }
  return corrections;
}

const Vector3 needle_inertia(1.0, 1.0, 1e-6), needle_momentum(1.0, 0.5, 1e-4);

}  // namespace

TEST_CASE("newton: the tangent of a turn and of ALGO-C1 are those of finite differences", "[rotation]") {
  const Vector3 axis = Vector3(0.3, -0.5, 0.8).normalized(), p(0.4, 1.1, -0.7);
  for (const double turn : {0.0, 1e-9, 1e-4, 0.19, 0.21, 1.0, 3.0, 6.0}) {
    const Vector3 angle = turn * axis;
    INFO("turn " << turn);
    // d(exp(x) p) = (D dx) x exp(x) p
    const auto turned = [&](const Vector3& x) { return Rotation(x)(p); };
    const Matrix3 exact = -cross_matrix(turned(angle)) * left_derivative(angle);
    CHECK((differences(turned, angle, 0.01) - exact).cwiseAbs().maxCoeff() <= 1e-11);
    const SimoWongResidual residual{Vector3(0.6, 0.8, 1.0), p, 0.7};
    CHECK((differences(residual, angle, 0.01) - residual.tangent(angle)).cwiseAbs().maxCoeff() <= 1e-11);
  }
}

TEST_CASE("newton: ALGO-C1 converges quadratically on needles", "[rotation]") {
  for (const double h : {1e-3, 5e-3, 1e-2, 2e-2}) {  // 0.1 to 2 rad
    const SimoWongResidual residual{needle_inertia, needle_momentum, h};
    const std::vector<double> exact = newton_corrections(residual, false);
    INFO("h = " << h << ": " << exact[0] << ", " << exact[1] << ", " << exact[2] << ", " << exact[3]);
    // Far from the motion's end the axial part of the correction still follows the others'.
    CHECK(exact[1] <= 0.05 * exact[0]);
    CHECK(exact[2] <= 0.01 * exact[1]);
    CHECK(exact[3] <= std::max(1e-5 * exact[2], 1e-13));
    CHECK(*std::max_element(exact.begin() + 4, exact.end()) <= 1e-13);
  }
  // Of a body of moderate moments each correction is a constant times the square of the one before.
  int seen = 0;
  for (const double h : {0.3, 0.4, 0.5, 0.6}) {
    const auto e = newton_corrections({Vector3(0.6, 0.8, 1.0), Vector3(1.8, 0.4, -0.9), h}, false);
    for (std::size_t k = 2; k < e.size() && e[k] > 1e-13; ++k) {
      if (e[k - 1] > 0.02) continue;
      const double order = std::log(e[k] / e[k - 1]) / std::log(e[k - 1] / e[k - 2]);
      INFO("h = " << h << ": " << e[k - 2] << ", " << e[k - 1] << ", " << e[k]);
      CHECK(order >= 1.7);
      CHECK(order <= 2.6);
      ++seen;
    }
  }
  CHECK(seen >= 4);
  // The control: a tangent to the second order is no more than linear, and fails where the step is large.
  const auto slow = newton_corrections({needle_inertia, needle_momentum, 5e-3}, true);
  CHECK(slow[4] >= 1e-6);
  const auto failing = newton_corrections({needle_inertia, needle_momentum, 1e-2}, true);
  CHECK_FALSE(failing[7] <= 1e-3);
}

TEST_CASE("newton: implicit schemes step over a radian of a needle's spin", "[rotation]") {
  const Catalogue catalogue = full_catalogue();
  const Scene scene = load_scene(catalogue, "needle");
  for (const char* scheme : {"simo-wong-c1", "liemid-ea"})
    for (const double step : {1e-3, 1e-2, 2e-2}) {
      RunSpec spec;
      spec.t_end = scene.t_end;
      spec.step = step;
      const RunResult result = run_scheme(catalogue, scheme, *scene.model, spec);
      const double iterations =
          static_cast<double>(result.cost.newton_iterations) / static_cast<double>(result.cost.steps);
      INFO(scheme << ", step " << step << ": " << to_string(result.status) << ", " << iterations);
      CHECK(result.status == Status::ok);
      const double solves = scheme == std::string_view("liemid-ea") ? 2.0 : 1.0;
      CHECK(iterations >= 2.0 * solves);
      CHECK(iterations <= 6.0 * solves);
    }
}
