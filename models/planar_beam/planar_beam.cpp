#include "models/planar_beam/planar_beam.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "models/planar_beam/set_up.hpp"

namespace gnomon::planar_beam {

template <int p>
std::string_view PlanarBeam<p>::load_class() const {
  if (has_followers()) return "follower";
  return data_.loads.empty() && data_.gravity == 0.0 ? "none" : "dead";
}

template <int p>
std::vector<double> PlanarBeam<p>::breaks() const {
  std::vector<double> times;
  for (const Load& load : data_.loads) {
    if (load.profile == Profile::table)
      times.insert(times.end(), load.table.t.begin(), load.table.t.end());
    else if (load.profile != Profile::constant)
      times.push_back(load.duration);
  }
  for (const Driven& one : driven_) {
    const std::vector<double> own = one.motion.breaks();
    times.insert(times.end(), own.begin(), own.end());
  }
  std::erase_if(times, [](double t) { return t <= 0.0; });
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

template <int p>
void PlanarBeam<p>::add_load(const Load& load, double factor, double* force) const {
  if (factor != 0.0) for_load(load, factor, [&](int i, double value) { force[i] += value; });
}

template <int p>
void PlanarBeam<p>::external_force(double t, double* force, Sides sides) const {
  std::fill(force, force + unknowns(), 0.0);
  for (const Load& load : loads_) add_load(load, load.factor(t), force);
  if (sides == Sides::joined) numbering_.join(force);
}

template <int p>
typename PlanarBeam<p>::Following PlanarBeam<p>::following(double t, int end, double phi) const {
  Following sum;
  for (const Load& load : followers_)
    if (load.at == (end == 0 ? Place::start : Place::end)) sum.add(load.factor(t), load, phi);
  return sum;
}

template <int p>
void PlanarBeam<p>::add_following(double t, const double* u, double* force) const {
  if (!has_followers()) return;
  for (int end = 0; end < 2; ++end) {
    const int i = end_unknown(end);
    const Following one = following(t, end, u[i + 2]);
    force[i] += one.force[0];
    force[i + 1] += one.force[1];
  }
}

template <int p>
void PlanarBeam<p>::internal_force(const double* u, double* force, Sides sides) const {
  std::fill(force, force + unknowns(), 0.0);
  for (int e = 0; e < elements(); ++e)
    for (int g = 0; g < p; ++g)
      element_.add_force(g, strain_at(u, e, g).force(section()), force + numbering_.first(e));
  add_hinge_moments(1.0, u, force);
  if (sides == Sides::joined) numbering_.join(force);
  for (int end = 0; end < 2; ++end) force[end_unknown(end) + 2] += spring(end) * u[end_unknown(end) + 2];
}

template <int p>
typename Element<p>::Matrix PlanarBeam<p>::element_tangent(const double* u, int e) const {
  typename Element<p>::Matrix matrix = Element<p>::Matrix::Zero();
  for (int g = 0; g < p; ++g) element_.add_tangent(g, strain_at(u, e, g).tangent(section()), matrix);
  if (has_springs()) for_ends_of(e, [&](int end, int i) { matrix(i + 2, i + 2) += spring(end); });
  return matrix;
}

template <int p>
typename Element<p>::Matrix PlanarBeam<p>::element_tangent(double t, const double* u, int e) const {
  typename Element<p>::Matrix matrix = element_tangent(u, e);
  if (has_followers())
    for_ends_of(e, [&](int end, int i) {
      const Following one = following(t, end, u[end_unknown(end) + 2]);
      matrix(i, i + 2) -= one.slope[0];
      matrix(i + 1, i + 2) -= one.slope[1];
    });
  return matrix;
}

template <int p>
void PlanarBeam<p>::momentum(const double* v, double* product, Sides sides) const {
  std::fill(product, product + unknowns(), 0.0);
  for (int e = 0; e < elements(); ++e) {
    const int first = numbering_.first(e);
    for (int a = 0; a <= p; ++a)
      for (int b = 0; b <= p; ++b)
        for (int k = 0; k < 3; ++k)
          product[first + 3 * a + k] += element_.mass[a][b] * density(k) * v[first + 3 * b + k];
  }
  if (sides == Sides::joined) numbering_.join(product);
}

template <int p>
void PlanarBeam<p>::accelerate(double* force) const {
  numbering_.join(force);
  for (int i : held_) force[i] = 0.0;
  const MassBand<p>& along_z = mass_[mass_.size() == 3 ? 1 : 0];
  if (has_hinges()) {
    mass_[0].solve(mass_index_[0], force);
    along_z.solve(mass_index_[1], force);
    mass_.back().solve(mass_index_[2], force);
    numbering_.spread(force);
  } else {
    MassBand<p>::solve(mass_[0], along_z, mass_.back(), force);
  }
  const double place = 1.0 / section().rhoA, rotation = 1.0 / section().rhoI;
  for (int i = 0; i < nodes(); ++i) {
    force[3 * i] *= place;
    force[3 * i + 1] *= place;
    force[3 * i + 2] *= rotation;
  }
}

template <int p>
typename PlanarBeam<p>::Vector PlanarBeam<p>::strains(const double* u) const {
  Vector strain(3 * point_count());
  for (int e = 0; e < elements(); ++e)
    for (int g = 0; g < p; ++g) {
      const PointStrain at = strain_at(u, e, g);
      strain.template segment<3>(3 * (e * p + g)) << at.e1, at.e2, at.bending;
    }
  return strain;
}

template <int p>
PointStrain PlanarBeam<p>::strain_at(const double* u, int e, int g) const {
  const double* nodal = u + numbering_.first(e);
  double s1 = 0, s2 = 0, s3 = 0, rotation = 0;
  for (int a = 0; a <= p; ++a) {
    s1 += element_.slope[g][a] * nodal[3 * a];
    s2 += element_.slope[g][a] * nodal[3 * a + 1];
    s3 += element_.slope[g][a] * nodal[3 * a + 2];
    rotation += element_.shape[g][a] * nodal[3 * a + 2];
  }
  return {points_[e * p + g], s1, s2, s3, rotation};
}

template <int p>
std::vector<double> PlanarBeam<p>::flatten(const State& state) const {
  std::vector<double> flat(state.u.begin(), state.u.end());
  flat.insert(flat.end(), state.v.begin(), state.v.end());
  flat.insert(flat.end(), state.strain.begin(), state.strain.end());
  return flat;
}

template <int p>
typename PlanarBeam<p>::State PlanarBeam<p>::restore(const std::vector<double>& flat) const {
  using Map = Eigen::Map<const Vector>;
  const double* at = flat.data();
  return {Map(at, unknowns()), Map(at + unknowns(), unknowns()), Map(at + 2 * unknowns(), 3 * point_count())};
}

template <int p>
std::vector<Named> PlanarBeam<p>::observe(const State& state) const {
  return {{"u", {state.u.begin(), state.u.end()}}, {"v", {state.v.begin(), state.v.end()}}};
}

template <int p>
std::vector<Probe> PlanarBeam<p>::probes(const State& state) const {
  const auto at = [&](const char* name, int i) {
    return Probe{name, {{"x", state.u[i]}, {"z", state.u[i + 1]}, {"phi", state.u[i + 2]}}};
  };
  std::vector<Probe> probes{at("start", 0), at("end", unknowns() - 3)};
  for (std::size_t k = 0; k < data_.hinges.size(); ++k) {
    const int left = numbering_.left_rotation(static_cast<int>(k)),
              right = numbering_.right_rotation(static_cast<int>(k));
    probes.push_back({"hinge" + std::to_string(k + 1),
                      {{"x", state.u[left - 2]},
                       {"z", state.u[left - 1]},
                       {"phi", state.u[left]},
                       {"jump", state.u[right] - state.u[left]}}});
  }
  return probes;
}

template <int p>
std::array<double, 4> PlanarBeam<p>::distance(const State& state, const State& reference) const {
  const Vector du = state.u - reference.u, dv = state.v - reference.v;
  const auto norm = [&](const Vector& d, int from, int to) {
    double sum = 0.0;
    for (int k = from; k < to; ++k) sum += scalar_product(d.data() + k, d.data() + k);
    return std::sqrt(std::max(sum, 0.0) / data_.length);
  };
  return {norm(du, 0, 2), norm(du, 2, 3), norm(dv, 0, 2), norm(dv, 2, 3)};
}

template <int p>
std::vector<InvariantInfo> PlanarBeam<p>::invariant_info() const {
  const std::vector<double> times = breaks();
  const double since = times.empty() ? 0.0 : times.back();
  std::vector<InvariantInfo> infos;
  if (keeps_energy()) infos.push_back({"energy", 1, since, scales_.energy});
  if (is_free_at_last()) {
    infos.push_back({"linear_momentum", 2, since, scales_.momentum});
    infos.push_back({"angular_momentum", 1, since, scales_.angular_momentum});
  }
  return infos;
}

template <int p>
void PlanarBeam<p>::invariants(double t, const State& state, double* out) const {
  if (keeps_energy())
    *out++ = kinetic_energy(state.v) + energy_of_jump(t, state.v) + strain_energy(state.strain) +
             spring_energy(state.u) + load_potential(state.u);
  if (!is_free_at_last()) return;
  const std::array<double, 3> momenta = this->momenta(state);
  std::copy(momenta.begin(), momenta.end(), out);
}

template <int p>
double PlanarBeam<p>::kinetic_energy(const Vector& v) const {
  double sum = 0.0;
  for (int k = 0; k < 3; ++k) sum += 0.5 * density(k) * scalar_product(v.data() + k, v.data() + k);
  return sum;
}

template <int p>
double PlanarBeam<p>::strain_energy(const Vector& strain) const {
  const CrossSection& C = section();
  double sum = 0.0;
  for (int k = 0; k < point_count(); ++k) {
    const double* e = strain.data() + 3 * k;
    sum += 0.5 * element_.weight[k % p] * (C.EA * e[0] * e[0] + C.GA * e[1] * e[1] + C.EI * e[2] * e[2]);
  }
  return sum;
}

template <int p>
double PlanarBeam<p>::spring_energy(const Vector& u) const {
  double sum = 0.0;
  for (int end = 0; end < 2; ++end) {
    const double phi = u[end_unknown(end) + 2];
    sum += 0.5 * spring(end) * phi * phi;
  }
  for_hinge_springs([&](int k, double stiffness) {
    const double turn = u[numbering_.right_rotation(k)] - u[numbering_.left_rotation(k)];
    sum += 0.5 * stiffness * turn * turn;
  });
  return sum;
}

template <int p>
double PlanarBeam<p>::energy_of_jump(double t, const Vector& v) const {
  if (!is_driven()) return 0.0;
  const auto change = [&](const Driven& one) {
    const double at = one.motion.snapped(t, 1e-9 * one.motion.over);
    return one.motion.rate_after(at) - one.motion.rate_before(at);
  };
  if (std::none_of(driven_.begin(), driven_.end(), [&](const Driven& one) { return change(one) != 0.0; }))
    return 0.0;
  // (v + j)^T M (v + j)/2 - v^T M v/2 with the jumps j of one component of all nodes
  double sum = 0.0;
  for (int k = 0; k < 3; ++k) {
    const auto jump_at = [&](int i) {
      double jump = 0.0;
      for (const Driven& one : driven_)
        if (one.unknown % 3 == k) jump += change(one) * one.response[i];
      return jump;
    };
    for (int e = 0; e < elements(); ++e)
      for (int a = 0; a <= p; ++a)
        for (int b = 0; b <= p; ++b)
          sum += density(k) * element_.mass[a][b] * jump_at(node(e, a)) *
                 (v[3 * node(e, b) + k] + 0.5 * jump_at(node(e, b)));
  }
  return sum;
}

template <int p>
double PlanarBeam<p>::load_potential(const Vector& u) const {
  double work = 0.0;
  for (const Load& load : loads_)
    if (load.final_factor() != 0.0)
      for_load(load, load.final_factor(), [&](int i, double force) { work += force * u[i]; });
  return -work;
}

template <int p>
std::array<double, 3> PlanarBeam<p>::momenta(const State& state) const {
  std::array<double, 3> sum{};
  for (int e = 0; e < elements(); ++e)
    for (int a = 0; a <= p; ++a)
      for (int b = 0; b <= p; ++b) {
        const int i = node(e, a), j = node(e, b);
        const double m = element_.mass[a][b] * section().rhoA;
        const double x = positions_[2 * i] + state.u[3 * i], z = positions_[2 * i + 1] + state.u[3 * i + 1];
        const double vx = state.v[3 * j], vz = state.v[3 * j + 1];
        sum[0] += m * vx;
        sum[1] += m * vz;
        sum[2] += m * (z * vx - x * vz) + element_.mass[a][b] * section().rhoI * state.v[3 * j + 2];
      }
  return sum;
}

template <int p>
double PlanarBeam<p>::scalar_product(const double* a, const double* b) const {
  double sum = 0.0;
  for (int e = 0; e < elements(); ++e)
    for (int i = 0; i <= p; ++i)
      for (int j = 0; j <= p; ++j) sum += element_.mass[i][j] * a[3 * node(e, i)] * b[3 * node(e, j)];
  return sum;
}

template <int p>
bool PlanarBeam<p>::keeps_energy() const {
  return damping() == 0.0 && all_end(followers_) &&
         std::all_of(driven_.begin(), driven_.end(),
                     [](const Driven& one) { return one.motion.ends_at_rest(); });
}

template <int p>
bool PlanarBeam<p>::is_free_at_last() const {
  return held_.empty() && damping() == 0.0 && !has_springs() && all_end(loads_) && all_end(followers_);
}

template class PlanarBeam<1>;
template class PlanarBeam<2>;
template class PlanarBeam<3>;
template class PlanarBeam<4>;

}  // namespace gnomon::planar_beam
