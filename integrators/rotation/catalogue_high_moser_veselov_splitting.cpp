#include "integrators/rotation/families.hpp"
#include "models/catalogue.hpp"

namespace gnomon::rotation {

void add_high_moser_veselov_splittings(Catalogue& catalogue) {
  add_schemes<Models>(catalogue, HighMoserVeselovSplittings{});
}

}  // namespace gnomon::rotation
