#include "models/rigid_body/exact_free_top.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "tests/catch.hpp"
#include "tests/rigid_body/free_body_taylor.hpp"

using namespace gnomon::rigid_body;
using namespace gnomon::tests;

namespace {

template <class Real>
using Vector = Eigen::Matrix<Real, 3, 1>;
using Top = ExactFreeTop<double>;
using TopL = ExactFreeTop<long double>;
using Eigen::Quaterniond;
using Eigen::Vector3d;

const Quaterniond tilted = Quaterniond(0.3, -0.5, 0.7, 0.4).normalized();
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double eps = std::numeric_limits<double>::epsilon();

struct Body {
  Vector3d inertia;
  Quaterniond orientation;
  Vector3d angular_momentum;

  Top exact() const { return {inertia, orientation, angular_momentum}; }
  TopL exact_long() const {
    return {inertia.cast<long double>(), orientation.cast<long double>(),
            angular_momentum.cast<long double>()};
  }
  FreeBodyL integrated(double t) const {
    return integrate_free_body(inertia.cast<long double>(),
                               {orientation.cast<long double>(), angular_momentum.cast<long double>()}, t);
  }
};

// The larger of the rotation angle and the relative difference of the momenta.
template <class State>
long double difference(const State& a, const FreeBodyL& b) {
  const Vector3L change = a.angular_momentum.template cast<long double>() - b.angular_momentum;
  const long double size = b.angular_momentum.norm();
  return std::max(rotation_angle(a.orientation.template cast<long double>(), b.orientation),
                  size > 0 ? change.norm() / size : change.norm());
}

double difference(const Top::State& a, const Top::State& b) {
  return static_cast<double>(
      difference(a, FreeBodyL{b.orientation.cast<long double>(), b.angular_momentum.cast<long double>()}));
}

// Compares both precisions with the integration; returns error / bound in double precision.
double check_against_integration(const Body& body, double t) {
  const FreeBodyL truth = body.integrated(t);
  const Top top = body.exact();
  const double error = static_cast<double>(difference(top.at(t), truth));
  INFO("inertia " << body.inertia.transpose() << ", m " << body.angular_momentum.transpose() << ", t " << t);
  CHECK(error <= 1e-10);
  CHECK(error <= top.error_bound(t));
  CHECK(difference(body.exact_long().at(t), truth) <= 3e-15L);
  return error / top.error_bound(t);
}

}  // namespace

TEST_CASE("exact free top: twenty random bodies against a long double integration", "[rigid_body]") {
  std::mt19937_64 generator(20240501);
  const auto uniform = [&] { return 2 * (static_cast<double>(generator() >> 11) * 0x1p-53) - 1; };
  std::vector<double> ratios;
  for (int i = 0; i < 20; ++i) {
    Body body;
    const double spread = i % 3;  // moments within a factor of 1, 100 and 10^4; most are no real bodies
    for (double& moment : body.inertia) moment = std::pow(10, spread * uniform()) * (1 + 0.5 * uniform());
    for (double& m : body.angular_momentum) m = uniform();
    body.orientation = Quaterniond(uniform(), uniform(), uniform(), uniform()).normalized();
    body.angular_momentum *= 3 / body.angular_momentum.cwiseQuotient(body.inertia).norm();
    ratios.push_back(check_against_integration(body, 100));
  }
  // The bound is no empty one.
  std::sort(ratios.begin(), ratios.end());
  CHECK(ratios[10] > 1e-3);
  CHECK(ratios[19] > 1e-2);
}

TEST_CASE("exact free top: every order of the axes and every sign", "[rigid_body]") {
  for (const double m_middle : {0.4, 1.6}) {
    Eigen::Vector3i order(0, 1, 2);
    do {
      for (int signs = 0; signs < 8; ++signs) {
        const Vector3d inertia(0.6, 0.8, 1);
        const Vector3d m(1.0, m_middle, signs % 2 == 0 ? 1.3 : 0.7);
        Body body{{}, tilted, {}};
        for (int i = 0; i < 3; ++i) {
          body.inertia[i] = inertia[order[i]];
          body.angular_momentum[i] = (signs >> i) % 2 == 0 ? m[order[i]] : -m[order[i]];
        }
        check_against_integration(body, 5);
        check_against_integration(body, -3);
      }
    } while (std::next_permutation(order.begin(), order.end()));
  }
}

