#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string_view>
#include <vector>

#include "models/planar_beam/constraint_dae.hpp"
#include "models/planar_beam/dae.hpp"
#include "models/planar_beam/data.hpp"
#include "models/planar_beam/element.hpp"
#include "models/planar_beam/field.hpp"
#include "models/planar_beam/mass.hpp"
#include "models/planar_beam/mass_form.hpp"
#include "models/planar_beam/ode.hpp"
#include "models/planar_beam/scales.hpp"
#include "models/planar_beam/static_form.hpp"
#include "models/planar_beam/statics.hpp"
#include "src/model.hpp"

namespace gnomon::planar_beam {

/// A planar geometrically exact beam of equal elements of order p, between supports and under loads.
template <int p>
class PlanarBeam {
 public:
  using State = planar_beam::State;
  using Vector = Eigen::VectorXd;
  static constexpr int order = p;
  static constexpr std::string_view model_name = "planar_beam";
  static constexpr std::string_view variant = std::array{"linear", "quadratic", "cubic", "quartic"}[p - 1];
  static constexpr std::array<MetricInfo, 4> metrics{
      MetricInfo{"displacement", "m", std::numeric_limits<double>::infinity()},
      MetricInfo{"rotation", "rad", std::numbers::pi},
      MetricInfo{"velocity", "m/s", std::numeric_limits<double>::infinity()},
      MetricInfo{"angular_velocity", "rad/s", std::numeric_limits<double>::infinity()}};

  explicit PlanarBeam(Data data)
      : data_(std::move(data)), element_(data_.length / data_.elements), nodes_(data_.elements * p + 1) {
    place_nodes();
    place_points();
    add_loads();
    hold_ends();
    initial_ = start_state();
    scales_ = estimate_scales(
        data_, centre_, last_position(), turning_inertia(),
        kinetic_energy(initial_.v) + strain_energy(initial_.strain) + spring_energy(initial_.u));
  }

  const Data& data() const { return data_; }
  const Element<p>& element() const { return element_; }
  const CrossSection& section() const { return data_.section; }
  int elements() const { return data_.elements; }
  int nodes() const { return nodes_; }
  int unknowns() const { return 3 * nodes_; }
  int point_count() const { return data_.elements * p; }
  const PointReference& point(int k) const { return points_[k]; }
  /// Positions (x, z) of the nodes at rest, one after the other, m.
  const std::vector<double>& positions() const { return positions_; }
  /// The centre of mass at rest, m.
  const std::array<double, 2>& centre() const { return centre_; }
  /// The unknowns that a support holds or prescribes, ascending.
  const std::vector<int>& held() const { return held_; }
  const std::vector<int>& free() const { return free_; }
  /// An unknown that a support moves. `response` are the rates of the same unknown of all nodes at a unit
  /// jump of the prescribed rate: 1 at that node, -M_ff^-1 M_fc elsewhere.
  struct Driven {
    int unknown;
    Motion motion;
    Vector response;
  };
  const std::vector<Driven>& driven() const { return driven_; }
  bool is_driven() const { return !driven_.empty(); }
  /// How unknown i moves, if a support prescribes it.
  const Motion* prescribed(int i) const {
    for (const Driven& one : driven_)
      if (one.unknown == i) return &one.motion;
    return nullptr;
  }
  /// Turns the velocities from the limit before a jump of the prescribed rates at time t into that after it.
  void jump(double t, double* v) const {
    for (const Driven& one : driven_) {
      const double change = one.motion.rate_after(t) - one.motion.rate_before(t);
      if (change != 0.0)
        for (int i = 0; i < nodes_; ++i) v[3 * i + one.unknown % 3] += change * one.response[i];
    }
  }

