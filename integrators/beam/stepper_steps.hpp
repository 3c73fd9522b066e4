#pragma once
#include <algorithm>
#include <cmath>

#include "integrators/beam/hinge_moment.hpp"
#include "integrators/beam/stepper.hpp"
#include "models/planar_beam/nodal_norm.hpp"

namespace gnomon::beam {

template <BeamForm M, Turning turning>
Status Stepper<M, turning>::step(const M& model, double t, double h) {
  aim(model, t, h);
  if (!driven_.empty()) model.jump(time_, v.data());
  inertia_floor_ = mass_floor_ * std::abs(2.0 / h) * v.norm();
  extrapolate(h);
  if (!solve(model, h)) {
    mean = v;
    if (!solve(model, h) && !continue_in_step(model, h)) return Status::newton_failed;
  }
  finish(h);
  return Status::ok;
}

template <BeamForm M, Turning turning>
void Stepper<M, turning>::aim(const M& model, double t, double h) {
  load(model, t + 0.5 * h);
  time_ = t;
  for (const Driven& end : driven_) time_ = end.motion.snapped(time_, nearby * h);
}

template <BeamForm M, Turning turning>
void Stepper<M, turning>::drive(double h) {
  for (const Driven& end : driven_) {
    const double t = end.motion.snapped(time_ + h, nearby * h);
    const double turn = end.motion.value(t) - end.motion.value(time_);
    const bool bent = turning == Turning::cayley && end.unknown % 3 == 2;
    const double rate = bent ? 2.0 / h * std::tan(0.5 * turn) : turn / h;
    mean[end.unknown] = rate;
    v[end.unknown] = rate - 0.5 * (end.motion.rate_before(t) - end.motion.rate_after(time_));
  }
}

template <BeamForm M, Turning turning>
double Stepper<M, turning>::evaluate(const M& model, double h) {
  const auto& element = model.element();
  const planar_beam::CrossSection section = model.section();
  const planar_beam::Numbering& numbering = model.numbering();
  const double rate = 2.0 / h;
  internal_.setZero();
  inertia_.setZero();
  for (int e = 0; e < model.elements(); ++e) {
    const int first = numbering.first(e);
    const double* vbar = mean.data() + first;
    const double* before = v.data() + first;
    double* force = internal_.data() + first;
    double* inertia = inertia_.data() + first;
    for (int g = 0; g < p; ++g) {
      double w1 = 0, w2 = 0, w3 = 0, omega = 0;
      for (int a = 0; a <= p; ++a) {
        w1 += element.slope[g][a] * vbar[3 * a];
        w2 += element.slope[g][a] * vbar[3 * a + 1];
        w3 += element.slope[g][a] * vbar[3 * a + 2];
        omega += element.shape[g][a] * vbar[3 * a + 2];
      }
      const planar_beam::PointReference& r = model.point(e * p + g);
      points_[e * p + g] = Point(history[e * p + g], r.e1, r.e2, section, h, w1, w2, w3, omega);
      element.add_force(g, points_[e * p + g].force(section), force);
    }
    for (int a = 0; a <= p; ++a)
      for (int b = 0; b <= p; ++b) {
        const double m = rate * element.mass[a][b];
        inertia[3 * a] += m * section.rhoA * (vbar[3 * b] - before[3 * b]);
        inertia[3 * a + 1] += m * section.rhoA * (vbar[3 * b + 1] - before[3 * b + 1]);
        inertia[3 * a + 2] += m * section.rhoI * (vbar[3 * b + 2] - before[3 * b + 2]);
      }
  }
  add_hinges(model, h);
  numbering.join(internal_.data());
  numbering.join(inertia_.data());
  if (model.has_springs() || model.has_followers()) add_ends(model, h);
  if (model.damping() != 0.0) {
    model.momentum(mean.data(), residual_.data());
    inertia_ += model.damping() * residual_;
  }
  for (int i : model.held()) internal_[i] = inertia_[i] = external_[i] = 0.0;
  ++evaluations;
  return take_residual();
}

template <BeamForm M, Turning turning>
void Stepper<M, turning>::linearise(const M& model, double h) {
  linearise_hinges(model, h);
  for (int e = 0; e < model.elements(); ++e) {
    if (assembled_)
      assembled_->add(e, element_tangent(model, e, h).data());
    else
      chain_.add(e, element_tangent(model, e, h));
  }
  if (assembled_)
    assembled_->factorise();
  else
    chain_.factorise();
  ++factorizations;
}

template <BeamForm M, Turning turning>
typename Stepper<M, turning>::ElementMatrix Stepper<M, turning>::element_tangent(const M& model, int e,
                                                                                 double h) const {
  const auto& element = model.element();
  ElementMatrix matrix = ElementMatrix::Zero();
  for (int g = 0; g < p; ++g)
    element.add_tangent(g, points_[e * p + g].force_tangent(model.section(), h), matrix);
  if (model.has_springs() || model.has_followers())
    model.for_ends_of(e, [&](int end, int i) {
      const EndTurn turn(u[model.end_unknown(end) + 2], mean[model.end_unknown(end) + 2], h);
      const auto load = model.following(middle_, end, turn.phi);
      matrix(i, i + 2) -= turn.rate * load.slope[0];
      matrix(i + 1, i + 2) -= turn.rate * load.slope[1];
      matrix(i + 2, i + 2) += model.spring(end) * turn.moment_slope;
    });
  const planar_beam::CrossSection& section = model.section();
  for (int a = 0; a <= p; ++a)
    for (int b = 0; b <= p; ++b) {
      const double m = (2.0 / h + model.damping()) * element.mass[a][b];
      matrix(3 * a, 3 * b) += m * section.rhoA;
      matrix(3 * a + 1, 3 * b + 1) += m * section.rhoA;
      matrix(3 * a + 2, 3 * b + 2) += m * section.rhoI;
    }
  return matrix;
}

template <BeamForm M, Turning turning>
const typename Stepper<M, turning>::Vector& Stepper<M, turning>::correct() {
  correction_ = -residual_;
  if (assembled_)
    assembled_->solve(correction_.data());
  else
    chain_.solve(correction_.data());
  ++iterations;
  return correction_;
}

template <BeamForm M, Turning turning>
void Stepper<M, turning>::finish(double h) {
  const int n = static_cast<int>(u.size());
  for (int i = 0; i < n; i += 3) {
    u[i] += h * mean[i];
    u[i + 1] += h * mean[i + 1];
    u[i + 2] += turning == Turning::cayley ? 2.0 * std::atan(0.5 * h * mean[i + 2]) : h * mean[i + 2];
  }
  v = 2.0 * mean - v;
  settle(h);
  for (std::size_t k = 0; k < points_.size(); ++k) history[k] = points_[k].end();
  past[2].swap(past[1]);
  past[1].swap(past[0]);
  past[0] = mean;
  known = h == past_step ? std::min(known + 1, 3) : 1;
  past_step = h;
}

template <BeamForm M, Turning turning>
void Stepper<M, turning>::add_hinges(const M& model, double h) {
  model.for_hinge_springs([&](int k, double stiffness) {
    const int left = model.numbering().left_rotation(k), right = model.numbering().right_rotation(k);
    const double moment =
        hinge_moment(turning == Turning::cayley, stiffness, u[right] - u[left], mean[left], mean[right], h)
            .moment;
    internal_[left] -= moment;
    internal_[right] += moment;
  });
}

template <BeamForm M, Turning turning>
void Stepper<M, turning>::linearise_hinges(const M& model, double h) {
  model.for_hinge_springs([&](int k, double stiffness) {
    const int left = model.numbering().left_rotation(k), right = model.numbering().right_rotation(k);
    const HingeMoment m =
        hinge_moment(turning == Turning::cayley, stiffness, u[right] - u[left], mean[left], mean[right], h);
    if (assembled_)
      assembled_->set_spring(k, m.by_left, m.by_right);
    else
      chain_.set_spring(k, m.by_left, m.by_right);
  });
}

template <BeamForm M, Turning turning>
void Stepper<M, turning>::add_ends(const M& model, double h) {
  for (int end = 0; end < 2; ++end) {
    const int i = model.end_unknown(end);
    const EndTurn turn(u[i + 2], mean[i + 2], h);
    const auto load = model.following(middle_, end, turn.phi);
    internal_[i] -= load.force[0];
    internal_[i + 1] -= load.force[1];
    internal_[i + 2] += model.spring(end) * turn.moment;
  }
}

template <BeamForm M, Turning turning>
double Stepper<M, turning>::take_residual() {
  const double arm = 1.0 / (length_ * length_);
  double inertia = 0.0, internal = 0.0, external = 0.0, total = 0.0;
  const int n = static_cast<int>(residual_.size());
  for (int i = 0; i < n; i += 3)
    for (int k = 0; k < 3; ++k) {
      const double weight = k == 2 ? arm : 1.0;
      const double x = inertia_[i + k], y = internal_[i + k], z = external_[i + k], r = x + y - z;
      residual_[i + k] = r;
      inertia += weight * x * x;
      internal += weight * y * y;
      external += weight * z * z;
      total += weight * r * r;
    }
  scale_ = std::sqrt(std::max({inertia, internal, external}));
  return std::sqrt(total);
}

template <BeamForm M, Turning turning>
void Stepper<M, turning>::extrapolate(double h) {
  const int usable = h == past_step ? known : 0;
  if (usable == 3)
    mean = 3.0 * (past[0] - past[1]) + past[2];
  else if (usable == 2)
    mean = 2.0 * past[0] - past[1];
  else
    mean = v;
  // Where the last one has been the better start lately, the other is tried only now and then.
  if (usable >= 2 && plain_ > 0) {
    --plain_;
    mean = past[0];
  }
  extrapolated_ = usable >= 2 && plain_ == 0;
}

template <BeamForm M, Turning turning>
bool Stepper<M, turning>::solve(const M& model, double h) {
  drive(h);
  double size = evaluate(model, h);
  if (extrapolated_ && !(size <= 1e-2 * scale_)) {
    trial_ = mean;
    mean = past[0];
    drive(h);
    const double plain = evaluate(model, h);
    if (size < plain) {
      mean = trial_;
      size = evaluate(model, h);
    } else {
      size = plain;
      plain_ = 16;
    }
  }
  extrapolated_ = false;
  bool fresh = false, keep = false;
  for (int k = 0; k < 40; ++k) {
    if (!std::isfinite(size)) return false;
    if (k > 0 && size <= threshold()) return polish(model, h, size);
    if (!keep) {
      linearise(model, h);
      fresh = true;
    }
    const double before = size;
    trial_ = mean;
    correct();
    double length = 1.0;
    bool leading = false;
    for (;; length *= 0.5) {
      mean = trial_ + length * correction_;
      size = evaluate(model, h);
      if (size <= (1.0 - 1e-4 * length) * before || size <= floor()) break;
      leading = std::isfinite(size) && leads_on(1.0 - 0.5 * length);
      if (leading) break;
      if (length < 1e-3) return false;
      if (!fresh) break;
    }
    if (size > before && !fresh && !leading) {  // the old tangent does not serve any more
      mean = trial_;
      size = evaluate(model, h);
      keep = false;
      continue;
    }
    keep = length == 1.0 && size <= kept_while_ * before;
    fresh = false;
  }
  return false;
}

template <BeamForm M, Turning turning>
bool Stepper<M, turning>::leads_on(double factor) {
  next_ = -residual_;
  if (assembled_)
    assembled_->solve(next_.data());
  else
    chain_.solve(next_.data());
  return planar_beam::nodal_norm(next_, length_) <= factor * planar_beam::nodal_norm(correction_, length_);
}

template <BeamForm M, Turning turning>
bool Stepper<M, turning>::polish(const M& model, double h, double size) {
  if (size <= 1e-2 * std::max(tolerance_ * scale_, floor())) return true;
  trial_ = mean;
  correct();
  mean += correction_;
  if (evaluate(model, h) <= std::max(size, floor())) return true;
  mean = trial_;
  evaluate(model, h);
  return true;
}

template <BeamForm M, Turning turning>
bool Stepper<M, turning>::continue_in_step(const M& model, double h) {
  mean = v;
  Vector& good = past[2];  // overwritten after the step anyway
  known = std::min(known, 2);
  double done = 0.0, part = 0.25;
  for (int tries = 0; tries < 60 && done < 1.0; ++tries) {
    good = mean;
    const double next = std::min(1.0, done + part);
    if (solve(model, next * h)) {
      done = next;
      part *= 1.5;
    } else {
      mean = good;
      part *= 0.5;
      if (part < 1e-3) return false;
    }
  }
  return done >= 1.0;
}

}  // namespace gnomon::beam
