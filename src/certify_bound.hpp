#pragma once
// From the distances between four solutions of one problem to a bound on the error of the best of them.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace gnomon {

/// Distances, in one metric and at one output time, between the solutions of methods A and B: A at a tight
/// and a loose tolerance, B with N ("coarse") and 2N ("fine") steps. A solution that is missing has an
/// infinite distance.
template <class Real>
struct Distances {
  Real methods{};     ///< A tight to B fine
  Real tolerances{};  ///< A tight to A loose
  Real steps{};       ///< B fine to B coarse
};

/// Bounds on the error of A tight - and, for the same reasons, of B fine - one for each output time, in the
/// unit of the distances:
///
///     bound = 2 (M + min(L, q S)) + floor,   M = methods, L = tolerances, S = steps,
///
/// each distance being the largest up to that output time.
///
/// Methods: e_A <= M + e_B (triangle inequality), so with independent methods M measures both errors. It can
/// mislead only where A and B are wrong in the same way; one of the two must be seen to be right by itself.
///
/// Own convergence: L is the error of A loose, an upper estimate of e_A that is too large by the ratio of the
/// tolerances. S is the error of B coarse, and q S estimates e_B with the contraction q measured at the last
/// doubling of the steps, not with the nominal 2^-order; at the level of rounding q is about 1. One estimate
/// suffices in the triangle inequality, hence the smaller; where the other method is bad, M shows it.
///
/// The largest value so far is used because a distance at one instant may vanish by chance. The factor 2
/// covers estimates that are a little low, and `floor` the rounding of the reference itself in this metric
/// (for an angle the machine epsilon, for a length epsilon times its size).
///
/// It is an estimate, not an enclosure. It cannot see what both methods share: the right-hand side with its
/// rounding, the initial state, the output times, and a feature so short that no node of either meets it.
///
/// step_contraction: q, taken as 1 if not in [0, 1]. A distance that is not a number gives an infinite bound
/// from there on.
template <class Real>
std::vector<Real> error_bounds(const std::vector<Distances<Real>>& distances, Real step_contraction,
                               Real floor) {
  using std::isnan;
  const Real infinity = std::numeric_limits<Real>::infinity();
  const Real q = step_contraction >= 0 && step_contraction <= 1 ? step_contraction : Real(1);
  const auto larger = [&](Real a, Real b) { return isnan(b) ? infinity : std::max<Real>(a, b); };
  Distances<Real> worst;
  std::vector<Real> bounds;
  bounds.reserve(distances.size());
  for (const Distances<Real>& d : distances) {
    worst.methods = larger(worst.methods, d.methods);
    worst.tolerances = larger(worst.tolerances, d.tolerances);
    worst.steps = larger(worst.steps, d.steps);
    const Real own = std::min<Real>(worst.tolerances, worst.steps == infinity ? infinity : q * worst.steps);
    bounds.push_back(Real(2) * (worst.methods + own) + floor);
  }
  return bounds;
}

}  // namespace gnomon
