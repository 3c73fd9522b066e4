// Steps of many bodies at once against the schemes for one body, and against themselves.

#include <algorithm>
#include <cstring>

#include "src/run.hpp"
#include "tests/catch.hpp"
#include "tests/ensemble/bodies.hpp"
#include "tests/support/allocations.hpp"

using namespace gnomon;
using namespace gnomon::test;

namespace {

constexpr double ulp_of_one = 0x1p-52;  // one ulp of 1

// Largest differences over some bodies: of an entry of the attitude, and of a component of the momentum
// relative to its size, in ulp of 1. Not a number counts as infinite.
struct StepError {
  double attitude = 0.0, momentum = 0.0;
  void add(const Eigen::Matrix3d& difference, const Eigen::Vector3d& change, double size) {
    const auto larger = [](double a, double b) { return b <= a ? a : b >= a ? b : HUGE_VAL; };
    attitude = larger(attitude, difference.cwiseAbs().maxCoeff() / ulp_of_one);
    momentum = larger(momentum, change.cwiseAbs().maxCoeff() / (size * ulp_of_one));
  }
};

// |m| and the impulse of the load that is added to it.
double momentum_size(const Body& body, double h) {
  return std::max({body.angular_momentum.stableNorm(), h * body.load.stableNorm(), 1e-290});
}

// Under a load the schemes for one body keep A m and go back to m through A, which is not quite orthonormal:
// bodies that start from what they get. Free bodies keep m itself.
template <class Single, class Load>
std::vector<Body> as_seen(std::vector<Body> bodies) {
  if constexpr (std::is_same_v<Load, rigid_body::Free>) return bodies;
  for (Body& body : bodies) {
    const auto one = single<Load>(body);
    body.angular_momentum = Single::view(one, Single::start(one, one.initial())).angular_momentum;
  }
  return bodies;
}

template <class Single, class Load>
std::vector<rigid_body::State> single_steps(const std::vector<Body>& bodies, double h) {
  std::vector<rigid_body::State> states;
  for (const Body& body : bodies) {
    const auto one = single<Load>(body);
    auto state = Single::start(one, one.initial());
    Single::step(one, state, 0.0, h);
    states.push_back(Single::view(one, state));
    if constexpr (std::is_same_v<Load, rigid_body::Free>)  // what the next step goes on with
      states.back().angular_momentum = state.body_momentum;
  }
  return states;
}
template <class S, class Load>
std::vector<rigid_body::State> ensemble_steps(const std::vector<Body>& bodies, double h) {
  const Ensemble<Load> model(bodies, {1, instruction_sets().back()}, 1.0);
  return model.restore(after_steps<S>(model, h, 1)).bodies;
}

// The largest difference of the ensemble's step and that of the scheme for one body.
template <class S, class Single, class Load>
[[gnu::noinline]] StepError step_error(const std::vector<Body>& bodies, double h) {
  const auto one = single_steps<Single, Load>(bodies, h);
  const auto many = ensemble_steps<S, Load>(as_seen<Single, Load>(bodies), h);
  StepError error;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    Eigen::Vector3d change = many[i].angular_momentum - one[i].angular_momentum;
    // The schemes for one body take the moment into the triad, out of it and in again.
    const Eigen::Matrix3d& A = bodies[i].attitude;
    const double defect = (A.transpose() * A - Eigen::Matrix3d::Identity()).norm();
    const double slack = defect * h * bodies[i].load.norm();
    for (double& value : change) value = std::abs(value) < slack ? 0.0 : std::abs(value) - slack;
    error.add(many[i].attitude - one[i].attitude, change, momentum_size(bodies[i], h));
  }
  return error;
}

using Vector3L = Eigen::Matrix<long double, 3, 1>;
using Matrix3L = Eigen::Matrix<long double, 3, 3>;

