#include <algorithm>
#include <cmath>
#include <map>

#include "integrators/rotation/munjiza.hpp"
#include "models/rigid_body/exact_free_top.hpp"
#include "src/study/study.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

using namespace gnomon;
using namespace gnomon::test;

namespace {

using Summaries = std::map<std::string, InvariantSummary>;

Summaries invariants(const Catalogue& catalogue, std::string_view scheme, const AnyModel& model,
                     const RunSpec& spec) {
  const RunResult result = run_scheme(catalogue, scheme, model, spec);
  REQUIRE(result.status == Status::ok);
  Summaries named;
  for (InvariantSummary& summary : summarise_invariants(model, result.invariants))
    named[summary.info.name] = summary;
  return named;
}

RunSpec fixed_step(double t_end, double step) {
  RunSpec spec;
  spec.t_end = t_end;
  spec.step = step;
  spec.watch = 1000;
  return spec;
}

bool within(double value, double low, double high) { return value >= low && value <= high; }

// What a scheme does to a free body, seen without its descriptor.
enum class Seen { holds, fails, undecided };

Seen judge(double deviation) {
  if (deviation <= 1e-10) return Seen::holds;  // roundoff of 1e4 steps
  return deviation >= 1e-9 ? Seen::fails : Seen::undecided;
}

struct Properties {
  Seen energy, momentum, reversible;
};

// The free body of a scene, started elsewhere.
std::shared_ptr<const AnyModel> restarted(const RigidBody<Free>& body, const BodyState& state) {
  return box(RigidBody<Free>(body.inertia(), state, {}, 1.0));
}

// A fixed-step scheme goes forth by 1e4 steps and back by steps of the opposite sign. The others have no
// steps of the caller's: the body with the opposite momentum runs the motion backwards.
Properties observe(const Catalogue& catalogue, const SchemeInfo& info) {
  const Scene scene = load_scene(catalogue, "asymmetric-free-top");
  const auto& body = typed<RigidBody<Free>>(scene);
  const bool fixed = info.stepping == Stepping::fixed;
  RunSpec spec = fixed_step(fixed ? 500.0 : 50.0, 0.05);
  if (!fixed) spec.step.reset();
  if (info.stepping == Stepping::adaptive) spec.tol = 1e-4;
  const Summaries forth = invariants(catalogue, info.name, *scene.model, spec);

  RunSpec unseen = spec;
  unseen.record = false;
  const RunResult there = run_scheme(catalogue, info.name, *scene.model, unseen);
  BodyState turned = body.restore(there.state);
  if (fixed) {
    unseen.t_end = -spec.t_end;
    unseen.step = -*spec.step;
  } else {
    turned.angular_momentum = -turned.angular_momentum;
  }
  const RunResult back = run_scheme(catalogue, info.name, *restarted(body, turned), unseen);
  BodyState returned = body.restore(back.state);
  if (!fixed) returned.angular_momentum = -returned.angular_momentum;
  const auto error = body.distance(returned, body.initial());
  return {judge(forth.at("energy").max_drift),
          judge(std::max(forth.at("angular_momentum").max_drift, forth.at("momentum_norm").max_drift)),
          judge(std::max(error[0], error[1]))};
}

// A scheme with all three properties: the closed form, step by step.
struct ExactSteps {
  static constexpr SchemeInfo info{.name = "exact-steps",
                                   .family = "test",
                                   .summary = "",
                                   .citation = "",
                                   .form = "rotation",
                                   .reversible = true,
                                   .conserves_energy = true,
                                   .conserves_momentum = true};
  template <class M>
  using State = BodyState;
  static BodyState start(const RigidBody<Free>&, const BodyState& state) { return state; }
  static BodyState view(const RigidBody<Free>&, const BodyState& state) { return state; }
  static Cost cost(const RigidBody<Free>&, const BodyState&, long steps) { return {.steps = steps}; }
  static Status step(const RigidBody<Free>& model, BodyState& state, double, double h) {
    advance(model, state, h);
    return Status::ok;
  }
  // Not to be inlined into the driver's loop, which would take the compiler minutes.
  [[gnu::noinline]] static void advance(const RigidBody<Free>& model, BodyState& state, double h) {
    const rigid_body::ExactFreeTop<long double> top(
        model.inertia().cast<long double>(),
        rigid_body::unit_quaternion(state.attitude).cast<long double>().normalized(),
        state.angular_momentum.cast<long double>());
    const auto next = top.at(h);
    state = {next.orientation.normalized().toRotationMatrix().cast<double>(),
             next.angular_momentum.cast<double>()};
  }
};

}  // namespace

