#pragma once
#include <array>
#include <cmath>

#include "integrators/rotation/cayley_flow.hpp"
#include "integrators/rotation/kicked.hpp"

namespace gnomon::rotation {

/// Modified moments J that raise the order of the discrete Moser-Veselov equations: 1/J_i = sigma/I_i +
/// delta, sigma and delta polynomials in N = h^2 |m|^2/2 and H = h^2 m.(I^-1 m)/2. E. Hairer, G. Vilmart, J.
/// Phys. A 39 (2006) 13225-13235; the terms of degree 3 and 4 are those of its authors' program DMV10.
template <int order>
class Preprocessing {
 public:
  static_assert(order >= 2 && order <= 10 && order % 2 == 0);
  static constexpr int degree = order / 2 - 1;

  explicit Preprocessing(const Vector3& inertia)
      : scale_(inertia.mean()), inverse_(scale_ * inertia.cwiseInverse()) {
    const Vector3 I = inertia / scale_;
    const double d = I.prod(), d2 = d * d, d3 = d2 * d, d4 = d2 * d2;
    const auto s = [&](int k) { return std::pow(I[0], k) + std::pow(I[1], k) + std::pow(I[2], k); };
    const auto x = [&](int k) { return s(-k); };
    // sum over the axes i of (I_j^p + I_k^p)/I_i^q
    const auto mixed = [&](int p, int q) { return s(p) * x(q) - s(p - q); };
    const double s1 = s(1), s2 = s(2), s3 = s(3), s4 = s(4), x1 = x(1), x2 = x(2), x3 = x(3), x4 = x(4);
    const double x11 = mixed(1, 1), x12 = mixed(1, 2), x21 = mixed(2, 1), x13 = mixed(1, 3);
    const double x31 = mixed(3, 1), x22 = mixed(2, 2);
    sigma_ = {s1 / (6.0 * d),
              -x1 / 3.0,
              (s2 / d - x1) / (30.0 * d),
              (1.0 - x11) / (30.0 * d),
              (3.0 * s1 / d + 2.0 * x2) / 60.0,
              (4.0 * d + 17.0 * s3 - 15.0 * d * x11) / (2520.0 * d3),
              (9.0 * s1 + 10.0 * d * x2 - 6.0 * x21) / (420.0 * d2),
              ((6.0 * x12 - 100.0 * x1) * d + 53.0 * s2) / (2520.0 * d2),
              (15.0 - d * x3 - 2.0 * x11) / (630.0 * d),
              (62.0 * s4 - 94.0 * d * x21 + 66.0 * d2 * x2 + 81.0 * d * s1) / (45360.0 * d4),
              (-77.0 * x31 + 75.0 * d * x12 + 214.0 * s2 - 240.0 * d * x1) / (22680.0 * d3),
              (26.0 * d * x22 + 55.0 * s3 + 204.0 * d - 50.0 * d2 * x3 - 59.0 * d * x11) / (7560.0 * d3),
              (137.0 * d * x2 - d * x13 + 3.0 * s1 - 69.0 * x21) / (11340.0 * d2),
              (2.0 * d2 * x4 + 5.0 * d * x12 - 171.0 * d * x1 + 159.0 * s2) / (45360.0 * d2)};
    delta_ = {-1.0 / (3.0 * d),
              s1 / (6.0 * d),
              -s1 / (60.0 * d2),
              x1 / (10.0 * d) - s2 / (60.0 * d2),
              -(9.0 + x11) / (60.0 * d),
              (34.0 * d * x1 - 19.0 * s2) / (2520.0 * d3),
              (s3 + 2.0 * d * x11 - 85.0 * d) / (1260.0 * d3),
              (47.0 * s1 + 13.0 * x21 - 38.0 * d * x2) / (2520.0 * d2),
              (9.0 * d * x1 + d * x12 - 11.0 * s2) / (1260.0 * d2),
              (60.0 * x11 * d - 61.0 * s3 - 247.0 * d) / (45360.0 * d4),
              (54.0 * d * s1 - s4 + 218.0 * d * x21 - 426.0 * d2 * x2) / (45360.0 * d4),
              (125.0 * d * x1 - 5.0 * x31 - 130.0 * s2 + 4.0 * d * x12) / (7560.0 * d3),
              (67.0 * s3 - 735.0 * d - 15.0 * d * x22 + 87.0 * d * x11 + 34.0 * d2 * x3) / (22680.0 * d3),
              (165.0 * s1 - d * x13 - 9.0 * x21 - 145.0 * d * x2) / (45360.0 * d2)};
  }

