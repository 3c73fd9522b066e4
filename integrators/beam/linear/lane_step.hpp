#pragma once
// One step of the implicit midpoint scheme with the elements of a beam in lanes. This header and those that
// it includes are compiled once for each instruction set, and everything in them has internal linkage: the
// linker must not take a function made for one set for that of another. For the same reason they use little
// of the standard library.

#include "integrators/beam/linear/lane_cuts.hpp"

namespace gnomon::beam::linear {
namespace {

/// Elements of the local nodes' arrays.
template <int lanes>
inline int node_values(const Layout& layout) {
  return lanes * node_components * (layout.rows() + 1);
}

/// Sets the mean velocities of the ends that are held: the first nodes of the first two lanes.
template <int lanes>
inline void impose(const Beam& beam, const Arrays& arrays, const StepInput& input) {
  for (int end = 0; end < 2; ++end)
    for (int k = 0; k < 3; ++k)
      if (beam.held[end][k]) arrays.mean[lanes * k + end] = input.imposed[end][k];
}

/// Sets the mean velocities to where Newton's iteration starts; returns the square of |v|.
template <int lanes>
inline double set_start(const Layout& layout, const Arrays& arrays, Start start) {
  using V = Lanes<lanes>;
  const int count = node_values<lanes>(layout);
  const auto at = [](const double* values) { return V(values, stdx::vector_aligned); };
  V square = 0.0;
  for (int i = 0; i < count; i += lanes) {
    const V v = at(arrays.v + i);
    square += v * v;
    V mean = v;
    if (start == Start::parabola)
      mean = 3.0 * (at(arrays.past0 + i) - at(arrays.past1 + i)) + at(arrays.past2 + i);
    else if (start == Start::line)
      mean = 2.0 * at(arrays.past0 + i) - at(arrays.past1 + i);
    else if (start == Start::constant)
      mean = at(arrays.past0 + i);
    mean.copy_to(arrays.mean + i, stdx::vector_aligned);
  }
  return reduce(square);
}

/// u, v and the elements' history at the end of the step.
template <int lanes, bool cayley>
inline void finish(const Layout& layout, const Arrays& arrays, const StepConstants<Lanes<lanes>>& step) {
  using V = Lanes<lanes>;
  const auto at = [](const double* values) { return V(values, stdx::vector_aligned); };
  const int rows = layout.rows();
  V left[3];
  for (int i = 0; i <= rows; ++i) {
    V mean[3];
    const int place = lanes * node_components * i;
    for (int k = 0; k < 3; ++k) {
      double *u = arrays.u + place + lanes * k, *v = arrays.v + place + lanes * k;
      mean[k] = at(arrays.mean + place + lanes * k);
      if (cayley && k == 2)
        (at(u) + 2.0 * arctan(V(step.half_h * mean[k]))).copy_to(u, stdx::vector_aligned);
      else
        (at(u) + step.h * mean[k]).copy_to(u, stdx::vector_aligned);
      (2.0 * mean[k] - at(v)).copy_to(v, stdx::vector_aligned);
    }
    if (i > 0) {
      double* element = arrays.elements + lanes * element_components * (i - 1);
      V now[7];
      for (int k = 0; k < 7; ++k) now[k] = at(element + lanes * k);
      const V slope[3] = {step.slope * (mean[0] - left[0]), step.slope * (mean[1] - left[1]),
                          step.slope * (mean[2] - left[2])};
      const Point<V, cayley> point(step, now, slope[0], slope[1], slope[2], 0.5 * (left[2] + mean[2]));
      // the length of (cos, sin) is put right to rounding
      const V norm = 1.5 - 0.5 * (point.next_c * point.next_c + point.next_s * point.next_s);
      const V next[7] = {point.d1, point.d2, point.next_c * norm,     point.next_s * norm,
                         point.g1, point.g2, now[6] + point.increment};
      for (int k = 0; k < 7; ++k) next[k].copy_to(element + lanes * k, stdx::vector_aligned);
    }
    for (int k = 0; k < 3; ++k) left[k] = mean[k];
  }
}

/// Newton's iteration without line search. What the residual r is after a correction x of the mean
/// velocities is quadratic in it: |r| = c |h x|^2. The iteration ends when, by the largest c of late, the
/// correction just made leaves a hundredth of what is asked, a tenth if c is wrong by ten: what is left of
/// the residual is lost from the invariants in each step. The size of the correction counts and not that of
/// the residual before it: in a stiff beam a small force that bends moves it far, and the stretch this gives
/// is of second order, but its force is large.
template <int lanes, bool cayley>
StepResult step(const Beam& beam, const Layout& layout, const Arrays& arrays, const StepInput& input) {
  constexpr double poor_start = 1e-2, poor_contraction = 0.3, safety = 10.0, fading = 0.9;
  constexpr int most_iterations = 8;
  StepResult result{false, false, false, 0, 0, fading * input.curvature};
  const double v_square = set_start<lanes>(layout, arrays, input.start);
  impose<lanes>(beam, arrays, input);
  const double speed = __builtin_fabs(2.0 / input.h) * __builtin_sqrt(v_square);
  const double floor = beam.force_floor + beam.mass_floor * speed;
  Sweep<lanes, cayley> sweep(beam, layout, arrays, input.h);
  typename Sweep<lanes, cayley>::Found before{}, found = {};
  double moved_before = 0.0;
  bool compare = input.compare && input.start > Start::constant;
  for (int k = 0; k < most_iterations;) {
    found = sweep.eliminate();
    ++result.evaluations;
    if (compare && !(found.size <= poor_start * found.scale)) {
      compare = false;
      result.constant_better = true;
      set_start<lanes>(layout, arrays, Start::constant);
      impose<lanes>(beam, arrays, input);
      before = found;
      continue;
    }
    compare = false;
    if (result.constant_better && k == 0 && !(found.size <= before.size)) {
      // the parabola may be lost by now
      result.constant_better = false;
      result.constant_worse = true;
      set_start<lanes>(layout, arrays, Start::line);
      impose<lanes>(beam, arrays, input);
      continue;
    }
    if (!(found.size < 1e300) || !(found.largest <= most_half_turn * most_half_turn)) return result;
    const double moved = (input.h * input.h) * sweep.apply();
    ++result.iterations;
    if (k > 0) {
      if (found.size <= floor) {
        result.solved = true;
        break;
      }
      const double contraction = poor_contraction * poor_contraction;
      if (!(found.size <= poor_contraction * before.size) && !(moved <= contraction * moved_before))
        return result;
      const double curvature = found.size / moved_before;
      if (!(curvature <= result.curvature)) result.curvature = curvature;
    }
    if (result.curvature >= 0.0) {
      const double left = safety * result.curvature * moved;
      // What the parts of the residual come to in the end is at least the difference.
      if (left <= 0.01 * floor || left <= 0.1 * beam.tolerance * (found.scale - found.size)) {
        result.solved = true;
        break;
      }
    }
    moved_before = moved;
    before = found;
    ++k;
  }
  if (result.solved) finish<lanes, cayley>(layout, arrays, sweep.constants());
  return result;
}

}  // namespace
}  // namespace gnomon::beam::linear
