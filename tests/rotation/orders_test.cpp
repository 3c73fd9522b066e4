#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <set>
#include <sstream>

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
  return {.name = name, .family = "test", .summary = "", .citation = "", .form = "rotation", .orders = orders};
}

// A right copy of the method of order 4, then copies with one defect each.
struct RightCopy {
  static constexpr SchemeInfo info = planted("copy", fourth);
  static constexpr BookCoefficients coefficients{};
};
struct SignsReversed {
  static constexpr SchemeInfo info = planted("signs-reversed", fourth);
  static constexpr BookCoefficients coefficients{.first_commutator = -1.0, .last_commutator = -1.0};
};
struct LastCommutatorOff {
  static constexpr SchemeInfo info = planted("last-commutator-off-by-1e-3", fourth);
  static constexpr BookCoefficients coefficients{.last_commutator = 1.001};
};
struct FirstCommutatorMissing {
  static constexpr SchemeInfo info = planted("first-commutator-missing", fourth);
  static constexpr BookCoefficients coefficients{.first_commutator = 0.0};
};
struct WeightOff {
  static constexpr SchemeInfo info = planted("weight-off-by-1e-3", fourth);
  static constexpr BookCoefficients coefficients{.weight3 = 2.002};
};
struct WeightsShifted {
  static constexpr SchemeInfo info = planted("weights-shifted-by-1e-3", fourth);
  static constexpr BookCoefficients coefficients{.weight2 = 2.002, .weight3 = 1.998};
};
struct MomentWeightsShifted {
  static constexpr SchemeInfo info = planted("moment-weights-shifted", fourth);
  static constexpr BookCoefficients coefficients{.moment_weight2 = 2.2, .moment_weight3 = 1.8};
};
struct FullImpulse {
  static constexpr SchemeInfo info = planted("full-impulse-for-half", half_impulse_orders);
  static constexpr BookCoefficients coefficients{
      .stage_impulse = 1.0, .stage_moments = false, .first_commutator = 0.0, .last_commutator = 0.0};
};
struct PreviousStage {
  static constexpr SchemeInfo info = planted("rotates-the-previous-stage", half_impulse_orders);
  static constexpr BookCoefficients coefficients{
      .stage_moments = false, .first_commutator = 0.0, .last_commutator = 0.0, .from_previous_stage = true};
};
// The first-order scheme where a second-order one is declared has its counterpart: better than declared.
struct BetterThanDeclared {
  static constexpr SchemeInfo info = planted("better-than-declared", half_impulse_orders);
  static constexpr BookCoefficients coefficients{.first_commutator = 0.0, .last_commutator = 0.0};
};

using Defects = TypeList<BookScheme<SignsReversed>, BookScheme<LastCommutatorOff>,
                         BookScheme<FirstCommutatorMissing>, BookScheme<WeightOff>, BookScheme<WeightsShifted>,
                         BookScheme<MomentWeightsShifted>, BookScheme<FullImpulse>, BookScheme<PreviousStage>,
                         BookScheme<BetterThanDeclared>>;

const char* const scene_of_class[] = {"asymmetric-free-top", "space-moment", "body-moment",
                                      "asymmetric-heavy-top"};

// The orders of one scheme on one scene, by the study that the command line runs. A scheme of order 1 needs
// smaller steps before its second term is gone; one of order 4 would meet rounding there.
std::vector<OrderRow> observe(Runner& runner, const Scene& scene, const SchemeInfo& scheme) {
  const bool first = scheme.order_for(scene.model->load_class()).value_or(1.0) == 1.0;
  std::vector<double> steps = step_ladder(scene, first ? 21 : 14, 0.5);
  if (first) steps.erase(steps.begin(), steps.begin() + 8);
  StudyOptions options;
  options.integrators = {std::string(scheme.name)};
  options.steps = steps;
  options.watch = 1;
  std::ostringstream log;
  output::Progress progress(0, output::ProgressMode::silent, log);
  return converge(runner, scene, options, progress).orders;
}

bool as_declared(const OrderRow& row) {
  return row.expected && row.order.observed && std::abs(*row.order.observed - *row.expected) <= 0.1;
}

}  // namespace

