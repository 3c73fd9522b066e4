#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "models/rigid_body/exact_free_top.hpp"
#include "models/rigid_body/load.hpp"
#include "models/rigid_body/rigid_body.hpp"
#include "models/rigid_body/state.hpp"
#include "models/rigid_body_ensemble/draw.hpp"
#include "src/instruction_set.hpp"
#include "src/model.hpp"

namespace gnomon::rigid_body_ensemble {

/// The bodies one by one, as every scheme starts from them and is compared by.
struct State {
  std::vector<rigid_body::State> bodies;
};

/// How the bodies are integrated. No result depends on it.
struct Execution {
  int threads = 1;
  InstructionSet instructions = InstructionSet::baseline;
};

/// Rigid bodies that do not act on one another, with inertia, attitude, spin and load drawn at random.
template <class LoadType>
class Ensemble {
 public:
  using State = rigid_body_ensemble::State;
  static constexpr std::string_view model_name = "rigid_body_ensemble";
  static constexpr std::string_view variant = LoadType::kind;
  static constexpr std::array<MetricInfo, 4> metrics{MetricInfo{"orientation_max", "rad", std::numbers::pi},
                                                     MetricInfo{"orientation_rms", "rad", std::numbers::pi},
                                                     MetricInfo{"momentum_max", "1", 1.0},
                                                     MetricInfo{"momentum_rms", "1", 1.0}};
  static constexpr bool has_moment = !std::is_same_v<LoadType, rigid_body::Free>;
  static constexpr bool has_gravity = std::is_same_v<LoadType, rigid_body::Gravity>;

  /// At least one body. `horizon` is the time the scene is run to [s].
  Ensemble(std::vector<Body> bodies, Execution execution, double horizon)
      : bodies_(std::move(bodies)), execution_(execution), horizon_(horizon) {
    double rate = 0.0;
    for (const Body& body : bodies_) {
      const double largest = body.inertia.maxCoeff(), smallest = body.inertia.minCoeff();
      const double spin = body.angular_momentum.cwiseQuotient(body.inertia).norm();
      double momentum = body.angular_momentum.norm();
      double energy = 0.5 * body.angular_momentum.dot(body.angular_momentum.cwiseQuotient(body.inertia));
      double fastest = spin;
      if constexpr (has_gravity) {
        const double depth = body.load.norm();
        momentum = std::max(momentum, std::sqrt(2.0 * largest * depth));
        energy += depth;
        fastest += std::sqrt(2.0 * depth / smallest);
      } else if constexpr (has_moment) {
        momentum = std::max(momentum, body.load.norm() * horizon);
        fastest = std::max(fastest, body.load.norm() * horizon / largest);
      }
      momentum_scales_.push_back(momentum > 0.0 ? momentum : 1.0);
      energies_.push_back(energy > 0.0 ? energy : 1.0);
      rate = std::max(rate, fastest);
    }
    time_scale_ = rate > 0.0 ? 1.0 / rate : horizon;
    if constexpr (!has_moment) {
      motions_.reserve(bodies_.size());
      for (const Body& body : bodies_)
        if (auto& top = motions_.emplace_back();
            body.attitude.allFinite() && std::isfinite(body.angular_momentum.stableNorm()))
          top.emplace(motion<double>(body));
    }
  }

  std::size_t bodies() const { return bodies_.size(); }
  const Eigen::Vector3d& inertia(std::size_t i) const { return bodies_[i].inertia; }
  /// space_moment: the moment in space [N m]; gravity: weight times the body point it acts at [N m].
  const Eigen::Vector3d& load_vector(std::size_t i) const { return bodies_[i].load; }
  int threads() const { return execution_.threads; }
  InstructionSet instructions() const { return execution_.instructions; }

  State initial() const {
    State state;
    state.bodies.reserve(bodies_.size());
    for (const Body& body : bodies_) state.bodies.push_back({body.attitude, body.angular_momentum});
    return state;
  }
  std::string_view load_class() const { return LoadType::kind; }
  double time_scale() const { return time_scale_; }
  std::vector<double> breaks() const { return {}; }

