#include "integrators/rotation/families.hpp"
#include "models/rigid_body/types.hpp"

namespace gnomon::rotation {

void add_splitting_schemes(Catalogue& catalogue) { add_schemes<RigidBodies>(catalogue, SplittingSchemes{}); }

}  // namespace gnomon::rotation
