// The schemes of discrete-element and molecular practice: orders, conservation, and what their papers claim.

#include <Eigen/Geometry>
#include <cmath>
#include <map>

#include "integrators/rotation/discrete_element.hpp"
#include "src/measure/drift.hpp"
#include "src/study/study.hpp"
#include "tests/catch.hpp"
#include "tests/rotation/printed_steps.hpp"
#include "tests/support/scenes.hpp"

using namespace gnomon;
using namespace gnomon::test;

namespace {

// Orders of orientation and momentum.
struct PracticeOrders {
  double orientation, momentum;
};
struct PracticeScheme {
  const char* name;
  PracticeOrders none, gravity, space_moment, body_moment;
  bool conserves_momentum, reversible;
};
constexpr PracticeOrders order_one{1, 1}, order_two{2, 2}, two_and_three{2, 3};
constexpr PracticeScheme practice_schemes[] = {
    {"fincham-leapfrog", order_two, order_two, order_two, order_two, true, false},
    {"omelyan", order_two, order_two, order_two, order_two, false, true},
    {"richardson", order_two, order_two, order_two, order_two, true, false},
    {"no-squish", order_two, order_two, order_two, order_two, true, true},
    {"buss", order_two, order_two, order_two, order_two, true, false},
    {"buss-augmented", order_two, order_two, order_two, order_two, true, false},
    {"johnson-williams-cook", order_two, order_one, order_one, order_one, true, false},
    {"spiral-leapfrog", two_and_three, order_two, order_two, two_and_three, false, false},
    {"spiral-synchronous", two_and_three, order_one, order_one, two_and_three, false, false},
    {"zhao-van-wachem", order_two, order_two, order_two, order_two, false, false},
};

Catalogue practice_catalogue() {
  Catalogue catalogue;
  add_models(catalogue);
  rotation::add_discrete_element_schemes(catalogue);
  return catalogue;
}

RunResult run_practice(const Catalogue& catalogue, const char* scheme, const AnyModel& model, double t_end,
                       long steps, int watch = 0) {
  RunSpec spec;
  spec.t_end = t_end;
  spec.step = t_end / static_cast<double>(steps);
  spec.watch = watch;
  spec.record = watch > 0;
  RunResult result = run_scheme(catalogue, scheme, model, spec);
  REQUIRE(result.status == Status::ok);
  REQUIRE(result.cost.steps == steps);
  return result;
}

// Orders from errors at steps halved one by one; each within 0.15 of the declared one.
void check_practice_slopes(const std::vector<double>& errors, double declared) {
  for (std::size_t k = 1; k < errors.size(); ++k) {
    const double slope = std::log2(errors[k - 1] / errors[k]);
    INFO("step halved " << k << " times: error " << errors[k] << ", order " << slope);
    CHECK(std::abs(slope - declared) <= 0.15);
  }
}

void check_practice_orders(const char* scene_name, const PracticeOrders PracticeScheme::*orders, double t_end,
                           long steps) {
  const Catalogue catalogue = practice_catalogue();
  const Scene scene = load_scene(catalogue, scene_name);
  const ReferenceStates reference = scene.model->reference({t_end});
  REQUIRE(!reference.kind.empty());
  for (const PracticeScheme& scheme : practice_schemes) {
    const PracticeOrders& declared = scheme.*orders;
    std::vector<double> orientation, momentum;
    for (long n = declared.orientation == 1.0 ? 8 * steps : steps; orientation.size() < 4; n *= 2) {
      const RunResult result = run_practice(catalogue, scheme.name, *scene.model, t_end, n);
      const auto error = scene.model->distance(result.state, reference.states.front());
      orientation.push_back(error[0]);
      momentum.push_back(error[1]);
    }
    INFO(scheme.name << " on " << scene_name);
    {
      INFO("orientation");
      check_practice_slopes(orientation, declared.orientation);
    }
    {
      INFO("momentum");
      check_practice_slopes(momentum, declared.momentum);
    }
    const SchemeInfo& info = *catalogue.scheme(scheme.name);
    const auto load = scene.model->load_class();
    CHECK(info.order_for(load, "orientation") == declared.orientation);
    CHECK(info.order_for(load, "momentum") == declared.momentum);
  }
}

// Drifts of the invariants of a free body, by name.
std::map<std::string, InvariantSummary> practice_drifts(const Catalogue& catalogue, const char* scheme,
                                                        const Scene& scene, double t_end, long steps) {
  const RunResult result = run_practice(catalogue, scheme, *scene.model, t_end, steps, 1000);
  std::map<std::string, InvariantSummary> named;
  for (InvariantSummary& summary : summarise_invariants(*scene.model, result.invariants))
    named[summary.info.name] = summary;
  return named;
}

double larger_error(const std::array<double, 2>& error) { return std::max(error[0], error[1]); }

// A heavy top that counts how often its moment is asked for.
struct CountingTop : RigidBody<Gravity> {
  explicit CountingTop(const RigidBody<Gravity>& body) : RigidBody<Gravity>(body) {}
  Eigen::Vector3d moment(double t, const Eigen::Matrix3d& attitude) const {
    ++asked;
    return RigidBody<Gravity>::moment(t, attitude);
  }
  mutable long asked = 0;
};

template <class S>
[[gnu::noinline]] void check_moments(const RigidBody<Gravity>& body, long a_step) {
  const CountingTop top(body);
  auto state = S::start(top, top.initial());
  for (long k = 0; k < 50; ++k)
    REQUIRE(S::step(top, state, 0.01 * static_cast<double>(k), 0.01) == Status::ok);
  INFO(S::info.name << ": " << top.asked << " moments in 50 steps");
  CHECK(top.asked == S::cost(top, state, 50).moments);
  CHECK(top.asked / 50 == a_step);
  CHECK(S::cost(body, S::start(body, body.initial()), 0).moments <= 1);
}

template <class... S>
void check_all_moments(const RigidBody<Gravity>& body, TypeList<S...>) {
  (check_moments<S>(body, S::info.name == "zhao-van-wachem" ? 2 : 1), ...);
}

}  // namespace

