#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <random>

#include "src/study/study.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

using namespace gnomon;
using namespace gnomon::test;
using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

constexpr double unit_roundoff = 2.220446049250313e-16;
const double pi = std::acos(-1.0);

class Random {
 public:
  explicit Random(unsigned seed) : generator_(seed) {}
  double uniform() { return 2.0 * static_cast<double>(generator_() >> 11) * 0x1p-53 - 1.0; }
  Vector3d vector() {
    const double x = uniform(), y = uniform(), z = uniform();
    return {x, y, z};
  }
  Quaterniond orientation() {
    const Vector3d v = vector();
    return Quaterniond(uniform(), v[0], v[1], v[2]).normalized();
  }
  BodyState state() {
    const Matrix3d attitude = orientation().toRotationMatrix();
    return {attitude, 2.0 * vector()};
  }

 private:
  std::mt19937_64 generator_;
};

const Vector3d inertia(0.6, 1.7, 1.1);

/// Calls `body(model)` with a body of each load.
template <class Body>
void for_each_load(Body&& body) {
  Random random(11);
  const BodyState initial = random.state();
  body(RigidBody<Free>(inertia, initial, {}, 3.0));
  body(RigidBody<Gravity>(inertia, initial, {2.0, {0.3, -0.4, 0.5}}, 3.0));
  body(RigidBody<SpaceMoment>(inertia, initial, {{0.2, 0.1, -0.3}}, 3.0));
  body(RigidBody<BodyMoment>(inertia, initial, {{0.2, 0.1, -0.3}}, 3.0));
  body(RigidBody<AttitudePotential>(inertia, initial, {1.0, 0.8, 0.3, {-0.5, 0.5, -0.5, 0.5}}, 3.0));
}

// Largest difference of an analytic derivative and the central differences of
// f, relative to the largest entry.
template <class F>
double jacobian_error(const F& f, const Eigen::MatrixXd& analytic, Eigen::VectorXd y) {
  Eigen::MatrixXd numeric(analytic.rows(), analytic.cols());
  for (int k = 0; k < y.size(); ++k) {
    const double at = y[k], step = 1e-5;
    y[k] = at + step;
    const Eigen::VectorXd plus = f(y);
    y[k] = at - step;
    numeric.col(k) = (plus - f(y)) / (2.0 * step);
    y[k] = at;
  }
  return (numeric - analytic).cwiseAbs().maxCoeff() / analytic.cwiseAbs().maxCoeff();
}

template <class Form>
void check_dae_jacobian(const Form& form, Random& random) {
  Eigen::VectorXd y(8), rate(8);
  for (int k = 0; k < 8; ++k) y[k] = random.uniform(), rate[k] = random.uniform();
  const auto residual = [&](const Eigen::VectorXd& at, const Eigen::VectorXd& rate_at) {
    Eigen::VectorXd value(8);
    form.residual(0.0, at.data(), rate_at.data(), value.data());
    return value;
  };
  for (double cj : {0.0, 1.0, 40.0}) {
    Eigen::Matrix<double, 8, 8> J;
    form.jacobian(0.0, cj, y.data(), rate.data(), J.data());
    // dF/dy + cj dF/dy' is the derivative of F(y + x, y' + cj x) by x.
    const auto shifted = [&](const Eigen::VectorXd& x) {
      return residual(Eigen::VectorXd(y + x), Eigen::VectorXd(rate + cj * x));
    };
    CHECK(jacobian_error(shifted, J, Eigen::VectorXd::Zero(8)) <= 4e-9);
    J(7, 2) += 1e-6 * J.cwiseAbs().maxCoeff();
    CHECK(jacobian_error(shifted, J, Eigen::VectorXd::Zero(8)) >= 1e-7);
  }
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), sizeof(double) * a.size()) == 0;
}

}  // namespace

TEST_CASE("rigid body: Jacobian of the ODE form", "[rigid_body]") {
  Random random(1);
  for_each_load([&](const auto& model) {
    const auto form = model.ode();
    for (int k = 0; k < 50; ++k) {
      // Quaternions of any norm: a solver's stages leave the unit sphere.
      Eigen::VectorXd y(7);
      for (int i = 0; i < 7; ++i) y[i] = 1.5 * random.uniform();
      const auto rhs = [&](const Eigen::VectorXd& at) {
        Eigen::VectorXd rate(7);
        form.rhs(0.0, at.data(), rate.data());
        return rate;
      };
      Eigen::MatrixXd J(7, 7);
      form.jacobian(0.0, y.data(), J.data());
      INFO(model.load_class());
      CHECK(jacobian_error(rhs, J, y) <= 1e-9);
      J(k % 7, (k / 7) % 7) += 1e-6 * J.cwiseAbs().maxCoeff();
      CHECK(jacobian_error(rhs, J, y) >= 1e-7);
    }
  });
}

