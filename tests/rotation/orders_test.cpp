#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <set>
#include <sstream>

#include "integrators/rotation/exact_splitting.hpp"
#include "integrators/rotation/moser_veselov.hpp"
#include "src/study/converge.hpp"
#include "tests/catch.hpp"
#include "tests/rotation/book_scheme.hpp"
#include "tests/support/scenes.hpp"

using namespace gnomon;
using namespace gnomon::test;

namespace {

constexpr std::array<DeclaredOrder, 4> fourth{
    {{"none", 4}, {"gravity", 4}, {"space_moment", 4}, {"body_moment", 4}}};
constexpr std::array<DeclaredOrder, 4> half_impulse_orders = rotation::MunjizaHalfImpulse::info.orders;

constexpr SchemeInfo planted(std::string_view name, const std::array<DeclaredOrder, 4>& orders) {
  return {
      .name = name, .family = "test", .summary = "", .citation = "", .form = "rotation", .orders = orders};
}

// A right copy of each of the four schemes, then copies with one defect each.
struct Printed
    : BookStep<BookCoefficients{
          .stage_impulse = 1.0, .stage_moments = false, .first_commutator = 0.0, .last_commutator = 0.0}> {
  static constexpr SchemeInfo info = planted("printed", rotation::Munjiza::info.orders);
};
struct HalfImpulse
    : BookStep<BookCoefficients{.stage_moments = false, .first_commutator = 0.0, .last_commutator = 0.0}> {
  static constexpr SchemeInfo info = planted("half-impulse", half_impulse_orders);
};
struct StageMoments : BookStep<BookCoefficients{.first_commutator = 0.0, .last_commutator = 0.0}> {
  static constexpr SchemeInfo info = planted("stage-moments", rotation::MunjizaStageMoments::info.orders);
};
struct Fourth : BookStep<BookCoefficients{}> {
  static constexpr SchemeInfo info = planted("fourth", fourth);
};
using RightCopies = TypeList<Printed, HalfImpulse, StageMoments, Fourth>;

struct SignsReversed : BookStep<BookCoefficients{.first_commutator = -1.0, .last_commutator = -1.0}> {
  static constexpr SchemeInfo info = planted("signs-reversed", fourth);
};
struct LastCommutatorOff : BookStep<BookCoefficients{.last_commutator = 1.001}> {
  static constexpr SchemeInfo info = planted("last-commutator-off", fourth);
};
struct FirstCommutatorMissing : BookStep<BookCoefficients{.first_commutator = 0.0}> {
  static constexpr SchemeInfo info = planted("first-commutator-missing", fourth);
};
struct WeightOff : BookStep<BookCoefficients{.weight3 = 2.002}> {
  static constexpr SchemeInfo info = planted("weight-off", fourth);
};
struct WeightOffByAMillionth : BookStep<BookCoefficients{.weight3 = 2.000002}> {
  static constexpr SchemeInfo info = planted("weight-off-by-a-millionth", fourth);
};
struct WeightsShifted : BookStep<BookCoefficients{.weight2 = 2.002, .weight3 = 1.998}> {
  static constexpr SchemeInfo info = planted("weights-shifted", fourth);
};
struct MomentWeightsShifted : BookStep<BookCoefficients{.moment_weight2 = 2.002, .moment_weight3 = 1.998}> {
  static constexpr SchemeInfo info = planted("moment-weights-shifted", fourth);
};
struct FullImpulse
    : BookStep<BookCoefficients{
          .stage_impulse = 1.0, .stage_moments = false, .first_commutator = 0.0, .last_commutator = 0.0}> {
  static constexpr SchemeInfo info = planted("full-impulse", half_impulse_orders);
};
struct PreviousStage : BookStep<BookCoefficients{.stage_moments = false,
                                                 .first_commutator = 0.0,
                                                 .last_commutator = 0.0,
                                                 .from_previous_stage = true}> {
  static constexpr SchemeInfo info = planted("rotates-the-previous-stage", half_impulse_orders);
};
// An order that is higher than declared is a wrong declaration, too.
struct BetterThanDeclared : BookStep<BookCoefficients{.first_commutator = 0.0, .last_commutator = 0.0}> {
  static constexpr SchemeInfo info = planted("better-than-declared", rotation::Munjiza::info.orders);
};
using FourthOrderDefects = TypeList<SignsReversed, LastCommutatorOff, FirstCommutatorMissing, WeightOff,
                                    WeightOffByAMillionth, WeightsShifted, MomentWeightsShifted>;
using HalfImpulseDefects = TypeList<FullImpulse, PreviousStage, BetterThanDeclared>;

// Splittings and a preprocessed Moser-Veselov step with a defect: of 1e-6 in one coefficient, or a sign.
constexpr auto steps_of = [](const auto& splitting) { return splitting.drifts; };
template <std::size_t n>
constexpr auto changed(std::array<double, n> steps, std::size_t k, double factor) {
  const double by = steps[k] * (factor - 1.0);
  steps[k] += by;
  if (k != n - 1 - k) steps[n - 1 - k] += by;
  steps[n / 2] -= 2.0 * by;  // the sum stays 1 and the sequence symmetric
  return rotation::composition(steps);
}
template <std::size_t n>
constexpr auto unbalanced(std::array<double, n> steps, std::size_t k, double factor) {
  steps[k] *= factor;
  return rotation::composition(steps);
}
constexpr auto yoshida4_copy = changed(steps_of(rotation::yoshida4), 0, 1.0);
constexpr auto yoshida4_sign = changed(steps_of(rotation::yoshida4), 0, -1.0);
constexpr auto kahan_li8_copy = changed(steps_of(rotation::kahan_li8), 2, 1.0);
constexpr auto kahan_li8_off = changed(steps_of(rotation::kahan_li8), 2, 1.0 + 1e-6);
constexpr auto kahan_li8_one_off = unbalanced(steps_of(rotation::kahan_li8), 2, 1.0 + 1e-6);
constexpr auto kahan_li8_sign = changed(steps_of(rotation::kahan_li8), 2, -1.0);

/// The first coefficient of sigma, s1/(6 d), times `factor`.
struct FirstCoefficient {
  double factor = 1.0;
};
template <FirstCoefficient first>
class PlantedMoserVeselov {
 public:
  static constexpr bool exact = false;
  explicit PlantedMoserVeselov(const Vector3& inertia) : inertia_(inertia), preprocessing_(inertia) {}
  Status turn(const Vector3& m, double tau, rotation::Quaternion& by) {
    const double scale = inertia_.mean();
    const Vector3 I = inertia_ / scale, scaled = tau / scale * m;
    const double change = (first.factor - 1.0) * I.sum() / (6.0 * I.prod()) * 0.5 * scaled.squaredNorm();
    const Vector3 inverse = scale * preprocessing_.moments(m, tau).cwiseInverse() + change * I.cwiseInverse();
    Vector3 c;
    const Status status = rotation::solve_cayley<rotation::CayleyTerms{false, true}>(
        Vector3(scale * inverse.cwiseInverse()), 0.5 * tau * m, c, iterations_);
    by = rotation::cayley(c);
    return status;
  }
  long iterations() const { return iterations_; }

