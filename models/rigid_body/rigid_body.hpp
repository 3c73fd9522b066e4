#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "models/rigid_body/absolute_dae.hpp"
#include "models/rigid_body/dae.hpp"
#include "models/rigid_body/exact_free_top.hpp"
#include "models/rigid_body/heavy_symmetric_top.hpp"
#include "models/rigid_body/load.hpp"
#include "models/rigid_body/ode.hpp"
#include "models/rigid_body/state.hpp"
#include "src/model.hpp"

namespace gnomon::rigid_body {

/// A rigid body turning about its centre of mass or about a pivot; its position is not part of the model.
template <class LoadType>
class RigidBody {
 public:
  using Load = LoadType;
  using State = rigid_body::State;
  static constexpr std::string_view model_name = "rigid_body";
  static constexpr std::string_view variant = Load::kind;
  static constexpr std::array<MetricInfo, 2> metrics{MetricInfo{"orientation", "rad", std::numbers::pi},
                                                     MetricInfo{"momentum", "1", 1.0}};
  static constexpr bool has_moment = !std::is_same_v<Load, Free>;

  /// Principal moments of inertia [kg m^2], the initial state, the load and the time [s] that the scene is
  /// run to (which sets the momentum scale of a body that a constant moment sets in motion).
  RigidBody(const Vector<double>& inertia, const State& initial, Load load, double horizon)
      : inertia_(inertia), initial_(initial), load_(std::move(load)) {
    const double largest = inertia.maxCoeff(), smallest = inertia.minCoeff();
    double rate = scaled_norm(initial.angular_momentum.cwiseQuotient(inertia));
    double momentum = scaled_norm(initial.angular_momentum);
    if constexpr (HasPotential<Load>) {
      const double depth = load_.depth();
      momentum = std::max(momentum, std::sqrt(2.0 * largest * depth));
      rate += std::sqrt(2.0 * depth / smallest);
    } else if constexpr (has_moment) {
      momentum = std::max(momentum, scaled_norm(load_.moment) * horizon);
      rate = std::max(rate, scaled_norm(load_.moment) * horizon / largest);
    }
    if constexpr (!has_moment)
      if (initial.attitude.allFinite() && std::isfinite(initial.angular_momentum.stableNorm()))
        free_motion_.emplace(inertia, unit_quaternion(initial.attitude), initial.angular_momentum);
    if constexpr (std::is_same_v<Load, Gravity>)
      if (symmetric_top_refusal().empty() && initial.attitude.allFinite() &&
          std::isfinite(initial.angular_momentum.stableNorm())) {
        const int axis = symmetry_axis();
        symmetric_motion_ = SymmetricMotion{top_axes(axis, load_.weight * load_.centre[axis] > 0.0),
                                            HeavySymmetricTop<double>(top_data())};
      }
    momentum_scale_ = momentum > 0.0 ? momentum : 1.0;
    time_scale_ = rate > 0.0 ? 1.0 / rate : horizon;
  }

  const Vector<double>& inertia() const { return inertia_; }
  const Load& load() const { return load_; }
  State initial() const { return initial_; }
  /// A moment that depends on the attitude asks the same of a scheme whatever its potential is.
  std::string_view load_class() const { return HasPotential<Load> ? Gravity::kind : Load::kind; }
  double time_scale() const { return time_scale_; }
  double momentum_scale() const { return momentum_scale_; }
  std::vector<double> breaks() const { return {}; }

  /// Moment about the reference point in space components, N m.
  Vector<double> moment(double t, const Eigen::Matrix3d& attitude) const requires has_moment {
    return load_.space_moment(t, attitude);
  }
  Vector<double> moment(double, const Eigen::Matrix3d&) const requires(!has_moment) {
    return Vector<double>::Zero();
  }

  /// The attitude column by column, then the angular momentum: 12 numbers.
  std::vector<double> flatten(const State& state) const {
    std::vector<double> flat(state.attitude.data(), state.attitude.data() + 9);
    flat.insert(flat.end(), state.angular_momentum.data(), state.angular_momentum.data() + 3);
    return flat;
  }
  State restore(const std::vector<double>& flat) const {
    return {Eigen::Map<const Eigen::Matrix3d>(flat.data()),
            Eigen::Map<const Eigen::Vector3d>(flat.data() + 9)};
  }
  std::vector<Named> observe(const State& state) const {
    const Eigen::Quaterniond q = unit_quaternion(state.attitude);
    const Eigen::Vector3d& m = state.angular_momentum;
    return {{"orientation", {q.w(), q.x(), q.y(), q.z()}}, {"angular_momentum", {m[0], m[1], m[2]}}};
  }

  /// Orientation: geodesic angle [rad]. Momentum: |m - m_ref| relative to the larger of |m(0)| and |m_ref|.
  /// The norms are scaled, as squares of very small or large momenta leave the range of double.
  std::array<double, 2> distance(const State& state, const State& reference) const {
    const double scale =
        std::max(scaled_norm(initial_.angular_momentum), scaled_norm(reference.angular_momentum));
    const double difference = scaled_norm(state.angular_momentum - reference.angular_momentum);
    return {geodesic_angle(state.attitude, reference.attitude),
            difference / (scale > 0.0 ? scale : momentum_scale_)};
  }

