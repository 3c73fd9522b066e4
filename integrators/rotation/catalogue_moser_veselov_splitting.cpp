#include "integrators/rotation/families.hpp"
#include "models/catalogue.hpp"

namespace gnomon::rotation {

void add_moser_veselov_splittings(Catalogue& catalogue) {
  add_schemes<Models>(catalogue, MoserVeselovSplittings{});
}

}  // namespace gnomon::rotation
