#pragma once
#include <array>
#include <memory>
#include <string_view>

#include "integrators/rotation/lanes/kernels.hpp"
#include "src/run.hpp"

namespace gnomon::rotation::lanes {

enum class Load { none, gravity, space_moment, body_moment };

/// A rigid body as the solver takes it.
struct Problem {
  std::array<double, 3> inertia;  ///< principal moments, kg m^2
  Load load;
  std::array<double, 3> load_vector;  ///< as in Body::load
  double momentum_scale;              ///< kg m^2/s
};

/// The form of the model that the solver needs: y = (q, m), 7 numbers, and the body itself.
class BodySystem : public FirstOrderSystem {
 public:
  virtual const Problem& problem() const = 0;
};

/// Steps of a symmetric rule of order 2 with eight step counts at once, one in each lane of the processor's
/// registers, extrapolated in the square of the step to order 16. Heavy symmetric tops are stepped by kicks
/// and exact drifts, other bodies by the explicit midpoint rule.
///
/// The estimated error of a step is the difference from what all but the greatest count give, of order 14.
/// (To leave out the least count instead would show less than the error where that count is too coarse to
/// matter.) The larger of the angle [rad] and the momentum over its scale is kept below spec.tol.
/// Orientations are normalised after each step.
std::unique_ptr<AdaptiveSolver> make_extrapolation(const BodySystem& system, const RunSpec& spec,
                                                   const Kernels& kernels = widest_kernels());

}  // namespace gnomon::rotation::lanes