TEST_CASE("exact free top: symmetric tops", "[rigid_body]") {
  const double oblate_rate = -14.0 / 9;
  const Top oblate({3, 3, 9}, tilted, {0, 5, 7});
  for (const double t : {-20.0, 0.0, 0.1, 3.0, 100.0}) {
    const Vector3d m(5 * std::sin(oblate_rate * t), 5 * std::cos(oblate_rate * t), 7);
    CHECK((oblate.at(t).angular_momentum - m).norm() <= 4 * eps * (10 + 8 * std::abs(t)));
  }
  CHECK(std::abs(oblate.period() * 14 / 9 - 2 * std::acos(-1.0)) < 4e-15);
  check_against_integration({{3, 3, 9}, tilted, {0, 5, 7}}, 100);
  check_against_integration({{9, 9, 3}, tilted, {0, 5, 7}}, 100);
  check_against_integration({{9, 3, 9}, tilted, {5, 1e-3, -7}}, 100);
  check_against_integration({{3, 3, 9}, tilted, {2, 5, 1e-8}}, 100);
}

TEST_CASE("exact free top: nearly equal moments lose no digits", "[rigid_body]") {
  for (const double gap : {1e-14, -1e-12, 1e-9, -1e-7, 1e-5, 1e-3}) {
    check_against_integration({{2, 2 * (1 + gap), 3}, tilted, {1, 2, 1}}, 50);
    check_against_integration({{3, 2 * (1 + gap), 2}, tilted, {1e-3, 2, 1}}, 50);
    check_against_integration({{3, 2 * (1 + gap), 2}, tilted, {std::sqrt(std::abs(gap)), 2, 1}}, 50);
    check_against_integration({{2, 2 * (1 + gap), 2 * (1 - gap)}, tilted, {1, 2, 3}}, 50);
  }
}

TEST_CASE("exact free top: constant angular momentum", "[rigid_body]") {
  // Sphere, rest, principal axes (one unstable), any axis in the plane of two equal moments.
  const std::vector<Body> bodies{{{2, 2, 2}, tilted, {1, -2, 3}}, {{1, 2, 3}, tilted, {0, 0, 0}},
                                 {{1, 2, 3}, tilted, {0, 0, -2}}, {{1, 2, 3}, tilted, {4, 0, 0}},
                                 {{1, 2, 3}, tilted, {0, 5, 0}},  {{2, 2, 3}, tilted, {1, -3, 0}}};
  for (const Body& body : bodies) {
    const Vector3d w = body.angular_momentum.cwiseQuotient(body.inertia);
    const double speed = w.norm();
    for (const double t : {-7.0, 0.0, 1e4}) {
      const Top::State state = body.exact().at(t);
      CHECK(state.angular_momentum == body.angular_momentum);
      Quaterniond turn(Eigen::AngleAxisd(speed * t, speed > 0 ? Vector3d(w / speed) : Vector3d::UnitX()));
      CHECK(difference(state, {body.orientation * turn, body.angular_momentum}) <=
            body.exact().error_bound(t));
    }
    CHECK(std::isinf(body.exact().period()));
  }
  CHECK(bodies[1].exact().error_bound(1e4) <= 4 * eps);
  CHECK(bodies[4].exact().complementary_modulus() == 0);
  CHECK(bodies[3].exact().complementary_modulus() == 1);
}

TEST_CASE("exact free top: published periods", "[rigid_body]") {
  const TopL asymmetric({0.6L, 0.8L, 1.0L}, QuaternionL::Identity(), {1.8L, 0.4L, -0.9L});
  CHECK(std::abs(asymmetric.period() - 6.8626161780581164L) < 1e-16L * 7);
  CHECK(std::abs(Top({3, 5, 9}, tilted, {0, 2, 0.01}).period() - 118.110887046385744) < 3e-14);
  const Vector3d m(1.8, 0.4, -0.9);
  const Top top({0.6, 0.8, 1}, tilted, m);
  CHECK((top.at(1000 * top.period()).angular_momentum - m).norm() < 1e-12);
  CHECK((top.at(0.5 * top.period()).angular_momentum - m).norm() > 0.1);
}

TEST_CASE("exact free top: approach to the separatrix", "[rigid_body]") {
  for (double m3 = 1e-2; m3 > 0.5e-12; m3 /= 10) {
    const Body body{{3, 5, 9}, tilted, {0, 2, m3}};
    const double k1 = m3 * std::sqrt(5 / (12 + 5 * m3 * m3));
    CHECK(std::abs(body.exact().complementary_modulus() / k1 - 1) < 1e-15);
    check_against_integration(body, 50);
  }
  // Several flips; there the integration itself has lost n eps / k1^2, 1e-14 or so.
  const Body body{{3, 5, 9}, tilted, {0, 2, 1e-2}};
  CHECK(difference(body.exact().at(1000), body.integrated(1000)) < 1e-13L);
}

