#include "integrators/rotation/families.hpp"
#include "models/rigid_body/types.hpp"

namespace gnomon::rotation {

void add_moser_veselov_splittings(Catalogue& catalogue) {
  add_schemes<RigidBodies>(catalogue, MoserVeselovSplittings{});
}

}  // namespace gnomon::rotation