TEST_CASE("practice: one moment a step, two of the predictor-corrector", "[rotation][practice]") {
  const Catalogue catalogue = practice_catalogue();
  const Scene scene = load_scene(catalogue, "asymmetric-heavy-top");
  check_all_moments(typed<RigidBody<Gravity>>(scene), rotation::DiscreteElementSchemes{});
}

TEST_CASE("practice: orders on a free body", "[rotation][practice]") {
  check_practice_orders("asymmetric-free-top", &PracticeScheme::none, 10.0, 1000);
}
TEST_CASE("practice: orders with a moment fixed in space", "[rotation][practice]") {
  check_practice_orders("space-moment", &PracticeScheme::space_moment, 5.0, 500);
}
TEST_CASE("practice: orders with a moment fixed in the body", "[rotation][practice]") {
  check_practice_orders("body-moment", &PracticeScheme::body_moment, 5.0, 500);
}
TEST_CASE("practice: orders with a weight", "[rotation][practice][long]") {
  check_practice_orders("asymmetric-heavy-top", &PracticeScheme::gravity, 5.0, 1000);
}

TEST_CASE("practice: what a free body keeps", "[rotation][practice]") {
  const Catalogue catalogue = practice_catalogue();
  const Scene scene = load_scene(catalogue, "asymmetric-free-top");
  for (const PracticeScheme& scheme : practice_schemes) {
    INFO(scheme.name);
    auto seen = practice_drifts(catalogue, scheme.name, scene, 500.0, 10000);
    CHECK(seen.at("orthonormality").max_drift <= 1e-14);
    const double momentum = seen.at("angular_momentum").max_drift;
    CHECK((momentum <= 1e-12) == scheme.conserves_momentum);
    CHECK((momentum >= 1e-7) == !scheme.conserves_momentum);
    const InvariantSummary& energy = seen.at("energy");
    const auto verdict = measure_drift(energy.times, energy.drift, 0.0).verdict;
    INFO("energy " << energy.max_drift << " " << to_string(verdict));
    CHECK(verdict == (scheme.reversible ? DriftVerdict::bounded : DriftVerdict::secular));
    CHECK(energy.max_drift >= 1e-6);
    CHECK(catalogue.scheme(scheme.name)->conserves_momentum == scheme.conserves_momentum);
    CHECK(catalogue.scheme(scheme.name)->reversible == scheme.reversible);
    CHECK(!catalogue.scheme(scheme.name)->conserves_energy);
  }
}

TEST_CASE("practice: reversible are two", "[rotation][practice]") {
  const Catalogue catalogue = practice_catalogue();
  const Scene scene = load_scene(catalogue, "asymmetric-heavy-top");
  const auto& body = typed<RigidBody<Gravity>>(scene);
  for (const PracticeScheme& scheme : practice_schemes) {
    const RunResult there = run_practice(catalogue, scheme.name, *scene.model, 10.0, 1000);
    const auto turned = box(RigidBody<Gravity>(body.inertia(), body.restore(there.state), body.load(), 10.0));
    RunSpec spec;
    spec.t_end = -10.0;
    spec.step = -0.01;
    spec.record = false;
    const RunResult back = run_scheme(catalogue, scheme.name, *turned, spec);
    const double error = larger_error(body.distance(body.restore(back.state), body.initial()));
    INFO(scheme.name << " " << error);
    CHECK((error <= 1e-11) == scheme.reversible);
    CHECK((error >= 1e-8) == !scheme.reversible);
  }
}