 private:
  Vector3 inertia_;
  rotation::Preprocessing<10> preprocessing_;
  long iterations_ = 0;
};

// The ends of the names choose the ladder of steps.
struct Yoshida4Copy : rotation::Kicked<rotation::ExactDrift, yoshida4_copy> {
  static constexpr SchemeInfo info =
      planted("yoshida4-copy-exact-drift", rotation::Yoshida4ExactDrift::info.orders);
};
struct Yoshida4Sign : rotation::Kicked<rotation::ExactDrift, yoshida4_sign> {
  static constexpr SchemeInfo info =
      planted("yoshida4-sign-exact-drift", rotation::Yoshida4ExactDrift::info.orders);
};
struct KahanLi8Copy : rotation::Kicked<rotation::ExactDrift, kahan_li8_copy> {
  static constexpr SchemeInfo info =
      planted("kahan-li8-copy-exact-drift", rotation::KahanLi8ExactDrift::info.orders);
};
struct KahanLi8Off : rotation::Kicked<rotation::ExactDrift, kahan_li8_off> {
  static constexpr SchemeInfo info =
      planted("kahan-li8-off-exact-drift", rotation::KahanLi8ExactDrift::info.orders);
};
struct KahanLi8OneOff : rotation::Kicked<rotation::ExactDrift, kahan_li8_one_off> {
  static constexpr SchemeInfo info =
      planted("kahan-li8-one-off-exact-drift", rotation::KahanLi8ExactDrift::info.orders);
};
struct KahanLi8Sign : rotation::Kicked<rotation::ExactDrift, kahan_li8_sign> {
  static constexpr SchemeInfo info =
      planted("kahan-li8-sign-exact-drift", rotation::KahanLi8ExactDrift::info.orders);
};
struct Dmv10Copy : rotation::Kicked<PlantedMoserVeselov<FirstCoefficient{}>, rotation::strang> {
  static constexpr SchemeInfo info = planted("dmv10-copy", rotation::Dmv10::info.orders);
};
struct Dmv10Off : rotation::Kicked<PlantedMoserVeselov<FirstCoefficient{1.0 + 1e-6}>, rotation::strang> {
  static constexpr SchemeInfo info = planted("dmv10-off", rotation::Dmv10::info.orders);
};
struct Dmv10Sign : rotation::Kicked<PlantedMoserVeselov<FirstCoefficient{-1.0}>, rotation::strang> {
  static constexpr SchemeInfo info = planted("dmv10-sign", rotation::Dmv10::info.orders);
};

const char* const scene_of_class[] = {"asymmetric-free-top", "space-moment", "body-moment",
                                      "asymmetric-heavy-top"};

// Steps largest, largest/2^factor, ..
struct Ladder {
  double largest, factor;
  int count;
};

// High orders and splittings with small error constants leave their asymptotic range for rounding within a
// few halvings of the step. They need a denser ladder of larger steps, and moments that disturb the free
// motion more.
bool is_accurate(const SchemeInfo& scheme, double order) {
  const auto ends_with = [&](std::string_view end) { return scheme.name.ends_with(end); };
  return order > 5.0 || (order > 3.0 && (ends_with("-exact-drift") || ends_with("-dmv10")));
}
const char* const strong_moment[] = {"load.moment=[0.9, -0.9, 1.3]", "body.angular_velocity=[0.8, 0.3, 0.7]"};

Scene scene_for(const Catalogue& catalogue, const char* name, const SchemeInfo& scheme, double order) {
  SceneChanges changes;
  if (is_accurate(scheme, order) && std::strstr(name, "-moment")) {
    changes.t_end = 1.0;
    changes.set.assign(std::begin(strong_moment), std::end(strong_moment));
  }
  return load_scene(catalogue, name, changes);
}

std::vector<double> steps_for(const Scene& scene, const SchemeInfo& scheme, double order) {
  Ladder ladder{};
  if (is_accurate(scheme, order)) {
    const std::string_view load = scene.model->load_class();
    if (load == "none")
      ladder = {0.2, 0.25, 20};
    else if (load == "gravity")
      ladder = order > 5.0 ? Ladder{0.25, 0.25, 20} : Ladder{0.05, 0.25, 12};
    else
      ladder = order > 5.0 ? Ladder{0.55, 0.25, 20} : Ladder{0.1, 0.25, 14};
  } else if (scheme.name == "cf4" || scheme.name == "rk4-quaternion") {
    ladder = {0.014, 0.3, 11};  // the terms of order 5 are large
  } else {
    // A scheme of order 1 needs smaller steps before its second term is gone; one of order 4 would meet
    // rounding there.
    std::vector<double> steps = step_ladder(scene, scheme, order == 1.0 ? 21 : 14, 0.5);
    if (order == 1.0) steps.erase(steps.begin(), steps.begin() + 8);
    return steps;
  }
  std::vector<double> steps;
  for (int k = 0; k < ladder.count; ++k) steps.push_back(ladder.largest * std::exp2(-ladder.factor * k));
  return steps;
}

// One scheme on one scene, by the study that the command line runs.
Convergence study_of(Runner& runner, const Scene& scene, const SchemeInfo& scheme, double order) {
  StudyOptions options;
  options.integrators = {std::string(scheme.name)};
  options.steps = steps_for(scene, scheme, order);
  options.watch = 1;
  std::ostringstream log;
  output::Progress progress(0, output::ProgressMode::silent, log);
  return converge(runner, scene, options, progress);
}

std::vector<OrderRow> observe(Runner& runner, const Scene& scene, const SchemeInfo& scheme) {
  const double order = scheme.order_for(scene.model->load_class()).value_or(1.0);
  return study_of(runner, scene, scheme, order).orders;
}

bool as_declared(const OrderRow& row) {
  return row.expected && row.order.observed &&
         std::abs(*row.order.observed - *row.expected) <= (*row.expected < 8.0 ? 0.1 : 0.15);
}

}  // namespace

