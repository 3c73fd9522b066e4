#pragma once
#include "models/planar_beam/planar_beam.hpp"
#include "src/catalogue.hpp"

namespace gnomon {

using PlanarBeams = TypeList<planar_beam::PlanarBeam<1>, planar_beam::PlanarBeam<2>,
                             planar_beam::PlanarBeam<3>, planar_beam::PlanarBeam<4>>;

}  // namespace gnomon
