#include "integrators/catalogue.hpp"
#include "integrators/beam/midpoint.hpp"
#include "models/catalogue.hpp"

namespace gnomon {

void add_beam_schemes(Catalogue& catalogue) {
  using namespace beam;
  add_schemes<Models>(catalogue, TypeList<BeamMidpoint, BeamEnergyMomentum>{});
}

}  // namespace gnomon
