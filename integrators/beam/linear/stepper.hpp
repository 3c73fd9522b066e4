#pragma once
#include <optional>
#include <vector>

#include "integrators/beam/linear/chain.hpp"
#include "integrators/beam/stepper.hpp"

namespace gnomon::beam::linear {

/// The scheme on a beam of linear elements: steps of the kernels where Newton's iteration converges quickly,
/// of the general stepper elsewhere, and wherever springs, followers, hinges or damping act. The solutions
/// agree to what the tolerance leaves.
template <BeamForm M, Turning turning>
class FastStepper {
 public:
  using General = Stepper<M, turning>;

  FastStepper(const M& model, const typename M::State& state, const SchemeOptions& options,
              const Kernels* kernels = nullptr)
      : general_(model, state, options) {
    const std::string_view named = model.data().instructions;
    if (!kernels) kernels = named.empty() ? fitting_kernels(model.elements()) : kernels_named(named);
    if (!kernels || model.elements() < kernels->lanes || options.modified_newton ||
        options.linear_solver != LinearSolver::block)
      return;
    if (model.has_springs() || model.has_followers() || model.damping() != 0.0 || model.has_hinges()) return;
    const planar_beam::CrossSection& C = model.section();
    Beam beam{model.elements(),
              model.element().length,
              model.data().length,
              C.EA,
              C.GA,
              C.EI,
              C.rhoA,
              C.rhoI,
              {},
              options.newton_tol,
              general_.force_floor(),
              general_.mass_floor()};
    for (int i : model.held()) beam.held[i < 3 ? 0 : 1][i % 3] = true;
    std::vector<double> offsets;
    for (int e = 0; e < model.elements(); ++e)
      offsets.insert(offsets.end(), {model.point(e).e1, model.point(e).e2});
    chain_.emplace(beam, *kernels, offsets);
  }

  [[gnu::noinline]] Status step(const M& model, double t, double h) {
    if (!chain_) return general_.step(model, t, h);
    if (pause_ > 0) {
      --pause_;
      return general_.step(model, t, h);
    }
    general_.aim(model, t, h);
    if (!general_.jumps()) {
      if (!in_lanes_) take();
      if (step_in_lanes(model, h)) return Status::ok;
      pause_ = patience;
    }
    give();
    return general_.step(model, t, h);
  }
  typename M::State view(const M& model) const {
    if (!in_lanes_) return general_.view(model);
    typename General::Vector u(model.unknowns()), v(model.unknowns());
    std::vector<PointHistory> history(model.point_count());
    chain_->give(u.data(), v.data(), history.data());
    return General::state_of(model, u, v, history);
  }
  Cost cost(long steps) const {
    Cost cost = general_.cost(steps);
    if (!chain_) return cost;
    cost.rhs += chain_->evaluations;
    cost.jacobians += chain_->evaluations;
    cost.factorizations += chain_->evaluations;
    cost.newton_iterations += chain_->iterations;
    return cost;
  }
  /// Steps that the kernels have made.
  long fast_steps() const { return fast_steps_; }

 private:
  /// Steps that the general stepper makes before the kernels are tried again.
  static constexpr int patience = 16;

  bool step_in_lanes(const M& model, double h) {
    double imposed[2][3] = {};
    const int last = model.unknowns() - 3;
    const auto end_of = [&](int i) { return i < last ? i : 3 + i - last; };
    general_.drive(h);
    for (const auto& driven : general_.driven()) {
      const int i = end_of(driven.unknown);
      imposed[i / 3][i % 3] = general_.mean[driven.unknown];
      chain_->set_velocity(i, general_.v[driven.unknown]);
    }
    if (!chain_->step(turning == Turning::cayley, h, general_.external().data(), imposed)) return false;
    general_.settle(h);
    for (const auto& driven : general_.driven()) {
      chain_->set_displacement(end_of(driven.unknown), general_.u[driven.unknown]);
      chain_->set_velocity(end_of(driven.unknown), general_.v[driven.unknown]);
    }
    ++fast_steps_;
    return true;
  }
  void take() {
    chain_->take({general_.u.data(),
                  general_.v.data(),
                  general_.history.data(),
                  {general_.past[0].data(), general_.past[1].data(), general_.past[2].data()},
                  general_.known,
                  general_.past_step});
    in_lanes_ = true;
  }
  void give() {
    if (!in_lanes_) return;
    chain_->give(general_.u.data(), general_.v.data(), general_.history.data());
    double* const past[3] = {general_.past[0].data(), general_.past[1].data(), general_.past[2].data()};
    chain_->give_past(past);
    general_.known = chain_->known();
    general_.past_step = chain_->past_step();
    in_lanes_ = false;
  }

  General general_;
  std::optional<Chain> chain_;
  bool in_lanes_ = false;  ///< where the state is
  int pause_ = 0;
  long fast_steps_ = 0;
};

}  // namespace gnomon::beam::linear
