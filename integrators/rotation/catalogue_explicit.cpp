#include "integrators/rotation/families.hpp"
#include "models/rigid_body/types.hpp"

namespace gnomon::rotation {

void add_explicit_schemes(Catalogue& catalogue) { add_schemes<RigidBodies>(catalogue, ExplicitSchemes{}); }

}  // namespace gnomon::rotation