TEST_CASE("practice: the production code is what the codes have", "[rotation][practice]") {
  const Catalogue catalogue = practice_catalogue();
  const Scene scene = load_scene(catalogue, "asymmetric-heavy-top");
  const auto& body = typed<RigidBody<Gravity>>(scene);
  const printed_steps::Run run{body, 0.01, 500};
  const auto apart = [&](const char* name, const BodyState& state) {
    const RunResult result = run_practice(catalogue, name, *scene.model, 5.0, run.n);
    return larger_error(body.distance(body.restore(result.state), state));
  };
  CHECK(apart("fincham-leapfrog", printed_steps::fincham(run, true)) <= 1e-12);
  CHECK(apart("richardson", printed_steps::richardson(run)) <= 1e-12);
  CHECK(apart("no-squish", printed_steps::no_squish(run)) <= 1e-12);
  CHECK(apart("buss", printed_steps::buss(run, false)) <= 1e-12);
  CHECK(apart("buss-augmented", printed_steps::buss(run, true)) <= 1e-12);
  CHECK(apart("omelyan", printed_steps::omelyan(run)) <= 1e-12);
  CHECK(apart("spiral-leapfrog", printed_steps::spiral_leapfrog(run)) <= 1e-12);
  CHECK(apart("spiral-synchronous", printed_steps::spiral_synchronous(run)) <= 1e-12);
  CHECK(apart("zhao-van-wachem", printed_steps::zhao_van_wachem(run, false)) <= 1e-12);
  // No two of them are the same.
  CHECK(apart("buss", printed_steps::buss(run, true)) >= 1e-6);
  CHECK(apart("fincham-leapfrog", printed_steps::fincham(run, false)) >= 1e-4);
  CHECK(apart("zhao-van-wachem", printed_steps::zhao_van_wachem(run, true)) >= 1e-4);
  CHECK(apart("richardson", printed_steps::fincham(run, true)) >= 1e-6);
  CHECK(apart("spiral-leapfrog", printed_steps::spiral_synchronous(run)) >= 1e-6);
}

TEST_CASE("practice: the quaternion form of Munjiza's scheme is his scheme", "[rotation][practice]") {
  const Catalogue catalogue = full_catalogue();
  for (const char* name :
       {"asymmetric-free-top", "asymmetric-heavy-top", "body-moment", "rest-then-pushed"}) {
    const Scene scene = load_scene(catalogue, name);
    INFO(name);
    const auto end = [&](const char* scheme) {
      return run_practice(catalogue, scheme, *scene.model, 5.0, 100).state;
    };
    const auto same = scene.model->distance(end("johnson-williams-cook"), end("munjiza"));
    const auto other = scene.model->distance(end("johnson-williams-cook"), end("rkmk4"));
    CHECK(std::max(same[0], same[1]) <= 1e-13);
    CHECK(std::max(other[0], other[1]) >= 1e-6);
  }
}

TEST_CASE("practice: variants in use are of order 1", "[rotation][practice][long]") {
  const Catalogue catalogue = practice_catalogue();
  const Scene scene = load_scene(catalogue, "asymmetric-heavy-top");
  const auto& body = typed<RigidBody<Gravity>>(scene);
  const BodyState exact = body.restore(scene.model->reference({5.0}).states.front());
  const auto errors = [&](auto&& steps, std::size_t metric) {
    std::vector<double> found;
    for (long n : {8000, 16000, 32000})
      found.push_back(
          body.distance(steps(printed_steps::Run{body, 5.0 / static_cast<double>(n), n}), exact)[metric]);
    return found;
  };
  for (std::size_t metric : {0, 1}) {
    // The second angular velocity of the leapfrog with the attitude of time t, not of the middle.
    check_practice_slopes(
        errors([](const printed_steps::Run& run) { return printed_steps::fincham(run, false); }, metric),
        1.0);
    check_practice_slopes(
        errors([](const printed_steps::Run& run) { return printed_steps::fincham(run, true); }, metric), 2.0);
    // The predictor-corrector with one moment a step.
    check_practice_slopes(
        errors([](const printed_steps::Run& run) { return printed_steps::zhao_van_wachem(run, true); },
               metric),
        1.0);
    check_practice_slopes(
        errors([](const printed_steps::Run& run) { return printed_steps::zhao_van_wachem(run, false); },
               metric),
        2.0);
  }
}

