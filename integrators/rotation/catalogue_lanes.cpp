#include "integrators/rotation/families.hpp"
#include "integrators/rotation/lanes/lanes.hpp"
#include "models/rigid_body/types.hpp"

namespace gnomon::rotation {

void add_lanes_schemes(Catalogue& catalogue) {
  add_schemes<RigidBodies>(catalogue, TypeList<LanesExtrapolated>{});
}

}  // namespace gnomon::rotation
