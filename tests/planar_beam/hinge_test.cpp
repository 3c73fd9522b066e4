// Beams whose pieces are joined by hinges.
#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <tuple>
#include <vector>

#include "integrators/beam/hinge_moment.hpp"
#include "integrators/beam/midpoint.hpp"
#include "integrators/beam/mixed_midpoint.hpp"
#include "integrators/beam/stander_stein.hpp"
#include "integrators/beam/verlet.hpp"
#include "models/planar_beam/assembled_chain.hpp"
#include "src/reference_states.hpp"
#include "tests/planar_beam/beams.hpp"

using namespace gnomon;
using namespace gnomon::test;
using planar_beam::Numbering;

namespace {

/// A dense system of all unknowns brought to those that are neither tied nor held, solved, and its solution
/// spread again.
Eigen::VectorXd dense_solution(const Numbering& numbering, const std::vector<int>& held,
                               const Eigen::MatrixXd& A, const Eigen::VectorXd& right) {
  const int n = numbering.unknowns();
  Eigen::MatrixXd T = Eigen::MatrixXd::Identity(n, n);
  for (int i : numbering.tied()) T(i, i + 3) = 1.0;
  for (int i : numbering.tied()) T(i, i) = 0.0;
  for (int i : held) T(i, i) = 0.0;
  Eigen::MatrixXd B = T.transpose() * A * T;
  for (int i = 0; i < n; ++i)
    if (T.col(i).isZero(0.0)) B(i, i) = 1.0;
  return T * B.partialPivLu().solve(T.transpose() * right);
}

/// Relative error of the elimination of a random system, the second one with the same pattern.
template <class Chain>
double chain_error(Chain chain, const Numbering& numbering, int order, const std::vector<int>& held,
                   bool springs) {
  const int n = numbering.unknowns(), size = 3 * (order + 1);
  Eigen::MatrixXd A(n, n);
  for (unsigned round = 0; round < 2; ++round) {
    A.setZero();
    for (int k = 0; springs && k < static_cast<int>(numbering.hinged().size()); ++k) {
      const int left = numbering.left_rotation(k), right = numbering.right_rotation(k);
      const double by_left = -0.7 - k - round, by_right = 1.3 + k;
      chain.set_spring(k, by_left, by_right);
      A(right, right) += by_right;
      A(right, left) += by_left;
      A(left, right) -= by_right;
      A(left, left) -= by_left;
    }
    for (int e = 0; e < numbering.elements(); ++e) {
      const Eigen::VectorXd entries = random_values(size * size, 1.0, 100U * round + e + 1);
      Eigen::MatrixXd K = Eigen::Map<const Eigen::MatrixXd>(entries.data(), size, size);
      K.diagonal().array() += size;
      if constexpr (requires { chain.add(e, K.data()); })
        chain.add(e, K.data());
      else
        chain.add(e, typename Chain::Matrix(K));
      A.block(numbering.first(e), numbering.first(e), size, size) += K;
    }
    chain.factorise();
  }
  const Eigen::VectorXd right = random_values(n, 1.0, 99), exact = dense_solution(numbering, held, A, right);
  Eigen::VectorXd x = right;
  chain.solve(x.data());
  for (int i : numbering.tied()) CHECK(x[i] == x[i + 3]);
  for (int i : held) CHECK(x[i] == 0.0);
  CHECK(exact.norm() >= 1e-2);
  return (x - exact).norm() / exact.norm();
}

template <int p>
void check_elimination() {
  for (const auto& [elements, hinged] :
       {std::pair{2, std::vector{1}}, {3, {1, 2}}, {5, {2}}, {6, {1, 2, 3, 5}}, {9, {4, 7}}})
    for (bool held : {false, true})
      for (bool springs : {false, true}) {
        const Numbering numbering(p, elements, hinged);
        const int n = numbering.unknowns();
        const std::vector<int> out = held ? std::vector<int>{0, 2, n - 2} : std::vector<int>{};
        INFO("order " << p << ", " << elements << " elements");
        CHECK(chain_error(beam::ElementChain<p>(elements, out, hinged), numbering, p, out, springs) <= 1e-13);
        for (LinearSolver solver : {LinearSolver::band, LinearSolver::klu, LinearSolver::sparselu})
          CHECK(chain_error(planar_beam::AssembledChain(solver, p, elements, out, hinged), numbering, p, out,
                            springs) <= 1e-13);
      }
}

/// A soft frame that hangs from a clamp: a hinge at a bend, another with a spring.
Data hinged_frame(int elements) {
  Data data = soft_beam(elements);
  data.bends = {{0.5, -1.0}};
  data.hinges = {{0.5}, {0.75, 0.3}};
  return data;
}

/// A free beam of three pieces in flight; the last hinge has a spring.
Data free_chain(int elements) {
  Data data = spinning_beam(elements, true);
  data.hinges = {{2.5}, {7.5, 5.0}};
  return data;
}

/// How far the tangent times Newton's correction is from minus the residual, by differences of the residual
/// along the correction.
template <class S, int p>
double correction_error(unsigned seed, LinearSolver solver) {
  Data data = hinged_frame(4);
  data.hinges.back().spring = 40.0;
  data.damping = 0.8;
  const PlanarBeam<p> model(data);
  const int n = model.unknowns();
  const auto joined = [&](double size, unsigned number) {
    Eigen::VectorXd values = random_values(n, size, number);
    model.numbering().spread(values.data());
    for (int i : model.held()) values[i] = 0.0;
    return values;
  };
  auto start = model.initial();
  start.u = joined(2.0, seed);
  start.v = joined(5.0, seed + 1);
  SchemeOptions options;
  options.linear_solver = solver;
  beam::Stepper<PlanarBeam<p>, S::kind> state(model, start, options);
  const Eigen::VectorXd middle = joined(5.0, seed + 2);
  const double h = 0.3;
  state.load(model, 0.1);
  state.mean = middle;
  state.evaluate(model, h);
  const Eigen::VectorXd residual = state.residual();
  state.linearise(model, h);
  const Eigen::VectorXd correction = state.correct();
  const double size = 1e-6 / correction.norm();
  state.mean = middle + size * correction;
  state.evaluate(model, h);
  const Eigen::VectorXd up = state.residual();
  state.mean = middle - size * correction;
  state.evaluate(model, h);
  CHECK(correction.norm() >= 1e-3);
  return ((up - state.residual()) / (2.0 * size) + residual).norm() / residual.norm();
}

/// Angles and rates of two rigid rods of length 1, mass m and moment of inertia I about their centres that
/// hang from each other and fall from the horizontal, clockwise; by the classical Runge-Kutta method.
std::array<double, 4> rigid_double_pendulum(double m, double I, double g, double t_end, int steps) {
  using State = std::array<double, 4>;
  const auto rate = [=](const State& y) {
    const double c = std::cos(y[0] - y[1]), s = std::sin(y[0] - y[1]);
    const double a11 = I + 1.25 * m, a12 = 0.5 * m * c, a22 = I + 0.25 * m;
    const double b1 = 1.5 * m * g * std::cos(y[0]) - 0.5 * m * s * y[3] * y[3];
    const double b2 = 0.5 * m * g * std::cos(y[1]) + 0.5 * m * s * y[2] * y[2];
    const double det = a11 * a22 - a12 * a12;
    return State{y[2], y[3], (a22 * b1 - a12 * b2) / det, (a11 * b2 - a12 * b1) / det};
  };
  const auto moved = [](const State& y, double h, const State& by) {
    State z = y;
    for (int k = 0; k < 4; ++k) z[k] += h * by[k];
    return z;
  };
  State y{};
  const double h = t_end / steps;
  for (int n = 0; n < steps; ++n) {
    const State k1 = rate(y), k2 = rate(moved(y, 0.5 * h, k1)), k3 = rate(moved(y, 0.5 * h, k2)),
                k4 = rate(moved(y, h, k3));
    for (int k = 0; k < 4; ++k) y[k] += h / 6.0 * (k1[k] + 2.0 * k2[k] + 2.0 * k3[k] + k4[k]);
  }
  return y;
}

/// Two beams, from a pin and from the first one's end.
Data double_pendulum(double EI) {
  Data data;
  data.length = 2.0;
  data.elements = 4;
  data.section = {100.0 * EI, 40.0 * EI, EI, 1.0, 1e-3};
  data.gravity = 9.81;
  data.supports[0].place = true;
  data.hinges = {{1.0}};
  return data;
}

template <int p>
planar_beam::State last_state(std::string_view scheme, const PlanarBeam<p>& model, const RunSpec& spec) {
  const RunResult result = run_beam(scheme, model, spec);
  INFO(scheme << ": " << result.message);
  REQUIRE(result.status == Status::ok);
  return model.restore(result.state);
}

/// Pieces 0.12, 0.24 and 0.18 m long between pins 0.24 m apart; the first is upright and turned.
Data four_bar(double EI) {
  Data data;
  data.length = 0.54;
  data.elements = 9;
  data.section = {1e3 * EI, 4e2 * EI, EI, 0.2, 2e-5};
  data.angle = 0.5 * std::numbers::pi;
  // The coupler's end is where circles about its start (0, 0.12) and about the pin (0.24, 0) meet.
  const double apart = std::hypot(0.24, 0.12), along = std::atan2(-0.12, 0.24);
  const double at_start = std::acos((apart * apart + 0.24 * 0.24 - 0.18 * 0.18) / (2.0 * apart * 0.24));
  const double at_pin = std::acos((apart * apart + 0.18 * 0.18 - 0.24 * 0.24) / (2.0 * apart * 0.18));
  const double coupler = along + at_start, rocker = along - at_pin;
  data.bends = {{0.12, coupler - data.angle}, {0.36, rocker - coupler}};
  data.hinges = {{0.12}, {0.36}};
  data.supports[0].motion = planar_beam::Motion{6.0, 0.25, planar_beam::MotionKind::spin_up};
  data.supports[1].place = true;
  return data;
}

}  // namespace

