#include "integrators/beam/mixed_midpoint.hpp"
#include "integrators/beam/stander_stein.hpp"
#include "integrators/beam/stepper_steps.hpp"

namespace gnomon::beam {

template class Stepper<planar_beam::PlanarBeam<1>, Turning::documented>;
template class Stepper<planar_beam::PlanarBeam<2>, Turning::documented>;
template class Stepper<planar_beam::PlanarBeam<3>, Turning::documented>;
template class Stepper<planar_beam::PlanarBeam<4>, Turning::documented>;
template class Stepper<planar_beam::PlanarBeam<1>, Turning::cayley>;
template class Stepper<planar_beam::PlanarBeam<2>, Turning::cayley>;
template class Stepper<planar_beam::PlanarBeam<3>, Turning::cayley>;
template class Stepper<planar_beam::PlanarBeam<4>, Turning::cayley>;
template class Stepper<planar_beam::PlanarBeam<1>, Turning::stander_stein>;
template class Stepper<planar_beam::PlanarBeam<2>, Turning::stander_stein>;
template class Stepper<planar_beam::PlanarBeam<3>, Turning::stander_stein>;
template class Stepper<planar_beam::PlanarBeam<4>, Turning::stander_stein>;
template class Stepper<planar_beam::PlanarBeam<1>, Turning::mixed>;
template class Stepper<planar_beam::PlanarBeam<2>, Turning::mixed>;
template class Stepper<planar_beam::PlanarBeam<3>, Turning::mixed>;
template class Stepper<planar_beam::PlanarBeam<4>, Turning::mixed>;

}  // namespace gnomon::beam
