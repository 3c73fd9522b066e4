#pragma once
#include <vector>

#include "integrators/beam/linear/kernels.hpp"
#include "integrators/beam/point_step.hpp"

namespace gnomon::beam::linear {

/// The state of the scheme as the kernels have it, and their work space. Only the constructor allocates.
class Chain {
 public:
  /// `strain_offsets`: e0 = (e1, e2) of one element after the other.
  Chain(const Beam& beam, const Kernels& kernels, const std::vector<double>& strain_offsets);

  /// Nodal values (x, z, rotation) of one node after the other, and the elements' history.
  struct Nodal {
    const double *u, *v;
    const PointHistory* history;
    const double* past[3];  ///< mean velocities of the last steps, the last one first
    int known;              ///< how many of them are known
    double past_step;       ///< the size of those steps, s
  };
  void take(const Nodal& state);
  void give(double* u, double* v, PointHistory* history) const;
  void give_past(double* const past[3]) const;
  int known() const { return known_; }
  double past_step() const { return past_step_; }

  /// Of unknown 0 to 2 of the first node, or 3 to 5, of the last.
  void set_displacement(int unknown, double u) { set(u_, unknown, u); }
  void set_velocity(int unknown, double v) { set(v_, unknown, v); }

  /// A step with nodal loads `external` at its middle. `imposed`: mean velocities of the held unknowns of
  /// both ends. If Newton's iteration does not converge quickly, nothing changes and the answer is no.
  bool step(bool cayley, double h, const double* external, const double (&imposed)[2][3]);

  long evaluations = 0, iterations = 0;

 private:
  struct alignas(64) Line {
    double values[8];
  };
  using Numbers = std::vector<Line>;

  static double* at(Numbers& numbers) { return numbers.data()->values; }
  static const double* at(const Numbers& numbers) { return numbers.data()->values; }
  Numbers room(int components, int count) const;
  void spread(const double* nodal, Numbers& to) const;
  void collect(const Numbers& from, double* nodal) const;
  void set(Numbers& numbers, int unknown, double value);

  Beam beam_;
  Layout layout_;
  const Kernels* kernels_;
  Numbers u_, v_, external_, elements_, blocks_;
  Numbers past_[3];
  std::vector<double> nodal_external_;
  int known_ = 0;
  int constant_ = 0, trusted_ = 0;  ///< steps for which one start of Newton's iteration is taken unseen
  double past_step_ = 0.0, curvature_ = -1.0;
};

}  // namespace gnomon::beam::linear