  std::vector<InvariantInfo> invariant_info() const {
    const double energy = energy_scale(), momentum = momentum_scale_;
    std::vector<InvariantInfo> infos{{"orthonormality", 1, 0.0, 1.0}};
    if constexpr (std::is_same_v<Load, Free>) {
      infos.push_back({"energy", 1, 0.0, energy});
      infos.push_back({"angular_momentum", 3, 0.0, momentum});
      infos.push_back({"momentum_norm", 1, 0.0, momentum});
    } else if constexpr (std::is_same_v<Load, Gravity>) {
      infos.push_back({"energy", 1, 0.0, energy});
      infos.push_back({"vertical_momentum", 1, 0.0, momentum});
      if (symmetry_axis() >= 0) infos.push_back({"axial_momentum", 1, 0.0, momentum});
      if (is_kovalevskaya()) {
        const double w2 = initial_.angular_momentum.cwiseQuotient(inertia_).squaredNorm();
        const double c = load_.weight * load_.centre.norm() / inertia_[2];
        infos.push_back({"kovalevskaya", 1, 0.0, (w2 + c) * (w2 + c)});
      }
    } else if constexpr (HasPotential<Load>) {
      infos.push_back({"energy", 1, 0.0, energy});
    } else if constexpr (std::is_same_v<Load, SpaceMoment>) {
      infos.push_back({"momentum_balance", 3, 0.0, momentum});
    }
    return infos;
  }

