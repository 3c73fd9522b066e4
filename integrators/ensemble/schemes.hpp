#pragma once
#include <memory>

#include "integrators/ensemble/arrays.hpp"
#include "integrators/ensemble/kernels.hpp"
#include "integrators/ensemble/team.hpp"
#include "integrators/rotation/munjiza.hpp"
#include "src/model.hpp"
#include "src/scheme.hpp"

namespace gnomon::ensemble {

/// What these schemes need of a model: bodies that do not act on one another, each with its principal inertia
/// [kg m^2] and what its load is made of (see Load), and how the work is to be done.
template <class M>
concept EnsembleForm = Model<M> && requires(const M& model, const typename M::State& state, std::size_t i) {
  { load_named(M::variant) } -> std::same_as<Load>;
  { model.bodies() } -> std::convertible_to<std::size_t>;
  { model.inertia(i) } -> std::convertible_to<Vector3>;
  { model.load_vector(i) } -> std::convertible_to<Vector3>;
  { model.threads() } -> std::convertible_to<int>;
  { model.instructions() } -> std::convertible_to<InstructionSet>;
  { state.bodies[i].attitude } -> std::convertible_to<Matrix3>;
  { state.bodies[i].angular_momentum } -> std::convertible_to<Vector3>;
};

/// A copy shares the threads, which keep nothing of a step.
struct EnsembleState {
  Arrays arrays;
  Step step;
  std::shared_ptr<Team> team;
};

EnsembleState start(std::size_t bodies, Scheme scheme, Load load, InstructionSet instructions, int threads);
void step_all(EnsembleState& state, double h);

/// A rotation scheme (its kernel) on the bodies of an ensemble. `Single` is the same scheme for one body.
template <class Single, Scheme kernel>
struct OnEnsemble {
  static constexpr SchemeInfo info = Single::info;
  template <EnsembleForm M>
  using State = EnsembleState;

  template <EnsembleForm M>
  static EnsembleState start(const M& model, const typename M::State& initial) {
    EnsembleState state = ensemble::start(model.bodies(), kernel, load_named(M::variant),
                                          model.instructions(), model.threads());
    for (std::size_t i = 0; i < model.bodies(); ++i) {
      const Matrix3& A = initial.bodies[i].attitude;
      const Vector3 &m = initial.bodies[i].angular_momentum, I = model.inertia(i), l = model.load_vector(i);
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t j = 0; j < 3; ++j) state.arrays.at(Field::attitude + 3 * k + j, i) = A(k, j);
        state.arrays.at(Field::momentum + k, i) = m[k];
        state.arrays.at(Field::inverse_inertia + k, i) = 1.0 / I[k];
        state.arrays.at(Field::load + k, i) = l[k];
      }
    }
    return state;
  }

  template <EnsembleForm M>
  static Status step(const M&, EnsembleState& state, double, double h) {
    step_all(state, h);
    return Status::ok;
  }

  template <EnsembleForm M>
  static typename M::State view(const M& model, const EnsembleState& state) {
    typename M::State seen = model.initial();
    for (std::size_t i = 0; i < model.bodies(); ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t j = 0; j < 3; ++j)
          seen.bodies[i].attitude(k, j) = state.arrays.at(Field::attitude + 3 * k + j, i);
        seen.bodies[i].angular_momentum[k] = state.arrays.at(Field::momentum + k, i);
      }
    return seen;
  }

  /// Counted for the ensemble as a whole.
  template <EnsembleForm M>
  static Cost cost(const M&, const EnsembleState&, long steps) {
    Cost cost;
    cost.steps = steps;
    cost.rhs = 4 * steps;
    if constexpr (load_named(M::variant) != Load::none)
      cost.moments = (kernel == Scheme::rkmk4 ? 4 : 1) * steps;
    return cost;
  }

  static double helper_cpu_seconds(const EnsembleState& state) { return state.team->helper_cpu_seconds(); }
};

using Munjiza = OnEnsemble<rotation::Munjiza, Scheme::munjiza>;
using Rkmk4 = OnEnsemble<rotation::Rkmk4, Scheme::rkmk4>;

}  // namespace gnomon::ensemble
