#include "integrators/beam/nodal_motion.hpp"

#include <cmath>
#include <limits>

namespace gnomon::beam {

NodalMotion::NodalMotion(std::unique_ptr<NodalBeam> nodal, Vector displacements, Vector velocities,
                         const SchemeOptions& options)
    : beam(std::move(nodal)),
      u(std::move(displacements)),
      v(std::move(velocities)),
      tolerance_(options.newton_tol),
      kept_while_(options.modified_newton ? 0.2 : 1e-2) {
  for (Vector* vector : {&a, &internal, &residual_, &correction_, &trial_, &guess_, &inertia_})
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

void NodalMotion::evaluate_force(const Vector& at_u, Vector& force) {
  beam->internal_force(at_u.data(), force.data());
  clear_held(force);
  ++evaluations;
}

void NodalMotion::force_after(double t, double h, Vector& force) const {
  beam->external_force(snapped(t, h), force.data());
  clear_held(force);
}
void NodalMotion::force_before(double t, double h, Vector& force) const {
  beam->external_force(std::nextafter(snapped(t, h), -std::numeric_limits<double>::infinity()), force.data());
  clear_held(force);
}

void NodalMotion::begin(double t, double h) {
  const double from = snapped(t, h);
  if (started_ && std::find(breaks_.begin(), breaks_.end(), from) == breaks_.end()) return;
  started_ = true;
  if (lumped.empty()) beam->jump(from, v.data());
  for (const Driven& end : driven_) {
    const double to = snapped(t + h, h), rate = end.motion.rate_after(from);
    v[end.unknown] = rate;
    a[end.unknown] =
        (4.0 * end.motion.rate_after(0.5 * (from + to)) - 3.0 * rate - end.motion.rate_before(to)) /
        (to - from);
  }
  force_after(from, h, residual_);
  accelerate_by(residual_);
}

void NodalMotion::accelerate(double t, double h) {
  force_before(t, h, residual_);
  accelerate_by(residual_);
}

/// The accelerations by an external force, which is overwritten.
void NodalMotion::accelerate_by(Vector& force) {
  evaluate_force(u, internal);
  force -= internal;
  trial_.setZero();
  for (const Driven& end : driven_) trial_[end.unknown] = a[end.unknown];
  a = trial_;
  if (lumped.empty()) {
    beam->momentum(a.data(), inertia_.data());
    force -= inertia_;
    beam->accelerate(force.data());
    a += force;
  } else {
    for (int i = 0; i < force.size(); ++i) a[i] += force[i] / lumped[i];
  }
}

void NodalMotion::drive(double from, double t, double h, Vector& at_u, Vector& at_v, Vector& at_a) const {
  for (int i : beam->held()) at_v[i] = at_a[i] = 0.0;
  const double begin = snapped(from, h), end = snapped(t, h);
  for (const Driven& by : driven_) {
    const double rate = by.motion.rate_before(end);
    at_u[by.unknown] = by.motion.value(end);
    at_v[by.unknown] = rate;
    at_a[by.unknown] =
        (3.0 * rate - 4.0 * by.motion.rate_after(0.5 * (begin + end)) + by.motion.rate_after(begin)) /
        (end - begin);
  }
}

double NodalMotion::size_of(const Vector& force) const {
  const double arm = 1.0 / (beam->length() * beam->length());
  double sum = 0.0;
  for (int i = 0; i < force.size(); ++i) sum += (i % 3 == 2 ? arm : 1.0) * force[i] * force[i];
  return std::sqrt(sum);
}

double NodalMotion::residual(const Stage& stage, const Vector& known, const Vector& at_a,
                             const Vector& force) {
  beam->momentum(at_a.data(), inertia_.data());
  clear_held(inertia_);
  inertia_ *= stage.mass;
  scale_ = std::max({size_of(inertia_), stage.force * size_of(force), stage.external_size});
  residual_ = inertia_ + stage.force * force + known;
  clear_held(residual_);
  return size_of(residual_);
}

bool NodalMotion::solve(const Stage& stage, const Vector& start, const Vector& known, Vector& at_a,
                        Vector& at_u, Vector& force) {
  guess_ = at_a;
  if (newton(stage, start, known, at_a, at_u, force)) return true;
  at_a.setZero();  // the stage without any acceleration
  for (int i : beam->held()) at_a[i] = guess_[i];
  return newton(stage, start, known, at_a, at_u, force);
}

bool NodalMotion::newton(const Stage& stage, const Vector& start, const Vector& known, Vector& at_a,
                         Vector& at_u, Vector& force) {
  const auto evaluate = [&] {
    at_u = start + stage.kappa * at_a;
    evaluate_force(at_u, force);
    return residual(stage, known, at_a, force);
  };
  double size = evaluate();
  // Strains are differences of displacements, whose rounding grows with the way that the beam has gone.
  const double floor = floor_ * (1.0 + at_u.lpNorm<Eigen::Infinity>() / element_length_);
  bool keep = false, fresh = false;
  for (int k = 0; k < 40; ++k) {
    if (!std::isfinite(size)) return false;
    if (size <= std::max(tolerance_ * scale_, floor)) return true;
    if (!keep) {
      beam->factorise(stage.mass, stage.force * stage.kappa, at_u.data());
      ++factorizations;
      fresh = true;
    }
    const double before = size;
    trial_ = at_a;
    correction_ = -residual_;
    beam->solve(correction_.data());
    ++iterations;
    double length = 1.0;
    for (;; length *= 0.5) {
      at_a = trial_ + length * correction_;
      size = evaluate();
      if (size <= (1.0 - 1e-4 * length) * before || size <= floor) break;
      if (length < 1e-3) return false;
      if (!fresh) break;
    }
    if (!(size <= before) && !fresh) {  // the old tangent does not serve any more
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
