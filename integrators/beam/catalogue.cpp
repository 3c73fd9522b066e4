#include "integrators/catalogue.hpp"
#include "integrators/beam/adaptive.hpp"
#include "integrators/beam/bathe.hpp"
#include "integrators/beam/energy_momentum_4.hpp"
#include "integrators/beam/generalized_alpha.hpp"
#include "integrators/beam/large_meshes.hpp"
#include "integrators/beam/linear_solvers.hpp"
#include "integrators/beam/midpoint.hpp"
#include "integrators/beam/mixed_midpoint.hpp"
#include "integrators/beam/rk4.hpp"
#include "integrators/beam/stander_stein.hpp"
#include "integrators/beam/verlet.hpp"
#include "models/planar_beam/types.hpp"

namespace gnomon {

void add_beam_schemes(Catalogue& catalogue) {
  using namespace beam;
  add_schemes<PlanarBeams>(catalogue, TypeList<BeamMidpoint,                //
                                               BeamEnergyMomentum,          //
                                               BeamStanderStein,            //
                                               BeamMixedMidpoint,           //
                                               BeamEnergyMomentum4,         //
                                               BeamEnergyMomentumAdaptive,  //
                                               BeamTrapezoidal,             //
                                               BeamGeneralizedAlpha,        //
                                               BeamHht,                     //
                                               BeamBathe,                   //
                                               BeamVerlet,                  //
                                               BeamVerletConsistent,        //
                                               BeamRk4>{});
  catalogue.reference_solvers.push_back({BeamEnergyMomentum4::info.name, 0.0, 0.0, 0.2});
  for (const std::vector<PartTask>& tasks : {linear_solver_tasks(), large_mesh_tasks()})
    catalogue.parts.insert(catalogue.parts.end(), tasks.begin(), tasks.end());
}

}  // namespace gnomon