  State initial() const { return initial_; }
  std::string_view load_class() const {
    if (has_followers()) return "follower";
    return data_.loads.empty() && data_.gravity == 0.0 ? "none" : "dead";
  }
  double time_scale() const { return scales_.time; }
  const Scales& scales() const { return scales_; }
  std::vector<double> breaks() const {
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

  /// The stiffness of the torsion spring at the start or the end, N m/rad.
  double spring(int end) const { return data_.supports[end].spring; }
  bool has_springs() const { return spring(0) != 0.0 || spring(1) != 0.0; }
  bool has_followers() const { return !followers_.empty(); }
  /// 1/s, proportional to mass.
  double damping() const { return data_.damping; }
  /// The first unknown, ux, of the node at the start or the end.
  int end_unknown(int end) const { return end == 0 ? 0 : unknowns() - 3; }

  /// Adds the nodal forces of a load, dead, times a factor.
  void add_load(const Load& load, double factor, double* force) const {
    if (factor != 0.0) for_load(load, factor, [&](int i, double value) { force[i] += value; });
  }
  /// Nodal forces of the dead loads at time t, N and N m.
  void external_force(double t, double* force) const {
    std::fill(force, force + unknowns(), 0.0);
    for (const Load& load : loads_) add_load(load, load.factor(t), force);
  }
  /// The load at an end that turns with its section, at time t and rotation phi: its force R(phi)^T f and the
  /// derivative of that by phi.
  struct Following {
    std::array<double, 2> force{}, slope{};

    void add(double factor, const Load& load, double phi) {
      const double c = std::cos(phi), s = std::sin(phi);
      const double x = factor * load.force[0], z = factor * load.force[1];
      force[0] += c * x + s * z;
      force[1] += c * z - s * x;
      slope[0] += c * z - s * x;
      slope[1] -= c * x + s * z;
    }
  };
  Following following(double t, int end, double phi) const {
    Following sum;
    for (const Load& load : followers_)
      if (load.at == (end == 0 ? Place::start : Place::end)) sum.add(load.factor(t), load, phi);
    return sum;
  }
  const std::vector<Load>& followers() const { return followers_; }
  /// All but the followers' forces, the weight among them.
  const std::vector<Load>& dead_loads() const { return loads_; }
  /// Adds the followers' forces in the configuration u.
  void add_following(double t, const double* u, double* force) const {
    if (!has_followers()) return;
    for (int end = 0; end < 2; ++end) {
      const int i = end_unknown(end);
      const Following one = following(t, end, u[i + 2]);
      force[i] += one.force[0];
      force[i + 1] += one.force[1];
    }
  }
  /// Nodal forces that the strained beam exerts against u: the derivative of its strain energy by u.
  void internal_force(const double* u, double* force) const {
    std::fill(force, force + unknowns(), 0.0);
    for (int e = 0; e < elements(); ++e)
      for (int g = 0; g < p; ++g)
        element_.add_force(g, strain_at(u, e, g).force(section()), force + 3 * p * e);
    for (int end = 0; end < 2; ++end) force[end_unknown(end) + 2] += spring(end) * u[end_unknown(end) + 2];
  }
  /// The derivative of the internal force of one element, that of the springs at its ends included, by its
  /// own nodal values.
  typename Element<p>::Matrix element_tangent(const double* u, int e) const {
    typename Element<p>::Matrix matrix = Element<p>::Matrix::Zero();
    for (int g = 0; g < p; ++g) element_.add_tangent(g, strain_at(u, e, g).tangent(section()), matrix);
    if (has_springs()) for_ends_of(e, [&](int end, int i) { matrix(i + 2, i + 2) += spring(end); });
    return matrix;
  }
  /// The derivative of internal less external force of one element at time t: not symmetric where a load
  /// follows.
  typename Element<p>::Matrix element_tangent(double t, const double* u, int e) const {
    typename Element<p>::Matrix matrix = element_tangent(u, e);
    if (has_followers())
      for_ends_of(e, [&](int end, int i) {
        const Following one = following(t, end, u[end_unknown(end) + 2]);
        matrix(i, i + 2) -= one.slope[0];
        matrix(i + 1, i + 2) -= one.slope[1];
      });
    return matrix;
  }
  /// Calls `body(end, i)` for the ends of the beam that element e has, i being the end's first unknown within
  /// the element.
  template <class Body>
  void for_ends_of(int e, Body&& body) const {
    if (e == 0) body(0, 0);
    if (e == elements() - 1) body(1, 3 * p);
  }
  /// Density of unknown k of a node: rho A for places, rho I for the rotation.
  double density(int k) const { return k < 2 ? section().rhoA : section().rhoI; }
  /// M v, for all unknowns.
  void momentum(const double* v, double* product) const {
    std::fill(product, product + unknowns(), 0.0);
    for (int e = 0; e < elements(); ++e)
      for (int a = 0; a <= p; ++a)
        for (int b = 0; b <= p; ++b)
          for (int k = 0; k < 3; ++k)
            product[3 * (e * p + a) + k] += element_.mass[a][b] * density(k) * v[3 * (e * p + b) + k];
  }
  /// Turns nodal forces into accelerations, those of held unknowns into 0.
  void accelerate(double* force) const {
    for (int i : held_) force[i] = 0.0;
    MassBand<p>::solve(mass_[0], mass_[mass_.size() == 3 ? 1 : 0], mass_.back(), force);
    const double place = 1.0 / section().rhoA, rotation = 1.0 / section().rhoI;
    for (int i = 0; i < nodes_; ++i) {
      force[3 * i] *= place;
      force[3 * i + 1] *= place;
      force[3 * i + 2] *= rotation;
    }
  }
  /// (epsilon, gamma, kappa) at all integration points.
  Vector strains(const double* u) const {
    Vector strain(3 * point_count());
    for (int e = 0; e < elements(); ++e)
      for (int g = 0; g < p; ++g) {
        const PointStrain at = strain_at(u, e, g);
        strain.template segment<3>(3 * (e * p + g)) << at.e1, at.e2, at.bending;
      }
    return strain;
  }
  PointStrain strain_at(const double* u, int e, int g) const {
    const double* nodal = u + 3 * p * e;
    double s1 = 0, s2 = 0, s3 = 0, rotation = 0;
    for (int a = 0; a <= p; ++a) {
      s1 += element_.slope[g][a] * nodal[3 * a];
      s2 += element_.slope[g][a] * nodal[3 * a + 1];
      s3 += element_.slope[g][a] * nodal[3 * a + 2];
      rotation += element_.shape[g][a] * nodal[3 * a + 2];
    }
    return {points_[e * p + g], s1, s2, s3, rotation};
  }

  /// u, v, then the strains.
  std::vector<double> flatten(const State& state) const {
    std::vector<double> flat(state.u.begin(), state.u.end());
    flat.insert(flat.end(), state.v.begin(), state.v.end());
    flat.insert(flat.end(), state.strain.begin(), state.strain.end());
    return flat;
  }
  State restore(const std::vector<double>& flat) const {
    using Map = Eigen::Map<const Vector>;
    const double* at = flat.data();
    return {Map(at, unknowns()), Map(at + unknowns(), unknowns()),
            Map(at + 2 * unknowns(), 3 * point_count())};
  }
  std::vector<Named> observe(const State& state) const {
    return {{"u", {state.u.begin(), state.u.end()}}, {"v", {state.v.begin(), state.v.end()}}};
  }

  /// Displacement (x, z) [m] and rotation phi [rad] of both ends.
  std::vector<Probe> probes(const State& state) const {
    const auto at = [&](const char* name, int i) {
      return Probe{name, {{"x", state.u[i]}, {"z", state.u[i + 1]}, {"phi", state.u[i + 2]}}};
    };
    return {at("start", 0), at("end", unknowns() - 3)};
  }

  /// L2 norms over the beam, divided by sqrt(L): displacement [m], rotation [rad], and of their rates.
  std::array<double, 4> distance(const State& state, const State& reference) const {
    const Vector du = state.u - reference.u, dv = state.v - reference.v;
    const auto norm = [&](const Vector& d, int from, int to) {
      double sum = 0.0;
      for (int k = from; k < to; ++k) sum += scalar_product(d.data() + k, d.data() + k);
      return std::sqrt(std::max(sum, 0.0) / data_.length);
    };
    return {norm(du, 0, 2), norm(du, 2, 3), norm(dv, 0, 2), norm(dv, 2, 3)};
  }

  /// See field.hpp.
  std::vector<double> field(const State& state, const std::vector<double>& places) const {
    return planar_beam::field<p>(state, elements(), places);
  }
  static std::array<double, 4> field_distance(const std::vector<double>& field,
                                              const std::vector<double>& reference) {
    return planar_beam::field_distance(field, reference);
  }

  /// Energy, unless something goes on to do work, and the momenta of a beam that nothing holds or pushes;
  /// from the end of the last change of the loads on.
  std::vector<InvariantInfo> invariant_info() const {
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
  /// energy: kinetic and strain energy and the potential of springs and of the loads as they are in the end
  /// [J]; where a prescribed rate jumps, after the jump. linear_momentum: (x, z) [N s]. angular_momentum:
  /// about the origin, along +y [N m s].
  void invariants(double t, const State& state, double* out) const {
    if (keeps_energy())
      *out++ = kinetic_energy(state.v) + energy_of_jump(t, state.v) + strain_energy(state.strain) +
               spring_energy(state.u) + load_potential(state.u);
    if (!is_free_at_last()) return;
    const std::array<double, 3> momenta = this->momenta(state);
    std::copy(momenta.begin(), momenta.end(), out);
  }

  double kinetic_energy(const Vector& v) const {
    double sum = 0.0;
    for (int k = 0; k < 3; ++k) sum += 0.5 * density(k) * scalar_product(v.data() + k, v.data() + k);
    return sum;
  }
  double strain_energy(const Vector& strain) const {
    const CrossSection& C = section();
    double sum = 0.0;
    for (int k = 0; k < point_count(); ++k) {
      const double* e = strain.data() + 3 * k;
      sum += 0.5 * element_.weight[k % p] * (C.EA * e[0] * e[0] + C.GA * e[1] * e[1] + C.EI * e[2] * e[2]);
    }
    return sum;
  }
  double spring_energy(const Vector& u) const {
    double sum = 0.0;
    for (int end = 0; end < 2; ++end) {
      const double phi = u[end_unknown(end) + 2];
      sum += 0.5 * spring(end) * phi * phi;
    }
    return sum;
  }
  /// What the impulse of a jump of the prescribed rates at time t adds to the kinetic energy.
  double energy_of_jump(double t, const Vector& v) const {
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
            sum += density(k) * element_.mass[a][b] * jump_at(e * p + a) *
                   (v[3 * (e * p + b) + k] + 0.5 * jump_at(e * p + b));
    }
    return sum;
  }
  /// Minus the work of the loads that stay, from rest on.
  double load_potential(const Vector& u) const {
    double work = 0.0;
    for (const Load& load : loads_)
      if (load.final_factor() != 0.0)
        for_load(load, load.final_factor(), [&](int i, double force) { work += force * u[i]; });
    return -work;
  }
  /// Linear momentum (x, z) [N s] and angular momentum about the origin along +y [N m s].
  std::array<double, 3> momenta(const State& state) const {
    std::array<double, 3> sum{};
    for (int e = 0; e < elements(); ++e)
      for (int a = 0; a <= p; ++a)
        for (int b = 0; b <= p; ++b) {
          const int i = e * p + a, j = e * p + b;
          const double m = element_.mass[a][b] * section().rhoA;
          const double x = positions_[2 * i] + state.u[3 * i], z = positions_[2 * i + 1] + state.u[3 * i + 1];
          const double vx = state.v[3 * j], vz = state.v[3 * j + 1];
          sum[0] += m * vx;
          sum[1] += m * vz;
          sum[2] += m * (z * vx - x * vz) + element_.mass[a][b] * section().rhoI * state.v[3 * j + 2];
        }
    return sum;
  }

  OdeForm<PlanarBeam> ode() const { return OdeForm<PlanarBeam>(*this); }
  MassForm<PlanarBeam> mass_form() const { return MassForm<PlanarBeam>(*this); }
  DaeForm<PlanarBeam> dae() const { return DaeForm<PlanarBeam>(*this); }
  ConstraintDaeForm<PlanarBeam> dae_constraints() const { return ConstraintDaeForm<PlanarBeam>(*this); }
  /// Equilibrium under the loads of a case. Refers to this beam.
  std::unique_ptr<StaticSystem> statics(LoadCase load_case = LoadCase::last) const {
    return std::make_unique<StaticForm<PlanarBeam>>(*this, load_case);
  }
  bool is_constrained() const { return !held_.empty(); }

 private:
  /// phi0 at arc length x.
  double angle(double x) const {
    double sum = data_.angle + data_.curvature * x;
    for (const Bend& bend : data_.bends)
      if (bend.at < x) sum += bend.angle;
    return sum;
  }
  /// The node where two elements meet at arc length x.
  int node_at(double x) const { return p * static_cast<int>(std::lround(x / element_.length)); }

  void place_nodes() {
    positions_.resize(2 * static_cast<std::size_t>(nodes_));
    const double half_turn = 0.5 * data_.curvature;
    std::array<double, 2> from = data_.start;  // of the piece between two bends, as are the next two
    double direction = data_.angle;
    int first = 0;
    std::size_t bend = 0;
    for (int i = 0; i < nodes_; ++i) {
      // A chord of a circle: length sin(k x/2)/(k/2), direction that of the tangent at x/2.
      const double x = data_.length * (i - first) / (nodes_ - 1), a = half_turn * x;
      const double chord = std::abs(a) < 1e-4 ? x * (1.0 - a * a / 6.0) : std::sin(a) / half_turn;
      positions_[2 * i] = from[0] + chord * std::cos(direction + a);
      positions_[2 * i + 1] = from[1] + chord * std::sin(direction + a);
      if (bend < data_.bends.size() && i == node_at(data_.bends[bend].at)) {
        from = {positions_[2 * i], positions_[2 * i + 1]};
        direction += 2.0 * a + data_.bends[bend++].angle;
        first = i;
      }
    }
    for (int k = 0; k < 2; ++k) {
      double sum = 0.0;
      for (int e = 0; e < elements(); ++e)
        for (int a = 0; a <= p; ++a) sum += element_.load[a] * positions_[2 * (e * p + a) + k];
      centre_[k] = sum / data_.length;
    }
  }
  void place_points() {
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
          d1 += element_.slope[g][a] * positions_[2 * (e * p + a)];
          d2 += element_.slope[g][a] * positions_[2 * (e * p + a) + 1];
        }
        points_.push_back({d1, d2, -(c * d1 + s * d2), -(-s * d1 + c * d2), -phi0});
      }
  }
  void add_loads() {
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
  void hold_ends() {
    for (Support& support : data_.supports) {
      if (support.motion) support.place = support.rotation = true;
      if (support.displacement[0] || support.displacement[1]) support.place = true;
    }
    const auto& ends = data_.supports;
    for (int end = 0; end < 2; ++end)
      for (int k = 0; k < 3; ++k)
        if (ends[end].holds(k)) held_.push_back(3 * (end == 0 ? 0 : nodes_ - 1) + k);
    for (int i = 0; i < unknowns(); ++i)
      if (!std::binary_search(held_.begin(), held_.end(), i)) free_.push_back(i);
    const auto band = [&](int k) {
      return MassBand<p>(element_, elements(), ends[0].holds(k), ends[1].holds(k));
    };
    mass_.push_back(band(0));
    if (ends[0].slide || ends[1].slide) mass_.push_back(band(1));
    mass_.push_back(band(2));
    for (int i : held_)
      if (const Motion* motion = ends[i < 3 ? 0 : 1].motion_of(i % 3))
        driven_.push_back({i, *motion, response_to(i)});
  }
  Vector response_to(int driven) const {
    Vector unit = Vector::Zero(unknowns()), forces(unknowns()), response(nodes_);
    unit[driven] = 1.0;
    momentum(unit.data(), forces.data());
    accelerate(forces.data());
    for (int i = 0; i < nodes_; ++i) response[i] = -forces[3 * i + driven % 3];
    response[driven / 3] = 1.0;
    return response;
  }
  State start_state() const {
    State state{Vector::Zero(unknowns()), Vector(unknowns()), Vector()};
    if (!data_.u.empty()) {
      state.u = Eigen::Map<const Vector>(data_.u.data(), unknowns());
      state.v = Eigen::Map<const Vector>(data_.v.data(), unknowns());
      state.strain = strains(state.u.data());
      return state;
    }
    const double w = data_.angular_velocity;
    for (int i = 0; i < nodes_; ++i) {
      state.v[3 * i] = data_.velocity[0] + w * (positions_[2 * i + 1] - centre_[1]);
      state.v[3 * i + 1] = data_.velocity[1] - w * (positions_[2 * i] - centre_[0]);
      state.v[3 * i + 2] = w;
    }
    for (int i : held_) state.v[i] = 0.0;
    state.strain = strains(state.u.data());
    return state;
  }

  template <class Add>
  void for_load(const Load& load, double factor, Add&& add) const {
    const double f[3] = {factor * load.force[0], factor * load.force[1], factor * load.moment};
    if (load.at == Place::distributed) {
      for (int e = 0; e < elements(); ++e)
        for (int a = 0; a <= p; ++a)
          for (int k = 0; k < 3; ++k) add(3 * (e * p + a) + k, element_.load[a] * f[k]);
    } else {
      const int node = load.at == Place::start ? 0 : load.at == Place::end ? nodes_ - 1 : node_at(load.x);
      for (int k = 0; k < 3; ++k) add(3 * node + k, f[k]);
    }
  }
  /// int a b dx of two interpolated fields, nodal values three apart.
  double scalar_product(const double* a, const double* b) const {
    double sum = 0.0;
    for (int e = 0; e < elements(); ++e)
      for (int i = 0; i <= p; ++i)
        for (int j = 0; j <= p; ++j) sum += element_.mass[i][j] * a[3 * (e * p + i)] * b[3 * (e * p + j)];
    return sum;
  }
  static bool all_end(const std::vector<Load>& loads) {
    return std::all_of(loads.begin(), loads.end(), [](const Load& l) { return l.final_factor() == 0.0; });
  }
  bool keeps_energy() const {
    return damping() == 0.0 && all_end(followers_) &&
           std::all_of(driven_.begin(), driven_.end(),
                       [](const Driven& one) { return one.motion.ends_at_rest(); });
  }
  bool is_free_at_last() const {
    return held_.empty() && damping() == 0.0 && !has_springs() && all_end(loads_) && all_end(followers_);
  }
  std::array<double, 2> last_position() const {
    return {positions_[2 * (nodes_ - 1)], positions_[2 * (nodes_ - 1) + 1]};
  }
  /// Moment of inertia about the centre of mass at rest.
  double turning_inertia() const {
    double sum = section().rhoI * data_.length;
    for (int k = 0; k < 2; ++k) {
      Vector arm(unknowns());
      for (int i = 0; i < nodes_; ++i) arm[3 * i] = positions_[2 * i + k] - centre_[k];
      sum += section().rhoA * scalar_product(arm.data(), arm.data());
    }
    return sum;
  }

  Data data_;
  Element<p> element_;
  int nodes_;
  std::vector<double> positions_;
  std::array<double, 2> centre_{};
  std::vector<PointReference> points_;
  std::vector<Load> loads_,
      followers_;  ///< dead ones, moments of followers among them, and followers' forces
  std::vector<int> held_, free_;
  std::vector<MassBand<p>> mass_;  ///< of x and z, or of both, and of rotations
  std::vector<Driven> driven_;
  State initial_;
  Scales scales_;
};

}  // namespace gnomon::planar_beam