// The step of a free body in extended precision, from the same data.
rigid_body::State extended_step(const Body& body, bool commutators, long double h) {
  const auto turn = [](const Vector3L& p) -> Matrix3L {
    const long double angle = p.norm();
    return angle > 0 ? Eigen::AngleAxis<long double>(angle, p / angle).toRotationMatrix()
                     : Matrix3L::Identity();
  };
  const Matrix3L A = body.attitude.cast<long double>();
  const Vector3L y = body.angular_momentum.cast<long double>(), I = body.inertia.cast<long double>();
  const auto velocity = [&](const Matrix3L& R) -> Vector3L {
    return R * (R.transpose() * y).cwiseQuotient(I);
  };
  const long double sign = commutators ? 1 : 0;
  const Vector3L w1 = y.cwiseQuotient(I), w2 = velocity(turn(h / 2 * w1));
  const Vector3L w3 = velocity(turn(h / 2 * w2 - sign * h * h / 8 * w1.cross(w2)));
  const Vector3L w4 = velocity(turn(h * w3));
  const Matrix3L R = turn(h / 6 * (w1 + 2 * (w2 + w3) + w4) - sign * h * h / 12 * w1.cross(w4));
  return {Matrix3L(A * R).cast<double>(), Vector3L(R.transpose() * y).cast<double>()};
}

// The errors of rounding of steps of free bodies.
StepError rounding_error(const std::vector<rigid_body::State>& states, const std::vector<Body>& bodies,
                         bool commutators, double h) {
  StepError error;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const rigid_body::State exact = extended_step(bodies[i], commutators, h);
    error.add(states[i].attitude - exact.attitude, states[i].angular_momentum - exact.angular_momentum,
              momentum_size(bodies[i], h));
  }
  return error;
}

bool bitwise_equal(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

// Still, slow, ordinary, beyond the polynomials, about half a turn and more than a turn: in every block.
const std::vector<double> mixed_angles{0.0,  1e-160, 1e-9, 1e-3, 0.1, 0.5, 1.0, 1.2,
                                       1.26, 2.0,    3.14, 3.15, 6.3, 20., 0.3};

}  // namespace

TEST_CASE("ensemble: a step is that of the scheme for one body to 4 ulp", "[ensemble]") {
  const double h = 0.01;
  for (const std::vector<double>& angles : std::vector<std::vector<double>>{{0.0},
                                                                            {1e-300, 1e-160, 1e-12, 1e-6},
                                                                            {0.001, 0.01, 0.1},
                                                                            {0.2, 0.3, 0.5},
                                                                            {0.8, 1.0, 1.2, 1.26},
                                                                            {1.3, 1.5, 2.0},
                                                                            {3.0, 3.13, 3.1415, 3.15}}) {
    const std::vector<Body> bodies = bodies_turning(2000, angles, h, 7);
    for_each_load([&]<class Load>(Load*) {
      const StepError a = step_error<ensemble::Munjiza, rotation::Munjiza, Load>(bodies, h);
      const StepError b = step_error<ensemble::Rkmk4, rotation::Rkmk4, Load>(bodies, h);
      INFO(Load::kind << ", angles from " << angles.front() << " rad: attitude " << a.attitude << " and "
                      << b.attitude << " ulp, momentum " << a.momentum << " and " << b.momentum);
      CHECK(a.attitude <= 4.0);
      CHECK(b.attitude <= 4.0);
      CHECK(a.momentum <= 4.0);
      CHECK(b.momentum <= 4.0);
      // The same operations in the same order: without a load the same bits, whatever the angle.
      if (std::is_same_v<Load, rigid_body::Free>)
        CHECK(std::max({a.attitude, b.attitude, a.momentum, b.momentum}) == 0.0);
    });
  }
  // The comparison tells the two schemes apart.
  const std::vector<Body> bodies = bodies_turning(50, {0.1}, h, 7);
  CHECK(step_error<ensemble::Munjiza, rotation::Rkmk4, rigid_body::Free>(bodies, h).attitude > 1e9);
  CHECK(step_error<ensemble::Rkmk4, rotation::MunjizaHalfImpulse, rigid_body::Gravity>(bodies, h).momentum >
        1e7);
}