TEST_CASE("schemes: observed orders are the declared ones", "[rotation][orders][long]") {
  const Catalogue catalogue = full_catalogue();
  ReferenceStore references("");
  const std::atomic<bool> stop{false};
  Runner runner(catalogue, references, stop);
  const auto fixed = schemes(catalogue, Stepping::fixed);
  REQUIRE(fixed.size() >= 4);
  std::set<std::string, std::less<>> classes;
  for (const char* name : scene_of_class) {
    const std::string load_class(load_scene(catalogue, name).model->load_class());
    classes.insert(load_class);
    for (const SchemeInfo& scheme : fixed) {
      const std::optional<double> order = scheme.order_for(load_class);
      const Scene scene = scene_for(catalogue, name, scheme, order.value_or(0.0));
      if (!catalogue.pair(scheme.name, *scene.model)) continue;
      const Convergence study = study_of(runner, scene, scheme, order.value_or(2.0));
      REQUIRE(study.orders.size() == scene.model->metrics().size());
      for (const OrderRow& row : study.orders) {
        INFO(scheme.name << " on " << name << ", " << row.metric << ": " << row.order.verdict << ", declared "
                         << row.expected.value_or(-1));
        if (!order) continue;
        CHECK(as_declared(row));
        CHECK(row.order.points >= 6);
      }
      if (order) continue;
      // No order is declared where a step is exact.
      INFO(scheme.name << " on " << name);
      for (const Row& row : study.rows) {
        REQUIRE(row.result.status == Status::ok);
        for (double error : row.error) CHECK(error <= 5e-14);
      }
    }
  }
  // Every load class in which a scheme declares an order has been looked at.
  for (const SchemeInfo& scheme : fixed)
    if (scheme.family == "rotation")
      for (const DeclaredOrder& declared : scheme.orders)
        if (!declared.load_class.empty()) CHECK(classes.count(declared.load_class) == 1);
}

