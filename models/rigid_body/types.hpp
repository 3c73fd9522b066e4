#pragma once
#include "models/rigid_body/rigid_body.hpp"
#include "src/catalogue.hpp"

namespace gnomon {

using RigidBodies =
    TypeList<rigid_body::RigidBody<rigid_body::Free>, rigid_body::RigidBody<rigid_body::Gravity>,
             rigid_body::RigidBody<rigid_body::SpaceMoment>, rigid_body::RigidBody<rigid_body::BodyMoment>,
             rigid_body::RigidBody<rigid_body::AttitudePotential>>;

}  // namespace gnomon
