#pragma once
#include "integrators/rotation/exact_drift.hpp"
#include "integrators/rotation/kicked.hpp"

namespace gnomon::rotation {

/// No order is declared without a moment: a step is then exact. `drifts` is their number.
constexpr SchemeInfo exact_drift_info(std::string_view name, std::string_view summary,
                                      std::string_view citation, int drifts, double order) {
  return {
      .name = name,
      .family = "rotation",
      .summary = summary,
      .citation = citation,
      .form = "rotation",
      .stages = drifts,
      .orders = {{{"gravity", order}, {"space_moment", order}, {"body_moment", order}}},
      .reversible = true,
      .conserves_energy = true,
      .conserves_momentum = true,
  };
}

struct StrangExactDrift : Kicked<ExactDrift, strang> {
  static constexpr SchemeInfo info = exact_drift_info(
      "strang-exact-drift", "half kick, exact motion of the free body, half kick; exact without a moment",
      "G. Strang, SIAM J. Numer. Anal. 5 (1968) 506-517; E. Celledoni, F. Fasso, N. Safstrom, A. Zanna, "
      "SIAM J. Sci. Comput. 30 (2008) 2084-2112",
      1, 2);
};
struct Yoshida4ExactDrift : Kicked<ExactDrift, yoshida4> {
  static constexpr SchemeInfo info =
      exact_drift_info("yoshida4-exact-drift", "three steps of strang-exact-drift, the middle one backwards",
                       yoshida4_citation, 3, 4);
};
struct Suzuki4ExactDrift : Kicked<ExactDrift, suzuki4> {
  static constexpr SchemeInfo info =
      exact_drift_info("suzuki4-exact-drift", "five steps of strang-exact-drift, the middle one backwards",
                       suzuki4_citation, 5, 4);
};
struct BlanesMoan4ExactDrift : Kicked<ExactDrift, blanes_moan4> {
  static constexpr SchemeInfo info =
      exact_drift_info("blanes-moan4-exact-drift",
                       "splitting of order 4 with a small error constant: seven kicks, six exact drifts",
                       blanes_moan4_citation, 6, 4);
};
struct BlanesMoanRkn4ExactDrift : Kicked<ExactDrift, blanes_moan_rkn4> {
  static constexpr SchemeInfo info =
      exact_drift_info("blanes-moan-rkn4-exact-drift",
                       "Runge-Kutta-Nystrom splitting of order 4: seven kicks, six exact drifts",
                       blanes_moan_rkn4_citation, 6, 4);
};
struct BlanesMoanRkn6ExactDrift : Kicked<ExactDrift, blanes_moan_rkn6> {
  static constexpr SchemeInfo info =
      exact_drift_info("blanes-moan-rkn6-exact-drift",
                       "Runge-Kutta-Nystrom splitting of order 6: fifteen exact drifts, fourteen kicks",
                       blanes_moan_rkn6_citation, 15, 6);
};
struct KahanLi6ExactDrift : Kicked<ExactDrift, kahan_li6> {
  static constexpr SchemeInfo info = exact_drift_info(
      "kahan-li6-exact-drift", "nine steps of strang-exact-drift, order 6", kahan_li6_citation, 9, 6);
};
struct Mclachlan8ExactDrift : Kicked<ExactDrift, mclachlan8> {
  static constexpr SchemeInfo info = exact_drift_info(
      "mclachlan8-exact-drift", "fifteen steps of strang-exact-drift, order 8", mclachlan8_citation, 15, 8);
};
struct KahanLi8ExactDrift : Kicked<ExactDrift, kahan_li8> {
  static constexpr SchemeInfo info = exact_drift_info(
      "kahan-li8-exact-drift", "seventeen steps of strang-exact-drift, order 8", kahan_li8_citation, 17, 8);
};

}  // namespace gnomon::rotation
