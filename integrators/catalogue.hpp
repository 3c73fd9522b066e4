#pragma once
#include "src/catalogue.hpp"

namespace gnomon {

// Each family compiles its own pairs in its own file; a new scheme is one line in its family's list there.
void add_rotation_schemes(Catalogue& catalogue);
void add_ensemble_schemes(Catalogue& catalogue);
void add_beam_schemes(Catalogue& catalogue);
void add_sundials_schemes(Catalogue& catalogue);

inline void add_integrators(Catalogue& catalogue) {
  add_rotation_schemes(catalogue);
  add_ensemble_schemes(catalogue);
  add_beam_schemes(catalogue);
  add_sundials_schemes(catalogue);
}

}  // namespace gnomon