TEST_CASE("planar beam: elimination with hinges against dense matrices", "[planar_beam]") {
  check_elimination<1>();
  check_elimination<2>();
  check_elimination<4>();
}

TEST_CASE("planar beam: a hinge's spring does the work of its energy", "[planar_beam]") {
  const double k = 3.0, angle = 0.4, h = 0.2;
  // Slow and fast, alike, opposite, and so fast that the Cayley map turns by almost a whole turn.
  for (const std::pair<double, double>& rates : {std::pair{0.3, -0.2},
                                                 {2.0, 2.0},
                                                 {2.0, 2.0 + 1e-7},
                                                 {-40.0, 35.0},
                                                 {11.0, -11.0},
                                                 {1e-9, 0.0},
                                                 {5.0, 500.0}})
    for (bool cayley : {false, true}) {
      const double left = rates.first, right = rates.second;
      const auto m = beam::hinge_moment(cayley, k, angle, left, right, h);
      const auto turn = [&](double rate) { return cayley ? 2.0 * std::atan(0.5 * h * rate) : h * rate; };
      const double after = angle + turn(right) - turn(left);
      const double work = h * (right - left) * m.moment, change = 0.5 * k * (after * after - angle * angle);
      INFO(left << " " << right << " " << cayley << ": " << work << " " << change);
      CHECK(std::abs(work - change) <= 1e-14 * k * (1.0 + after * after));
      const double step = 1e-5 * (1.0 + std::abs(left) + std::abs(right));
      const auto moment = [&](double by_left, double by_right) {
        return beam::hinge_moment(cayley, k, angle, left + by_left, right + by_right, h).moment;
      };
      CHECK(std::abs((moment(step, 0.0) - moment(-step, 0.0)) / (2.0 * step) - m.by_left) <= 1e-7);
      CHECK(std::abs((moment(0.0, step) - moment(0.0, -step)) / (2.0 * step) - m.by_right) <= 1e-7);
    }
}

