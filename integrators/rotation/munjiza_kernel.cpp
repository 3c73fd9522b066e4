#include "integrators/rotation/munjiza_kernel.hpp"

#include <cmath>

#include "models/rigid_body/rigid_body.hpp"
#include "src/measure/timing.hpp"

namespace gnomon::rotation {
namespace {

/// rot(p, .) as a + s p x a + c p x (p x a), s = sin|p|/|p| and c = (1 - cos|p|)/|p|^2.
struct Turn {
  double x, y, z, s, c;

  Turn(double x_, double y_, double z_) : x(x_), y(y_), z(z_) {
    const double q = x * x + y * y + z * z;
    if (q > 1.0) {
      const double angle = std::sqrt(q), half = std::sin(0.5 * angle);
      s = std::sin(angle) / angle;
      c = 2.0 * half * half / q;
      return;
    }
    const double q2 = q * q, q4 = q2 * q2;
    s = ((1.0 - q * (1.0 / 6)) + (1.0 / 120 - q * (1.0 / 5040)) * q2) +
        (((1.0 / 362880 - q * (1.0 / 39916800)) + (1.0 / 6227020800 - q * (1.0 / 1307674368000)) * q2) +
         q4 * (1.0 / 355687428096000)) *
            q4;
    c = ((0.5 - q * (1.0 / 24)) + (1.0 / 720 - q * (1.0 / 40320)) * q2) +
        (((1.0 / 3628800 - q * (1.0 / 479001600)) + (1.0 / 87178291200 - q * (1.0 / 20922789888000)) * q2) +
         q4 * (1.0 / 6402373705728000)) *
            q4;
  }
  void apply(double sign, const double* a, double* out) const {
    const double u = y * a[2] - z * a[1], v = z * a[0] - x * a[2], w = x * a[1] - y * a[0], t = sign * s;
    out[0] = a[0] + t * u + c * (y * w - z * v);
    out[1] = a[1] + t * v + c * (z * u - x * w);
    out[2] = a[2] + t * w + c * (x * v - y * u);
  }
};

/// A row by row, y = A^T H.
struct Kernel {
  double inverse[3], A[9], y[3];

  void velocity(const Turn& turn, double* w) const {
    double back[3];
    turn.apply(-1.0, y, back);
    for (int k = 0; k < 3; ++k) back[k] *= inverse[k];
    turn.apply(1.0, back, w);
  }
  void step(double h) {
    const double half = 0.5 * h, sixth = h / 6.0;
    const double w1[3] = {inverse[0] * y[0], inverse[1] * y[1], inverse[2] * y[2]};
    double w2[3], w3[3], w4[3], turned[3], p[3];
    velocity(Turn(half * w1[0], half * w1[1], half * w1[2]), w2);
    velocity(Turn(half * w2[0], half * w2[1], half * w2[2]), w3);
    velocity(Turn(h * w3[0], h * w3[1], h * w3[2]), w4);
    for (int k = 0; k < 3; ++k) p[k] = sixth * (w1[k] + 2.0 * (w2[k] + w3[k]) + w4[k]);
    const Turn turn(p[0], p[1], p[2]);
    turn.apply(-1.0, y, turned);
    for (int k = 0; k < 3; ++k) y[k] = turned[k];
    for (int row = 0; row < 3; ++row) {
      turn.apply(-1.0, A + 3 * row, turned);
      for (int k = 0; k < 3; ++k) A[3 * row + k] = turned[k];
    }
  }
};

[[gnu::noinline]] void march(Kernel& state, long steps, double h) {
  Kernel kernel = state;
  for (long n = 0; n < steps; ++n) kernel.step(h);
  state = kernel;
}

double run(const void* model, double t_end, double step, std::vector<double>& state, long& evaluations) {
  const auto& body = *static_cast<const rigid_body::RigidBody<rigid_body::Free>*>(model);
  rigid_body::State start = body.initial();
  Kernel kernel;
  for (int k = 0; k < 3; ++k) {
    kernel.inverse[k] = 1.0 / body.inertia()[k];
    kernel.y[k] = start.angular_momentum[k];
    for (int j = 0; j < 3; ++j) kernel.A[3 * k + j] = start.attitude(k, j);
  }
  const long steps = std::lround(t_end / step);
  const double begin = thread_cpu_seconds();
  march(kernel, steps, t_end / static_cast<double>(steps));
  const double seconds = thread_cpu_seconds() - begin;
  const Eigen::Vector3d momentum = start.attitude * start.angular_momentum;
  for (int k = 0; k < 9; ++k) start.attitude(k / 3, k % 3) = kernel.A[k];
  start.angular_momentum = start.attitude.transpose() * momentum;
  state = body.flatten(start);
  evaluations = 4 * steps;
  return seconds;
}

}  // namespace

const Yardstick munjiza_kernel_yardstick{
    .name = "munjiza by hand",
    .summary = "the steps of the documented scheme on a free body, written out",
    .scene = "asymmetric-free-top",
    .integrator = "munjiza",
    .tol = 0.0,
    .step = 0.01,
    .run = run,
};

}  // namespace gnomon::rotation