  /// J [kg m^2] for the momentum m (body components) and the step h.
  Vector3 moments(const Vector3& m, double h) const {
    const Vector3 scaled = h / scale_ * m;
    const double N = 0.5 * scaled.squaredNorm(), H = 0.5 * scaled.dot(inverse_.cwiseProduct(scaled));
    double sigma = 1.0, delta = 0.0;
    std::size_t first = 0;  // of the terms of one degree: N^k, N^(k-1) H, .., H^k
    for (int k = 1; k <= degree; ++k) {
      double terms_sigma = 0.0, terms_delta = 0.0, power = 1.0;  // of H
      for (int j = 0; j <= k; ++j, ++first, power *= H) {
        terms_sigma = terms_sigma * N + sigma_[first] * power;
        terms_delta = terms_delta * N + delta_[first] * power;
      }
      sigma += terms_sigma;
      delta += terms_delta;
    }
    return scale_ * (sigma * inverse_.array() + delta).inverse().matrix();
  }

 private:
  double scale_;
  Vector3 inverse_;  // of the moments over `scale_`
  std::array<double, 14> sigma_, delta_;
};

/// A discrete Moser-Veselov step: with c the vector (angle tangent) of the turn,
///     J c + c x (J c) = (1 + |c|^2) (h/2) m,
/// which keeps |m|, m.(J^-1 m) and so m.(I^-1 m).
template <int order>
class MoserVeselovFlow {
 public:
  static constexpr bool exact = false;
  explicit MoserVeselovFlow(const Vector3& inertia) : inertia_(inertia), preprocessing_(inertia) {}

  Status turn(const Vector3& m, double tau, Quaternion& by) {
    Vector3 c;
    const Vector3 J = order == 2 ? inertia_ : preprocessing_.moments(m, tau);
    const Status status = solve_cayley<CayleyTerms{false, true}>(J, 0.5 * tau * m, c, iterations_);
    by = cayley(c);
    return status;
  }
  long iterations() const { return iterations_; }

 private:
  Vector3 inertia_;
  Preprocessing<order> preprocessing_;
  long iterations_ = 0;
};

constexpr SchemeInfo moser_veselov_info(std::string_view name, std::string_view summary, double free_order) {
  return {
      .name = name,
      .family = "rotation",
      .summary = summary,
      .citation =
          "J. Moser, A.P. Veselov, Commun. Math. Phys. 139 (1991) 217-243; E. Hairer, G. Vilmart, J. Phys. A "
          "39 (2006) 13225-13235; moment by Strang splitting",
      .form = "rotation",
      .orders = {{{"none", free_order}, {"gravity", 2}, {"space_moment", 2}, {"body_moment", 2}}},
      .reversible = true,
      .conserves_energy = true,
      .conserves_momentum = true,
  };
}

struct Dmv2 : Kicked<MoserVeselovFlow<2>, strang> {
  static constexpr SchemeInfo info =
      moser_veselov_info("dmv2", "discrete Moser-Veselov equations, half kicks", 2);
};
struct Dmv4 : Kicked<MoserVeselovFlow<4>, strang> {
  static constexpr SchemeInfo info =
      moser_veselov_info("dmv4", "discrete Moser-Veselov equations, preprocessed to order 4, half kicks", 4);
};
struct Dmv6 : Kicked<MoserVeselovFlow<6>, strang> {
  static constexpr SchemeInfo info =
      moser_veselov_info("dmv6", "discrete Moser-Veselov equations, preprocessed to order 6, half kicks", 6);
};
struct Dmv8 : Kicked<MoserVeselovFlow<8>, strang> {
  static constexpr SchemeInfo info =
      moser_veselov_info("dmv8", "discrete Moser-Veselov equations, preprocessed to order 8, half kicks", 8);
};
struct Dmv10 : Kicked<MoserVeselovFlow<10>, strang> {
  static constexpr SchemeInfo info = moser_veselov_info(
      "dmv10", "discrete Moser-Veselov equations, preprocessed to order 10, half kicks", 10);
};

}  // namespace gnomon::rotation
