// The error bound that `exact-free-top` gives of itself, against a solution that knows no closed form.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>

#include "tests/catch.hpp"
#include "tests/rigid_body/free_body_taylor.hpp"
#include "tests/support/scenes.hpp"

using namespace gnomon;
using namespace gnomon::test;
using gnomon::tests::FreeBodyL;
using gnomon::tests::QuaternionL;
using gnomon::tests::Vector3L;

namespace {

struct BoundSeen {
  double error, bound;  ///< the largest over the times
};

/// Checks that no error is above its bound, of the orientation [rad] and of the momentum over its magnitude.
std::array<BoundSeen, 2> check_own_bounds(const Catalogue& catalogue, const Eigen::Vector3d& principal,
                                          const BodyState& start, const std::vector<double>& times) {
  using Matrix3L = Eigen::Matrix<long double, 3, 3>;
  std::array<BoundSeen, 2> seen{};
  for (const double t : times) {
    const RigidBody<Free> body(principal, start, {}, t);
    RunSpec spec;
    spec.t_end = t;
    spec.record = false;
    const RunResult result = run_scheme(catalogue, "exact-free-top", *box(body), spec);
    REQUIRE(result.own_bound.size() == 2);
    const BodyState state = body.restore(result.state);
    const FreeBodyL truth = gnomon::tests::integrate_free_body(
        principal.cast<long double>(), {QuaternionL::Identity(), start.angular_momentum.cast<long double>()},
        t);
    const Matrix3L turned =
        start.attitude.cast<long double>() * truth.orientation.normalized().toRotationMatrix();
    const Matrix3L apart = turned.transpose() * state.attitude.cast<long double>();
    const long double sine =
        0.5L *
        Vector3L(apart(2, 1) - apart(1, 2), apart(0, 2) - apart(2, 0), apart(1, 0) - apart(0, 1)).norm();
    const double angle = static_cast<double>(std::atan2(sine, 0.5L * (apart.trace() - 1.0L)));
    const double momentum =
        static_cast<double>((state.angular_momentum.cast<long double>() - truth.angular_momentum).norm() /
                            truth.angular_momentum.norm());
    INFO("inertia " << principal.transpose() << ", m " << start.angular_momentum.transpose() << ", t " << t);
    CHECK(angle <= result.own_bound[0]);
    CHECK(momentum <= result.own_bound[1]);
    seen[0] = {std::max(seen[0].error, angle), std::max(seen[0].bound, result.own_bound[0])};
    seen[1] = {std::max(seen[1].error, momentum), std::max(seen[1].bound, result.own_bound[1])};
  }
  return seen;
}

}  // namespace

TEST_CASE("exact free top: the error bound of a run is one, and not an empty one", "[rigid_body]") {
  const Catalogue catalogue = full_catalogue();
  std::mt19937_64 random(11);
  const auto uniform = [&] { return 2.0 * (static_cast<double>(random() >> 11) * 0x1p-53) - 1.0; };
  double widest = 0.0, most = 0.0;
  const auto look = [&](const Eigen::Vector3d& principal, const BodyState& start,
                        const std::vector<double>& times) {
    for (const BoundSeen& each : check_own_bounds(catalogue, principal, start, times)) {
      INFO("inertia " << principal.transpose() << ", m " << start.angular_momentum.transpose() << ": error "
                      << each.error << ", bound " << each.bound);
      CHECK(each.bound <= 1e4 * std::max(each.error, 1e-17));
      widest = std::max(widest, each.bound / std::max(each.error, 1e-17));
      most = std::max(most, each.error);
    }
  };
  for (int k = 0; k < 20; ++k) {
    // Moments of a real body: those of three masses on its axes.
    const Eigen::Vector3d masses(0.1 + std::abs(uniform()), 0.1 + std::abs(uniform()),
                                 0.1 + std::abs(uniform()));
    const Eigen::Vector3d principal(masses[1] + masses[2], masses[2] + masses[0], masses[0] + masses[1]);
    const Eigen::Quaterniond attitude =
        Eigen::Quaterniond(uniform(), uniform(), uniform(), uniform()).normalized();
    look(principal, {attitude.toRotationMatrix(), Eigen::Vector3d(uniform(), uniform(), uniform())},
         {0.1, 1.0, 10.0, 60.0});
  }
  // Beside the separatrix, up to the first flip and in it.
  for (const double m3 : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10})
    look({3.0, 5.0, 9.0}, {Eigen::Matrix3d::Identity(), {0.0, 2.0, m3}}, {1.0, 20.0, 40.0, 60.0});
  INFO("widest " << widest << ", largest error " << most);
  CHECK(most >= 1e-15);
}