  /// A body after the other: the attitude column by column, then the angular momentum, 12 numbers.
  std::vector<double> flatten(const State& state) const {
    std::vector<double> flat;
    flat.reserve(12 * state.bodies.size());
    for (const rigid_body::State& body : state.bodies) {
      flat.insert(flat.end(), body.attitude.data(), body.attitude.data() + 9);
      flat.insert(flat.end(), body.angular_momentum.data(), body.angular_momentum.data() + 3);
    }
    return flat;
  }
  State restore(const std::vector<double>& flat) const {
    State state;
    for (std::size_t k = 0; k + 12 <= flat.size(); k += 12)
      state.bodies.push_back({Eigen::Map<const Eigen::Matrix3d>(flat.data() + k),
                              Eigen::Map<const Eigen::Vector3d>(flat.data() + k + 9)});
    return state;
  }
  /// Quaternions and angular momenta of the first bodies, one after the other: thousands would fill results.
  std::vector<Named> observe(const State& state) const {
    constexpr std::size_t shown = 16;
    Named orientation{"orientation", {}}, momentum{"angular_momentum", {}};
    for (std::size_t i = 0; i < std::min(shown, state.bodies.size()); ++i) {
      const Eigen::Quaterniond q = rigid_body::unit_quaternion(state.bodies[i].attitude);
      const Eigen::Vector3d& m = state.bodies[i].angular_momentum;
      orientation.values.insert(orientation.values.end(), {q.w(), q.x(), q.y(), q.z()});
      momentum.values.insert(momentum.values.end(), {m[0], m[1], m[2]});
    }
    return {orientation, momentum};
  }

  /// Largest and root mean square over the bodies of the geodesic angle [rad] and of |m - m_ref| relative to
  /// the larger of |m(0)| and |m_ref|. A reference may hold the first bodies alone; then they are compared.
  std::array<double, 4> distance(const State& state, const State& reference) const {
    Spread orientation, momentum;
    for (std::size_t i = 0; i < reference.bodies.size(); ++i) {
      const rigid_body::State &body = state.bodies[i], &exact = reference.bodies[i];
      const double scale = std::max(rigid_body::scaled_norm(bodies_[i].angular_momentum),
                                    rigid_body::scaled_norm(exact.angular_momentum));
      orientation.add(rigid_body::geodesic_angle(body.attitude, exact.attitude));
      momentum.add(rigid_body::scaled_norm(body.angular_momentum - exact.angular_momentum) /
                   (scale > 0.0 ? scale : momentum_scales_[i]));
    }
    return {orientation.largest, orientation.rms(), momentum.largest, momentum.rms()};
  }

  std::vector<InvariantInfo> invariant_info() const {
    std::vector<InvariantInfo> infos{{"orthonormality", 1, 0.0, 1.0}};
    if constexpr (!has_moment || has_gravity) {
      infos.push_back({"energy", 1, 0.0, 1.0});
      infos.push_back({"energy_rms", 1, 0.0, 1.0});
    }
    infos.push_back({"momentum", 1, 0.0, 1.0});
    return infos;
  }

  /// orthonormality: largest entry of |A^T A - 1| of all bodies. energy: mean over the bodies of the change
  /// of T + V relative to its size; energy_rms: root of the mean of its square, which changes of either sign
  /// do not cancel in. momentum: largest change of what is constant of A m (all of it; its vertical part
  /// under gravity; A m - M t under a moment M), relative to the size of A m.
  void invariants(double t, const State& state, double* out) const {
    Spread orthonormality, energy, momentum;
    double sum = 0.0;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const Body& body = bodies_[i];
      const Eigen::Matrix3d& A = state.bodies[i].attitude;
      const Eigen::Vector3d& m = state.bodies[i].angular_momentum;
      orthonormality.add((A.transpose() * A - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff());
      const double change =
          (energy_of(i, A, m) - energy_of(i, body.attitude, body.angular_momentum)) / energies_[i];
      sum += change;
      energy.add(std::abs(change));
      Eigen::Vector3d gain = A * m - body.attitude * body.angular_momentum;
      if constexpr (has_gravity) gain[0] = gain[1] = 0.0;
      if constexpr (has_moment && !has_gravity) gain -= body.load * t;
      momentum.add(gain.norm() / momentum_scales_[i]);
    }
    *out++ = orthonormality.largest;
    if constexpr (!has_moment || has_gravity) {
      *out++ = sum / static_cast<double>(bodies_.size());
      *out++ = energy.rms();
    }
    *out++ = momentum.largest;
  }

