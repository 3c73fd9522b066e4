#include "integrators/catalogue.hpp"
#include "integrators/rotation/discrete_element.hpp"
#include "integrators/rotation/exact_free_top.hpp"
#include "integrators/rotation/exact_heavy_symmetric_top.hpp"
#include "integrators/rotation/families.hpp"
#include "integrators/rotation/munjiza_kernel.hpp"
#include "models/rigid_body/types.hpp"

namespace gnomon {

void add_rotation_schemes(Catalogue& catalogue) {
  using namespace rotation;
  add_schemes<RigidBodies>(catalogue, MunjizaSchemes{});
  add_splitting_schemes(catalogue);
  add_high_splitting_schemes(catalogue);
  add_moser_veselov_schemes(catalogue);
  add_moser_veselov_splittings(catalogue);
  add_high_moser_veselov_splittings(catalogue);
  add_second_order_schemes(catalogue);
  add_explicit_schemes(catalogue);
  add_discrete_element_schemes(catalogue);
  add_lanes_schemes(catalogue);
  add_schemes<RigidBodies>(catalogue, TypeList<ExactFreeTop, ExactHeavySymmetricTop>{});
  catalogue.yardsticks.push_back(munjiza_kernel_yardstick);
}

}  // namespace gnomon
