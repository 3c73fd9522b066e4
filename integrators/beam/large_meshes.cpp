#include "integrators/beam/large_meshes.hpp"

#include <cmath>

#include "integrators/sundials/schemes.hpp"
#include "models/planar_beam/planar_beam.hpp"

namespace gnomon::beam {
namespace {

using Beam = planar_beam::PlanarBeam<1>;

/// CPU seconds of the integration.
template <class Scheme>
double seconds(const Beam& beam) {
  RunSpec spec;
  spec.t_end = 20.0 * beam.element().length / std::sqrt(beam.section().EA / beam.section().rhoA);
  spec.tol = 1e-4;
  spec.record = false;
  const RunResult result = gnomon::run<Beam, Scheme>(beam, spec);
  return result.status == Status::ok ? result.cpu_seconds : std::nan("");
}

double run(int variant, int size) {
  planar_beam::Data data;
  data.length = 10.0;
  data.elements = size;
  data.section = {1e4, 1e4, 500.0, 1.0, 10.0};
  data.start = {6.0, 0.0};
  data.angle = 2.214297435588181;
  data.loads = {{planar_beam::Place::start, {8.0, 0.0}, 80.0, planar_beam::Profile::step, 2.5}};
  const Beam beam(data);
  return variant == 0 ? seconds<sundials::CvodeBdf>(beam) : seconds<sundials::CvodeBdfGmres>(beam);
}

}  // namespace

std::vector<PartTask> large_mesh_tasks() {
  std::vector<PartTask> tasks;
  for (const int variant : {0, 1})
    for (const int size : {1000, 20'000})
      tasks.push_back({"planar_beam",
                       "CPU time of CVODE's BDF on the flying beam while an axial wave passes 20 elements, "
                       "tolerance 1e-4",
                       "solver of Newton's systems",
                       variant == 0 ? "block elimination" : "GMRES, preconditioned by it", "elements", size,
                       variant, run, true});
  return tasks;
}

}  // namespace gnomon::beam
