#pragma once
// The README's example: a model and a scheme of one's own, whole.
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "src/catalogue.hpp"
#include "src/ode.hpp"

namespace example {

using namespace gnomon;

/// A plane pendulum of unit length and mass in gravity g [m/s^2]: a'' = -g sin a.
class Pendulum {
 public:
  struct State {
    double angle, rate;  // rad, rad/s
  };
  static constexpr std::string_view model_name = "pendulum", variant = "";
  static constexpr std::array<MetricInfo, 2> metrics{MetricInfo{"angle", "rad", 3.0},
                                                     MetricInfo{"rate", "rad/s", 9.0}};

  explicit Pendulum(double g) : g_(g) {}

  State initial() const { return {1.0, 0.0}; }
  double acceleration(double angle) const { return -g_ * std::sin(angle); }
  std::string_view load_class() const { return "gravity"; }
  double time_scale() const { return 1.0 / std::sqrt(g_); }
  std::vector<double> breaks() const { return {}; }

  std::vector<double> flatten(const State& s) const { return {s.angle, s.rate}; }
  State restore(const std::vector<double>& flat) const { return {flat[0], flat[1]}; }
  std::vector<Named> observe(const State& s) const { return {{"angle", {s.angle}}, {"rate", {s.rate}}}; }
  std::array<double, 2> distance(const State& s, const State& reference) const {
    return {std::abs(s.angle - reference.angle), std::abs(s.rate - reference.rate)};
  }
  std::vector<InvariantInfo> invariant_info() const { return {{"energy", 1, 0.0, g_}}; }
  void invariants(double, const State& s, double* out) const {
    *out = 0.5 * s.rate * s.rate + g_ * (1.0 - std::cos(s.angle));
  }

  /// With this form CVODE and ARKODE run on it, and references are certified.
  struct Ode {
    const Pendulum* model;
    int size() const { return 2; }
    std::vector<double> scales() const { return {1.0, 1.0 / model->time_scale()}; }
    std::optional<SparsePattern> sparsity() const { return std::nullopt; }
    void pack(double, const State& s, double* y) const { y[0] = s.angle, y[1] = s.rate; }
    State unpack(double, const double* y) const { return {y[0], y[1]}; }
    void rhs(double, const double* y, double* rate) const {
      rate[0] = y[1], rate[1] = model->acceleration(y[0]);
    }
    void jacobian(double, const double* y, double* J) const {  // column by column
      J[0] = 0.0, J[1] = -model->g_ * std::cos(y[0]), J[2] = 1.0, J[3] = 0.0;
    }
  };
  Ode ode() const { return {this}; }

 private:
  double g_;
};

/// The Stoermer-Verlet scheme for anything with an angle, a rate and an acceleration.
struct Verlet {
  static constexpr SchemeInfo info{
      .name = "verlet",
      .family = "example",
      .summary = "Stoermer-Verlet: half kick, drift, half kick",
      .citation = "E. Hairer, C. Lubich, G. Wanner, Acta Numerica 12 (2003) 399-450, eq. (1.5)",
      .form = "acceleration",
      .stages = 2,
      .orders = {{{"gravity", 2}}},
      .reversible = true,
  };
  template <class M>
  using State = typename M::State;
  template <class M>
  static typename M::State start(const M&, const typename M::State& state) {
    return state;
  }
  template <class M>
  static typename M::State view(const M&, const typename M::State& state) {
    return state;
  }
  template <class M>
  static Cost cost(const M&, const typename M::State&, long steps) {
    return {.steps = steps, .rhs = 2 * steps};
  }
  template <class M>
  static Status step(const M& model, typename M::State& s, double, double h) requires requires {
    model.acceleration(s.angle);
  }
  {
    s.rate += 0.5 * h * model.acceleration(s.angle);
    s.angle += h * s.rate;
    s.rate += 0.5 * h * model.acceleration(s.angle);
    return Status::ok;
  }
};

/// The catalogue lines.
inline Catalogue catalogue() {
  Catalogue catalogue;
  add_model_types(catalogue, TypeList<Pendulum>{});
  add_schemes<TypeList<Pendulum>>(catalogue, TypeList<Verlet>{});
  return catalogue;
}

}  // namespace example
