#pragma once
#include "integrators/rotation/cayley_flow.hpp"
#include "integrators/rotation/kicked.hpp"

namespace gnomon::rotation {

/// m' - m = h a x I^-1 a with a = (m + m')/2, the turn being the Cayley map of h I^-1 a. With c = (h/2) I^-1
/// a it is I c + c x (I c) = (h/2) m. The moment acts by half kicks.
struct ImplicitMidpoint : Kicked<CayleyFlow<CayleyTerms{false, false}>, strang> {
  static constexpr SchemeInfo info{
      .name = "implicit-midpoint",
      .family = "rotation",
      .summary = "implicit midpoint rule for the body momentum, attitude by its Cayley map, half kicks",
      .citation =
          "M.A. Austin, P.S. Krishnaprasad, L.S. Wang, J. Comput. Phys. 107 (1993) 105-117; moment by "
          "Strang splitting",
      .form = "rotation",
      .orders = {{{"none", 2}, {"gravity", 2}, {"space_moment", 2}, {"body_moment", 2}}},
      .reversible = true,
      .conserves_energy = true,
      .conserves_momentum = true,
  };
};

}  // namespace gnomon::rotation
