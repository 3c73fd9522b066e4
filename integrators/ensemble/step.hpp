#pragma once
// The schemes of integrators/rotation/munjiza.hpp on many bodies at once, one a lane. Compiled once for each
// instruction set, see lanes.hpp.

// A step needs many more numbers than there are registers. With its instructions put in order before
// registers are given out, fewer go to memory and back: rkmk4 under gravity takes a tenth less time. Ahead of
// all other headers, so that nothing that is inlined is compiled otherwise.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("schedule-insns", "sched-pressure")
#endif

#include "integrators/ensemble/kernels.hpp"
#include "integrators/ensemble/rotation.hpp"

namespace gnomon::ensemble {
namespace {

/// Field f and the two after it, of the bodies from i on.
template <class Real>
Vector<Real> load_vector(const Range& range, std::size_t f, std::size_t i) {
  const double* from = range.values + place(f, i);
  if constexpr (std::is_same_v<Real, double>)
    return {from[0], from[block], from[2 * block]};
  else
    return {Real::load(from), Real::load(from + block), Real::load(from + 2 * block)};
}
template <class Real>
void store_vector(const Vector<Real>& vector, const Range& range, std::size_t f, std::size_t i) {
  double* to = range.values + place(f, i);
  if constexpr (std::is_same_v<Real, double>) {
    to[0] = vector.x, to[block] = vector.y, to[2 * block] = vector.z;
  } else {
    vector.x.store(to);
    vector.y.store(to + block);
    vector.z.store(to + 2 * block);
  }
}

/// The moment of one body, or of the bodies in the lanes, in the body triad of time t.
template <Load load_kind, class Real>
class Moment {
 public:
  Moment(const Range& range, std::size_t i)
      : vertical_(load_vector<Real>(range, Field::attitude + 6, i)),
        given_(load_vector<Real>(range, Field::load, i)) {
    if constexpr (load_kind == Load::space_moment)  // A^T M
      given_ = given_.x * load_vector<Real>(range, Field::attitude, i) +
               given_.y * load_vector<Real>(range, Field::attitude + 3, i) + given_.z * vertical_;
  }
  /// At the attitude of time t.
  Vector<Real> operator()() const {
    if constexpr (load_kind == Load::space_moment) return given_;
    return cross(vertical_, given_);  // c x (-W A^T e3)
  }
  /// At that attitude turned further.
  Vector<Real> operator()(const Rotation<Real>& stage) const {
    if constexpr (load_kind == Load::space_moment) return given_;
    return cross(vertical_, stage(given_));
  }

