#pragma once
#include "integrators/rotation/cayley_flow.hpp"
#include "integrators/rotation/kicked.hpp"

namespace gnomon::rotation {

/// m = u - (h/2) u x w + (h^2/4)(w.u) w with u = I w, the turn cay(h w), and the momentum after it from
/// u + (h/2) u x w + (h^2/4)(w.u) w, which is the same momentum in space. With c = (h/2) w the first equation
/// is I c + c x (I c) + (c.I c) c = (h/2) m. The half kicks are part of the method.
struct LieVerlet : Kicked<CayleyFlow<CayleyTerms{true, false}>, strang> {
  static constexpr SchemeInfo info{
      .name = "lie-verlet",
      .family = "rotation",
      .summary = "variational Lie-Verlet method on the Cayley map",
      .citation =
          "N. Bou-Rabee, J.E. Marsden, Found. Comput. Math. 9 (2009) 197-219, the variational "
          "Stormer-Verlet method with the Cayley map",
      .form = "rotation",
      .orders = {{{"none", 2}, {"gravity", 2}, {"space_moment", 2}, {"body_moment", 2}}},
      .reversible = true,
      .conserves_momentum = true,
  };
};

}  // namespace gnomon::rotation