TEST_CASE("rigid body: Jacobians of the DAE forms", "[rigid_body]") {
  Random random(2);
  for_each_load([&](const auto& model) {
    for (int k = 0; k < 20; ++k) {
      check_dae_jacobian(model.dae(), random);
      check_dae_jacobian(model.dae_index2(), random);
    }
  });
}

TEST_CASE("rigid body: the DAE forms start consistently", "[rigid_body]") {
  Random random(3);
  for_each_load([&](const auto& model) {
    for (int k = 0; k < 20; ++k) {
      const BodyState state = random.state();
      double y[8], rate[8], value[8], ode_rate[7];
      const auto check = [&](const auto& form) {
        form.pack(0.0, state, y);
        form.resume(0.0, y, rate);
        form.residual(0.0, y, rate, value);
        for (double v : value) CHECK(std::abs(v) <= 4.0 * unit_roundoff);
        CHECK(y[7] == 0.0);
        CHECK(rate[7] == 0.0);
        // The hidden constraint q.q' = 0.
        CHECK(std::abs(y[0] * rate[0] + y[1] * rate[1] + y[2] * rate[2] + y[3] * rate[3]) <=
              8.0 * unit_roundoff);
        model.ode().rhs(0.0, y, ode_rate);
        CHECK(std::memcmp(ode_rate, rate, sizeof ode_rate) == 0);
        // A multiplier shows in the residual: as mu' where it is stabilised,
        // else as mu.
        const bool stabilised = form.algebraic()[7] == 0;
        (stabilised ? rate : y)[7] = 1.0;
        form.residual(0.0, y, rate, value);
        for (int i = 0; i < 4; ++i) CHECK(std::abs(value[i] + y[i]) <= 4.0 * unit_roundoff);
      };
      check(model.dae());
      check(model.dae_index2());
    }
    CHECK(model.dae().algebraic() == std::vector<int>(8, 0));
    CHECK(model.dae_index2().algebraic() == std::vector<int>{0, 0, 0, 0, 0, 0, 0, 1});
  });
}

TEST_CASE("rigid body: rates in double and in long double", "[rigid_body]") {
  Random random(4);
  for_each_load([&](const auto& model) {
    for (int k = 0; k < 200; ++k) {
      double y[7], rate[7];
      long double wide[7], wide_rate[7];
      model.ode().pack(0.0, random.state(), y);
      std::copy(y, y + 7, wide);
      model.ode().rhs(0.0, y, rate);
      model.extended_rhs(0.0L, wide, wide_rate);
      for (int i = 0; i < 7; ++i)
        CHECK(std::abs(static_cast<double>(rate[i] - wide_rate[i])) <= 32.0 * unit_roundoff);
    }
  });
}

TEST_CASE("rigid body: the ODE form has the moment of the attitude form", "[rigid_body]") {
  Random random(5);
  for_each_load([&](const auto& model) {
    for (int k = 0; k < 50; ++k) {
      const BodyState state = random.state();
      double y[7], rate[7];
      model.ode().pack(0.0, state, y);
      model.ode().rhs(0.0, y, rate);
      const Vector3d& m = state.angular_momentum;
      const Vector3d w = m.cwiseQuotient(inertia);
      // m' = m x w + tau, so A tau is the moment in space: the rate of H = A m.
      const Vector3d tau = Vector3d(rate[4], rate[5], rate[6]) - m.cross(w);
      const Vector3d moment = model.moment(0.0, state.attitude);
      CHECK((state.attitude * tau - moment).norm() <= 32.0 * unit_roundoff);
      if (model.load_class() != "none") CHECK(moment.norm() >= 0.01);
      // A' = A hat(w), by a central difference of the quaternion's motion.
      const double step = 1e-5;
      double forth[7], back[7];
      for (int i = 0; i < 7; ++i) forth[i] = y[i] + step * rate[i], back[i] = y[i] - step * rate[i];
      const Matrix3d turning =
          (model.ode().unpack(0.0, forth).attitude - model.ode().unpack(0.0, back).attitude) / (2.0 * step);
      Matrix3d hat;
      hat << 0.0, -w[2], w[1], w[2], 0.0, -w[0], -w[1], w[0], 0.0;
      CHECK((turning - state.attitude * hat).cwiseAbs().maxCoeff() <= 1e-9);
    }
  });
}

