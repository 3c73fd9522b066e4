#include "integrators/rotation/families.hpp"
#include "integrators/rotation/lanes/lanes.hpp"
#include "models/catalogue.hpp"

namespace gnomon::rotation {

void add_lanes_schemes(Catalogue& catalogue) {
  add_schemes<Models>(catalogue, TypeList<LanesExtrapolated>{});
}

}  // namespace gnomon::rotation
