#include "integrators/rotation/families.hpp"
#include "models/rigid_body/types.hpp"

namespace gnomon::rotation {

void add_second_order_schemes(Catalogue& catalogue) {
  add_schemes<RigidBodies>(catalogue, SecondOrderSchemes{});
}

}  // namespace gnomon::rotation
