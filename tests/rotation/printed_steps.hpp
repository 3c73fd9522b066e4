#pragma once
// Steps of discrete-element and molecular codes on a heavy top, written down as those codes have them: with
// the momentum or velocity of the half step carried along, in the frame they use. An independent check of the
// production code, and the place for variants that are told apart in tests.

#include <Eigen/Geometry>

#include "models/rigid_body/rigid_body.hpp"

namespace gnomon::test::printed_steps {

using Body = rigid_body::RigidBody<rigid_body::Gravity>;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

/// q o (0, v), and (0, v) o q, times a factor.
inline Quaterniond right(const Quaterniond& q, const Vector3d& v, double factor = 1.0) {
  Quaterniond p = q * Quaterniond(0.0, v[0], v[1], v[2]);
  p.coeffs() *= factor;
  return p;
}
inline Quaterniond left(const Vector3d& v, const Quaterniond& q, double factor = 1.0) {
  Quaterniond p = Quaterniond(0.0, v[0], v[1], v[2]) * q;
  p.coeffs() *= factor;
  return p;
}
inline Quaterniond plus(const Quaterniond& a, const Quaterniond& b) {
  return Quaterniond(a.coeffs() + b.coeffs());
}
inline Quaterniond exponential(const Vector3d& p) {
  return p.norm() > 0.0 ? Quaterniond(Eigen::AngleAxisd(p.norm(), p.normalized())) : Quaterniond::Identity();
}

/// A run of n steps of size h from the initial state.
struct Run {
  const Body& body;
  double h;
  long n;

  Quaterniond orientation() const { return rigid_body::unit_quaternion(body.initial().attitude); }
  Vector3d momentum() const { return body.initial().attitude * body.initial().angular_momentum; }
  Vector3d moment(const Quaterniond& q) const { return body.moment(0.0, q.toRotationMatrix()); }
  /// I^-1 R^T L.
  Vector3d velocity(const Quaterniond& q, const Vector3d& L) const {
    return (q.conjugate() * L).cwiseQuotient(body.inertia());
  }
  /// I^-1 (tau - w x I w).
  Vector3d rate(const Vector3d& w, const Vector3d& tau) const {
    return (tau - w.cross(Vector3d(body.inertia().cwiseProduct(w)))).cwiseQuotient(body.inertia());
  }
  static rigid_body::State state(const Quaterniond& q, const Vector3d& L) {
    return {q.toRotationMatrix(), q.conjugate() * L};
  }
};

/// L(t - h/2) carried. `middle`: the attitude of the middle also for the second angular velocity; without it,
/// as some codes have it, that of time t.
[[gnu::noinline]] inline rigid_body::State fincham(const Run& run, bool middle) {
  const double h = run.h;
  Quaterniond q = run.orientation();
  Vector3d L = run.momentum() - 0.5 * h * run.moment(q);
  for (long k = 0; k < run.n; ++k) {
    const Vector3d M = run.moment(q);
    const Quaterniond half = plus(q, right(q, run.velocity(q, L + 0.5 * h * M), 0.25 * h)).normalized();
    L += h * M;
    q = plus(q, right(half, run.velocity(middle ? half : q, L), 0.5 * h)).normalized();
  }
  return Run::state(q, L + 0.5 * h * run.moment(q));
}

/// LAMMPS, with its angular velocities in space.
[[gnu::noinline]] inline rigid_body::State richardson(const Run& run) {
  const double h = run.h;
  Quaterniond q = run.orientation();
  Vector3d L = run.momentum();
  for (long k = 0; k < run.n; ++k) {
    L += 0.5 * h * run.moment(q);
    const Vector3d w = q * run.velocity(q, L);
    const Quaterniond full = plus(q, left(w, q, 0.5 * h)).normalized();
    Quaterniond half = plus(q, left(w, q, 0.25 * h)).normalized();
    const Vector3d w_half = half * run.velocity(half, L);
    half = plus(half, left(w_half, half, 0.25 * h)).normalized();
    q = Quaterniond(2.0 * half.coeffs() - full.coeffs()).normalized();
    L += 0.5 * h * run.moment(q);
  }
  return Run::state(q, L);
}

/// With the momenta p = 2 q o (0, m) conjugate to q and the permutations P_k q = q o e_k.
[[gnu::noinline]] inline rigid_body::State no_squish(const Run& run) {
  const double h = run.h;
  Quaterniond q = run.orientation();
  Quaterniond p = right(q, run.body.initial().angular_momentum, 2.0);
  const auto kick = [&] {
    const Vector3d tau = q.conjugate() * run.moment(q);
    p = plus(p, right(q, tau, h));
  };
  const auto turn = [&](int axis, double time) {
    const Vector3d e = Vector3d::Unit(axis);
    const Quaterniond Pq = right(q, e), Pp = right(p, e);
    const double phase = time * p.coeffs().dot(Pq.coeffs()) / (4.0 * run.body.inertia()[axis]);
    q = Quaterniond(std::cos(phase) * q.coeffs() + std::sin(phase) * Pq.coeffs());
    p = Quaterniond(std::cos(phase) * p.coeffs() + std::sin(phase) * Pp.coeffs());
  };
  for (long k = 0; k < run.n; ++k) {
    kick();
    turn(2, 0.5 * h), turn(1, 0.5 * h), turn(0, h), turn(1, 0.5 * h), turn(2, 0.5 * h);
    kick();
  }
  return {q.toRotationMatrix(), 0.5 * (q.conjugate() * p).vec()};
}

/// In space, with J = R I R^T and W' = J^-1 (M - W x L).
[[gnu::noinline]] inline rigid_body::State buss(const Run& run, bool augmented) {
  const double h = run.h;
  Quaterniond q = run.orientation();
  Vector3d L = run.momentum();
  for (long k = 0; k < run.n; ++k) {
    const Vector3d M = run.moment(q), W = q * run.velocity(q, L);
    const Vector3d rate = q * run.velocity(q, M - W.cross(L));
    Vector3d mean = W + 0.5 * h * rate;
    if (augmented) mean += h * h / 12.0 * rate.cross(W);
    q = exponential(h * mean) * q;
    L += 0.5 * h * (M + run.moment(q));
  }
  return Run::state(q, L);
}

/// w(t - h/2) carried, its equation iterated component by component.
[[gnu::noinline]] inline rigid_body::State omelyan(const Run& run) {
  const double h = run.h;
  const Vector3d I = run.body.inertia();
  Quaterniond q = run.orientation();
  Vector3d w = run.body.initial().angular_momentum.cwiseQuotient(I);
  const auto kick = [&](double time) {
    const Vector3d tau = q.conjugate() * run.moment(q);
    Vector3d next = w;
    for (int k = 0; k < 40; ++k) {
      const Vector3d old = next;
      for (int a = 0; a < 3; ++a) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        next[a] = w[a] + time / I[a] * (tau[a] + 0.5 * (w[b] * w[c] + old[b] * old[c]) * (I[b] - I[c]));
      }
    }
    w = next;
  };
  kick(0.5 * h);
  for (long k = 0; k < run.n; ++k) {
    const double a = h * h * w.squaredNorm() / 16.0;
    q = Quaterniond(((1.0 - a) * q.coeffs() + right(q, w, 0.5 * h).coeffs()) / (1.0 + a));
    kick(k + 1 < run.n ? h : 0.5 * h);
  }
  return {q.toRotationMatrix(), I.cwiseProduct(w)};
}

