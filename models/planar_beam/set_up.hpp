#pragma once
// How a beam is set up from its data: nodes, points, loads, supports and the state at the start. Included by
// planar_beam.cpp alone.

#include <algorithm>
#include <cmath>

#include "models/planar_beam/planar_beam.hpp"

namespace gnomon::planar_beam {

template <int p>
PlanarBeam<p>::PlanarBeam(Data data)
    : data_(std::move(data)),
      element_(data_.length / data_.elements),
      numbering_(p, data_.elements, hinged(data_)) {
  place_nodes();
  place_points();
  add_loads();
  hold_ends();
  initial_ = start_state();
  scales_ = estimate_scales(
      data_, centre_, last_position(), turning_inertia(),
      kinetic_energy(initial_.v) + strain_energy(initial_.strain) + spring_energy(initial_.u));
}

template <int p>
std::vector<int> PlanarBeam<p>::hinged(const Data& data) {
  std::vector<int> elements;
  for (const Hinge& hinge : data.hinges)
    elements.push_back(static_cast<int>(std::lround(hinge.at / (data.length / data.elements))));
  return elements;
}

template <int p>
double PlanarBeam<p>::angle(double x) const {
  double sum = data_.angle + data_.curvature * x;
  for (const Bend& bend : data_.bends)
    if (bend.at < x) sum += bend.angle;
  return sum;
}

template <int p>
void PlanarBeam<p>::place_nodes() {
  positions_.resize(2 * static_cast<std::size_t>(nodes()));
  const int last = elements() * p;
  const double half_turn = 0.5 * data_.curvature;
  std::array<double, 2> from = data_.start;  // of the piece between two bends, as are the next two
  double direction = data_.angle;
  int first = 0;
  std::size_t bend = 0;
  for (int i = 0; i <= last; ++i) {
    // A chord of a circle: length sin(k x/2)/(k/2), direction that of the tangent at x/2.
    const double x = data_.length * (i - first) / last, a = half_turn * x;
    const double chord = std::abs(a) < 1e-4 ? x * (1.0 - a * a / 6.0) : std::sin(a) / half_turn;
    const std::array<double, 2> at{from[0] + chord * std::cos(direction + a),
                                   from[1] + chord * std::sin(direction + a)};
    const int end_of = std::max(i - 1, 0) / p;
    std::copy(at.begin(), at.end(), positions_.begin() + 2 * node(end_of, i - p * end_of));
    if (i % p == 0 && i < last) std::copy(at.begin(), at.end(), positions_.begin() + 2 * node(i / p, 0));
    if (bend < data_.bends.size() && i == p * element_from(data_.bends[bend].at)) {
      from = at;
      direction += 2.0 * a + data_.bends[bend++].angle;
      first = i;
    }
  }
  for (int k = 0; k < 2; ++k) {
    double sum = 0.0;
    for (int e = 0; e < elements(); ++e)
      for (int a = 0; a <= p; ++a) sum += element_.load[a] * positions_[2 * node(e, a) + k];
    centre_[k] = sum / data_.length;
  }
}

template <int p>
void PlanarBeam<p>::place_points() {
  for (int e = 0; e < elements(); ++e)
    for (int g = 0; g < p; ++g) {
      const double phi0 = angle((e + element_.at[g]) * element_.length);
      const double c = std::cos(phi0), s = std::sin(phi0);
      if (data_.geometry == Geometry::exact) {
        points_.push_back({c, s, -1.0, 0.0, -phi0});
        continue;
      }
      double d1 = 0.0, d2 = 0.0;
      for (int a = 0; a <= p; ++a) {
        d1 += element_.slope[g][a] * positions_[2 * node(e, a)];
        d2 += element_.slope[g][a] * positions_[2 * node(e, a) + 1];
      }
      points_.push_back({d1, d2, -(c * d1 + s * d2), -(-s * d1 + c * d2), -phi0});
    }
}

template <int p>
void PlanarBeam<p>::add_loads() {
  for (const Load& load : data_.loads) {
    if (!load.follower) {
      loads_.push_back(load);
      continue;
    }
    followers_.push_back(load);
    if (load.moment != 0.0) {
      loads_.push_back(load);
      loads_.back().force = {0.0, 0.0};
    }
  }
  if (data_.gravity != 0.0)
    loads_.push_back(
        {Place::distributed, {0.0, -data_.gravity * section().rhoA}, 0.0, Profile::constant, 0.0});
}

template <int p>
void PlanarBeam<p>::hold_ends() {
  for (Support& support : data_.supports) {
    if (support.motion) support.place = support.rotation = true;
    if (support.displacement[0] || support.displacement[1]) support.place = true;
  }
  const auto& ends = data_.supports;
  for (int end = 0; end < 2; ++end)
    for (int k = 0; k < 3; ++k)
      if (ends[end].holds(k)) held_.push_back(end_unknown(end) + k);
  const std::vector<int>& tied = numbering_.tied();
  for (int i = 0; i < unknowns(); ++i) {
    const bool ties = std::binary_search(tied.begin(), tied.end(), i);
    if (!ties && !std::binary_search(held_.begin(), held_.end(), i)) free_.push_back(i);
    if (!ties && has_hinges()) mass_index_[i % 3].push_back(i);
  }
  const auto band = [&](int k) {
    return MassBand<p>(element_, numbering_, k < 2, ends[0].holds(k), ends[1].holds(k));
  };
  mass_.push_back(band(0));
  if (ends[0].slide || ends[1].slide) mass_.push_back(band(1));
  mass_.push_back(band(2));
  for (int i : held_)
    if (const Motion* motion = ends[i < 3 ? 0 : 1].motion_of(i % 3))
      driven_.push_back({i, *motion, response_to(i)});
}

template <int p>
typename PlanarBeam<p>::Vector PlanarBeam<p>::response_to(int driven) const {
  Vector unit = Vector::Zero(unknowns()), forces(unknowns()), response(nodes());
  unit[driven] = 1.0;
  momentum(unit.data(), forces.data());
  accelerate(forces.data());
  for (int i = 0; i < nodes(); ++i) response[i] = -forces[3 * i + driven % 3];
  response[driven / 3] = 1.0;
  return response;
}

template <int p>
typename PlanarBeam<p>::State PlanarBeam<p>::start_state() const {
  State state{Vector::Zero(unknowns()), Vector(unknowns()), Vector()};
  if (!data_.u.empty()) {
    state.u = Eigen::Map<const Vector>(data_.u.data(), unknowns());
    state.v = Eigen::Map<const Vector>(data_.v.data(), unknowns());
    state.strain = strains(state.u.data());
    return state;
  }
  const double w = data_.angular_velocity;
  for (int i = 0; i < nodes(); ++i) {
    state.v[3 * i] = data_.velocity[0] + w * (positions_[2 * i + 1] - centre_[1]);
    state.v[3 * i + 1] = data_.velocity[1] - w * (positions_[2 * i] - centre_[0]);
    state.v[3 * i + 2] = w;
  }
  for (int i : held_) state.v[i] = 0.0;
  state.strain = strains(state.u.data());
  return state;
}

template <int p>
std::array<double, 2> PlanarBeam<p>::last_position() const {
  return {positions_[2 * nodes() - 2], positions_[2 * nodes() - 1]};
}

template <int p>
double PlanarBeam<p>::turning_inertia() const {
  double sum = section().rhoI * data_.length;
  for (int k = 0; k < 2; ++k) {
    Vector arm(unknowns());
    for (int i = 0; i < nodes(); ++i) arm[3 * i] = positions_[2 * i + k] - centre_[k];
    sum += section().rhoA * scalar_product(arm.data(), arm.data());
  }
  return sum;
}

}  // namespace gnomon::planar_beam