TEST_CASE("exact free top: flips near the separatrix", "[rigid_body]") {
  // Reference values by Taylor series with 70 digits, for q = 1 at t = 0 and the data as rounded to double.
  // The third body starts far from the middle axis, with k1^2 the small difference of two large terms.
  struct Case {
    Vector3d inertia, angular_momentum;
    double t;
    FreeBodyL reference;
  };
  const Case cases[] = {
      {{3, 5, 9},
       {0, 2, 1e-8},
       1000,
       {{0.003101733965387503177497L, 0.2249166098918604557327L, 0.006294339344974416938656L,
         0.9743527488201441554645L},
        {0.01775154231163075072897L, -1.999803042017862307551L, 0.02174111040546285496557L}}},
      {{3, 5, 9},
       {0, 2, 1e-12},
       1000,
       {{-0.7904739044776832383622L, 9.661148983581644819227e-06L, 0.6124957193698646343892L,
         -2.464629773600372078287e-07L},
        {2.444894076296880366263e-05L, 1.999999999626405809696L, 2.994371481040282318165e-05L}}},
      {{0.3, 0.6, 0.8},
       {1, 1.5, 2 * (1 + 1e-10)},
       60,
       {{0.4684845433584778945956L, -0.8243748594080752411266L, 0.04706752883222929034596L,
         0.3141862052028094536153L},
        {-0.0009168414780089099921358L, -2.692581623091214648566L, 0.001833901083582946337055L}}}};
  for (const Case& c : cases) {
    const Body body{c.inertia, Quaterniond::Identity(), c.angular_momentum};
    const double error = static_cast<double>(difference(body.exact().at(c.t), c.reference));
    INFO("inertia " << c.inertia.transpose() << ", m " << c.angular_momentum.transpose());
    CHECK(error <= body.exact().error_bound(c.t));
    CHECK(body.exact().error_bound(c.t) <= 5e-12);
    CHECK(difference(body.exact_long().at(c.t), c.reference) < 1e-16L);
  }
}

TEST_CASE("exact free top: on the separatrix", "[rigid_body]") {
  // m_low^2 I_high (I_b - I_low) = m_high^2 I_low (I_high - I_b) holds exactly. Then m_b = G tanh(rate t +
  // u0) with rate = G / I_b sqrt((I_high - I_b) (I_b - I_low) / (I_high I_low)).
  struct Case {
    Body body;
    double rate_over_magnitude;
  };
  for (const auto& [body, ratio] : {Case{{{3, 6, 8}, tilted, {1, 1.5, 2}}, 1.0 / 12},
                                    // of models/rigid_body/study.toml
                                    Case{{{4, 5, 9}, tilted, {0.5, 2, 0.375}}, 1.0 / 15},
                                    Case{{{15, 18, 90}, tilted, {2, -1.5, 1}}, 1.0 / 45}}) {
    const Top top = body.exact();
    CHECK(top.complementary_modulus() == 0);
    CHECK(std::isinf(top.period()));
    check_against_integration(body, 20);
    check_against_integration(body, -15);
    const double magnitude = body.angular_momentum.norm();
    const double start = std::atanh(body.angular_momentum[1] / magnitude);
    for (const double t : {-1e4, -2.0, 1.0, 30.0, 1e4}) {
      const Vector3d m = top.at(t).angular_momentum;
      CHECK(std::abs(m[1] - magnitude * std::tanh(magnitude * ratio * t + start)) < 1e-14);
    }
    // Late, it turns about the middle axis at the rate G / I_b.
    const Top::State late = top.at(1e4);
    const Top::State later = top.at(1e4 + 3);
    const Quaterniond turn(
        Eigen::AngleAxisd(magnitude / body.inertia[1] * 3, Vector3d(late.angular_momentum / magnitude)));
    CHECK(difference(later, {late.orientation * turn, late.angular_momentum}) < 1e-11);
    CHECK(top.error_bound(1e4) < 2e-11);
  }
}

