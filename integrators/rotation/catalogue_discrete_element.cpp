#include "integrators/rotation/discrete_element.hpp"
#include "models/rigid_body/types.hpp"

namespace gnomon::rotation {

void add_discrete_element_schemes(Catalogue& catalogue) {
  add_schemes<RigidBodies>(catalogue, DiscreteElementSchemes{});
}

}  // namespace gnomon::rotation