TEST_CASE("schemes: the table of orders is the one that the documentation states", "[rotation][orders]") {
  const auto orders = [](const SchemeInfo& info) {
    return std::array<double, 4>{
        info.order_for("none").value_or(0), info.order_for("space_moment").value_or(0),
        info.order_for("gravity").value_or(0), info.order_for("body_moment").value_or(0)};
  };
  CHECK(orders(rotation::Munjiza::info) == std::array<double, 4>{2, 1, 1, 1});
  CHECK(orders(rotation::MunjizaHalfImpulse::info) == std::array<double, 4>{2, 2, 1, 1});
  CHECK(orders(rotation::MunjizaStageMoments::info) == std::array<double, 4>{2, 2, 2, 2});
  CHECK(orders(rotation::Rkmk4::info) == std::array<double, 4>{4, 4, 4, 4});
  CHECK(!rotation::Rkmk4::info.order_for("no such load"));
}

TEST_CASE("schemes: planted defects are seen in the observed orders", "[rotation][orders][long]") {
  Catalogue catalogue;
  add_models(catalogue);
  add_schemes<TypeList<RigidBody<Gravity>, RigidBody<SpaceMoment>>>(catalogue, RightCopies{});
  const std::size_t right = catalogue.schemes.size();
  add_schemes<TypeList<RigidBody<Gravity>>>(catalogue, FourthOrderDefects{});
  add_schemes<TypeList<RigidBody<SpaceMoment>>>(catalogue, HalfImpulseDefects{});
  ReferenceStore references("");
  const std::atomic<bool> stop{false};
  Runner runner(catalogue, references, stop);
  for (std::size_t k = 0; k < catalogue.schemes.size(); ++k) {
    const SchemeInfo& scheme = catalogue.schemes[k];
    int wrong = 0;
    std::ostringstream seen;
    for (const char* name : {"space-moment", "asymmetric-heavy-top"}) {
      const Scene scene = load_scene(catalogue, name);
      if (!catalogue.pair(scheme.name, *scene.model)) continue;
      for (const OrderRow& row : observe(runner, scene, scheme)) {
        wrong += as_declared(row) ? 0 : 1;
        seen << name << " " << row.metric << ": " << row.order.observed.value_or(-1) << "\n";
        // The sign of the commutators is worth two orders.
        if (scheme.name == SignsReversed::info.name) {
          REQUIRE(row.order.observed);
          CHECK(std::abs(*row.order.observed - 2.0) <= 0.1);
        }
      }
    }
    INFO(scheme.name << "\n" << seen.str());
    CHECK((wrong == 0) == (k < right));
  }
}