TEST_CASE("exact free top: restarting gives the same motion", "[rigid_body]") {
  const std::vector<Body> bodies{{{0.6, 0.8, 1}, tilted, {1.8, 0.4, -0.9}},
                                 {{3, 3, 9}, tilted, {0, 5, 7}},
                                 {{1, 20, 3}, tilted, {-0.1, 2, 0.4}},
                                 {{3, 5, 9}, tilted, {0, 2, 0.3}}};
  for (const Body& body : bodies) {
    const Top top = body.exact();
    for (const double t1 : {0.3, 17.0, -40.0}) {
      const Top::State middle = top.at(t1);
      const Top restarted(body.inertia, middle.orientation, middle.angular_momentum);
      CHECK(difference(restarted.at(23), top.at(t1 + 23)) < 1e-12);
      CHECK(difference(restarted.at(-t1), top.at(0)) < 1e-12);
      CHECK(difference(restarted.at(23), top.at(t1 + 23.001)) > 1e-4);
    }
    // Reversal of time: the body with -m runs backwards.
    const Top reversed(body.inertia, body.orientation, -body.angular_momentum);
    const Top::State back = reversed.at(31);
    CHECK(difference({back.orientation, -back.angular_momentum}, top.at(-31)) < 1e-12);
    CHECK(difference(top.at(0), {body.orientation, body.angular_momentum}) <= top.error_bound(0));
  }
}

TEST_CASE("exact free top: energy and spatial angular momentum", "[rigid_body]") {
  const std::vector<Body> bodies{{{0.6, 0.8, 1}, tilted, {1.8, 0.4, -0.9}},
                                 {{3, 5, 9}, tilted, {0, 2, 0.01}},
                                 {{0.001, 1, 50}, tilted, {1e-3, 2, 1}},
                                 {{9, 3, 9}, tilted, {5, 1e-3, -7}}};
  for (const Body& body : bodies) {
    const Top top = body.exact();
    const Vector3d momentum = body.orientation * body.angular_momentum;
    const auto energy = [&](const Vector3d& m) { return m.dot(m.cwiseQuotient(body.inertia)) / 2; };
    for (double t = -1e4; t <= 1e4; t += 61.7) {
      const Top::State s = top.at(t);
      CHECK(std::abs(energy(s.angular_momentum) / energy(body.angular_momentum) - 1) <= 64 * eps);
      CHECK((s.orientation * s.angular_momentum - momentum).norm() <= 16 * eps * momentum.norm());
      CHECK(std::abs(s.orientation.norm() - 1) <= 2 * eps);
    }
  }
}

TEST_CASE("exact free top: the comparison sees a moment changed by 1e-6", "[rigid_body]") {
  const Body body{{0.6, 0.8, 1}, tilted, {1.8, 0.4, -0.9}};
  const FreeBodyL truth = body.integrated(100);
  for (int i = 0; i < 3; ++i) {
    Body changed = body;
    changed.inertia[i] *= 1 + 1e-6;
    const double error = static_cast<double>(difference(changed.exact().at(100), truth));
    CHECK(error > 1e-6);
    CHECK(error > 1e3 * body.exact().error_bound(100));
  }
}

namespace {

// By the mean of the angular speed over the motion.
double angle_turned(const Body& body, double t) {
  const Top top = body.exact();
  const int samples = 200;
  double sum = 0;
  for (int i = 0; i < samples; ++i)
    sum += top.at((i + 0.5) / samples * t).angular_momentum.cwiseQuotient(body.inertia).norm();
  return sum / samples * t;
}

// Of double precision against extended precision, in units of eps (1 + angle turned).
double rounding_errors(const Body& body, double t) {
  const TopL::State truth = body.exact_long().at(t);
  const double error = static_cast<double>(
      difference(body.exact().at(t), FreeBodyL{truth.orientation, truth.angular_momentum}));
  INFO("inertia " << body.inertia.transpose() << ", m " << body.angular_momentum.transpose() << ", t " << t);
  CHECK(error <= body.exact().error_bound(t));
  return error / (eps * (1 + angle_turned(body, t)));
}

}  // namespace

