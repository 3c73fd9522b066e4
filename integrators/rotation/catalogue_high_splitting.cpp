#include "integrators/rotation/families.hpp"
#include "models/rigid_body/types.hpp"

namespace gnomon::rotation {

void add_high_splitting_schemes(Catalogue& catalogue) {
  add_schemes<RigidBodies>(catalogue, HighSplittingSchemes{});
}

}  // namespace gnomon::rotation
