#include "integrators/rotation/families.hpp"
#include "models/catalogue.hpp"

namespace gnomon::rotation {

void add_second_order_schemes(Catalogue& catalogue) { add_schemes<Models>(catalogue, SecondOrderSchemes{}); }

}  // namespace gnomon::rotation
