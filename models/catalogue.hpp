#pragma once
#include "models/planar_beam/types.hpp"
#include "models/rigid_body/types.hpp"
#include "models/rigid_body_ensemble/types.hpp"

namespace gnomon {

/// The types of all models. A new model adds its types here and its reader in catalogue.cpp.
using Models = Joined<RigidBodies, Joined<Ensembles, PlanarBeams>>;

/// Adds the models with their readers and the folders of their scenes.
void add_models(Catalogue& catalogue);

}  // namespace gnomon
