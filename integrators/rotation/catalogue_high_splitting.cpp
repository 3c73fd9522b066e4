#include "integrators/rotation/families.hpp"
#include "models/catalogue.hpp"

namespace gnomon::rotation {

void add_high_splitting_schemes(Catalogue& catalogue) {
  add_schemes<Models>(catalogue, HighSplittingSchemes{});
}

}  // namespace gnomon::rotation
