#pragma once
#include <vector>

#include "models/planar_beam/mass_form.hpp"

namespace gnomon::planar_beam {

/// The implicit form 0 = u' - v, 0 = M w' + alpha M w + f_int(u) - f_ext(t, u) on the free unknowns: an ODE
/// (index 0) that needs no inverse of M, so that its Jacobian is sparse.
template <class Beam>
class DaeForm : private MassForm<Beam> {
 public:
  explicit DaeForm(const Beam& beam) : MassForm<Beam>(beam), inertia_(beam.unknowns()) {}
  using MassForm<Beam>::size, MassForm<Beam>::scales, MassForm<Beam>::sparsity;
  using MassForm<Beam>::pack, MassForm<Beam>::unpack;
  std::vector<int> algebraic() const { return std::vector<int>(size(), 0); }

  /// u and w are continuous, whatever jumps.
  void resume(double t, const double* y, double* rate) const { this->beam_->ode().rhs(t, y, rate); }

  void residual(double t, const double* y, const double* rate, double* value) const {
    const Beam& beam = *this->beam_;
    const int n = this->count();
    this->forces(t, y);
    this->damp(y);
    accelerations_.setZero(beam.unknowns());
    for (int i = 0; i < n; ++i) accelerations_[beam.free()[i]] = rate[n + i];
    beam.numbering().spread(accelerations_.data());
    beam.momentum(accelerations_.data(), inertia_.data());
    this->velocities(t, y, value);
    for (int i = 0; i < n; ++i) {
      value[i] = rate[i] - value[i];
      value[n + i] = inertia_[beam.free()[i]] - this->f_[beam.free()[i]];
    }
  }
  void jacobian(double t, double cj, const double* y, const double*, double* values) const {
    this->combine(t, y, cj, -1.0, values);
  }

 private:
  mutable Eigen::VectorXd accelerations_, inertia_;
};

}  // namespace gnomon::planar_beam
