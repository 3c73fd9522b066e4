#include "integrators/rotation/families.hpp"
#include "models/catalogue.hpp"

namespace gnomon::rotation {

void add_moser_veselov_schemes(Catalogue& catalogue) {
  add_schemes<Models>(catalogue, MoserVeselovSchemes{});
}

}  // namespace gnomon::rotation