TEST_CASE("beam schemes: tangent with hinges against finite differences", "[planar_beam]") {
  using namespace gnomon::beam;
  for (unsigned seed : {1U, 11U})
    for (LinearSolver solver : {LinearSolver::block, LinearSolver::klu})
      for (double error :
           {correction_error<BeamMidpoint, 1>(seed, solver), correction_error<BeamMidpoint, 3>(seed, solver),
            correction_error<BeamEnergyMomentum, 1>(seed, solver),
            correction_error<BeamEnergyMomentum, 2>(seed, solver),
            correction_error<BeamEnergyMomentum, 4>(seed, solver),
            correction_error<BeamStanderStein, 2>(seed, solver),
            correction_error<BeamMixedMidpoint, 2>(seed, solver)})
        CHECK(error <= 1e-6);
}

TEST_CASE("beam schemes: a free chain keeps energy and momenta as declared", "[planar_beam]") {
  const PlanarBeam<1> model(free_chain(8));
  for (const SchemeInfo& scheme : beam_schemes()) {
    const Drifts d = drifts(scheme.name, model, 5.0, 0.005);
    INFO(scheme.name << ": " << d.energy << " " << d.linear << " " << d.angular);
    CHECK(d.linear <= 1e-12);
    CHECK((d.energy <= 1e-11) == scheme.conserves_energy);
    CHECK((d.energy >= 1e-8) == !scheme.conserves_energy);
    CHECK((d.angular <= 1e-11) == scheme.conserves_momentum);
    CHECK((d.angular >= 1e-9) == !scheme.conserves_momentum);
  }
  // With large steps and elements of higher order, too. The hinges do turn, one against its spring.
  const PlanarBeam<3> cubic(free_chain(4));
  const Drifts d = drifts("beam-energy-momentum", cubic, 50.0, 0.1);
  INFO(d.energy << " " << d.linear << " " << d.angular);
  CHECK(d.energy <= 1e-11);
  CHECK(d.linear <= 1e-12);
  CHECK(d.angular <= 1e-12);
  RunSpec spec;
  spec.t_end = 5.0;
  spec.step = 0.1;
  const auto probes = cubic.probes(last_state("beam-energy-momentum", cubic, spec));
  REQUIRE(probes.size() == 4);
  for (std::size_t k : {2U, 3U}) {
    CHECK(probes[k].components[3].first == "jump");
    CHECK(std::abs(probes[k].components[3].second) >= 0.05);
  }
}

