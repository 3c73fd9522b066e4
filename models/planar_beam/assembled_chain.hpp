#pragma once
#include <array>
#include <memory>
#include <vector>

#include "models/planar_beam/numbering.hpp"
#include "src/scheme.hpp"

namespace gnomon::planar_beam {

/// A factorisation of a sparse matrix whose entries change and whose pattern stays.
class Factorisation {
 public:
  virtual ~Factorisation() = default;
  /// `values` in the order of the pattern's rows.
  virtual bool factorise(const std::vector<double>& values) = 0;
  virtual void solve(double* right) = 0;
};

/// The linear system of ElementChain, assembled and given to a solver that knows nothing of chains. Inner
/// nodes are not condensed.
class AssembledChain {
 public:
  AssembledChain(LinearSolver solver, int order, int elements, std::vector<int> held,
                 std::vector<int> hinged = {});
  AssembledChain(const AssembledChain& other);
  AssembledChain& operator=(const AssembledChain& other);
  AssembledChain(AssembledChain&&) = default;
  AssembledChain& operator=(AssembledChain&&) = default;

  /// As in ElementChain.
  void set_spring(int k, double by_left, double by_right);
  /// Adds the matrix of element e, column by column.
  void add(int e, const double* matrix);
  /// Ends what `add` has assembled; the next `add` begins anew.
  void factorise();
  /// Solves in place. Not a number everywhere if the matrix was singular.
  void solve(double* values) const;

 private:
  void make_solver();

  LinearSolver kind_;
  int order_;
  Numbering numbering_;
  std::vector<int> held_;
  /// Of each hinge the derivatives of its moment by the rotations on the left and on the right, and the slots
  /// of those in the equations of both.
  struct Spring {
    std::array<double, 2> slope{};
    std::array<std::array<long, 2>, 2> slot;
  };
  std::vector<Spring> springs_;
  std::vector<long> column_start_, row_;
  std::vector<int> slot_;  ///< of the elements' entries, -1 where an unknown is held
  std::vector<double> values_;
  std::unique_ptr<Factorisation> solver_;
  bool regular_ = false;
};

}  // namespace gnomon::planar_beam
