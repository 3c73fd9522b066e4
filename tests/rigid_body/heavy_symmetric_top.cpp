// The closed form of the heavy symmetric top against certified solutions and steady precession.

#include "models/rigid_body/heavy_symmetric_top.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "src/study/study.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

using namespace gnomon;
using namespace gnomon::test;
using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

using Top = RigidBody<Gravity>;

double apart(const Top& body, const BodyState& a, const BodyState& b) {
  const auto d = body.distance(a, b);
  return std::max(d[0], d[1]);
}

}  // namespace

TEST_CASE("rigid body: the closed form of the heavy symmetric top", "[rigid_body][closed_form]") {
  const Catalogue catalogue = full_catalogue();
  for (const char* name : {"heavy-symmetric-top", "fast-heavy-top"}) {
    const Scene scene = load_scene(catalogue, name);
    const auto& shipped = typed<Top>(scene);
    BodyState tilted = shipped.initial();
    tilted.attitude = AngleAxisd(2.0, Vector3d(1, 2, 2) / 3.0).toRotationMatrix() * tilted.attitude;
    tilted.angular_momentum += 0.3 * tilted.angular_momentum.norm() * Vector3d(0.5, -0.2, 0.7);
    Gravity hanging = shipped.load();
    hanging.centre = -hanging.centre;
    const Top tops[] = {shipped, Top(shipped.inertia(), tilted, shipped.load(), 1.0),
                        Top(shipped.inertia(), tilted, hanging, 1.0)};
    for (const Top& top : tops) {
      REQUIRE(top.symmetric_top_refusal().empty());
      CHECK(apart(top, top.symmetric_top(0.0), top.initial()) <= 2e-15);
      const std::vector<double> times{0.05, 0.4, 1.5};
      const ReferenceStates reference = detail::certified_states<Top, long double>(top, times, 50'000'000);
      REQUIRE(reference.kind == "certified");
      for (std::size_t k = 0; k < times.size(); ++k) {
        const BodyState expected = top.restore(reference.states[k]);
        INFO(name << ", t = " << times[k]);
        CHECK(apart(top, top.symmetric_top(times[k]), expected) <= 5e-14);
        CHECK(apart(top, top.symmetric_top(times[k] * (1.0 + 1e-9)), expected) >= 1e-11);
      }
    }
  }
}

TEST_CASE("rigid body: the closed form in steady precession", "[rigid_body][closed_form]") {
  const double i1 = 5.0, i3 = 1.0, torque = 20.0, tilt = 1.1, precession = 0.7;
  const double w3 = (torque / precession + i1 * precession * std::cos(tilt)) / i3;
  const double spin = w3 - precession * std::cos(tilt);
  const auto exact = [&](double t) {
    const Matrix3d A = AngleAxisd(precession * t, Vector3d::UnitZ()).toRotationMatrix() *
                       AngleAxisd(tilt, Vector3d::UnitX()).toRotationMatrix() *
                       AngleAxisd(spin * t, Vector3d::UnitZ()).toRotationMatrix();
    const Vector3d w = precession * A.transpose() * Vector3d::UnitZ() + spin * Vector3d::UnitZ();
    return BodyState{A, w.cwiseProduct(Vector3d(i1, i1, i3))};
  };
  const Top top(Vector3d(i1, i1, i3), exact(0.0), {torque, {0, 0, 1}}, 1.0);
  for (double t : {0.1, 1.0, 5.0}) CHECK(apart(top, top.symmetric_top(t), exact(t)) <= 1e-13);
}

TEST_CASE("rigid body: bodies that the closed form of the top refuses", "[rigid_body][closed_form]") {
  const Catalogue catalogue = full_catalogue();
  for (const char* name : {"asymmetric-heavy-top", "kovalevskaya"}) {
    const Scene scene = load_scene(catalogue, name);
    CHECK(!typed<Top>(scene).symmetric_top_refusal().empty());
    CHECK(catalogue.pair("exact-heavy-symmetric-top", *scene.model) == nullptr);
  }
  const Vector3d inertia(5, 5, 1), m(0, 0, 3);
  const Top upright(inertia, {Matrix3d::Identity(), m}, {1.0, {0, 0, 1}}, 1.0);
  CHECK(!upright.symmetric_top_refusal().empty());
  const Top weightless(inertia, {Matrix3d::Identity(), m}, {0.0, {0, 0, 1}}, 1.0);
  CHECK(!weightless.symmetric_top_refusal().empty());
}
