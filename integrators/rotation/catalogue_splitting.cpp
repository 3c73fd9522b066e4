#include "integrators/rotation/families.hpp"
#include "models/catalogue.hpp"

namespace gnomon::rotation {

void add_splitting_schemes(Catalogue& catalogue) { add_schemes<Models>(catalogue, SplittingSchemes{}); }

}  // namespace gnomon::rotation
