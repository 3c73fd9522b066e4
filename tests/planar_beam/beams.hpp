#pragma once
// Beams for tests, made without scene files.

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <string_view>

#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

namespace gnomon::test {

using planar_beam::Data;
using planar_beam::PlanarBeam;

/// J.C. Simo, L. Vu-Quoc, J. Appl. Mech. 53 (1986) 855.
inline Data flying_beam(int elements, double EI) {
  Data data;
  data.length = 10.0;
  data.elements = elements;
  data.section = {1e4, 1e4, EI, 1.0, 10.0};
  data.start = {6.0, 0.0};
  data.angle = 2.214297435588181;
  data.loads = {{planar_beam::Place::start, {8.0, 0.0}, 80.0, planar_beam::Profile::step, 2.5}};
  data.horizon = 15.0;
  return data;
}

/// A free beam of soft section with a spin; curved by a quarter circle or straight.
inline Data spinning_beam(int elements, bool curved) {
  Data data = flying_beam(elements, 500.0);
  data.loads.clear();
  data.section.rhoI = 1.0;
  data.curvature = curved ? 0.15707963267948966 : 0.0;
  data.velocity = {0.5, 0.2};
  data.angular_velocity = 1.0;
  return data;
}

/// All frequencies of the mesh are low, so that moderate steps are in the range of the order.
inline Data soft_beam(int elements) {
  Data data;
  data.elements = elements;
  data.section = {10.0, 5.0, 0.5, 1.0, 0.1};
  data.gravity = 1.0;
  data.supports[0] = {true, true};
  data.loads = {{planar_beam::Place::end, {0.3, 0.8}, 0.2, planar_beam::Profile::constant, 0.0}};
  data.horizon = 2.0;
  return data;
}

/// A soft arm whose root is turned by a ramp that ends before the time of most tests.
inline Data soft_arm(int elements, double over) {
  Data data = soft_beam(elements);
  data.loads.clear();
  data.gravity = 0.0;
  data.supports[0].motion = planar_beam::Motion{-1.0, over};
  return data;
}

inline const Catalogue& beam_catalogue() {
  static const Catalogue catalogue = full_catalogue();
  return catalogue;
}

/// The schemes of equal steps that are made for beams.
inline std::vector<SchemeInfo> beam_schemes() {
  std::vector<SchemeInfo> schemes;
  for (const SchemeInfo& info : beam_catalogue().schemes)
    if (info.form == "beam" && info.stepping == Stepping::fixed) schemes.push_back(info);
  return schemes;
}

/// Runs a scheme as the program does.
template <int p>
RunResult run_beam(std::string_view scheme, const PlanarBeam<p>& model, const RunSpec& spec) {
  for (const Pair& pair : beam_catalogue().pairs)
    if (pair.scheme == scheme && pair.model_type == typeid(PlanarBeam<p>)) return pair.run(&model, spec);
  throw std::logic_error(std::string(scheme) + " does not run on beams");
}
template <int p>
RunResult run_beam(std::string_view scheme, const PlanarBeam<p>& model, double t_end, double step,
                   int samples = 0) {
  RunSpec spec;
  spec.t_end = t_end;
  spec.step = step;
  spec.samples = samples;
  return run_beam(scheme, model, spec);
}

/// Largest changes of energy and momenta after the invariants' own time, by their scales.
struct Drifts {
  double energy = 0.0, linear = 0.0, angular = 0.0;
};
template <int p>
Drifts drifts_of(const PlanarBeam<p>& model, const RunResult& result) {
  INFO(result.message);
  REQUIRE(result.status == Status::ok);
  const auto infos = model.invariant_info();
  const std::size_t count = infos.size() == 3 ? 4 : 1;
  const double* first = nullptr;
  Drifts most;
  for (std::size_t k = 0; k < result.invariants.t.size(); ++k) {
    if (result.invariants.t[k] < infos[0].since) continue;
    const double* now = result.invariants.values.data() + count * k;
    if (!first) first = now;
    most.energy = std::max(most.energy, std::abs(now[0] - first[0]) / infos[0].scale);
    if (count == 1) continue;
    most.linear = std::max(most.linear, std::hypot(now[1] - first[1], now[2] - first[2]) / infos[1].scale);
    most.angular = std::max(most.angular, std::abs(now[3] - first[3]) / infos[2].scale);
  }
  REQUIRE(first);
  return most;
}
template <int p>
Drifts drifts(std::string_view scheme, const PlanarBeam<p>& model, double t_end, double step) {
  return drifts_of(model, run_beam(scheme, model, t_end, step));
}

/// Nodal values in [-size, size].
inline Eigen::VectorXd random_values(int count, double size, unsigned seed) {
  std::mt19937 engine(seed);
  Eigen::VectorXd values(count);
  for (double& value : values) value = size * (2.0 * static_cast<double>(engine()) / 4294967295.0 - 1.0);
  return values;
}

}  // namespace gnomon::test
