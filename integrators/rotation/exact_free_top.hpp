#pragma once
#include "src/run.hpp"

namespace gnomon::rotation {

/// The closed form of the free rigid body, evaluated in double precision where output is wanted.
struct ExactFreeTop {
  static constexpr SchemeInfo info{
      .name = "exact-free-top",
      .family = "rotation",
      .summary =
          "closed form of the free body: trigonometric, elliptic or hyperbolic functions as the case is",
      .citation =
          "C.G.J. Jacobi 1850; E. Celledoni, F. Fasso, N. Safstrom, A. Zanna, SIAM J. Sci. Comput. 30 (2008) "
          "2084-2112",
      .form = "closed form",
      .stepping = Stepping::closed_form,
      .conserves_energy = true,
      .conserves_momentum = true,
  };
  template <class M>
  static auto at(const M& model, double t) -> decltype(model.closed_form(t)) {
    return model.closed_form(t);
  }
  /// Of the errors of at(model, t), in the order of the model's metrics.
  template <class M>
  static auto error_bound(const M& model, double t) -> decltype(model.closed_form_bound(t)) {
    return model.closed_form_bound(t);
  }
};

}  // namespace gnomon::rotation