namespace {

// Without a moment a splitting is one drift, so one scheme of each drift stands for all of them.
bool repeats_a_drift(const SchemeInfo& info) {
  const auto ends_with = [&](std::string_view end) { return info.name.ends_with(end); };
  return (ends_with("-exact-drift") && info.name != "strang-exact-drift") || ends_with("-dmv10");
}

void check_momentum_and_orthonormality(double h) {
  const Catalogue catalogue = full_catalogue();
  for (const char* name : {"asymmetric-free-top", "symmetric-free-top", "dzhanibekov"}) {
    SceneChanges longer;
    longer.t_end = 1e5 * h;
    const Scene scene = load_scene(catalogue, name, longer);
    for (const SchemeInfo& info : schemes(catalogue, Stepping::fixed)) {
      if (!catalogue.pair(info.name, *scene.model) || repeats_a_drift(info)) continue;
      const Summaries seen = invariants(catalogue, info.name, *scene.model, fixed_step(1e5 * h, h));
      const double norm = seen.at("momentum_norm").max_drift,
                   momentum = seen.at("angular_momentum").max_drift;
      INFO(info.name << " on " << name << ", h = " << h << ": " << norm << ", " << momentum);
      // |A^T H|: the momentum that most schemes store is constant, so this shows the attitude. It may well be
      // kept to the last bit, or |m| alone be kept, as by Omelyan's leapfrog on a symmetric body.
      if (info.conserves_momentum) {
        CHECK(std::max(norm, momentum) <= 1e-12);
      } else if (h == 0.1) {
        CHECK(momentum >= 1e-9);
      }
      CHECK(within(seen.at("orthonormality").max_drift, 1e-15, 1e-12));
    }
  }
}

}  // namespace

TEST_CASE("schemes: without a moment a splitting is its drift", "[rotation][splitting]") {
  const Catalogue catalogue = full_catalogue();
  const Scene scene = load_scene(catalogue, "asymmetric-free-top");
  int compared = 0;
  for (const SchemeInfo& info : schemes(catalogue, Stepping::fixed)) {
    if (!repeats_a_drift(info)) continue;
    ++compared;
    const char* drift = info.name.ends_with("-dmv10") ? "dmv10" : "strang-exact-drift";
    const RunSpec spec = fixed_step(10.0, 0.1);
    INFO(info.name);
    CHECK(run_scheme(catalogue, info.name, *scene.model, spec).state ==
          run_scheme(catalogue, drift, *scene.model, spec).state);
  }
  CHECK(compared == 16);
}

TEST_CASE("schemes: momentum and orthonormality stay at roundoff over 1e5 small steps",
          "[rotation][invariants][long]") {
  check_momentum_and_orthonormality(0.01);
}

TEST_CASE("schemes: momentum and orthonormality stay at roundoff over 1e5 large steps",
          "[rotation][invariants][long]") {
  check_momentum_and_orthonormality(0.1);
}

TEST_CASE("schemes: the energy of a free body drifts", "[rotation][invariants][long]") {
  const Catalogue catalogue = full_catalogue();
  // Over 1e5 steps; relative to the energy, signed: an asymmetric body gains, this symmetric one loses.
  struct Case {
    const char* scene;
    double h, printed, fourth_order;
  };
  for (const Case& c : {Case{"asymmetric-free-top", 0.01, 1.96e-5, 1.05e-9},
                        Case{"asymmetric-free-top", 0.05, 1.16e-2, 1.56e-5},
                        Case{"asymmetric-free-top", 0.1, 9.03e-2, 9.94e-4},
                        Case{"symmetric-free-top", 0.01, -7.38e-5, -1.54e-8},
                        Case{"symmetric-free-top", 0.05, -4.64e-2, -2.42e-4}}) {
    SceneChanges longer;
    longer.t_end = 1e5 * c.h;
    const Scene scene = load_scene(catalogue, c.scene, longer);
    const auto drift = [&](const char* scheme) {
      const Summaries seen = invariants(catalogue, scheme, *scene.model, fixed_step(1e5 * c.h, c.h));
      const InvariantSummary& energy = seen.at("energy");
      CHECK(measure_drift(energy.times, energy.drift, 0.0).verdict == DriftVerdict::secular);
      return energy.drift.back();
    };
    INFO(c.scene << ", h = " << c.h);
    const double printed = drift("munjiza"), fourth_order = drift("rkmk4");
    INFO("munjiza " << printed << ", rkmk4 " << fourth_order);
    CHECK(within(printed / c.printed, 0.9, 1.1));
    CHECK(within(fourth_order / c.fourth_order, 0.9, 1.1));
    CHECK(std::abs(printed) > 10.0 * std::abs(fourth_order));
    // Above the roundoff of the same run, which the momentum shows.
    CHECK(std::abs(fourth_order) > 1e-10);
  }
}