TEST_CASE("rigid body: moments derive from their potentials", "[rigid_body]") {
  // A small turn a in space changes the potential by -M.a.
  Random random(6);
  const Gravity gravity{2.0, {0.3, -0.4, 0.5}};
  const Quaterniond b = random.orientation();
  const AttitudePotential potential{1.5, 0.8, 0.3, {b.w(), b.x(), b.y(), b.z()}};
  const auto of_gravity = [&](const Matrix3d& A) { return 2.0 * (A * gravity.centre)[2]; };
  const auto of_attitude = [&](const Matrix3d& A) {
    const double stretch = (A - Matrix3d::Identity()).norm() - 0.8;
    return 1.5 * stretch * stretch - 0.3 / (A - b.toRotationMatrix()).norm();
  };
  const auto check = [&](const auto& load, const auto& V) {
    for (int k = 0; k < 50; ++k) {
      const Matrix3d A = random.orientation().toRotationMatrix();
      const Vector3d a = random.vector().normalized();
      const auto turned = [&](double angle) { return V(AngleAxisd(angle, a).toRotationMatrix() * A); };
      CHECK(std::abs(load.potential(A) - V(A)) <= 1e-12);
      CHECK(std::abs(V(A)) <= load.depth() / 0.05);
      const double slope = (turned(1e-5) - turned(-1e-5)) / 2e-5;
      CHECK(std::abs(slope + load.space_moment(0.0, A).dot(a)) <= 1e-8);
    }
  };
  check(gravity, of_gravity);
  check(potential, of_attitude);
}

TEST_CASE("rigid body: a potential of the attitude gives no moment where it has no derivative",
          "[rigid_body]") {
  const AttitudePotential potential{1.0, 0.8, 0.3, {std::cos(0.5), std::sin(0.5), 0.0, 0.0}};
  const double one[4] = {1.0, 0.0, 0.0, 0.0};
  const auto pull = -0.3 / (4 * std::sqrt(2.0) * std::pow(std::sin(0.5), 3)) * std::cos(0.5);
  // What is left at the one point is the term of the other.
  CHECK((potential.body_moment(one) - Vector3d(-pull * std::sin(0.5), 0.0, 0.0)).norm() <= 1e-14);
  const auto spring = 8.0 * (0.8 / (std::sqrt(8.0) * std::sin(0.5)) - 1.0) * std::cos(0.5) * std::sin(0.5);
  CHECK((potential.body_moment(potential.attractor.data()) - Vector3d(spring, 0.0, 0.0)).norm() <= 1e-14);
  CHECK(potential.body_moment_derivative(one).allFinite());
  CHECK(potential.body_moment_derivative(potential.attractor.data()).allFinite());
}

TEST_CASE("rigid body: states survive flattening, packing and unpacking", "[rigid_body]") {
  Random random(7);
  for_each_load([&](const auto& model) {
    for (int k = 0; k < 100; ++k) {
      BodyState state = random.state();
      if (k == 0) state.attitude(0, 1) = -0.0, state.angular_momentum[2] = 5e-324;
      const std::vector<double> flat = model.flatten(state);
      REQUIRE(flat.size() == 12);
      CHECK(same_bits(flat, model.flatten(model.restore(flat))));
      CHECK(flat[1] == state.attitude(1, 0));
      if (k == 0) continue;
      double y[8];
      model.ode().pack(0.0, state, y);
      CHECK(y[0] >= 0.0);
      const BodyState unpacked = model.ode().unpack(0.0, y);
      CHECK((unpacked.attitude - state.attitude).cwiseAbs().maxCoeff() <= 4.0 * unit_roundoff);
      CHECK(unpacked.angular_momentum == state.angular_momentum);
      model.dae().pack(0.0, state, y);
      CHECK((model.dae().unpack(0.0, y).attitude - state.attitude).cwiseAbs().maxCoeff() <=
            4.0 * unit_roundoff);
    }
  });
}

TEST_CASE("rigid body: the norm of a quaternion stays visible", "[rigid_body]") {
  // A solver that lets |q| drift must not have it hidden by a normalisation.
  for_each_load([&](const auto& model) {
    double y[7] = {0.5, -0.5, 0.5, 0.5, 1.0, 2.0, 3.0};
    for (int k = 0; k < 4; ++k) y[k] *= 1.0 + 1e-6;
    std::vector<double> values(16);
    model.invariants(0.0, model.ode().unpack(0.0, y), values.data());
    REQUIRE(model.invariant_info().front().name == "orthonormality");
    CHECK(std::abs(values[0] - 4e-6) <= 1e-10);
  });
}

