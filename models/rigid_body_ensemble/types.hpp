#pragma once
#include "models/rigid_body_ensemble/ensemble.hpp"
#include "src/catalogue.hpp"

namespace gnomon {

/// The types of the model of many rigid bodies, one a load.
using Ensembles = TypeList<rigid_body_ensemble::Ensemble<rigid_body::Free>,
                           rigid_body_ensemble::Ensemble<rigid_body::SpaceMoment>,
                           rigid_body_ensemble::Ensemble<rigid_body::Gravity>>;

}  // namespace gnomon
