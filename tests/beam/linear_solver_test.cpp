// Solvers of the beam schemes' linear systems that know nothing of chains.
#include <Eigen/Dense>
#include <cmath>

#include "integrators/beam/linear_solvers.hpp"
#include "integrators/beam/midpoint.hpp"
#include "models/planar_beam/assembled_chain.hpp"
#include "tests/catch.hpp"
#include "tests/planar_beam/beams.hpp"

using namespace gnomon;
using namespace gnomon::test;
using planar_beam::AssembledChain;

namespace {

constexpr LinearSolver assembled[] = {LinearSolver::band, LinearSolver::lapack, LinearSolver::klu,
                                      LinearSolver::sparselu};

/// Residual of the solution of a random system, the second one with the same pattern; `pivots`: with small
/// diagonals, so that rows have to be exchanged.
double solution_error(LinearSolver solver, int order, int elements, bool held, bool pivots) {
  const int size = 3 * (order + 1), n = 3 * (order * elements + 1);
  const std::vector<int> out = held ? std::vector<int>{0, 2, n - 2} : std::vector<int>{};
  AssembledChain chain(solver, order, elements, out);
  Eigen::MatrixXd A(n, n);
  for (unsigned round = 0; round < 2; ++round) {
    A.setZero();
    for (int e = 0; e < elements; ++e) {
      const Eigen::VectorXd entries = random_values(size * size, 1.0, 100U * round + e + 1);
      Eigen::MatrixXd K = Eigen::Map<const Eigen::MatrixXd>(entries.data(), size, size);
      K.diagonal() *= pivots ? 1e-3 : 1.0;
      if (!pivots) K.diagonal().array() += size;
      chain.add(e, K.data());
      A.block(3 * order * e, 3 * order * e, size, size) += K;
    }
    chain.factorise();
  }
  Eigen::VectorXd right = random_values(n, 1.0, 99), x = right;
  for (int i : out) {
    A.row(i).setZero();
    A.col(i).setZero();
    A(i, i) = 1.0;
    right[i] = 0.0;
  }
  AssembledChain copy = chain;
  Eigen::VectorXd y = x;
  chain.solve(x.data());
  copy.solve(y.data());
  CHECK((x - y).norm() <= 1e-9 * x.norm());
  for (int i : out) CHECK(x[i] == 0.0);
  return (A * x - right).norm() / (A.norm() * x.norm());
}

}  // namespace

TEST_CASE("beam schemes: assembled systems by band matrix, LAPACK, KLU and SparseLU", "[planar_beam]") {
  for (LinearSolver solver : assembled)
    for (int order : {1, 2, 4})
      for (int elements : {1, 2, 9})
        for (bool held : {false, true})
          for (bool pivots : {false, true}) {
            INFO(to_string(solver) << ", order " << order << ", " << elements << " elements");
            CHECK(solution_error(solver, order, elements, held, pivots) <= 1e-13);
          }
}

TEST_CASE("beam schemes: a singular system has no solution by any solver", "[planar_beam]") {
  for (LinearSolver solver : assembled) {
    AssembledChain chain(solver, 1, 2, {});
    const Eigen::Matrix<double, 6, 6> zero = Eigen::Matrix<double, 6, 6>::Zero();
    for (int e = 0; e < 2; ++e) chain.add(e, zero.data());
    chain.factorise();
    Eigen::VectorXd x = Eigen::VectorXd::Ones(9);
    chain.solve(x.data());
    CHECK_FALSE(x.allFinite());
  }
}

TEST_CASE("beam schemes: --linear-solver changes nothing but rounding", "[planar_beam]") {
  const auto last = [](const auto& model, LinearSolver solver) {
    SchemeOptions options;
    options.linear_solver = solver;
    auto state = beam::BeamEnergyMomentum::start(model, model.initial(), options);
    for (int n = 0; n < 20; ++n)
      REQUIRE(beam::BeamEnergyMomentum::step(model, state, 0.01 * n, 0.01) == Status::ok);
    return beam::BeamEnergyMomentum::view(model, state);
  };
  const PlanarBeam<1> linear(soft_beam(9));
  const PlanarBeam<3> cubic(soft_beam(3));
  for (LinearSolver solver : assembled) {
    CHECK((last(linear, solver).u - last(linear, LinearSolver::block).u).norm() <= 1e-9);
    CHECK((last(cubic, solver).u - last(cubic, LinearSolver::block).u).norm() <= 1e-9);
  }
  CHECK(last(linear, LinearSolver::block).u.norm() >= 1e-3);
}

TEST_CASE("beam schemes: every linear solver is timed at three sizes", "[planar_beam]") {
  const std::vector<PartTask> tasks = beam::linear_solver_tasks();
  CHECK(tasks.size() == 15);
  for (const PartTask& task : tasks)
    if (task.size == 20) CHECK(task.run(task.index, task.size) > 0.0);
}
