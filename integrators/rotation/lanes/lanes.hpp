#pragma once
#include "integrators/rotation/lanes/extrapolation.hpp"
#include "src/ode.hpp"

namespace gnomon::rotation {
namespace lanes {

/// A model of one rigid body: its principal moments and a load of one of the kinds that the kernels know.
template <class M>
concept LaneBody = HasOde<M> && requires(const M& model) {
  model.inertia();
  { model.momentum_scale() } -> std::convertible_to<double>;
  model.load();
  { M::Load::kind } -> std::convertible_to<std::string_view>;
  requires M::Load::kind != "attitude_potential";
};

template <LaneBody M>
Problem problem_of(const M& model) {
  Problem problem{{}, Load::none, {}, model.momentum_scale()};
  const auto list = [](const auto& v) { return std::array<double, 3>{v[0], v[1], v[2]}; };
  problem.inertia = list(model.inertia());
  if constexpr (M::Load::kind == "gravity") {
    problem.load = Load::gravity;
    problem.load_vector = list((model.load().weight * model.load().centre).eval());
  } else if constexpr (M::Load::kind != "none") {
    problem.load = M::Load::kind == "space_moment" ? Load::space_moment : Load::body_moment;
    problem.load_vector = list(model.load().moment);
  }
  return problem;
}

template <LaneBody M, class Form>
class ErasedBody final : public gnomon::detail::Erased<BodySystem, M, Form> {
 public:
  ErasedBody(const M& model, Form form)
      : gnomon::detail::Erased<BodySystem, M, Form>(model, std::move(form)), problem_(problem_of(model)) {}
  const Problem& problem() const override { return problem_; }

 private:
  Problem problem_;
};

template <LaneBody M>
std::unique_ptr<BodySystem> erase_body(const M& model) {
  auto form = model.ode();
  return std::make_unique<ErasedBody<M, decltype(form)>>(model, std::move(form));
}

}  // namespace lanes

struct LanesExtrapolated {
  static constexpr SchemeInfo info{
      .name = "lanes-extrapolated-strang",
      .family = "rotation",
      .summary =
          "order 16 by extrapolation of eight step counts in the lanes of one core: Strang splitting of "
          "heavy symmetric tops, explicit midpoint rule of other bodies",
      .citation =
          "G. Strang, SIAM J. Numer. Anal. 5 (1968) 506-517; W.B. Gragg, SIAM J. Numer. Anal. 2 (1965) "
          "384-403; E. Hairer, S.P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd "
          "ed., Springer 1993, section II.9",
      .form = "rotation",
      .stepping = Stepping::adaptive,
  };
  template <lanes::LaneBody M>
  static std::unique_ptr<lanes::BodySystem> system(const M& model) {
    return lanes::erase_body(model);
  }
  static std::unique_ptr<AdaptiveSolver> make(const lanes::BodySystem& system, const RunSpec& spec) {
    return lanes::make_extrapolation(system, spec);
  }
};

}  // namespace gnomon::rotation
