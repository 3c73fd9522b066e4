#include "integrators/catalogue.hpp"
#include "integrators/ensemble/schemes.hpp"
#include "integrators/rotation/exact_free_top.hpp"
#include "models/rigid_body_ensemble/types.hpp"

namespace gnomon {

void add_ensemble_schemes(Catalogue& catalogue) {
  using Schemes = TypeList<ensemble::Munjiza, ensemble::Rkmk4, rotation::ExactFreeTop>;
  add_implementations<Ensembles>(catalogue, Schemes{});
}

}  // namespace gnomon