TEST_CASE("rigid body: distances", "[rigid_body]") {
  Random random(8);
  const RigidBody<Free> model(inertia, random.state(), {}, 1.0);
  const double angles[] = {0.0, 1e-15, 1e-12, 1e-8, 1e-3, 1.0, 2.0, pi - 1e-3, pi - 1e-8, pi - 1e-12, pi};
  for (int k = 0; k < 200; ++k) {
    const Quaterniond q = random.orientation();
    const Vector3d axis = random.vector().normalized(), other = random.vector();
    for (double angle : angles) {
      const Quaterniond turned = q * Quaterniond(AngleAxisd(angle, axis));
      const BodyState a{q.toRotationMatrix(), other}, b{turned.toRotationMatrix(), other};
      // The matrices are rounded.
      CHECK(std::abs(model.distance(a, b)[0] - angle) <= 8.0 * unit_roundoff);
      CHECK(std::abs(model.distance(b, a)[0] - angle) <= 8.0 * unit_roundoff);
      CHECK(model.distance(a, a)[0] <= 2.0 * unit_roundoff);
      CHECK(model.distance(a, b)[1] == 0.0);
    }
  }
  // Momentum: relative to the larger of the initial and the reference's own.
  const double start = model.initial().angular_momentum.norm();
  const BodyState a = model.initial(), small{a.attitude, 0.5 * a.angular_momentum},
                  large{a.attitude, 3.0 * a.angular_momentum};
  CHECK(std::abs(model.distance(a, small)[1] - 0.5) <= 4.0 * unit_roundoff);
  CHECK(std::abs(model.distance(a, large)[1] - 2.0 / 3.0) <= 4.0 * unit_roundoff);
  CHECK(std::abs(model.distance({a.attitude, a.angular_momentum + Vector3d(start, 0, 0)}, a)[1] - 1.0) <=
        4.0 * unit_roundoff);
}

TEST_CASE("rigid body: distances and drifts do not depend on the unit of mass", "[rigid_body]") {
  const Matrix3d attitude = Matrix3d::Identity();
  const Vector3d start(0.3, -0.4, 1.2), apart(3e-9, 4e-9, 0.0);
  for (const int exponent : {-1000, -530, 0, 530, 1000}) {
    INFO(exponent);
    const auto scaled = [&](const Vector3d& v) {
      return Vector3d(std::ldexp(v[0], exponent), std::ldexp(v[1], exponent), std::ldexp(v[2], exponent));
    };
    const BodyState initial{attitude, scaled(start)}, other{attitude, scaled(start + apart)};
    const RigidBody<SpaceMoment> model(scaled(inertia), initial, {scaled({0.1, 0.2, 0.3})}, 1.0);
    CHECK(std::abs(model.distance(other, initial)[1] / (5e-9 / 1.3) - 1.0) <= 1e-6);
    CHECK(model.distance(initial, initial)[1] == 0.0);
    BodyState wrong = other;
    wrong.angular_momentum[1] = std::nan("");
    CHECK(std::isnan(model.distance(wrong, initial)[1]));
    const auto boxed = box(model);
    Trace trace{{0.0}, boxed->invariants(0.0, model.flatten(initial))};
    trace.t.push_back(1.0);
    const auto later = boxed->invariants(0.0, model.flatten(other));
    trace.values.insert(trace.values.end(), later.begin(), later.end());
    const auto summaries = summarise_invariants(*boxed, trace);
    REQUIRE(summaries[1].info.name == "momentum_balance");
    CHECK(std::abs(summaries[1].max_drift / (5e-9 / 1.3) - 1.0) <= 1e-6);
  }
}

TEST_CASE("rigid body: a scaled norm is the norm", "[rigid_body]") {
  Random random(5);
  for (int k = 0; k < 1000; ++k) {
    const Vector3d v = random.vector();
    CHECK(rigid_body::scaled_norm(v) == v.norm());
  }
  CHECK(rigid_body::scaled_norm(Vector3d::Zero()) == 0.0);
  CHECK(rigid_body::scaled_norm({0.0, 5e-324, 0.0}) == 5e-324);
  CHECK(std::abs(rigid_body::scaled_norm({3e300, -4e300, 0.0}) / 5e300 - 1.0) <= 2.0 * unit_roundoff);
  CHECK(std::isinf(rigid_body::scaled_norm({0.0, -INFINITY, 1.0})));
  for (int k = 0; k < 3; ++k) {
    Vector3d v = Vector3d::Zero();
    v[k] = std::nan("");
    CHECK(std::isnan(rigid_body::scaled_norm(v)));
  }
}

