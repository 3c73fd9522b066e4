#include "integrators/beam/linear_solvers.hpp"

#include "models/planar_beam/assembled_chain.hpp"
#include "models/planar_beam/element_chain.hpp"
#include "models/planar_beam/planar_beam.hpp"
#include "src/measure/timing.hpp"

namespace gnomon::beam {
namespace {

using Beam = planar_beam::PlanarBeam<1>;
using Chain = planar_beam::ElementChain<1>;

/// (2/h) M + (h/2) K of each element at rest.
Chain::Matrix step_matrix(const Beam& beam, const Eigen::VectorXd& u, int e, double h) {
  Chain::Matrix matrix = 0.5 * h * beam.element_tangent(u.data(), e);
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b)
      for (int k = 0; k < 3; ++k)
        matrix(3 * a + k, 3 * b + k) += 2.0 / h * beam.element().mass[a][b] * beam.density(k);
  return matrix;
}

/// CPU seconds of one factorisation and solution.
template <class System>
double seconds(System& system, int size) {
  const Eigen::VectorXd right = Eigen::VectorXd::LinSpaced(3 * (size + 1), -1.0, 1.0);
  Eigen::VectorXd x = right;
  system.factorise();
  const double begin = thread_cpu_seconds();
  system.factorise();
  x = right;
  system.solve(x.data());
  const double spent = thread_cpu_seconds() - begin;
  return x.allFinite() ? spent : std::nan("");
}

double run(int variant, int size) {
  planar_beam::Data data;
  data.length = 10.0;
  data.elements = size;
  data.section = {1e4, 1e4, 500.0, 1.0, 10.0};
  data.angle = 2.2;
  const Beam beam(data);
  const Eigen::VectorXd u = beam.initial().u;
  const double h = 0.005;
  const auto solver = static_cast<LinearSolver>(variant);
  if (solver == LinearSolver::block) {
    Chain chain(size, {});
    for (int e = 0; e < size; ++e) chain.add(e, step_matrix(beam, u, e, h));
    return seconds(chain, size);
  }
  planar_beam::AssembledChain chain(solver, 1, size, {});
  for (int e = 0; e < size; ++e) chain.add(e, step_matrix(beam, u, e, h).data());
  return seconds(chain, size);
}

}  // namespace

std::vector<PartTask> linear_solver_tasks() {
  std::vector<PartTask> tasks;
  for (std::size_t solver = 0; solver < linear_solver_names.size(); ++solver)
    for (int size : {20, 200, 2000})
      tasks.push_back({"planar_beam", "Time of one factorisation and solution", "linear solver",
                       linear_solver_names[solver], "elements", size, static_cast<int>(solver), run});
  return tasks;
}

}  // namespace gnomon::beam
