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
#include "models/planar_beam/numbering.hpp"
#include "models/planar_beam/ode.hpp"
#include "models/planar_beam/scales.hpp"
#include "models/planar_beam/static_form.hpp"
#include "models/planar_beam/statics.hpp"
#include "src/model.hpp"

namespace gnomon::planar_beam {

/// A planar geometrically exact beam of equal elements of order p, between supports and under loads. Compiled
/// once, in planar_beam.cpp.
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

  explicit PlanarBeam(Data data);

  const Data& data() const { return data_; }
  const Element<p>& element() const { return element_; }
  const CrossSection& section() const { return data_.section; }
  int elements() const { return data_.elements; }
  /// Which unknowns are whose; those of hinges are there twice.
  const Numbering& numbering() const { return numbering_; }
  int nodes() const { return unknowns() / 3; }
  int unknowns() const { return numbering_.unknowns(); }
  int point_count() const { return data_.elements * p; }
  const PointReference& point(int k) const { return points_[k]; }
  /// Positions (x, z) of the nodes at rest, one after the other, m.
  const std::vector<double>& positions() const { return positions_; }
  /// The centre of mass at rest, m.
  const std::array<double, 2>& centre() const { return centre_; }
  /// The unknowns that a support holds or prescribes, ascending.
  const std::vector<int>& held() const { return held_; }
  /// Those that are neither held nor tied to others at a hinge, ascending.
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
        for (int i = 0; i < nodes(); ++i) v[3 * i + one.unknown % 3] += change * one.response[i];
    }
  }

  State initial() const { return initial_; }
  std::string_view load_class() const;
  double time_scale() const { return scales_.time; }
  const Scales& scales() const { return scales_; }
  std::vector<double> breaks() const;

  /// The stiffness of the torsion spring at the start or the end, N m/rad.
  double spring(int end) const { return data_.supports[end].spring; }
  bool has_springs() const { return spring(0) != 0.0 || spring(1) != 0.0; }
  bool has_followers() const { return !followers_.empty(); }
  /// 1/s, proportional to mass.
  double damping() const { return data_.damping; }
  /// The first unknown, ux, of the node at the start or the end.
  int end_unknown(int end) const { return end == 0 ? 0 : unknowns() - 3; }

  /// Adds the nodal forces of a load, dead, times a factor.
  void add_load(const Load& load, double factor, double* force) const;
  /// Nodal forces of the dead loads at time t, N and N m.
  void external_force(double t, double* force, Sides sides = Sides::joined) const;
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
  Following following(double t, int end, double phi) const;
  const std::vector<Load>& followers() const { return followers_; }
  /// All but the followers' forces, the weight among them.
  const std::vector<Load>& dead_loads() const { return loads_; }
  /// Adds the followers' forces in the configuration u.
  void add_following(double t, const double* u, double* force) const;
  /// Nodal forces that the strained beam exerts against u: the derivative of its strain energy by u.
  void internal_force(const double* u, double* force, Sides sides = Sides::joined) const;
  bool has_hinges() const { return !numbering_.hinged().empty(); }
  /// Calls `body(k, stiffness)` for the hinges that have a spring; N m/rad.
  template <class Body>
  void for_hinge_springs(Body&& body) const {
    for (std::size_t k = 0; k < data_.hinges.size(); ++k)
      if (data_.hinges[k].spring != 0.0) body(static_cast<int>(k), data_.hinges[k].spring);
  }
  /// Adds the moments of the hinges' springs at the rotations of u, times a factor, to the internal forces.
  void add_hinge_moments(double factor, const double* u, double* force) const {
    for_hinge_springs([&](int k, double stiffness) {
      const int left = numbering_.left_rotation(k), right = numbering_.right_rotation(k);
      const double moment = factor * stiffness * (u[right] - u[left]);
      force[left] -= moment;
      force[right] += moment;
    });
  }
  /// The derivative of the internal force of one element, that of the springs at its ends included but not
  /// that of hinges' springs, by its own nodal values.
  typename Element<p>::Matrix element_tangent(const double* u, int e) const;
  /// The derivative of internal less external force of one element at time t: not symmetric where a load
  /// follows.
  typename Element<p>::Matrix element_tangent(double t, const double* u, int e) const;
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
  void momentum(const double* v, double* product, Sides sides = Sides::joined) const;
  /// Turns nodal forces into accelerations, those of held unknowns into 0. Forces on tied displacements count
  /// as in Numbering::join.
  void accelerate(double* force) const;
  /// (epsilon, gamma, kappa) at all integration points.
  Vector strains(const double* u) const;
  PointStrain strain_at(const double* u, int e, int g) const;

  /// u, v, then the strains.
  std::vector<double> flatten(const State& state) const;
  State restore(const std::vector<double>& flat) const;
  std::vector<Named> observe(const State& state) const;

  /// Displacement (x, z) [m] and rotation phi [rad] of both ends; of hinges the rotation on the left, and
  /// what that on the right exceeds it by.
  std::vector<Probe> probes(const State& state) const;

  /// L2 norms over the beam, divided by sqrt(L): displacement [m], rotation [rad], and of their rates.
  std::array<double, 4> distance(const State& state, const State& reference) const;

  /// See field.hpp.
  std::vector<double> field(const State& state, const std::vector<double>& places) const {
    return planar_beam::field<p>(state, numbering_, places);
  }
  static std::array<double, 4> field_distance(const std::vector<double>& field,
                                              const std::vector<double>& reference) {
    return planar_beam::field_distance(field, reference);
  }

  /// Energy, unless something goes on to do work, and the momenta of a beam that nothing holds or pushes;
  /// from the end of the last change of the loads on.
  std::vector<InvariantInfo> invariant_info() const;
  /// energy: kinetic and strain energy and the potential of springs and of the loads as they are in the end
  /// [J]; where a prescribed rate jumps, after the jump. linear_momentum: (x, z) [N s]. angular_momentum:
  /// about the origin, along +y [N m s].
  void invariants(double t, const State& state, double* out) const;

  double kinetic_energy(const Vector& v) const;
  double strain_energy(const Vector& strain) const;
  double spring_energy(const Vector& u) const;
  /// What the impulse of a jump of the prescribed rates at time t adds to the kinetic energy.
  double energy_of_jump(double t, const Vector& v) const;
  /// Minus the work of the loads that stay, from rest on.
  double load_potential(const Vector& u) const;
  /// Linear momentum (x, z) [N s] and angular momentum about the origin along +y [N m s].
  std::array<double, 3> momenta(const State& state) const;

  OdeForm<PlanarBeam> ode() const { return OdeForm<PlanarBeam>(*this); }
  MassForm<PlanarBeam> mass_form() const { return MassForm<PlanarBeam>(*this); }
  DaeForm<PlanarBeam> dae() const { return DaeForm<PlanarBeam>(*this); }
  ConstraintDaeForm<PlanarBeam> dae_constraints() const { return ConstraintDaeForm<PlanarBeam>(*this); }
  /// Equilibrium under the loads of a case. Refers to this beam.
  std::unique_ptr<StaticSystem> statics(LoadCase load_case = LoadCase::last) const {
    return std::make_unique<StaticForm<PlanarBeam>>(*this, load_case);
  }
  bool is_constrained() const { return !held_.empty() || has_hinges(); }

 private:
  /// phi0 at arc length x.
  double angle(double x) const;
  /// The element that begins at arc length x, where two elements meet.
  int element_from(double x) const { return static_cast<int>(std::lround(x / element_.length)); }
  static std::vector<int> hinged(const Data& data);
  /// The number of node a of element e.
  int node(int e, int a) const { return numbering_.first(e) / 3 + a; }

  void place_nodes();
  void place_points();
  void add_loads();
  void hold_ends();
  Vector response_to(int driven) const;
  State start_state() const;

  template <class Add>
  void for_load(const Load& load, double factor, Add&& add) const {
    const double f[3] = {factor * load.force[0], factor * load.force[1], factor * load.moment};
    if (load.at == Place::distributed) {
      for (int e = 0; e < elements(); ++e)
        for (int a = 0; a <= p; ++a)
          for (int k = 0; k < 3; ++k) add(numbering_.first(e) + 3 * a + k, element_.load[a] * f[k]);
    } else {
      const int first = load.at == Place::start ? 0
                        : load.at == Place::end ? unknowns() - 3
                                                : numbering_.first(element_from(load.x));
      for (int k = 0; k < 3; ++k) add(first + k, f[k]);
    }
  }
  /// int a b dx of two interpolated fields, nodal values three apart.
  double scalar_product(const double* a, const double* b) const;
  static bool all_end(const std::vector<Load>& loads) {
    return std::all_of(loads.begin(), loads.end(), [](const Load& l) { return l.final_factor() == 0.0; });
  }
  bool keeps_energy() const;
  bool is_free_at_last() const;
  std::array<double, 2> last_position() const;
  /// Moment of inertia about the centre of mass at rest.
  double turning_inertia() const;

  Data data_;
  Element<p> element_;
  Numbering numbering_;
  std::vector<double> positions_;
  std::array<double, 2> centre_{};
  std::vector<PointReference> points_;
  std::vector<Load> loads_,
      followers_;  ///< dead ones, moments of followers among them, and followers' forces
  std::vector<int> held_, free_;
  std::vector<MassBand<p>> mass_;  ///< of x and z, or of both, and of rotations
  /// Of x, z and rotations the unknowns in the order of their mass matrix; empty without hinges.
  std::array<std::vector<int>, 3> mass_index_;
  std::vector<Driven> driven_;
  State initial_;
  Scales scales_;
};

extern template class PlanarBeam<1>;
extern template class PlanarBeam<2>;
extern template class PlanarBeam<3>;
extern template class PlanarBeam<4>;

}  // namespace gnomon::planar_beam