// The more a step turns a body, the more it magnifies rounding, whoever does it.
TEST_CASE("ensemble: rounding errors of large turns are those of the scheme for one body", "[ensemble]") {
  const double h = 0.01;
  for (const std::vector<double>& angles :
       std::vector<std::vector<double>>{{0.8, 1.0, 1.2}, {1.3, 1.6, 2.0}, {3.0, 3.13, 3.1415, 3.15}}) {
    const std::vector<Body> bodies = bodies_turning(2000, angles, h, 7);
    const auto check = [&]<class S, class Single>(S*, Single*, bool commutators) {
      const std::vector<Body> seen = as_seen<Single, rigid_body::Free>(bodies);
      const StepError one =
          rounding_error(single_steps<Single, rigid_body::Free>(bodies, h), seen, commutators, h);
      const StepError many =
          rounding_error(ensemble_steps<S, rigid_body::Free>(seen, h), seen, commutators, h);
      INFO(S::info.name << ", angles from " << angles.front() << " rad: attitude " << many.attitude
                        << " ulp and " << one.attitude << " for one, momentum " << many.momentum << " and "
                        << one.momentum);
      CHECK(many.attitude <= 2.0 * one.attitude + 1.0);
      CHECK(many.momentum <= 1.5 * one.momentum + 1.0);
    };
    check(static_cast<ensemble::Munjiza*>(nullptr), static_cast<rotation::Munjiza*>(nullptr), false);
    check(static_cast<ensemble::Rkmk4*>(nullptr), static_cast<rotation::Rkmk4*>(nullptr), true);
  }
}

TEST_CASE("ensemble: every instruction set gives the same bits", "[ensemble]") {
  const double h = 0.01;
  const std::vector<Body> bodies = bodies_turning(101, mixed_angles, h, 3);
  for_each_load([&]<class Load>(Load*) {
    const auto results = [&](InstructionSet set) {
      const Ensemble<Load> model(bodies, {1, set}, 1.0);
      std::vector<double> both = after_steps<ensemble::Munjiza>(model, h, 20);
      const std::vector<double> rkmk4 = after_steps<ensemble::Rkmk4>(model, h, 20);
      both.insert(both.end(), rkmk4.begin(), rkmk4.end());
      return both;
    };
    const std::vector<double> first = results(InstructionSet::baseline);
    CHECK(all_finite(first));
    for (const InstructionSet set : instruction_sets()) {
      INFO(Load::kind << " with " << to_string(set));
      CHECK(bitwise_equal(results(set), first));
    }
  });
}

TEST_CASE("ensemble: neither neighbours nor threads change a body's result", "[ensemble]") {
  const double h = 0.01;
  const std::vector<Body> bodies = bodies_turning(101, mixed_angles, h, 5);
  const auto results = [&](const std::vector<Body>& some, int threads) {
    const Ensemble<rigid_body::Gravity> model(some, {threads, instruction_sets().back()}, 1.0);
    return after_steps<ensemble::Rkmk4>(model, h, 20);
  };
  const std::vector<double> all = results(bodies, 1);
  for (const int threads : {2, 3, 8, 20}) {
    INFO(threads << " threads");
    CHECK(bitwise_equal(results(bodies, threads), all));
  }
  for (const std::size_t i : {0U, 1U, 15U, 16U, 50U, 100U}) {
    INFO("body " << i);
    CHECK(bitwise_equal(results({bodies[i]}, 1),
                        std::vector<double>(all.begin() + 12 * static_cast<long>(i),
                                            all.begin() + 12 * static_cast<long>(i + 1))));
  }
  // Another body is told apart.
  CHECK(!bitwise_equal(results({bodies[4]}, 1), results({bodies[5]}, 1)));
}

