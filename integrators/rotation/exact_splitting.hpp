#pragma once
#include "integrators/rotation/exact_drift.hpp"
#include "integrators/rotation/kicked.hpp"

namespace gnomon::rotation {

/// Strang steps by the fractions c of the step, neighbouring half kicks joined.
template <std::size_t n>
struct Composition {
  std::array<double, n + 1> kicks{};
  std::array<double, n> drifts{};
  constexpr explicit Composition(const std::array<double, n>& c) : drifts(c) {
    for (std::size_t k = 0; k < n; ++k) kicks[k] += 0.5 * c[k], kicks[k + 1] += 0.5 * c[k];
  }
};

/// H. Yoshida, Phys. Lett. A 150 (1990) 262-268: c = 1/(2 - 2^(1/3)), 1 - 2 c, c.
struct Yoshida4 {
  static constexpr double c = 1.3512071919596576340;
  static constexpr Composition<3> steps{std::array<double, 3>{c, 1.0 - 2.0 * c, c}};
  static constexpr auto kicks = steps.kicks;
  static constexpr auto drifts = steps.drifts;
};

/// M. Suzuki, Phys. Lett. A 146 (1990) 319-323: c = 1/(4 - 4^(1/3)), c, 1 - 4 c, c, c.
struct Suzuki4 {
  static constexpr double c = 0.41449077179437573714;
  static constexpr Composition<5> steps{std::array<double, 5>{c, c, 1.0 - 4.0 * c, c, c}};
  static constexpr auto kicks = steps.kicks;
  static constexpr auto drifts = steps.drifts;
};

/// S. Blanes, P.C. Moan, J. Comput. Appl. Math. 142 (2002) 313-330: S6, order 4.
struct BlanesMoan4 {
  static constexpr double a1 = 0.0792036964311957, a2 = 0.353172906049774, a3 = -0.0420650803577195;
  static constexpr double a4 = 1.0 - 2.0 * (a1 + a2 + a3);
  static constexpr double b1 = 0.209515106613362, b2 = -0.143851773179818, b3 = 0.5 - (b1 + b2);
  static constexpr std::array<double, 7> kicks{a1, a2, a3, a4, a3, a2, a1};
  static constexpr std::array<double, 6> drifts{b1, b2, b3, b3, b2, b1};
};

/// No order is declared without a moment: a step is then exact.
struct StrangExactDrift : Kicked<ExactDrift, Strang> {
  static constexpr SchemeInfo info{
      .name = "strang-exact-drift",
      .family = "rotation",
      .summary = "half kick, exact motion of the free body, half kick; exact without a moment",
      .citation =
          "G. Strang, SIAM J. Numer. Anal. 5 (1968) 506-517; E. Celledoni, F. Fasso, N. Safstrom, A. Zanna, "
          "SIAM J. Sci. Comput. 30 (2008) 2084-2112",
      .form = "rotation",
      .stages = 1,
      .orders = {{{"gravity", 2}, {"space_moment", 2}, {"body_moment", 2}}},
      .reversible = true,
      .conserves_energy = true,
      .conserves_momentum = true,
  };
};

struct Yoshida4ExactDrift : Kicked<ExactDrift, Yoshida4> {
  static constexpr SchemeInfo info{
      .name = "yoshida4-exact-drift",
      .family = "rotation",
      .summary = "triple jump of strang-exact-drift",
      .citation = "H. Yoshida, Phys. Lett. A 150 (1990) 262-268",
      .form = "rotation",
      .stages = 3,
      .orders = {{{"gravity", 4}, {"space_moment", 4}, {"body_moment", 4}}},
      .reversible = true,
      .conserves_energy = true,
      .conserves_momentum = true,
  };
};

struct Suzuki4ExactDrift : Kicked<ExactDrift, Suzuki4> {
  static constexpr SchemeInfo info{
      .name = "suzuki4-exact-drift",
      .family = "rotation",
      .summary = "composition of five steps of strang-exact-drift, the middle one backwards",
      .citation = "M. Suzuki, Phys. Lett. A 146 (1990) 319-323",
      .form = "rotation",
      .stages = 5,
      .orders = {{{"gravity", 4}, {"space_moment", 4}, {"body_moment", 4}}},
      .reversible = true,
      .conserves_energy = true,
      .conserves_momentum = true,
  };
};

struct BlanesMoan4ExactDrift : Kicked<ExactDrift, BlanesMoan4> {
  static constexpr SchemeInfo info{
      .name = "blanes-moan4-exact-drift",
      .family = "rotation",
      .summary = "splitting into seven kicks and six exact motions of the free body, small error constant",
      .citation = "S. Blanes, P.C. Moan, J. Comput. Appl. Math. 142 (2002) 313-330, S6 of order 4",
      .form = "rotation",
      .stages = 6,
      .orders = {{{"gravity", 4}, {"space_moment", 4}, {"body_moment", 4}}},
      .reversible = true,
      .conserves_energy = true,
      .conserves_momentum = true,
  };
};

}  // namespace gnomon::rotation