TEST_CASE("schemes: observed orders are the declared ones", "[rotation][orders]") {
  const Catalogue catalogue = full_catalogue();
  ReferenceStore references("");
  const std::atomic<bool> stop{false};
  Runner runner(catalogue, references, stop);
  const auto fixed = schemes(catalogue, Stepping::fixed);
  REQUIRE(fixed.size() >= 4);
  std::set<std::string_view> classes;
  for (const char* name : scene_of_class) {
    const Scene scene = load_scene(catalogue, name);
    classes.insert(scene.model->load_class());
    for (const SchemeInfo& scheme : fixed) {
      if (!catalogue.pair(scheme.name, *scene.model)) continue;
      const auto rows = observe(runner, scene, scheme);
      REQUIRE(rows.size() == scene.model->metrics().size());
      for (const OrderRow& row : rows) {
        INFO(scheme.name << " on " << name << ", " << row.metric << ": " << row.order.verdict << ", declared "
                         << row.expected.value_or(-1));
        CHECK(as_declared(row));
        CHECK(row.order.points >= 6);
      }
    }
  }
  // Every load class in which a scheme declares an order has been looked at.
  for (const SchemeInfo& scheme : fixed)
    for (const DeclaredOrder& declared : scheme.orders)
      if (!declared.load_class.empty()) CHECK(classes.count(declared.load_class) == 1);
}

TEST_CASE("schemes: the table of orders is the one that the documentation states", "[rotation][orders]") {
  const auto orders = [](const SchemeInfo& info) {
    return std::array<double, 4>{info.order_for("none").value_or(0), info.order_for("space_moment").value_or(0),
                                 info.order_for("gravity").value_or(0),
                                 info.order_for("body_moment").value_or(0)};
  };
  CHECK(orders(rotation::Munjiza::info) == std::array<double, 4>{2, 1, 1, 1});
  CHECK(orders(rotation::MunjizaHalfImpulse::info) == std::array<double, 4>{2, 2, 1, 1});
  CHECK(orders(rotation::MunjizaStageMoments::info) == std::array<double, 4>{2, 2, 2, 2});
  CHECK(orders(rotation::Rkmk4::info) == std::array<double, 4>{4, 4, 4, 4});
  CHECK(!rotation::Rkmk4::info.order_for("no such load"));
}

TEST_CASE("schemes: planted defects are seen in the observed orders", "[rotation][orders]") {
  Catalogue catalogue;
  add_models(catalogue);
  add_schemes<Models>(catalogue, TypeList<BookScheme<RightCopy>>{});
  add_schemes<Models>(catalogue, Defects{});
  ReferenceStore references("");
  const std::atomic<bool> stop{false};
  Runner runner(catalogue, references, stop);
  for (const SchemeInfo& scheme : catalogue.schemes) {
    int wrong = 0;
    std::ostringstream seen;
    for (const char* name : scene_of_class) {
      const Scene scene = load_scene(catalogue, name);
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
    if (scheme.name == RightCopy::info.name)
      CHECK(wrong == 0);
    else
      CHECK(wrong > 0);
  }
}

TEST_CASE("schemes: the production code is the scheme as printed", "[rotation]") {
  struct Printed {
    static constexpr SchemeInfo info = planted("printed", {});
    static constexpr BookCoefficients coefficients{
        .stage_impulse = 1.0, .stage_moments = false, .first_commutator = 0.0, .last_commutator = 0.0};
  };
  struct HalfImpulse {
    static constexpr SchemeInfo info = planted("half", {});
    static constexpr BookCoefficients coefficients{
        .stage_moments = false, .first_commutator = 0.0, .last_commutator = 0.0};
  };
  struct StageMoments {
    static constexpr SchemeInfo info = planted("stage", {});
    static constexpr BookCoefficients coefficients{.first_commutator = 0.0, .last_commutator = 0.0};
  };
  const Catalogue catalogue = full_catalogue();
  for (const char* name : scene_of_class) {
    const Scene scene = load_scene(catalogue, name);
    RunSpec spec;
    spec.t_end = 5.0;
    spec.step = 0.05;
    spec.record = false;
    with_rigid_body(scene, [&](const auto& model) {
      using M = std::decay_t<decltype(model)>;
      const std::pair<RunResult, RunResult> runs[] = {
          {run<M, rotation::Munjiza>(model, spec), run<M, BookScheme<Printed>>(model, spec)},
          {run<M, rotation::MunjizaHalfImpulse>(model, spec), run<M, BookScheme<HalfImpulse>>(model, spec)},
          {run<M, rotation::MunjizaStageMoments>(model, spec), run<M, BookScheme<StageMoments>>(model, spec)},
          {run<M, rotation::Rkmk4>(model, spec), run<M, BookScheme<RightCopy>>(model, spec)}};
      for (const auto& [production, printed] : runs) {
        const auto d = scene.model->distance(production.state, printed.state);
        INFO(name << ": " << d[0] << " " << d[1]);
        CHECK(d[0] <= 1e-13);
        CHECK(d[1] <= 1e-13);
      }
      // The four differ among each other by far more, where they are not one and the same.
      CHECK(scene.model->distance(runs[2].first.state, runs[3].first.state)[0] > 1e-6);
    });
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
