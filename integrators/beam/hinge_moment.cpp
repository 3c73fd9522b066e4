#include "integrators/beam/hinge_moment.hpp"

#include <cmath>

namespace gnomon::beam {
namespace {

/// (atan a - atan b)/(a - b) and its derivatives by a and b.
struct Quotient {
  double value, by_a, by_b;
};

Quotient quotient_of_angles(double a, double b) {
  const double q = 1.0 + a * b;
  if (q < 0.5) {  // a and b are far apart
    const double value = (std::atan(a) - std::atan(b)) / (a - b);
    return {value, (1.0 / (1.0 + a * a) - value) / (a - b), (value - 1.0 / (1.0 + b * b)) / (a - b)};
  }
  // atan a - atan b = atan w, w = (a - b)/(1 + a b)
  const double w = (a - b) / q, x = w * w;
  const bool small = std::abs(w) < 1e-3;
  const double g = small ? 1.0 - x * (1.0 / 3.0 - x / 5.0) : std::atan(w) / w;
  const double slope = small ? -w * (2.0 / 3.0 - 0.8 * x) : (1.0 / (1.0 + x) - g) / w;
  const double cube = q * q * q;
  return {g / q, slope * (1.0 + b * b) / cube - g * b / (q * q),
          -slope * (1.0 + a * a) / cube - g * a / (q * q)};
}

}  // namespace

HingeMoment hinge_moment(bool cayley, double stiffness, double angle, double left, double right, double h) {
  const double half = 0.5 * h, a = half * right, b = half * left;
  if (!cayley) return {stiffness * (angle + a - b), -stiffness * half, stiffness * half};
  const Quotient f = quotient_of_angles(a, b);
  const double mean = angle + f.value * (a - b);
  return {stiffness * f.value * mean, stiffness * half * (f.by_b * mean - f.value / (1.0 + b * b)),
          stiffness * half * (f.by_a * mean + f.value / (1.0 + a * a))};
}

}  // namespace gnomon::beam
