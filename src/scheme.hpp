#pragma once
#include <array>
#include <concepts>
#include <optional>
#include <string_view>

#include "src/model.hpp"
#include "src/status.hpp"

namespace gnomon {

/// How far a scheme is told to go at once.
enum class Stepping {
  fixed,       ///< equal steps, `--step`
  adaptive,    ///< a tolerance, `--tol`
  closed_form  ///< evaluated where output is wanted; neither
};

constexpr std::string_view to_string(Stepping stepping) {
  switch (stepping) {
    case Stepping::fixed:
      return "fixed step";
    case Stepping::adaptive:
      return "adaptive";
    case Stepping::closed_form:
      return "closed form";
  }
  return "";
}

/// What solves the linear systems of beam schemes: elimination of the chain's blocks, or solvers that know
/// less of it, to be compared with.
enum class LinearSolver { block, band, lapack, klu, sparselu };
inline constexpr std::array<std::string_view, 5> linear_solver_names{"block", "band", "lapack", "klu",
                                                                     "sparselu"};
constexpr std::string_view to_string(LinearSolver solver) {
  return linear_solver_names[static_cast<std::size_t>(solver)];
}

/// What a user may tell a scheme of equal steps; each takes what concerns it.
struct SchemeOptions {
  double newton_tol = 1e-10;              ///< of nonlinear equations, relative residual
  std::optional<double> spectral_radius;  ///< at infinite frequency; none: the scheme's own default
  bool modified_newton = false;           ///< one tangent a step for as long as it serves
  LinearSolver linear_solver = LinearSolver::block;
};

/// Which of the SchemeOptions a scheme uses, besides the spectral radius; the others do not concern it.
struct OptionUse {
  bool newton_tol = false, modified_newton = false, linear_solver = false;
};

/// The order of the error of a scheme on models of one load class.
struct DeclaredOrder {
  std::string_view load_class;
  double order;
};

/// What a scheme declares about itself. The command line, the tables and the tests are driven by it, and a
/// test fails where a declared property does not hold *and* where one holds that is not declared.
struct SchemeInfo {
  std::string_view name;
  std::string_view family;
  std::string_view summary;
  std::string_view citation;  ///< with equation numbers
  std::string_view form;      ///< the form of a model that it needs: "rotation", "ode", "dae", "closed form"
  Stepping stepping = Stepping::fixed;
  int stages = 0;                         ///< evaluations of the rates a step; 0 where it varies
  std::array<DeclaredOrder, 4> orders{};  ///< empty entries have an empty load class
  bool reversible = false;                ///< a step back undoes a step, to roundoff
  bool conserves_energy = false;          ///< of a body or beam without load, to roundoff
  bool conserves_momentum = false;        ///< likewise
  bool control = false;                   ///< a negative control: only run when asked for by name
  /// Orders of the angular momentum of a body, where they differ from those of its orientation.
  std::array<DeclaredOrder, 2> momentum_orders{};
  /// Range of SchemeOptions::spectral_radius; none where the scheme does not take it.
  std::optional<std::array<double, 2>> spectral_radii{};
  OptionUse uses{};

  constexpr std::optional<double> order_for(std::string_view load_class) const {
    for (const DeclaredOrder& declared : orders)
      if (!declared.load_class.empty() && declared.load_class == load_class) return declared.order;
    return std::nullopt;
  }
  /// The same in one class of error, by its name.
  constexpr std::optional<double> order_for(std::string_view load_class, std::string_view metric) const {
    if (metric == "momentum")
      for (const DeclaredOrder& declared : momentum_orders)
        if (!declared.load_class.empty() && declared.load_class == load_class) return declared.order;
    return order_for(load_class);
  }
};

template <class S>
concept Scheme = requires {
  { S::info } -> std::convertible_to<SchemeInfo>;
};

/// A scheme of equal steps on a model. Its `State` is everything it needs to go on; a copy of it is a
/// checkpoint. `step` returns Status::ok, or why it could not (the state is then worthless); it allocates
/// nothing. `start` may take SchemeOptions as a third argument. `caution(model, state, h)`, where a scheme
/// has it, tells why steps of that size are likely to fail from there; empty if they are not. It is asked at
/// the start and along the run.
template <class S, class M>
concept FixedStepOn = Scheme<S> && Model<M> &&
    requires(const M& model, const typename M::State& start, double t, double h,
             typename S::template State<M>& state, const typename S::template State<M>& view) {
  { S::start(model, start) } -> std::same_as<typename S::template State<M>>;
  { S::step(model, state, t, h) } -> std::same_as<Status>;
  { S::view(model, view) } -> std::same_as<typename M::State>;
  { S::cost(model, view, 1L) } -> std::same_as<Cost>;  // after that many steps
};

/// A closed form: the state at any time, at once.
template <class S, class M>
concept ClosedFormOn = Scheme<S> && Model<M> && requires(const M& model, double t) {
  { S::at(model, t) } -> std::same_as<typename M::State>;
};

}  // namespace gnomon