TEST_CASE("exact free top: rounding errors grow with the angle turned", "[rigid_body]") {
  std::mt19937_64 generator(7);
  const auto uniform = [&] { return 2 * (static_cast<double>(generator() >> 11) * 0x1p-53) - 1; };
  // Real bodies by the second moments of their mass, which are not negative: compact ones, needles and
  // plates down to a millionth; and moments of no real body, as different.
  for (int kind = 0; kind < 4; ++kind) {
    double worst = 0;
    for (int i = 0; i < 200; ++i) {
      const double thin = std::pow(10, 3 * uniform() - 3);
      Vector3d mass(1, 1 + 0.9 * uniform(), 1 + 0.9 * uniform());
      if (kind == 1) mass = Vector3d(1, thin * (1 + 0.9 * uniform()), thin * (1 + 0.9 * uniform()));
      if (kind == 2) mass = Vector3d(1, 1 + 0.9 * uniform(), thin);
      Body body{{mass[1] + mass[2], mass[0] + mass[2], mass[0] + mass[1]}, tilted, {}};
      if (kind == 3) body.inertia = Vector3d(thin * (1 + 0.9 * uniform()), thin * (1 + 0.9 * uniform()), 1);
      for (double& m : body.angular_momentum) m = uniform();
      if (i % 2 == 0) body.angular_momentum = body.angular_momentum.cwiseProduct(body.inertia).eval();
      if (body.exact().complementary_modulus() < 0.01) continue;
      const double rate = body.angular_momentum.cwiseQuotient(body.inertia).norm();
      worst = std::max(worst, rounding_errors(body, std::pow(10, 2.5 + 1.5 * uniform()) / rate));
    }
    INFO("kind " << kind << ", worst " << worst);
    CHECK(worst <= (kind < 3 ? 8 : 20));
    CHECK(worst >= 0.1);
  }
}

TEST_CASE("exact free top: momentum that circulates faster than the body turns", "[rigid_body]") {
  // 6.5 rad, and half a million revolutions of the momentum.
  const Body flat{{1.2e-6, 1.21e-6, 0.9}, tilted, {4e-7, -4e-7, 0.4}};
  CHECK(std::abs(angle_turned(flat, 10) - 6.5) < 0.1);
  CHECK(rounding_errors(flat, 10) <= 8);
  Body other = flat;
  other.angular_momentum[2] *= 1 + 1e-12;
  CHECK(rounding_errors(other, 10) <= 8);
  CHECK(difference(flat.exact().at(10), other.exact().at(10)) > 1e-12);
  for (const double ratio : {1.0, 1.01, 1.7, 5.0, 30.0}) {
    const Body body{{1e-3, ratio * 1e-3, 0.9}, tilted, {4e-4, -7e-4, 0.4}};
    check_against_integration(body, 0.6);
    check_against_integration({{0.9, 1e-3, ratio * 1e-3}, tilted, {-0.4, 4e-4, 7e-4}}, -0.6);
    CHECK(rounding_errors(body, 0.6) <= 8);
    CHECK(rounding_errors(body, 100) <= 8);
  }
}

TEST_CASE("exact free top: data outside the domain", "[rigid_body]") {
  const Vector3d m(1, 2, 3);
  CHECK_THROWS_AS(Top({1, 0, 1}, tilted, m), std::invalid_argument);
  CHECK_THROWS_AS(Top({1, -1, 1}, tilted, m), std::invalid_argument);
  CHECK_THROWS_AS(Top({1, infinity, 1}, tilted, m), std::invalid_argument);
  CHECK_THROWS_AS(Top({1, 2, 3}, Quaterniond(2, 0, 0, 0), m), std::invalid_argument);
  CHECK_THROWS_AS(Top({1, 2, 3}, Quaterniond(0, 0, 0, 0), m), std::invalid_argument);
  CHECK_THROWS_AS(Top({1, 2, 3}, tilted, {1, std::nan(""), 0}), std::invalid_argument);
}

TEST_CASE("exact free top: extreme magnitudes", "[rigid_body]") {
  // Units do not matter, and neither does a component 1e-200 times the others.
  const Body body{{0.6, 0.8, 1}, tilted, {1.8, 0.4, -0.9}};
  const double scale = 0x1p-400;
  const Top small(body.inertia * scale, body.orientation, body.angular_momentum * scale);
  const Top::State state = small.at(10);
  CHECK(difference({state.orientation, state.angular_momentum / scale}, body.exact().at(10)) <= 1e-15);
  // Starting 1e-200 from the unstable axis, the flip comes after half of the period 4 ln(4 / k1) / lambda.
  const Top flip({3, 5, 9}, tilted, {0, 2, 1e-200});
  const double lambda = 2.0 / 5 * std::sqrt(8.0 / 27);
  const double k1 = 1e-200 * std::sqrt(5.0 / 12);
  CHECK(std::abs(flip.complementary_modulus() / k1 - 1) < 1e-15);
  CHECK(std::abs(flip.period() * lambda / (4 * (std::log(4.0) - std::log(k1))) - 1) < 1e-14);
  CHECK(flip.at(0.24 * flip.period()).angular_momentum[1] > 1.99);
  CHECK(flip.at(0.26 * flip.period()).angular_momentum[1] < -1.99);
}