  /// orthonormality: largest entry of |A^T A - 1|. energy T + V [J]. angular_momentum: A m, in space.
  /// momentum_norm: |m|. vertical_momentum: (A m).e3. axial_momentum: m along the axis of a Lagrange top.
  /// kovalevskaya: the fourth integral of the Kovalevskaya top. momentum_balance: A m - M t for a
  /// space-constant moment M.
  void invariants(double t, const State& state, double* out) const {
    const Eigen::Matrix3d& A = state.attitude;
    const Eigen::Vector3d& m = state.angular_momentum;
    const Eigen::Vector3d H = A * m;
    const double kinetic = 0.5 * m.dot(m.cwiseQuotient(inertia_));
    *out++ = (A.transpose() * A - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
    if constexpr (std::is_same_v<Load, Free>) {
      *out++ = kinetic;
      for (int k = 0; k < 3; ++k) *out++ = H[k];
      *out++ = scaled_norm(m);
    } else if constexpr (std::is_same_v<Load, Gravity>) {
      *out++ = kinetic + load_.potential(A);
      *out++ = H[2];
      if (symmetry_axis() >= 0) *out++ = m[symmetry_axis()];
      if (is_kovalevskaya()) {
        const Eigen::Vector3d w = m.cwiseQuotient(inertia_), g = A.row(2);
        const double c = load_.weight * load_.centre[0] / inertia_[2];
        const double a = w[0] * w[0] - w[1] * w[1] - c * g[0], b = 2.0 * w[0] * w[1] - c * g[1];
        *out++ = a * a + b * b;
      }
    } else if constexpr (HasPotential<Load>) {
      *out++ = kinetic + load_.potential(A);
    } else if constexpr (std::is_same_v<Load, SpaceMoment>) {
      for (int k = 0; k < 3; ++k) *out++ = H[k] - load_.moment[k] * t;
    }
  }

  OdeForm<Load> ode() const { return {inertia_, load_, momentum_scale_}; }
  DaeForm<Load, true> dae() const { return {inertia_, load_, momentum_scale_}; }
  DaeForm<Load, false> dae_index2() const { return {inertia_, load_, momentum_scale_}; }
  /// In absolute coordinates, with the pivot as a constraint.
  AbsoluteDaeForm<true> dae_constraints() const requires std::is_same_v<Load, Gravity> {
    return {inertia_, load_, momentum_scale_};
  }
  AbsoluteDaeForm<false> dae_index3() const requires std::is_same_v<Load, Gravity> {
    return {inertia_, load_, momentum_scale_};
  }
  /// Whether there is a body with this inertia about the pivot and this centre of mass.
  bool is_constrained() const requires std::is_same_v<Load, Gravity> {
    const Eigen::Matrix3d central = AbsoluteDaeForm<true>::central_inertia(inertia_, load_);
    return load_.centre.norm() > 0.0 && central.llt().info() == Eigen::Success;
  }

  /// The rates of y = (q, m) and a start in any precision, for references.
  template <class Real>
  void extended_rhs(Real, const Real* y, Real* rate) const {
    rates(inertia_, load_, y, rate);
  }

  /// The closed form of the free body in double precision, as an integrator of its own. What does not depend
  /// on the time is worked out once a body.
  State closed_form(double t) const requires(!has_moment) {
    const auto state = free_motion_.value().at(t);
    return {state.orientation.toRotationMatrix(), state.angular_momentum};
  }

  /// A bound of its errors against the closed form of the data as given. The attitude is a rounded matrix at
  /// both ends.
  std::array<double, 2> closed_form_bound(double t) const requires(!has_moment) {
    const double bound = free_motion_.value().error_bound(t) + 8.0 * 2.2e-16;
    return {bound, bound};
  }

  /// The closed form of Lagrange's top in double precision, as an integrator of its own, and why this body is
  /// none; empty if it is. What does not depend on the time is worked out once a body.
  State symmetric_top(double t) const requires std::is_same_v<Load, Gravity> {
    const SymmetricMotion& motion = symmetric_motion_.value();
    const auto state = motion.top.at(t);
    return {(state.orientation * motion.turn.conjugate()).toRotationMatrix(),
            motion.turn * state.angular_momentum};
  }
  std::string_view symmetric_top_refusal() const requires std::is_same_v<Load, Gravity> {
    const int axis = symmetry_axis();
    if (axis < 0) return "the body is not symmetric about the axis through its centre";
    if (load_.weight * load_.centre[axis] == 0.0) return "the weight has no moment";
    return {};
  }

  /// The closed form of Lagrange's top in extended precision with its bound; nothing for other bodies.
  std::optional<Exact<RigidBody>> exact_if_known(double t) const requires std::is_same_v<Load, Gravity> {
    if (!symmetric_motion_) return std::nullopt;
    using Real = long double;
    const HeavySymmetricTop<Real> top(top_data());
    const auto state = top.at(Real(t));
    const Eigen::Quaterniond turn = symmetric_motion_->turn;
    const Eigen::Quaterniond q =
        (state.orientation * turn.conjugate().cast<Real>()).normalized().template cast<double>();
    const double coefficients[4] = {q.w(), q.x(), q.y(), q.z()};
    const Eigen::Vector3d m = turn.toRotationMatrix() * state.angular_momentum.template cast<double>();
    // The state is rounded to double, and so was the initial one: a unit in the last place each.
    const double bound = static_cast<double>(top.error_bound(Real(t))) + 8.0 * 2.2e-16;
    const double size = std::max(initial_.angular_momentum.norm(), m.norm());
    return Exact<RigidBody>{
        {homogeneous_matrix(coefficients), m},
        {bound, size > 0.0 ? std::min(2.0, bound * static_cast<double>(top.momentum_size()) / size) : bound}};
  }

  /// The closed form of the free body in extended precision, as a reference with its bound.
  Exact<RigidBody> exact(double t) const requires(!has_moment) {
    using Real = long double;
    const Eigen::Quaterniond q = unit_quaternion(initial_.attitude);
    const ExactFreeTop<Real> top(inertia_.cast<Real>(), q.cast<Real>().normalized(),
                                 initial_.angular_momentum.cast<Real>());
    const auto state = top.at(Real(t));
    const Eigen::Quaterniond orientation = state.orientation.normalized().template cast<double>();
    const double coefficients[4] = {orientation.w(), orientation.x(), orientation.y(), orientation.z()};
    // The state is rounded to double, and so was the initial one: a unit in the last place each.
    const double bound = static_cast<double>(top.error_bound(Real(t))) + 8.0 * 2.2e-16;
    return {{homogeneous_matrix(coefficients), state.angular_momentum.template cast<double>()},
            {bound, bound}};
  }

 private:
  /// The axis k of a Lagrange top: the centre lies on it and the two other moments are equal; else -1.
  int symmetry_axis() const {
    if constexpr (std::is_same_v<Load, Gravity>) {
      for (int k = 0; k < 3; ++k) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        if (inertia_[a] == inertia_[b] && load_.centre[a] == 0.0 && load_.centre[b] == 0.0) return k;
      }
    }
    return -1;
  }
  HeavyTopData top_data() const requires std::is_same_v<Load, Gravity> {
    const int axis = symmetry_axis();
    return HeavyTopData::of(inertia_, load_.weight, load_.centre[axis], axis,
                            unit_quaternion(initial_.attitude), initial_.angular_momentum);
  }
  bool is_kovalevskaya() const {
    if constexpr (std::is_same_v<Load, Gravity>) {
      return inertia_[0] == inertia_[1] && inertia_[0] == 2.0 * inertia_[2] && load_.centre[1] == 0.0 &&
             load_.centre[2] == 0.0;
    }
    return false;
  }
  double energy_scale() const {
    double scale = 0.5 * initial_.angular_momentum.dot(initial_.angular_momentum.cwiseQuotient(inertia_));
    if constexpr (HasPotential<Load>) scale += load_.depth();
    return scale > 0.0 ? scale : 1.0;
  }

  Vector<double> inertia_;
  State initial_;
  Load load_;
  double momentum_scale_ = 1.0;
  double time_scale_ = 1.0;
  struct SymmetricMotion {
    Eigen::Quaterniond turn;  ///< from axes with the symmetry axis third and upright to those of the body
    HeavySymmetricTop<double> top;
  };
  std::conditional_t<std::is_same_v<Load, Gravity>, std::optional<SymmetricMotion>, std::monostate>
      symmetric_motion_;
  std::conditional_t<has_moment, std::monostate, std::optional<ExactFreeTop<double>>> free_motion_;
};

}  // namespace gnomon::rigid_body