  /// Loaded bodies have no closed form: certified solutions, one a body, of the first ones. Bodies being
  /// drawn at random, they stand for all.
  std::size_t reference_parts() const requires has_moment {
    return std::min<std::size_t>(bodies_.size(), 256);
  }
  rigid_body::RigidBody<LoadType> reference_part(std::size_t i) const requires has_moment {
    const Body& body = bodies_[i];
    const rigid_body::State initial{body.attitude, body.angular_momentum};
    if constexpr (has_gravity)
      return {body.inertia, initial, LoadType{1.0, body.load}, horizon_};
    else
      return {body.inertia, initial, LoadType{body.load}, horizon_};
  }
  State join(std::vector<rigid_body::State> bodies) const requires has_moment { return {std::move(bodies)}; }
  /// Of orientation and momentum; no root mean square is larger than the largest.
  std::array<double, 4> join_bounds(const std::vector<double>& largest) const requires has_moment {
    return {largest[0], largest[0], largest[1], largest[1]};
  }

  /// Every body by its closed form, in double precision. What does not depend on the time is worked out once
  /// a body.
  State closed_form(double t) const requires(!has_moment) {
    State state;
    state.bodies.reserve(bodies_.size());
    for (const auto& top : motions_) {
      const auto body = top.value().at(t);
      state.bodies.push_back({body.orientation.toRotationMatrix(), body.angular_momentum});
    }
    return state;
  }
  /// A bound of its errors, the largest of all bodies.
  std::array<double, 4> closed_form_bound(double t) const requires(!has_moment) {
    double bound = 0.0;
    for (const auto& top : motions_) bound = std::max(bound, top.value().error_bound(t));
    bound += 8.0 * 2.2e-16;
    return {bound, bound, bound, bound};
  }
  /// The same in extended precision, as a reference; its bound is the largest of all bodies.
  Exact<Ensemble> exact(double t) const requires(!has_moment) {
    using Real = long double;
    Exact<Ensemble> result{{}, {}};
    double bound = 0.0;
    for (const Body& body : bodies_) {
      const auto top = motion<Real>(body);
      const auto state = top.at(Real(t));
      const Eigen::Quaterniond rounded = state.orientation.normalized().template cast<double>();
      const double coefficients[4] = {rounded.w(), rounded.x(), rounded.y(), rounded.z()};
      result.state.bodies.push_back(
          {rigid_body::homogeneous_matrix(coefficients), state.angular_momentum.template cast<double>()});
      bound = std::max(bound, static_cast<double>(top.error_bound(Real(t))));
    }
    // The state is rounded to double, and so was the initial one: a unit in the last place each.
    result.bound.fill(bound + 8.0 * 2.2e-16);
    return result;
  }

 private:
  /// The largest and the root mean square of some numbers that are not negative; not finite if one is not.
  struct Spread {
    double largest = 0.0, squares = 0.0, count = 0.0;
    void add(double value) {
      if (!(value <= largest || std::isnan(largest))) largest = value;
      squares += value * value;
      count += 1.0;
    }
    double rms() const { return std::sqrt(squares / count); }
  };

  template <class Real>
  static rigid_body::ExactFreeTop<Real> motion(const Body& body) {
    return {body.inertia.cast<Real>(),
            rigid_body::unit_quaternion(body.attitude).template cast<Real>().normalized(),
            body.angular_momentum.cast<Real>()};
  }

  double energy_of(std::size_t i, const Eigen::Matrix3d& A, const Eigen::Vector3d& m) const {
    double energy = 0.5 * m.dot(m.cwiseQuotient(bodies_[i].inertia));
    if constexpr (has_gravity) energy += A.row(2).dot(bodies_[i].load);
    return energy;
  }

  std::vector<Body> bodies_;
  Execution execution_;
  double horizon_;
  std::vector<double> momentum_scales_, energies_;
  std::vector<std::optional<rigid_body::ExactFreeTop<double>>> motions_;  // of free bodies
  double time_scale_ = 1.0;
};

}  // namespace gnomon::rigid_body_ensemble