TEST_CASE("beam schemes: a stiff spring at a hinge makes explicit steps small", "[planar_beam]") {
  Data data = free_chain(8);
  const auto stable = [](const PlanarBeam<1>& model) {
    const beam::NodalBeamOf<PlanarBeam<1>> nodal(model);
    return beam::stable_step(nodal, model.initial().u.data(), beam::Mass::consistent);
  };
  const double soft = stable(PlanarBeam<1>(data));
  data.hinges[0].spring = 1e5;
  const PlanarBeam<1> model(data);
  const double h = stable(model);
  CHECK(2.0 * h <= soft);  // the bound of the elements without it would not do
  CHECK(drifts("beam-verlet-consistent", model, 1000 * h, h).energy <= 1e-2);
  const RunResult far = run_beam("beam-verlet-consistent", model, 1000 * h, 2.0 * h);
  if (far.status == Status::ok) CHECK_FALSE(drifts_of(model, far).energy <= 1.0);
}

TEST_CASE("beam schemes: declared orders with hinges", "[planar_beam]") {
  const PlanarBeam<2> model(hinged_frame(4));
  const auto any = box(model);
  const ReferenceStates reference = any->reference({1.0});
  INFO(reference.message);
  REQUIRE(reference.kind == "certified");
  const auto exact = model.restore(reference.states[0]);
  CHECK(std::abs(exact.u[model.numbering().right_rotation(0)] -
                 exact.u[model.numbering().left_rotation(0)]) >= 0.1);
  for (const SchemeInfo& scheme : beam_schemes()) {
    RunSpec spec;
    spec.t_end = 1.0;
    const auto errors = [&](int steps) {
      spec.step = 1.0 / steps;
      return model.distance(last_state(scheme.name, model, spec), exact);
    };
    const auto order = scheme.order_for("dead");
    const int steps = order && *order > 2.0 && scheme.name != "beam-rk4" ? 320 : 1280;
    const auto coarse = errors(steps), fine = errors(2 * steps);
    for (std::size_t k = 0; k < 4; ++k) {
      INFO(scheme.name << ", " << model.metrics[k].name << ": " << coarse[k] << " " << fine[k]);
      if (order) {
        CHECK(fine[k] >= 100.0 * reference.bounds[0][k]);
        CHECK(std::abs(std::log2(coarse[k] / fine[k]) - *order) <= 0.1);
      } else {  // lumped mass
        CHECK(fine[k] >= 1e-3);
        CHECK(fine[k] <= 0.5);
      }
    }
  }
}