TEST_CASE("schemes: declared properties hold, and no others", "[rotation][invariants][long]") {
  Catalogue catalogue = full_catalogue();
  add_schemes<TypeList<RigidBody<Free>>>(catalogue, TypeList<ExactSteps>{});
  for (const SchemeInfo& info : catalogue.schemes) {
    const bool on_bodies = std::any_of(catalogue.pairs.begin(), catalogue.pairs.end(), [&](const Pair& pair) {
      return pair.scheme == info.name && pair.model_type == typeid(RigidBody<Free>);
    });
    if (info.control || !on_bodies) continue;
    INFO(info.name);
    const Properties seen = observe(catalogue, info);
    CHECK(seen.energy == (info.conserves_energy ? Seen::holds : Seen::fails));
    CHECK(seen.momentum == (info.conserves_momentum ? Seen::holds : Seen::fails));
    // A closed form takes no steps, so there is none to undo.
    if (info.stepping != Stepping::closed_form)
      CHECK(seen.reversible == (info.reversible ? Seen::holds : Seen::fails));
  }
}

TEST_CASE("schemes: conservation under gravity", "[rotation][invariants][long]") {
  const Catalogue catalogue = full_catalogue();
  for (const char* name : {"asymmetric-heavy-top", "kovalevskaya"}) {
    const Scene scene = load_scene(catalogue, name);
    for (const SchemeInfo& info : schemes(catalogue, Stepping::fixed)) {
      if (!catalogue.pair(info.name, *scene.model)) continue;
      const double order = info.order_for("gravity").value();
      // The error of the energy is of the order of the scheme. Two halvings show it, one where the order is
      // high, from the least step from which they end above rounding.
      const int halvings = order > 5.0 ? 1 : 2;
      const double enough = 4e-13 * std::exp2(halvings * order);
      double h = 0.0125, coarser = 0.0;
      for (int left = halvings; left >= 0;) {
        const Summaries seen = invariants(catalogue, info.name, *scene.model, fixed_step(scene.t_end, h));
        const double energy = seen.at("energy").max_drift;
        INFO(info.name << " on " << name << ", h = " << h << ", energy " << energy << " after " << coarser);
        // The moment of the weight is horizontal at every stage, so the vertical momentum is kept.
        CHECK((seen.at("vertical_momentum").max_drift <= 1e-13) == info.conserves_momentum);
        CHECK(seen.at("orthonormality").max_drift <= 1e-13);
        if (coarser == 0.0 && energy < enough && h < 0.2) {
          h *= 2.0;
          continue;
        }
        if (coarser == 0.0 && energy < enough) {
          CHECK(order > 5.0);  // so exact that it meets rounding before its asymptotic range
          break;
        }
        if (coarser == 0.0 && seen.count("kovalevskaya")) CHECK(seen.at("kovalevskaya").max_drift >= 1e-13);
        if (coarser > 0.0) CHECK(std::abs(std::log2(coarser / energy) - order) <= (order < 8.0 ? 0.1 : 0.15));
        CHECK(energy >= 1e-13);
        coarser = energy;
        h *= 0.5;
        --left;
      }
    }
  }
}

TEST_CASE("schemes: the impulse of a moment fixed in space is kept", "[rotation][invariants][long]") {
  const Catalogue catalogue = full_catalogue();
  for (const char* name : {"space-moment", "rest-then-pushed"}) {
    const Scene scene = load_scene(catalogue, name);
    for (const SchemeInfo& info : schemes(catalogue, Stepping::fixed)) {
      if (!catalogue.pair(info.name, *scene.model)) continue;
      INFO(info.name << " on " << name);
      const Summaries seen = invariants(catalogue, info.name, *scene.model, fixed_step(scene.t_end, 0.01));
      CHECK((seen.at("momentum_balance").max_drift <= 5e-13) == info.conserves_momentum);
    }
  }
  // Seen against a model that is told another moment.
  const Scene scene = load_scene(catalogue, "space-moment");
  const Scene other = load_scene(catalogue, "space-moment", {{}, {"load.moment=[0.2, 0.1, -0.30001]"}});
  RunSpec spec = fixed_step(5.0, 0.01);
  const RunResult result = run_scheme(catalogue, "munjiza", *scene.model, spec);
  const auto right = scene.model->invariants(5.0, result.state),
             wrong = other.model->invariants(5.0, result.state),
             start = scene.model->invariants(0.0, scene.model->reference({0.0}).states.front());
  CHECK(std::abs(right[3] - start[3]) <= 5e-13);
  CHECK(std::abs(wrong[3] - start[3]) >= 1e-6);
}
