#pragma once
#include <array>
#include <cstddef>
#include <string_view>

namespace gnomon::rotation {

/// Fractions of the step of a splitting into kicks by the moment and free drifts, in turn: kick, drift, ..,
/// kick if there is a kick more than there are drifts, else drift, kick, .., drift.
template <std::size_t kick_count, std::size_t drift_count>
struct Splitting {
  static_assert(kick_count == drift_count + 1 || drift_count == kick_count + 1);
  static constexpr bool drift_first = drift_count > kick_count;
  std::array<double, kick_count> kicks{};
  std::array<double, drift_count> drifts{};
};

/// The second half of a symmetric sequence of n from its first, the middle one or two such that all add to 1.
template <std::size_t n, std::size_t given>
constexpr std::array<double, n> symmetric(const std::array<double, given>& first) {
  static_assert(given == (n - 1) / 2);
  std::array<double, n> all{};
  double rest = 1.0;
  for (std::size_t k = 0; k < given; ++k) {
    all[k] = all[n - 1 - k] = first[k];
    rest -= 2.0 * first[k];
  }
  all[given] = all[n - 1 - given] = n % 2 == 1 ? rest : 0.5 * rest;
  return all;
}

/// Kick, drift, kick by a half, the whole and a half, for each of n fractions of the step in turn;
/// neighbouring half kicks are joined.
template <std::size_t n>
constexpr Splitting<n + 1, n> composition(const std::array<double, n>& steps) {
  Splitting<n + 1, n> splitting;
  splitting.drifts = steps;
  for (std::size_t k = 0; k < n; ++k) {
    splitting.kicks[k] += 0.5 * steps[k];
    splitting.kicks[k + 1] += 0.5 * steps[k];
  }
  return splitting;
}

inline constexpr auto strang = composition<1>({1.0});

// c = 1/(2 - 2^(1/3)), 1 - 2 c, c
inline constexpr std::string_view yoshida4_citation = "H. Yoshida, Phys. Lett. A 150 (1990) 262-268";
inline constexpr auto yoshida4 = composition(symmetric<3, 1>({1.3512071919596576340}));

// c = 1/(4 - 4^(1/3)), c, 1 - 4 c, c, c
inline constexpr std::string_view suzuki4_citation = "M. Suzuki, Phys. Lett. A 146 (1990) 319-323";
inline constexpr auto suzuki4 =
    composition(symmetric<5, 2>({0.41449077179437573714, 0.41449077179437573714}));

inline constexpr std::string_view kahan_li6_citation =
    "W. Kahan, R.-C. Li, Math. Comp. 66 (1997) 1089-1099, order 6 in 9 stages";
inline constexpr auto kahan_li6 = composition(symmetric<9, 4>(
    {0.39216144400731413928, 0.33259913678935943860, -0.70624617255763935981, 0.08221359629355080023}));

inline constexpr std::string_view mclachlan8_citation =
    "R.I. McLachlan, SIAM J. Sci. Comput. 16 (1995) 151-168, order 8 in 15 stages";
inline constexpr auto mclachlan8 = composition(symmetric<15, 7>(
    {0.74167036435061295345, -0.40910082580003159400, 0.19075471029623837995, -0.57386247111608226666,
     0.29906418130365592384, 0.33462491824529818378, 0.31529309239676659663}));

inline constexpr std::string_view kahan_li8_citation =
    "W. Kahan, R.-C. Li, Math. Comp. 66 (1997) 1089-1099, order 8 in 17 stages";
inline constexpr auto kahan_li8 = composition(symmetric<17, 8>(
    {0.13020248308889008088, 0.56116298177510838456, -0.38947496264484728641, 0.15884190655515560090,
     -0.39590389413323757734, 0.18453964097831570709, 0.25837438768632204729, 0.29501172360931029887}));

inline constexpr std::string_view blanes_moan4_citation =
    "S. Blanes, P.C. Moan, J. Comput. Appl. Math. 142 (2002) 313-330, S6 of order 4";
inline constexpr Splitting<7, 6> blanes_moan4{
    symmetric<7, 3>({0.0792036964311957, 0.353172906049774, -0.0420650803577195}),
    symmetric<6, 2>({0.209515106613362, -0.143851773179818})};

// Splittings of Runge-Kutta-Nystrom type need that kicks commute and that the energy of a drift is quadratic
// in the momentum. Both hold for rigid bodies: a kick adds to the body momentum what depends on the attitude
// alone.
inline constexpr std::string_view blanes_moan_rkn4_citation =
    "S. Blanes, P.C. Moan, J. Comput. Appl. Math. 142 (2002) 313-330, SRKN_6^b of order 4";
inline constexpr Splitting<7, 6> blanes_moan_rkn4{
    symmetric<7, 3>({0.0829844064174052, 0.396309801498368, -0.0390563049223486}),
    symmetric<6, 2>({0.245298957184271, 0.604872665711080})};

inline constexpr std::string_view blanes_moan_rkn6_citation =
    "S. Blanes, P.C. Moan, J. Comput. Appl. Math. 142 (2002) 313-330, SRKN_14^a of order 6";
inline constexpr Splitting<14, 15> blanes_moan_rkn6{
    symmetric<14, 6>({0.09171915262446165, 0.183983170005006, -0.05653436583288827, 0.004914688774712854,
                      0.143761127168358, 0.328567693746804}),
    symmetric<15, 7>({0.0378593198406116, 0.102635633102435, -0.0258678882665587, 0.314241403071447,
                      -0.130144459517415, 0.106417700369543, -0.00879424312851058})};

}  // namespace gnomon::rotation