TEST_CASE("rigid body: invariants are constant along the exact motion of every scene", "[rigid_body][long]") {
  const Catalogue catalogue = full_catalogue();
  int scenes = 0;
  for (const ShippedScene& shipped : shipped_scenes(catalogue)) {
    const Scene scene = load_scene(catalogue, shipped.name);
    if (scene.model_name != "rigid_body") continue;
    ++scenes;
    std::vector<double> times;
    for (int k = 0; k <= 8; ++k) times.push_back(scene.t_end * k / 8);
    const ReferenceStates reference = scene.model->reference(times);
    REQUIRE(!reference.kind.empty());
    // Drifts of all invariants, with the momentum as it is or half of it the wrong way round after the
    // start.
    const auto drifts = [&](double factor) {
      Trace trace{times, {}};
      for (std::size_t k = 0; k < times.size(); ++k) {
        std::vector<double> state = reference.states[k];
        if (k > 0)
          for (std::size_t i = 9; i < 12; ++i) state[i] *= factor;
        const auto values = scene.model->invariants(times[k], state);
        trace.values.insert(trace.values.end(), values.begin(), values.end());
      }
      return summarise_invariants(*scene.model, trace);
    };
    INFO(shipped.name);
    for (const InvariantSummary& summary : drifts(1.0)) {
      INFO(summary.info.name);
      CHECK(summary.max_drift <= 2e-15);
    }
    double wrong = 0.0;
    for (const InvariantSummary& summary : drifts(-0.5)) wrong = std::max(wrong, summary.max_drift);
    // A moment fixed in the body keeps nothing but the orthonormality.
    if (scene.model->load_class() == "body_moment")
      CHECK(drifts(1.0).size() == 1);
    else
      CHECK(wrong >= 0.01);
  }
  CHECK(scenes >= 11);
}

TEST_CASE("rigid body: energy with the wrong sign of gravity is not constant", "[rigid_body]") {
  const Catalogue catalogue = full_catalogue();
  const Scene scene = load_scene(catalogue, "asymmetric-heavy-top");
  const auto& body = typed<RigidBody<Gravity>>(scene);
  const RigidBody<Gravity> upside_down(body.inertia(), body.initial(),
                                       {-body.load().weight, body.load().centre}, scene.t_end);
  const ReferenceStates reference = scene.model->reference({5.0, 10.0});
  const std::vector<double> start = body.flatten(body.initial());
  const auto wrong = box(upside_down);
  for (std::size_t k = 0; k < 2; ++k) {
    const auto energy = [&](const AnyModel& model, const std::vector<double>& state) {
      return model.invariants(0.0, state)[1];
    };
    CHECK(std::abs(energy(*scene.model, reference.states[k]) - energy(*scene.model, start)) <= 1e-14);
    CHECK(std::abs(energy(*wrong, reference.states[k]) - energy(*wrong, start)) >= 0.1);
  }
}

TEST_CASE("rigid body: scales of a body at rest", "[rigid_body]") {
  const BodyState rest{Matrix3d::Identity(), Vector3d::Zero()};
  const auto check = [](const auto& model) {
    INFO(model.load_class());
    CHECK(std::isfinite(model.time_scale()));
    CHECK(model.time_scale() > 0.0);
    for (double scale : model.ode().scales()) CHECK((std::isfinite(scale) && scale > 0.0));
    for (double scale : model.dae().scales()) CHECK((std::isfinite(scale) && scale > 0.0));
    for (const InvariantInfo& info : model.invariant_info())
      CHECK((std::isfinite(info.scale) && info.scale > 0.0));
    const auto distance = model.distance(model.initial(), model.initial());
    CHECK(distance[0] <= 2.0 * unit_roundoff);
    CHECK(distance[1] == 0.0);
    BodyState moved = model.initial();
    moved.angular_momentum[0] = 1e-3;
    CHECK(model.distance(moved, model.initial())[1] > 0.0);
    CHECK(std::isfinite(model.distance(moved, model.initial())[1]));
  };
  check(RigidBody<Free>(inertia, rest, {}, 10.0));
  check(RigidBody<Gravity>(inertia, rest, {1.0, {1.0, 0.0, 0.0}}, 10.0));
  check(RigidBody<Gravity>(inertia, rest, {1.0, {0.0, 0.0, 0.0}}, 10.0));
  check(RigidBody<SpaceMoment>(inertia, rest, {{0.0, 0.0, 0.0}}, 10.0));
  check(RigidBody<SpaceMoment>(inertia, rest, {{0.1, 0.0, 0.0}}, 10.0));
  check(RigidBody<BodyMoment>(inertia, rest, {{0.0, 1e-9, 0.0}}, 10.0));
}