TEST_CASE("planar beam: SUNDIALS integrates a hinged frame to the same motion in all forms",
          "[planar_beam]") {
  const PlanarBeam<1> model(hinged_frame(4));
  RunSpec spec;
  spec.t_end = 1.0;
  spec.tol = 1e-10;
  const auto exact = last_state("arkode-erk8", model, spec);
  CHECK(exact.v.norm() >= 1.0);
  for (const auto& [scheme, tolerance, error] : {std::tuple{"cvode-adams", 1e-9, 3e-6},
                                                 {"cvode-bdf", 1e-9, 3e-6},
                                                 {"arkode-dirk", 1e-9, 3e-6},
                                                 {"ida-bdf", 1e-9, 3e-6},
                                                 {"ida-bdf-constraints", 1e-9, 3e-6},
                                                 {"beam-energy-momentum-adaptive", 1e-8, 6e-5}}) {
    spec.tol = tolerance;
    const auto d = model.distance(last_state(scheme, model, spec), exact);
    INFO(scheme << ": " << d[0] << " " << d[1] << " " << d[2] << " " << d[3]);
    for (double one : d) CHECK(one <= error);
  }
}

TEST_CASE("planar beam: a stiff double pendulum is that of rigid rods", "[planar_beam]") {
  const double t_end = 1.0;
  const auto exact = rigid_double_pendulum(1.0, 1.0 / 12.0 + 1e-3, 9.81, t_end, 4000);
  const auto half = rigid_double_pendulum(1.0, 1.0 / 12.0 + 1e-3, 9.81, t_end, 2000);
  for (int k = 0; k < 4; ++k) CHECK(std::abs(exact[k] - half[k]) <= 1e-8);
  CHECK(std::abs(exact[0] - exact[1]) >= 0.3);
  RunSpec spec;
  spec.t_end = t_end;
  spec.step = 5e-4;
  for (const auto& [EI, tolerance] : {std::pair{1e3, 3e-3}, {1e5, 3e-5}}) {
    const PlanarBeam<2> model(double_pendulum(EI));
    const auto state = last_state("beam-energy-momentum", model, spec);
    // The chords of the two beams.
    const int joint = model.numbering().right_rotation(0) - 2, end = model.unknowns() - 3;
    const double x[2] = {1.0 + state.u[joint], 2.0 + state.u[end]},
                 z[2] = {state.u[joint + 1], state.u[end + 1]};
    const double angle[2] = {std::atan2(-z[0], x[0]), std::atan2(z[0] - z[1], x[1] - x[0])};
    for (int k = 0; k < 2; ++k) {
      const double error = std::abs(std::remainder(angle[k] - exact[k], 2.0 * std::numbers::pi));
      INFO("EI " << EI << ", beam " << k << ": " << error);
      CHECK(error <= tolerance);
      CHECK(error >= 0.1 * tolerance);  // they do bend
    }
  }
}

TEST_CASE("planar beam: a stiff four-bar mechanism moves as its linkage", "[planar_beam]") {
  const PlanarBeam<2> model(four_bar(1e3));
  RunSpec spec;
  spec.step = 1e-3;
  double least = 4.0, most = 0.0;
  for (double t : {0.2, 0.45, 0.7, 0.95, 1.2}) {
    spec.t_end = t;
    for (const char* scheme : {"beam-midpoint", "beam-energy-momentum"}) {
      const auto state = last_state(scheme, model, spec);
      const double crank = 0.5 * std::numbers::pi - model.data().supports[0].motion->value(t);
      const double bx = 0.12 * std::cos(crank), bz = 0.12 * std::sin(crank);
      // The end of the coupler, on the circle about the right pin.
      const double apart = std::hypot(0.24 - bx, bz), along = std::atan2(-bz, 0.24 - bx);
      const double at_start = std::acos((apart * apart + 0.24 * 0.24 - 0.18 * 0.18) / (2.0 * apart * 0.24));
      const double cx = bx + 0.24 * std::cos(along + at_start), cz = bz + 0.24 * std::sin(along + at_start);
      const double rocker = std::atan2(cz, cx - 0.24);
      least = std::min(least, rocker);
      most = std::max(most, rocker);
      const int b = model.numbering().right_rotation(0) - 2, c = model.numbering().right_rotation(1) - 2;
      const auto place = [&](int i, int k) { return model.positions()[2 * (i / 3) + k] + state.u[i + k]; };
      INFO(scheme << ", t = " << t << ": " << place(b, 0) - bx << " " << place(b, 1) - bz << " "
                  << place(c, 0) - cx << " " << place(c, 1) - cz);
      CHECK(std::hypot(place(b, 0) - bx, place(b, 1) - bz) <= 1e-6);
      CHECK(std::hypot(place(c, 0) - cx, place(c, 1) - cz) <= 1e-6);
      // The coupler turns as the line between its ends.
      const double coupler = model.data().angle + model.data().bends[0].angle - std::atan2(cz - bz, cx - bx);
      CHECK(std::abs(std::remainder(state.u[b + 2] - coupler, 2.0 * std::numbers::pi)) <= 1e-5);
    }
  }
  CHECK(most - least >= 0.5);
}