TEST_CASE("practice: end state of the cylinder of the SPIRAL paper", "[rotation][practice]") {
  const Eigen::Quaterniond q(0.9775650205852, 0.1624605750054, -0.1340474643670, 0.0021140941174);
  const Eigen::Vector3d w(87.920785874248, -0.815978794068, 0.710055355329);
  const Catalogue catalogue = practice_catalogue();
  const Scene scene = load_scene(catalogue, "spiral-cylinder");
  const auto& body = typed<RigidBody<BodyMoment>>(scene);
  const BodyState published{q.normalized().toRotationMatrix(), body.inertia().cwiseProduct(w)};
  for (const char* name : {"spiral-leapfrog", "spiral-synchronous"}) {
    std::vector<double> orientation, velocity;
    for (long n : {4000, 8000, 16000}) {
      const BodyState end = body.restore(run_practice(catalogue, name, *scene.model, 2.0, n).state);
      orientation.push_back(body.distance(end, published)[0]);
      velocity.push_back((end.angular_momentum.cwiseQuotient(body.inertia()) - w).norm());
    }
    INFO(name << ": orientation " << orientation.back() << " rad, velocity " << velocity.back() << " rad/s");
    check_practice_slopes(orientation, 2.0);
    check_practice_slopes(velocity, 3.0);
    CHECK(orientation.back() <= 1e-6);
    CHECK(velocity.back() <= 2e-7);
  }
}

TEST_CASE("practice: the commutator term of Buss pays at fast spin only", "[rotation][practice]") {
  const Catalogue catalogue = practice_catalogue();
  const auto error = [&](const char* scheme, const Scene& scene, double t_end, long steps,
                         const std::vector<double>& exact) {
    return scene.model->distance(run_practice(catalogue, scheme, *scene.model, t_end, steps).state, exact)[0];
  };
  // Published end state of the fast heavy top, good to six digits.
  const Scene fast = load_scene(catalogue, "fast-heavy-top");
  const auto& body = typed<RigidBody<Gravity>>(fast);
  const Eigen::Quaterniond q(0.1229473, -0.4910794, 0.3504308, -0.7879869);
  const std::vector<double> end = body.flatten({q.normalized().toRotationMatrix(), Eigen::Vector3d::Zero()});
  const double plain_fast = error("buss", fast, 2.0, 2048, end),
               augmented_fast = error("buss-augmented", fast, 2.0, 2048, end);
  INFO(plain_fast << " " << augmented_fast);
  CHECK(std::abs(plain_fast / 2.32e-1 - 1.0) <= 0.02);
  CHECK(std::abs(augmented_fast / 1.86e-3 - 1.0) <= 0.02);
  const Scene slow = load_scene(catalogue, "asymmetric-free-top");
  const std::vector<double> exact = slow.model->reference({10.0}).states.front();
  const double plain = error("buss", slow, 10.0, 1000, exact),
               augmented = error("buss-augmented", slow, 10.0, 1000, exact);
  INFO(plain << " " << augmented);
  CHECK(std::abs(plain / 1.26e-4 - 1.0) <= 0.02);
  CHECK(std::abs(augmented / 4.30e-4 - 1.0) <= 0.02);
}

TEST_CASE("practice: energy in the long run", "[rotation][practice][long]") {
  const Catalogue catalogue = practice_catalogue();
  const Scene free = load_scene(catalogue, "asymmetric-free-top");
  const auto energy = [&](const char* scheme, double h) {
    auto seen = practice_drifts(catalogue, scheme, free, 1e5 * h, 100000);
    return seen.at("energy").max_drift;
  };
  CHECK(energy("omelyan", 0.05) <= 1e-4);
  CHECK(energy("no-squish", 0.05) <= 1.1e-3);
  CHECK(energy("zhao-van-wachem", 0.1) >= 2.0);
  // The body that gains energy and keeps H comes to turn about the axis of the smallest moment of inertia.
  CHECK(std::abs(energy("richardson", 0.1) - 0.0946) <= 1e-3);
  // Unstable at half a radian a step.
  const Scene top = load_scene(catalogue, "heavy-symmetric-top");
  RunSpec spec;
  spec.t_end = 30.0;
  spec.step = 0.01;
  const auto blows_up = [&](const char* scheme) {
    const RunResult result = run_scheme(catalogue, scheme, *top.model, spec);
    if (result.status != Status::ok) return true;
    for (const InvariantSummary& summary : summarise_invariants(*top.model, result.invariants))
      if (summary.info.name == "energy") return summary.max_drift > 1.0;
    return false;
  };
  for (const PracticeScheme& scheme : practice_schemes) {
    INFO(scheme.name);
    CHECK(blows_up(scheme.name) == (std::string_view(scheme.name) == "zhao-van-wachem"));
  }
}