TEST_CASE("ensemble: a body with data that are not numbers does not harm others", "[ensemble]") {
  std::vector<Body> bodies = bodies_turning(16, {0.1}, 0.01, 5);
  const auto results = [&] {
    return after_steps<ensemble::Munjiza>(
        Ensemble<rigid_body::Free>(bodies, {1, instruction_sets().back()}, 1.0), 0.01, 5);
  };
  const std::vector<double> good = results();
  bodies[3].angular_momentum[1] = std::nan("");
  const std::vector<double> bad = results();
  CHECK(std::isnan(bad[12 * 3]));
  CHECK(bitwise_equal({bad.begin(), bad.begin() + 36}, {good.begin(), good.begin() + 36}));
  CHECK(bitwise_equal({bad.begin() + 48, bad.end()}, {good.begin() + 48, good.end()}));
}

TEST_CASE("ensemble: drift over 1e4 steps is that of the scheme for one body", "[ensemble]") {
  const double h = 0.05;
  const long steps = 10'000;
  const std::vector<Body> bodies = bodies_turning(16, {0.02, 0.05, 0.1}, h, 11);
  const Ensemble<rigid_body::Free> model(bodies, {1, instruction_sets().back()}, 1.0);
  const auto many = model.restore(after_steps<ensemble::Munjiza>(model, h, steps));
  double single_orthonormality = 0.0, orthonormality = 0.0, momentum = 0.0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const auto one = single<rigid_body::Free>(bodies[i]);
    auto state = rotation::Munjiza::start(one, one.initial());
    for (long n = 0; n < steps; ++n) rotation::Munjiza::step(one, state, 0.0, h);
    double first[6], ours[6], theirs[6];
    one.invariants(0.0, one.initial(), first);
    one.invariants(0.0, many.bodies[i], ours);
    one.invariants(0.0, rotation::Munjiza::view(one, state), theirs);
    orthonormality = std::max(orthonormality, ours[0]);
    single_orthonormality = std::max(single_orthonormality, theirs[0]);
    INFO("body " << i << ": energy drift " << ours[1] / first[1] - 1.0 << " and "
                 << theirs[1] / first[1] - 1.0);
    CHECK(std::abs(theirs[1] / first[1] - 1.0) > 1e-8);
    CHECK(std::abs(ours[1] - theirs[1]) <= 1e-3 * std::abs(theirs[1] - first[1]));
    const Eigen::Vector3d gain = many.bodies[i].attitude * many.bodies[i].angular_momentum -
                                 bodies[i].attitude * bodies[i].angular_momentum;
    momentum = std::max(momentum, gain.norm() / bodies[i].angular_momentum.norm());
  }
  INFO("orthonormality " << orthonormality << ", single " << single_orthonormality << "; momentum "
                         << momentum);
  CHECK(orthonormality <= 2.0 * single_orthonormality);
  CHECK(orthonormality <= 2e-12);
  CHECK(momentum <= 2e-12);
}

TEST_CASE("ensemble: steps allocate nothing", "[ensemble][allocation]") {
  const double h = 0.01;
  for (const int threads : {1, 2}) {
    const Ensemble<rigid_body::Gravity> model(bodies_turning(100, mixed_angles, h, 3),
                                              {threads, instruction_sets().back()}, 1.0);
    auto state = ensemble::Rkmk4::start(model, model.initial());
    const auto before = state;
    CHECK(allocations_of([&] {
            for (int n = 0; n < 100; ++n) ensemble::Rkmk4::step(model, state, 0.0, h);
          }) == 0);
    CHECK(state.arrays.at(ensemble::attitude, 2) != before.arrays.at(ensemble::attitude, 2));
    // Neither does going back to a copy.
    CHECK(allocations_of([&] { state = before; }) == 0);
  }
}

TEST_CASE("ensemble: a team does each part once and counts its helpers' time", "[ensemble]") {
  ensemble::Team team(3);
  std::vector<int> done(3);
  for (int n = 0; n < 1000; ++n)
    team.run(
        [](const void* context, int part) {
          ++(*const_cast<std::vector<int>*>(
              static_cast<const std::vector<int>*>(context)))[static_cast<std::size_t>(part)];
        },
        &done);
  CHECK(done == std::vector<int>{1000, 1000, 1000});
  CHECK(team.helper_cpu_seconds() > 0.0);
  CHECK(ensemble::Team(1).helper_cpu_seconds() == 0.0);
}