TEST_CASE("planar beam: statics of beams with hinges", "[planar_beam]") {
  // Clamped, hinged in the middle, pinned at the end, with a force on the right half's middle: each half is
  // statically determinate.
  Data data;
  data.elements = 4;
  data.section = {50.0, 20.0, 1.0, 1.0, 1.0};
  data.supports[0] = {true, true};
  data.supports[1].place = true;
  data.hinges = {{0.5}};
  const double P = 1e-6;
  data.loads = {{planar_beam::Place::inside, {0.0, -P}, 0.0, planar_beam::Profile::constant, 0.0}};
  data.loads[0].x = 0.75;
  const PlanarBeam<3> beam(data);
  const auto solve = [](const auto& of) {
    INFO(of.statics()->refusal());
    CHECK(of.statics()->refusal().empty());
    const StaticPath path = follow_equilibrium(*of.statics());
    REQUIRE(path.status == Status::ok);
    return of.restore(path.points.back().state);
  };
  const auto state = solve(beam);
  const int left = beam.numbering().left_rotation(0), right = beam.numbering().right_rotation(0);
  const double Q = 0.5 * P, deflection = Q * 0.125 / 3.0 + Q * 0.5 / 20.0;
  CHECK(std::abs(state.u[left - 1] + deflection) <= 1e-6 * deflection);
  CHECK(state.u[left - 1] == state.u[right - 1]);
  CHECK(std::abs(state.u[left] - Q * 0.125) <= 1e-6 * Q);  // Q l^2/(2 EI), clockwise
  CHECK(state.u[right] - state.u[left] <= -0.3 * deflection);
  // The bending moment falls linearly from the clamp to nothing at the hinge, and rises from there to the
  // load.
  for (int k = 0; k < beam.point_count(); ++k) {
    const double x = (k / 3 + beam.element().at[k % 3]) * 0.25;
    const double moment = x < 0.5 ? Q * (0.5 - x) : x < 0.75 ? -Q * (x - 0.5) : -Q * (1.0 - x);
    CHECK(std::abs(state.strain[3 * k + 2] - moment) <= 1e-6 * Q);
  }
  // A spring between both sides: that stiff it is no hinge any more.
  Data sprung = data, whole = data;
  sprung.hinges[0].spring = 1e7;
  whole.hinges.clear();
  const PlanarBeam<3> with_spring(sprung), without(whole);
  const auto stiff = solve(with_spring), rigid = solve(without);
  CHECK(std::abs(stiff.u[left - 1] - rigid.u[left - 1]) <= 1e-6 * deflection);
  CHECK(std::abs(rigid.u[left - 1]) <= 0.8 * deflection);
  // Mechanisms are refused.
  data.supports[0].rotation = false;
  CHECK(PlanarBeam<1>(data).statics()->refusal() == "a beam whose pieces can move freely as rigid bodies");
  data.bends = {{0.5, 0.7}};  // a three-hinged arch
  CHECK(PlanarBeam<1>(data).statics()->refusal().empty());
  data.hinges.push_back({0.75});
  CHECK_FALSE(PlanarBeam<1>(data).statics()->refusal().empty());
  data.hinges[1].spring = 1.0;
  CHECK(PlanarBeam<1>(data).statics()->refusal().empty());
}