TEST_CASE("schemes: planted defects of splittings and of the preprocessing are seen in the observed orders",
          "[rotation][orders][long]") {
  Catalogue catalogue;
  add_models(catalogue);
  add_schemes<TypeList<RigidBody<Gravity>>>(catalogue, TypeList<Yoshida4Copy, KahanLi8Copy>{});
  add_schemes<TypeList<RigidBody<Free>>>(catalogue, TypeList<Dmv10Copy>{});
  const std::size_t right = catalogue.schemes.size();
  add_schemes<TypeList<RigidBody<Gravity>>>(
      catalogue, TypeList<Yoshida4Sign, KahanLi8Off, KahanLi8OneOff, KahanLi8Sign>{});
  add_schemes<TypeList<RigidBody<Free>>>(catalogue, TypeList<Dmv10Off, Dmv10Sign>{});
  ReferenceStore references("");
  const std::atomic<bool> stop{false};
  Runner runner(catalogue, references, stop);
  for (std::size_t k = 0; k < catalogue.schemes.size(); ++k) {
    const SchemeInfo& scheme = catalogue.schemes[k];
    int wrong = 0, looked = 0;
    std::ostringstream seen;
    for (const char* name : {"asymmetric-free-top", "asymmetric-heavy-top"}) {
      const Scene scene = load_scene(catalogue, name);
      if (!catalogue.pair(scheme.name, *scene.model)) continue;
      for (const OrderRow& row : observe(runner, scene, scheme)) {
        ++looked;
        wrong += as_declared(row) ? 0 : 1;
        seen << name << " " << row.metric << ": " << row.order.verdict << "\n";
      }
    }
    INFO(scheme.name << "\n" << seen.str());
    CHECK(looked == 2);
    CHECK(wrong == (k < right ? 0 : looked));
  }
}

TEST_CASE("schemes: the production code is the scheme as printed", "[rotation]") {
  Catalogue catalogue = full_catalogue();
  add_schemes<TypeList<RigidBody<Free>, RigidBody<Gravity>, RigidBody<SpaceMoment>>>(catalogue,
                                                                                     RightCopies{});
  for (const char* name : {"asymmetric-free-top", "space-moment", "asymmetric-heavy-top"}) {
    const Scene scene = load_scene(catalogue, name);
    RunSpec spec;
    spec.t_end = 5.0;
    spec.step = 0.05;
    const auto apart = [&](std::string_view a, std::string_view b) {
      const auto d = scene.model->distance(run_scheme(catalogue, a, *scene.model, spec).state,
                                           run_scheme(catalogue, b, *scene.model, spec).state);
      return std::max(d[0], d[1]);
    };
    INFO(name);
    CHECK(apart("munjiza", "printed") <= 1e-13);
    CHECK(apart("munjiza-half-impulse", "half-impulse") <= 1e-13);
    CHECK(apart("munjiza-stage-moments", "stage-moments") <= 1e-13);
    CHECK(apart("rkmk4", "fourth") <= 1e-13);
    CHECK(apart("rkmk4", "stage-moments") > 1e-5);
  }
}

TEST_CASE("schemes: without a moment three of the four are one and the same", "[rotation]") {
  const Catalogue catalogue = full_catalogue();
  for (const char* name : {"asymmetric-free-top", "dzhanibekov", "symmetric-free-top", "space-moment",
                           "body-moment", "asymmetric-heavy-top", "rest-then-pushed"}) {
    const Scene scene = load_scene(catalogue, name);
    RunSpec spec;
    spec.t_end = 10.0;
    spec.step = 0.01;
    const auto final = [&](const char* scheme) {
      const RunResult result = run_scheme(catalogue, scheme, *scene.model, spec);
      REQUIRE(result.status == Status::ok);
      REQUIRE(result.cost.steps == 1000);
      return result.state;
    };
    const auto same = [](const std::vector<double>& a, const std::vector<double>& b) {
      return std::memcmp(a.data(), b.data(), sizeof(double) * a.size()) == 0;
    };
    const auto printed = final("munjiza"), half = final("munjiza-half-impulse"),
               stage = final("munjiza-stage-moments"), fourth_order = final("rkmk4");
    INFO(name);
    const bool is_free = scene.model->load_class() == "none";
    CHECK(same(printed, half) == is_free);
    CHECK(same(printed, stage) == is_free);
    CHECK(same(half, stage) == is_free);
    CHECK(!same(stage, fourth_order));
  }
}
