#pragma once
#include "models/planar_beam/planar_beam.hpp"
#include "models/rigid_body/rigid_body.hpp"
#include "src/catalogue.hpp"

namespace gnomon {

/// The types of all models. A new model adds its types here and its reader in catalogue.cpp.
using Models = TypeList<rigid_body::RigidBody<rigid_body::Free>, rigid_body::RigidBody<rigid_body::Gravity>,
                        rigid_body::RigidBody<rigid_body::SpaceMoment>,
                        rigid_body::RigidBody<rigid_body::BodyMoment>, planar_beam::PlanarBeam<1>,
                        planar_beam::PlanarBeam<2>, planar_beam::PlanarBeam<3>, planar_beam::PlanarBeam<4>>;

/// Adds the models with their readers and the folders of their scenes.
void add_models(Catalogue& catalogue);

}  // namespace gnomon