/// w(t - h/2) carried, the turn through the angle and the axis.
[[gnu::noinline]] inline rigid_body::State spiral_leapfrog(const Run& run) {
  const double h = run.h;
  const Vector3d I = run.body.inertia();
  Quaterniond q = run.orientation();
  Vector3d w = run.body.initial().angular_momentum.cwiseQuotient(I);
  const auto kick = [&](double time) {
    const Vector3d tau = q.conjugate() * run.moment(q);
    const Vector3d k1 = time * run.rate(w, tau), k2 = time * run.rate(w + k1, tau),
                   k3 = time * run.rate(w + 0.25 * (k1 + k2), tau);
    w += (k1 + k2 + 4.0 * k3) / 6.0;
  };
  kick(0.5 * h);
  for (long k = 0; k < run.n; ++k) {
    q = q * exponential(h * w);
    kick(k + 1 < run.n ? h : 0.5 * h);
  }
  return {q.toRotationMatrix(), I.cwiseProduct(w)};
}

[[gnu::noinline]] inline rigid_body::State spiral_synchronous(const Run& run) {
  const double h = run.h;
  const Vector3d I = run.body.inertia();
  Quaterniond q = run.orientation();
  Vector3d w = run.body.initial().angular_momentum.cwiseQuotient(I);
  for (long k = 0; k < run.n; ++k) {
    const Vector3d tau = q.conjugate() * run.moment(q), k1 = h * run.rate(w, tau);
    q = q * exponential(h * w) * exponential(0.5 * h * k1);
    const Vector3d k2 = h * run.rate(w + k1, tau), k3 = h * run.rate(w + 0.25 * (k1 + k2), tau);
    w += (k1 + k2 + 4.0 * k3) / 6.0;
  }
  return {q.toRotationMatrix(), I.cwiseProduct(w)};
}

/// Angular velocities in space, multiplied from the left. `once`: the moment of time t for the middle too.
[[gnu::noinline]] inline rigid_body::State zhao_van_wachem(const Run& run, bool once) {
  const double h = run.h;
  const Vector3d I = run.body.inertia();
  Quaterniond q = run.orientation();
  Vector3d w = run.body.initial().angular_momentum.cwiseQuotient(I);
  for (long k = 0; k < run.n; ++k) {
    const Vector3d M = run.moment(q), rate = run.rate(w, q.conjugate() * M);
    const Vector3d quarter = q * Vector3d(w + 0.25 * h * rate), half = w + 0.5 * h * rate;
    const Quaterniond middle = exponential(0.5 * h * quarter) * q;
    const Vector3d rate_half = run.rate(half, middle.conjugate() * (once ? M : run.moment(middle)));
    q = exponential(h * (middle * half)) * q;
    w += h * rate_half;
  }
  return {q.toRotationMatrix(), I.cwiseProduct(w)};
}

}  // namespace gnomon::test::printed_steps
