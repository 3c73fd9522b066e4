#include "integrators/rotation/discrete_element.hpp"
#include "models/rigid_body/rigid_body.hpp"

namespace gnomon::rotation {

void add_discrete_element_schemes(Catalogue& catalogue) {
  using namespace rigid_body;
  using Bodies = TypeList<RigidBody<Free>, RigidBody<Gravity>, RigidBody<SpaceMoment>, RigidBody<BodyMoment>>;
  add_schemes<Bodies>(catalogue, DiscreteElementSchemes{});
}

}  // namespace gnomon::rotation
