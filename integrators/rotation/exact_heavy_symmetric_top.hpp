#pragma once
#include "src/run.hpp"

namespace gnomon::rotation {

/// The closed form of the heavy symmetric top, evaluated where output is wanted.
struct ExactHeavySymmetricTop {
  static constexpr SchemeInfo info{
      .name = "exact-heavy-symmetric-top",
      .family = "rotation",
      .summary = "closed form of Lagrange's top: elliptic functions and integrals of the third kind",
      .citation =
          "E.T. Whittaker, A Treatise on the Analytical Dynamics of Particles and Rigid Bodies, 4th ed., "
          "Cambridge 1937, sections 71-72",
      .form = "closed form",
      .stepping = Stepping::closed_form,
  };
  template <class M>
  static auto at(const M& model, double t) -> decltype(model.symmetric_top(t)) {
    return model.symmetric_top(t);
  }
  template <class M>
  static auto refusal(const M& model) -> decltype(model.symmetric_top_refusal()) {
    return model.symmetric_top_refusal();
  }
};

}  // namespace gnomon::rotation
