#include "integrators/beam/nodal_motion.hpp"

#include <cmath>
#include <limits>

#include "models/planar_beam/nodal_norm.hpp"

namespace gnomon::beam {

NodalMotion::NodalMotion(std::unique_ptr<NodalBeam> nodal, Vector displacements, Vector velocities,
                         const SchemeOptions& options)
    : beam(std::move(nodal)),
      u(std::move(displacements)),
      v(std::move(velocities)),
      damping_(beam->damping()),
      tolerance_(options.newton_tol),
      kept_while_(options.modified_newton ? 0.2 : 1e-2) {
  for (Vector* vector : {&a, &internal, &residual_, &correction_, &trial_, &next_, &guess_, &inertia_})
    vector->setZero(beam->unknowns());
  breaks_ = beam->breaks();
  breaks_.insert(breaks_.begin(), 0.0);
  for (int i : beam->held())
    if (const planar_beam::Motion* motion = beam->prescribed(i)) driven_.push_back({i, *motion});
  const planar_beam::CrossSection section = beam->section();
  element_length_ = beam->length() / beam->elements();
  floor_ = 4.0 * std::numeric_limits<double>::epsilon() * std::max(section.EA, section.GA) *
           std::sqrt(static_cast<double>(beam->unknowns()));
}

double NodalMotion::snapped(double t, double h) const {
  for (double at : breaks_)
    if (std::abs(t - at) <= nearby * h) return at;
  return t;
}

void NodalMotion::clear_held(Vector& values) const {
  for (int i : beam->held()) values[i] = 0.0;
}

double NodalMotion::before(double t, double h) const {
  return std::nextafter(snapped(t, h), -std::numeric_limits<double>::infinity());
}

void NodalMotion::evaluate_force(double t, const Vector& at_u, Vector& force) {
  beam->internal_force(t, at_u.data(), force.data());
  clear_held(force);
  ++evaluations;
}

void NodalMotion::force_after(double t, double h, Vector& force) const {
  beam->external_force(snapped(t, h), force.data());
  clear_held(force);
}
void NodalMotion::force_before(double t, double h, Vector& force) const {
  beam->external_force(before(t, h), force.data());
  clear_held(force);
}

void NodalMotion::begin(double t, double h) {
  const double from = snapped(t, h);
  if (started_ && std::find(breaks_.begin(), breaks_.end(), from) == breaks_.end()) return;
  started_ = true;
  if (lumped.empty()) beam->jump(from, v.data());
  for (const Driven& one : driven_) {
    v[one.unknown] = one.motion.rate_after(from);
    a[one.unknown] = one.motion.acceleration_after(from);
  }
  force_after(from, h, residual_);
  accelerate_by(from, residual_);
  a -= damping_ * v;
  for (int i : beam->held()) a[i] = trial_[i];
}

void NodalMotion::accelerate(double t, double h) {
  force_before(t, h, residual_);
  accelerate_by(before(t, h), residual_);
}

/// The accelerations by an external force, which is overwritten; `trial_` keeps those of held unknowns.
void NodalMotion::accelerate_by(double t, Vector& force) {
  evaluate_force(t, u, internal);
  force -= internal;
  trial_.setZero();
  correction_.setZero();
  for (const Driven& one : driven_) {
    trial_[one.unknown] = a[one.unknown];
    correction_[one.unknown] = a[one.unknown] + damping_ * v[one.unknown];
  }
  a = trial_;
  if (lumped.empty()) {
    beam->momentum(correction_.data(), inertia_.data());
    force -= inertia_;
    beam->accelerate(force.data());
    a += force;
  } else {
    for (int i = 0; i < force.size(); ++i) a[i] += force[i] / lumped[i];
    beam->spread(a.data());
    for (int i : beam->held()) a[i] = trial_[i];
  }
}

void NodalMotion::drive(double t, double h, Vector& at_u, Vector& at_v, Vector& at_a) const {
  for (int i : beam->held()) at_v[i] = at_a[i] = 0.0;
  const double end = snapped(t, h);
  for (const Driven& one : driven_) {
    at_u[one.unknown] = one.motion.value(end);
    at_v[one.unknown] = one.motion.rate_before(end);
    at_a[one.unknown] = one.motion.acceleration_after(before(t, h));
  }
}

double NodalMotion::size_of(const Vector& force) const {
  return planar_beam::nodal_norm(force, 1.0 / beam->length());
}

bool NodalMotion::torn() const {
  const planar_beam::CrossSection section = beam->section();
  const double length = beam->length();
  return size_of(internal) > 1e6 * std::max({section.EA, section.GA, section.EI / (length * length)});
}

double NodalMotion::residual(const Stage& stage, const Vector& start_v, const Vector& known,
                             const Vector& at_a, const Vector& force) {
  const double damped = stage.force * damping_;
  residual_ = (stage.mass + damped * stage.rate) * at_a + damped * start_v;
  beam->momentum(residual_.data(), inertia_.data());
  clear_held(inertia_);
  scale_ = std::max({size_of(inertia_), stage.force * size_of(force), stage.external_size});
  residual_ = inertia_ + stage.force * force + known;
  clear_held(residual_);
  return size_of(residual_);
}

bool NodalMotion::solve(const Stage& stage, Vector& start_u, Vector& start_v, const Vector& known,
                        Vector& at_u, Vector& at_v, Vector& at_a, Vector& force) {
  at_u = u;
  drive(stage.t, stage.h, at_u, at_v, at_a);
  for (int i : beam->held()) {
    start_u[i] = at_u[i] - stage.kappa * at_a[i];
    start_v[i] = at_v[i] - stage.rate * at_a[i];
  }
  guess_ = at_a;
  if (!newton(stage, start_u, start_v, known, at_u, at_a, force)) {
    at_a.setZero();  // the stage without any acceleration
    for (int i : beam->held()) at_a[i] = guess_[i];
    if (!newton(stage, start_u, start_v, known, at_u, at_a, force)) return false;
  }
  at_v = start_v + stage.rate * at_a;
  drive(stage.t, stage.h, at_u, at_v, at_a);
  return true;
}

bool NodalMotion::leads_on(double factor) {
  next_ = -residual_;
  beam->solve(next_.data());
  const double length = beam->length();
  return planar_beam::nodal_norm(next_, length) <= factor * planar_beam::nodal_norm(correction_, length);
}

bool NodalMotion::newton(const Stage& stage, const Vector& start_u, const Vector& start_v,
                         const Vector& known, Vector& at_u, Vector& at_a, Vector& force) {
  const double t = before(stage.t, stage.h);
  const auto evaluate = [&] {
    at_u = start_u + stage.kappa * at_a;
    evaluate_force(t, at_u, force);
    return residual(stage, start_v, known, at_a, force);
  };
  double size = evaluate();
  // Strains are differences of displacements, whose rounding grows with the way that the beam has gone.
  const double floor = floor_ * (1.0 + at_u.lpNorm<Eigen::Infinity>() / element_length_);
  bool keep = false, fresh = false;
  for (int k = 0; k < 40; ++k) {
    if (!std::isfinite(size)) return false;
    if (k > 0 && size <= std::max(tolerance_ * scale_, floor)) return true;
    if (!keep) {
      beam->factorise(stage.mass + stage.force * damping_ * stage.rate, stage.force * stage.kappa, t,
                      at_u.data());
      ++factorizations;
      fresh = true;
    }
    const double before = size;
    trial_ = at_a;
    correction_ = -residual_;
    beam->solve(correction_.data());
    ++iterations;
    double length = 1.0;
    bool leading = false;
    for (;; length *= 0.5) {
      at_a = trial_ + length * correction_;
      size = evaluate();
      if (size <= (1.0 - 1e-4 * length) * before || size <= floor) break;
      leading = std::isfinite(size) && leads_on(1.0 - 0.5 * length);
      if (leading) break;
      if (length < 1e-3) return false;
      if (!fresh) break;
    }
    if (!(size <= before) && !fresh && !leading) {  // the old tangent does not serve any more
      at_a = trial_;
      size = evaluate();
      keep = false;
      continue;
    }
    keep = length == 1.0 && size <= kept_while_ * before;
    fresh = false;
  }
  return false;
}

Cost NodalMotion::cost(long steps) const {
  return {.steps = steps,
          .rhs = evaluations,
          .jacobians = factorizations,
          .factorizations = factorizations,
          .newton_iterations = iterations};
}

}  // namespace gnomon::beam
