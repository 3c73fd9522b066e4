#include "integrators/rotation/families.hpp"
#include "models/catalogue.hpp"

namespace gnomon::rotation {

void add_explicit_schemes(Catalogue& catalogue) { add_schemes<Models>(catalogue, ExplicitSchemes{}); }

}  // namespace gnomon::rotation
