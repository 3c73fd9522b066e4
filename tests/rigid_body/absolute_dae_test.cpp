// The heavy top in absolute coordinates: its derivatives, its start, and its motion, which is that of the top
// about its pivot.
#include "models/rigid_body/absolute_dae.hpp"

#include <cmath>
#include <vector>

#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/silence.hpp"

using namespace gnomon;
using namespace gnomon::test;
using rigid_body::AbsoluteDaeForm;

namespace {

const Gravity load{2.0, {0.3, -0.4, 0.5}};
const RigidBody<Gravity> tilted_top(
    {0.6, 1.7, 1.1},
    {Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, -2).normalized()).toRotationMatrix(), {0.5, -1.2, 0.9}},
    load, 3.0);

template <class Form>
Eigen::VectorXd residual(const Form& form, const Eigen::VectorXd& y, const Eigen::VectorXd& rate) {
  Eigen::VectorXd value(form.size());
  form.residual(0.0, y.data(), rate.data(), value.data());
  return value;
}

template <class Form>
void check_derivatives(const Form& form) {
  const int n = form.size();
  Eigen::VectorXd y(n), rate(n);
  for (int k = 0; k < n; ++k) y[k] = std::sin(1.0 + 3.7 * k), rate[k] = std::cos(2.0 + 2.3 * k);
  for (double cj : {0.0, 3.0}) {
    Eigen::MatrixXd analytic(n, n), numeric(n, n);
    form.jacobian(0.0, cj, y.data(), rate.data(), analytic.data());
    for (int k = 0; k < n; ++k) {
      const Eigen::VectorXd e = 1e-5 * Eigen::VectorXd::Unit(n, k);
      numeric.col(k) = (residual(form, y + e, rate + cj * e) - residual(form, y - e, rate - cj * e)) / 2e-5;
    }
    CHECK((numeric - analytic).cwiseAbs().maxCoeff() <= 1e-9);
    CHECK(analytic.cwiseAbs().minCoeff() == 0.0);
  }
}

template <class Form>
void check_start(const Form& form) {
  const int n = form.size();
  Eigen::VectorXd y(n), rate(n);
  form.pack(0.0, tilted_top.initial(), y.data());
  form.resume(0.0, y.data(), rate.data());
  CHECK(residual(form, y, rate).cwiseAbs().maxCoeff() <= 1e-14);
  // Not by chance: every equation notices another rate or value.
  for (int k = 0; k < n; ++k) {
    Eigen::VectorXd other = rate, changed = y;
    other[k] += 1e-3, changed[k] += 1e-3;
    CHECK(residual(form, changed, other).cwiseAbs().maxCoeff() >= 1e-6);
  }
  const BodyState back = form.unpack(0.0, y.data());
  CHECK((back.attitude - tilted_top.initial().attitude).cwiseAbs().maxCoeff() <= 1e-15);
  CHECK((back.angular_momentum - tilted_top.initial().angular_momentum).norm() <= 1e-15);
  // The rates of the quaternion are those of the top about its pivot, and so is that of the whole momentum.
  double pivot[7], expected[7];
  rigid_body::pack_state(tilted_top.initial(), pivot);
  rigid_body::rates(tilted_top.inertia(), load, pivot, expected);
  for (int k = 0; k < 4; ++k) CHECK(std::abs(rate[3 + k] - expected[k]) <= 1e-15);
  const Eigen::VectorXd later = y + 1e-6 * rate, sooner = y - 1e-6 * rate;
  const Eigen::Vector3d slope =
      (form.unpack(0.0, later.data()).angular_momentum - form.unpack(0.0, sooner.data()).angular_momentum) /
      2e-6;
  for (int k = 0; k < 3; ++k) CHECK(std::abs(slope[k] - expected[4 + k]) <= 1e-8);
}

}  // namespace

TEST_CASE("rigid body: the forms in absolute coordinates and their derivatives", "[rigid_body]") {
  REQUIRE(tilted_top.is_constrained());
  check_derivatives(tilted_top.dae_constraints());
  check_derivatives(tilted_top.dae_index3());
  check_start(tilted_top.dae_constraints());
  check_start(tilted_top.dae_index3());
  // No body has its centre of mass so far out.
  CHECK(!RigidBody<Gravity>(tilted_top.inertia(), tilted_top.initial(), {20.0, load.centre}, 3.0)
             .is_constrained());
}

TEST_CASE("rigid body: heavy tops in absolute coordinates move as about their pivot", "[rigid_body]") {
  const Catalogue catalogue = full_catalogue();
  const StderrCapture capture;
  int tops = 0;
  for (const char* name : {"fast-heavy-top", "asymmetric-heavy-top", "kovalevskaya"}) {
    const Scene scene = load_scene(catalogue, name);
    REQUIRE(catalogue.refusal("ida-bdf-constraints", *scene.model) == "");
    RunSpec spec;
    spec.t_end = 0.5;
    spec.record = false;
    const auto reference = scene.model->reference({spec.t_end}).states.front();
    double coarse = 0.0;
    for (double tol : {1e-5, 1e-8}) {
      spec.tol = tol;
      const RunResult result = run_scheme(catalogue, "ida-bdf-constraints", *scene.model, spec);
      INFO(name << ", tolerance " << tol << ": " << result.message);
      REQUIRE(result.status == Status::ok);
      const double error = scene.model->distance(result.state, reference)[0];
      CHECK(error <= 3e3 * tol);
      if (tol == 1e-5)
        coarse = error;
      else
        CHECK(error <= 0.02 * coarse);
    }
    // Index 3 has no regular Newton matrix at small steps.
    for (double tol : {1e-3, 1e-6, 1e-9}) {
      spec.tol = tol;
      const RunResult result = run_scheme(catalogue, "ida-bdf-index3", *scene.model, spec);
      CHECK(result.status == Status::solver_failed);
      CHECK(result.message.find("index") != std::string::npos);
      CHECK(result.t == 0.0);
    }
    ++tops;
  }
  CHECK(tops == 3);
  CHECK(capture.text() == "");
}
