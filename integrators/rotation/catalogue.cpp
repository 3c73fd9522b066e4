#include "integrators/catalogue.hpp"
#include "integrators/rotation/exact_free_top.hpp"
#include "integrators/rotation/munjiza.hpp"
#include "models/rigid_body/types.hpp"

namespace gnomon {

void add_rotation_schemes(Catalogue& catalogue) {
  using namespace rotation;
  using Schemes = TypeList<Munjiza, MunjizaHalfImpulse, MunjizaStageMoments, Rkmk4, ExactFreeTop>;
  add_schemes<RigidBodies>(catalogue, Schemes{});
}

}  // namespace gnomon