 private:
  Vector<Real> vertical_;  // A^T e3
  Vector<Real> given_;     // A^T M, or the weight times the body point
};

template <class Real>
struct NoMoment {
  NoMoment(const Range&, std::size_t) {}
};

/// One step of the body i, or of the bodies in the lanes from i on. Equation numbers and stages are those of
/// integrators/rotation/munjiza.hpp; all vectors are in the body triad of time t, and y = A^T H is what a
/// body keeps of its momentum, so that H(t+h) = H + M h becomes y(t+h) = R(p)^T (y + h A^T M). False, and
/// nothing done, if a lane has a rotation beyond the range of the polynomials.
template <Scheme scheme, Load load_kind, class Real>
bool step(const Range& range, std::size_t i, double h) {
  constexpr bool has_moment = load_kind != Load::none, is_rkmk4 = scheme == Scheme::rkmk4;
  // Only gravity has other moments at other stages.
  constexpr bool stage_moments = is_rkmk4 && load_kind == Load::gravity;
  using MomentType = std::conditional_t<has_moment, Moment<load_kind, Real>, NoMoment<Real>>;
  using Vec = Vector<Real>;
  const auto twice = [](const Vec& a) { return a + a; };

  const Vec y = load_vector<Real>(range, Field::momentum, i);
  const Vec inverse = load_vector<Real>(range, Field::inverse_inertia, i);
  const Real full = h, half = 0.5 * h, sixth = h / 6.0;
  const MomentType moment(range, i);
  const auto velocity = [&](const Rotation<Real>& stage, const Vec& stage_momentum) {
    return stage(product(inverse, stage.inverse(stage_momentum)));
  };
  // The momentum that a stage sees: y plus the impulse of the moment k in the given time.
  const auto after = [&](const Real& time, const Vec& k) { return y + time * k; };

  const Vec w1 = product(inverse, y);  // (5.79)
  const Vec p1 = half * w1;            // (5.80)
  const Rotation<Real> stage1(p1);     // (5.81)
  Vec w2 = w1, w3 = w1, w4 = w1, k2 = y, k3 = y, end = y;
  if constexpr (has_moment)
    w2 = velocity(stage1, after(is_rkmk4 ? half : full, moment()));  // (5.82)
  else
    w2 = velocity(stage1, y);
  Vec p2 = half * w2;                                                     // (5.83)
  if constexpr (is_rkmk4) p2 = p2 - Real(0.125 * h * h) * cross(w1, w2);  // Munthe-Kaas, left action
  const Rotation<Real> stage2(p2);                                        // (5.84)
  if constexpr (stage_moments)
    w3 = velocity(stage2, after(half, k2 = moment(stage1)));
  else if constexpr (has_moment)
    w3 = velocity(stage2, after(is_rkmk4 ? half : full, moment()));  // (5.85)
  else
    w3 = velocity(stage2, y);
  const Vec p3 = full * w3;         // (5.86)
  const Rotation<Real> stage3(p3);  // (5.87)
  if constexpr (stage_moments) {
    w4 = velocity(stage3, after(full, k3 = moment(stage2)));
    end = after(sixth, moment() + twice(k2 + k3) + moment(stage3));
  } else if constexpr (has_moment) {
    end = after(full, moment());
    w4 = velocity(stage3, end);  // (5.88)
  } else {
    w4 = velocity(stage3, y);
  }
  Vec p = sixth * (w1 + twice(w2 + w3) + w4);                          // (5.89), (5.90)
  if constexpr (is_rkmk4) p = p - Real(h * h / 12.0) * cross(w1, w4);  // Munthe-Kaas, left action
  const Rotation<Real> turn(p);
  if constexpr (!std::is_same_v<Real, double>) {
    const auto wide = [](const Rotation<Real>& rotation) { return beyond(rotation.square(), sinc_limit); };
    if (any((wide(stage1) || wide(stage2)) || (wide(stage3) || wide(turn)))) [[unlikely]]
      return false;
  }

  store_vector<Real>(turn.inverse(end), range, Field::momentum, i);             // (5.92)
  for (std::size_t row = Field::attitude; row < Field::attitude + 9; row += 3)  // (5.91)
    store_vector<Real>(turn.inverse(load_vector<Real>(range, row, i)), range, row, i);
  return true;
}

/// The same for some bodies one by one.
template <Scheme scheme, Load load_kind>
[[gnu::noinline, gnu::flatten]] void step_singly(const Range& range, double h) {
  for (std::size_t i = range.begin; i < range.end; ++i) step<scheme, load_kind, double>(range, i, h);
}

/// Everything is inlined into the loop over the bodies.
template <Scheme scheme, Load load_kind>
[[gnu::flatten]] void step_range(const Range& range, double h) {
  for (std::size_t i = range.begin; i < range.end; i += Lanes::size)
    if (!step<scheme, load_kind, Lanes>(range, i, h)) [[unlikely]]
      step_singly<scheme, load_kind>({range.values, i, i + Lanes::size}, h);
}

template <Scheme scheme>
constexpr Kernels::Row row{step_range<scheme, Load::none>, step_range<scheme, Load::space_moment>,
                           step_range<scheme, Load::gravity>};
constexpr Kernels compiled_kernels{{row<Scheme::munjiza>, row<Scheme::rkmk4>}};

}  // namespace
}  // namespace gnomon::ensemble
