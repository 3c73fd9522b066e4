#include "integrators/catalogue.hpp"
#include "integrators/beam/midpoint.hpp"
#include "models/planar_beam/types.hpp"

namespace gnomon {

void add_beam_schemes(Catalogue& catalogue) {
  using namespace beam;
  add_schemes<PlanarBeams>(catalogue, TypeList<BeamMidpoint, BeamEnergyMomentum>{});
}

}  // namespace gnomon
