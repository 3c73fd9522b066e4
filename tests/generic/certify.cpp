#include "src/certify.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/catch.hpp"
#include "tests/generic/problems.hpp"

namespace {

using gnomon::Certified;
using gnomon::certify;
using gnomon::CertifyOptions;
using gnomon::CertifyProblem;
using gnomon::Distances;
using gnomon::error_bounds;
using gnomon::generic::test::distance;
using gnomon::generic::test::Kepler;
using gnomon::generic::test::Lorenz;
using gnomon::generic::test::StiffPair;
using Long = long double;

template <class Real>
constexpr Real epsilon = std::numeric_limits<Real>::epsilon();
constexpr Long infinity = std::numeric_limits<Long>::infinity();

/// Euclidean distance of the first two components.
template <class Real>
Real planar(const std::vector<Real>& a, const std::vector<Real>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1]);
}

/// f(segment, t, y, dydt) from a right-hand side without segments.
template <class F>
auto unsegmented(const F& f) {
  return [f](int, auto t, const auto* y, auto* dydt) { f(t, y, dydt); };
}

template <class Real>
CertifyProblem<Real> kepler_problem(Real length) {
  CertifyProblem<Real> p;
  p.y0 = Kepler<Real>{}.initial();
  p.scale.assign(4, Real(1));
  for (int k = 1; k <= 10; ++k) p.outputs.push_back(length * Real(k) / Real(10));
  return p;
}

/// Checks that the bounds hold at every time and are not more than 1000 times too large over all.
template <class Real, class Exact>
void check_bounds(const Certified<Real>& solution, const std::vector<Real>& bounds, Exact&& exact) {
  REQUIRE(solution.tight.size() == solution.times.size());
  REQUIRE(bounds.size() == solution.times.size());
  Long largest_error = 0, largest_bound = 0;
  for (std::size_t k = 0; k < bounds.size(); ++k) {
    const Long error = distance(solution.tight[k], exact(solution.times[k]));
    const Long bound = bounds[k];
    INFO("output " << k << ": error " << error << ", bound " << bound);
    CHECK(error <= bound);
    largest_error = std::max(largest_error, error);
    largest_bound = std::max(largest_bound, bound);
  }
  INFO("largest error " << largest_error << ", bound " << largest_bound);
  CHECK(largest_bound <= 1000 * largest_error);
}

template <class Real>
void check_kepler(const CertifyOptions<Real>& options) {
  const Kepler<Real> kepler;
  auto f = unsegmented(kepler);
  const auto solution = certify(f, kepler_problem(Real(15.75)), options);
  INFO(solution.message);
  CHECK(solution.converged);
  CHECK(solution.message.empty());
  check_bounds(solution, error_bounds(solution, planar<Real>, epsilon<Real>),
               [&](Real t) { return kepler.position(t); });
}

/// y' = level - y with level 0 up to the break and 1 after it; the exact solution from y(0) = 1.
constexpr Long jump_time = 0.7123456789012345678L;
std::vector<Long> jump_exact(Long t) {
  return {t <= jump_time ? std::exp(-t) : 1 - std::exp(jump_time - t) + std::exp(-t)};
}

CertifyProblem<Long> jump_problem(std::vector<Long> breaks) {
  CertifyProblem<Long> p;
  p.y0 = {1};
  p.scale = {1};
  p.outputs = {0.5L, 1.0L, 2.0L};
  p.breaks = std::move(breaks);
  return p;
}

template <class Real>
Real scalar(const std::vector<Real>& a, const std::vector<Real>& b) {
  return std::abs(a[0] - b[0]);
}

}  // namespace

TEST_CASE("generic: a certified bound holds and is not needlessly large") {
  check_kepler<Long>({});
  check_kepler<double>({});
  CertifyOptions<Long> rough;  // errors of A far above rounding
  rough.tight = 1e-12L;
  rough.loose = 1e-9L;
  check_kepler<Long>(rough);
  CertifyOptions<double> few;  // B ends before rounding
  few.tight = 1e-11;
  few.loose = 1e-8;
  few.target = 1e-9;
  check_kepler<double>(few);
}

TEST_CASE("generic: a certified solution says how it was made") {
  const Kepler<double> kepler;
  long calls = 0;
  auto f = [&](int, double t, const double* y, double* dydt) {
    ++calls;
    kepler(t, y, dydt);
  };
  const auto solution = certify(f, kepler_problem(4.0));
  REQUIRE(solution.converged);
  CHECK(solution.evaluations == calls);
  CHECK(solution.seconds > 0);
  REQUIRE(solution.methods.size() == 4);
  CHECK(solution.methods[0].find("extrapolation") != std::string::npos);
  CHECK(solution.methods[0] != solution.methods[1]);
  CHECK(solution.methods[2].find("order 16, " + std::to_string(solution.steps) + " steps") !=
        std::string::npos);
  CHECK(solution.methods[3].find("order 16, " + std::to_string(solution.steps / 2) + " steps") !=
        std::string::npos);
  CHECK(solution.loose_distance >= 10 * solution.distances.methods);
}

TEST_CASE("generic: the contraction of the steps is measured from one doubling to the next") {
  auto f = unsegmented(Kepler<Long>{});
  CertifyOptions<Long> options;
  options.target = 1e-4L;
  const auto first = certify(f, kepler_problem(15.75L), options);
  options.target = 0.9L * first.distances.steps;
  const auto second = certify(f, kepler_problem(15.75L), options);
  CHECK(second.steps == 2 * first.steps);
  CHECK(second.coarse == first.fine);
  CHECK(second.step_contraction == second.distances.steps / first.distances.steps);
  CHECK(second.step_contraction > 1e-7L);
  CHECK(second.step_contraction < 0.1L);
}

TEST_CASE("generic: certification sees a method that solves other equations") {
  const Kepler<Long> kepler;
  auto right = unsegmented(kepler);
  auto wrong = [&](int, Long t, const Long* y, Long* dydt) {
    kepler(t, y, dydt);
    dydt[2] *= 1 + 1e-9L;
  };
  const auto problem = kepler_problem(15.75L);
  const auto good = certify(right, problem);
  const Long good_bound = error_bounds(good, planar<Long>, epsilon<Long>).back();
  CHECK(good_bound <= 1e-15L);
  // B wrong: the solution is right, but the bound must say that this is not known. A wrong: so is the
  // solution.
  for (const bool a_wrong : {false, true}) {
    const auto bad = a_wrong ? certify(wrong, right, problem, {}) : certify(right, wrong, problem, {});
    CHECK_FALSE(bad.converged);
    CHECK(bad.message.find("different solutions") != std::string::npos);
    const Long bound = error_bounds(bad, planar<Long>, epsilon<Long>).back();
    CHECK(bound >= 1e-9L);
    CHECK(bound <= 1e-6L);
    const Long error = distance(bad.tight.back(), kepler.position(15.75L));
    CHECK(error <= bound);
    CHECK((error >= 1e-9L) == a_wrong);
  }
}

TEST_CASE("generic: certification splits at breaks, and sees when it should have") {
  auto split = [](int segment, Long, const Long* y, Long* dydt) { dydt[0] = Long(segment) - y[0]; };
  const auto good = certify(split, jump_problem({jump_time}));
  INFO(good.message);
  CHECK(good.converged);
  for (std::size_t k = 0; k < good.times.size(); ++k)
    CHECK(distance(good.tight[k], jump_exact(good.times[k])) <= 1e-18L);
  CHECK(error_bounds(good, scalar<Long>, epsilon<Long>).back() <= 1e-16L);

  auto unsplit = [](int, Long t, const Long* y, Long* dydt) { dydt[0] = (t <= jump_time ? 0 : 1) - y[0]; };
  CertifyOptions<Long> options;
  options.max_evaluations = 2'000'000;
  const auto bad = certify(unsplit, jump_problem({}), options);
  CHECK_FALSE(bad.converged);
  CHECK_FALSE(bad.message.empty());
  REQUIRE(bad.fine.size() == 3);
  CHECK(distance(bad.fine.front(), jump_exact(0.5L)) <= 1e-17L);
  CHECK(distance(bad.fine.back(), jump_exact(2)) >= 1e-8L);
  CHECK(error_bounds(bad, scalar<Long>, epsilon<Long>).back() >= 1e-8L);
}

TEST_CASE("generic: segments are counted by the breaks that lie behind") {
  // y' = segment: the value tells which segments were used. Breaks before, at and after the start, at and
  // between output times, and after the last one.
  auto f = [](int segment, double, const double*, double* dydt) { dydt[0] = segment; };
  CertifyProblem<double> p;
  p.t0 = 0;
  p.y0 = {0};
  p.scale = {1};
  p.outputs = {0, 1, 2, 4};
  p.breaks = {-1, 0, 1, 2.5, 3, 4, 9};
  const auto solution = certify(f, p);
  INFO(solution.message);
  CHECK(solution.converged);
  REQUIRE(solution.tight.size() == 4);
  const double expected[] = {0, 2, 5, 5 + 0.5 * 3 + 0.5 * 4 + 1 * 5};
  for (std::size_t k = 0; k < 4; ++k) {
    CHECK(std::abs(solution.tight[k][0] - expected[k]) <= 4e-15);
    CHECK(std::abs(solution.fine[k][0] - expected[k]) <= 4e-15);
  }
}

TEST_CASE("generic: the bound grows where the problem amplifies errors, and only there") {
  StiffPair<Long> pair;
  CertifyProblem<Long> p;
  p.y0 = pair.initial();
  p.scale = {1, 1};
  p.outputs = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  auto growing = unsegmented(pair);
  const auto up = certify(growing, p);
  CHECK(up.converged);
  const auto up_bounds = error_bounds(up, planar<Long>, epsilon<Long>);
  check_bounds(up, up_bounds, [&](Long t) { return pair.exact(t); });
  CHECK(up_bounds.back() >= 300 * up_bounds.front());

  pair.growth = -1;
  auto decaying = unsegmented(pair);
  const auto down = certify(decaying, p);
  CHECK(down.converged);
  const auto down_bounds = error_bounds(down, planar<Long>, epsilon<Long>);
  for (std::size_t k = 0; k < p.outputs.size(); ++k)
    CHECK(distance(down.tight[k], pair.exact(p.outputs[k])) <= down_bounds[k]);
  CHECK(down_bounds.back() <= 3 * down_bounds.front());
}

TEST_CASE("generic: the bound of a chaotic problem holds against a solution in a longer format") {
  auto in_double = unsegmented(Lorenz<double>{});
  auto in_long = unsegmented(Lorenz<Long>{});
  CertifyProblem<double> p;
  p.y0 = Lorenz<double>{}.initial();
  p.scale = {10, 10, 10};
  p.outputs = {1, 2.5, 5, 7.5, 10, 15, 20};
  CertifyProblem<Long> q;
  q.y0 = {1, 1, 1};
  q.scale = {10, 10, 10};
  q.outputs.assign(p.outputs.begin(), p.outputs.end());
  const auto rough = certify(in_double, p);
  const auto fine = certify(in_long, q);
  CHECK(rough.converged);
  CHECK(fine.converged);
  const auto rough_bounds = error_bounds(rough, planar<double>, 40 * epsilon<double>);
  const auto fine_bounds = error_bounds(fine, planar<Long>, 40 * epsilon<Long>);
  for (std::size_t k = 0; k < p.outputs.size(); ++k) {
    const Long error = distance(rough.tight[k], {fine.tight[k][0], fine.tight[k][1]});
    INFO("t " << p.outputs[k] << ": error " << error << ", bound " << rough_bounds[k]);
    CHECK(error <= static_cast<Long>(rough_bounds[k]));
    CHECK(fine_bounds[k] <= 0.01L * static_cast<Long>(rough_bounds[k]));
  }
  CHECK(rough_bounds[4] >= 2 * rough_bounds[0]);
  CHECK(rough_bounds[6] >= 1000 * rough_bounds[0]);
  CHECK(rough_bounds[6] <= 1e-6);

  // Far beyond what the precision can follow, it must not be called converged to anything small.
  p.outputs = {80};
  CertifyOptions<double> options;
  options.max_evaluations = 3'000'000;
  const auto lost = certify(in_double, p, options);
  CHECK_FALSE(lost.converged);
  CHECK(error_bounds(lost, planar<double>, epsilon<double>).back() >= 1e-3);
}

TEST_CASE("generic: certification reports what cannot be done") {
  CertifyProblem<double> p;
  p.y0 = {1};
  p.scale = {1};
  p.outputs = {0.25, 1};
  auto late = [](int, double t, const double* y, double* dydt) {
    dydt[0] = t > 0.5 ? std::numeric_limits<double>::quiet_NaN() : -y[0];
  };
  auto decay = [](int, double, const double* y, double* dydt) { dydt[0] = -y[0]; };
  const auto broken = certify(late, p);
  CHECK_FALSE(broken.converged);
  CHECK(broken.message.find("extrapolation") != std::string::npos);
  CHECK(broken.tight.size() == 1);
  CHECK(broken.evaluations < 100'000);
  const auto half = certify(decay, late, p, {});  // A has a right-hand side, B has not
  CHECK_FALSE(half.converged);
  CHECK(half.message.find("collocation") != std::string::npos);
  CHECK(half.tight.size() == 2);
  CHECK(half.fine.empty());
  CHECK(half.evaluations < 1'000'000);
  CHECK(std::isinf(error_bounds(half, scalar<double>, 0.0).front()));
  bool shown = false;
  const auto bounds = error_bounds(
      broken,
      [&](const std::vector<double>& a, const std::vector<double>&) {
        shown = shown || a.empty();
        return 0.0;
      },
      0.0);
  CHECK_FALSE(shown);
  REQUIRE(bounds.size() == 2);
  CHECK(bounds[1] == std::numeric_limits<double>::infinity());

  CertifyOptions<double> options;
  options.max_evaluations = 100;
  p.outputs = {1000};
  const auto poor = certify(decay, p, options);
  CHECK_FALSE(poor.converged);
  CHECK(poor.evaluations <= 300);
  CHECK(poor.message.find("evaluation") != std::string::npos);

  const auto refused = [&](const CertifyProblem<double>& problem, const CertifyOptions<double>& o = {}) {
    const auto solution = certify(decay, problem, o);
    const auto b = error_bounds(solution, scalar<double>, 0.0);
    return !solution.converged && !solution.message.empty() && solution.evaluations == 0 &&
           std::all_of(b.begin(), b.end(), [](double x) { return std::isinf(x); });
  };
  p.outputs = {1, 2};
  CHECK_FALSE(refused(p));
  auto bad = p;
  bad.outputs = {2, 1};
  CHECK(refused(bad));
  bad.outputs = {1, 1};
  CHECK(refused(bad));
  bad.outputs = {-1};
  CHECK(refused(bad));
  bad.outputs = {};
  CHECK(refused(bad));
  bad = p;
  bad.breaks = {0.5, 0.5};
  CHECK(refused(bad));
  bad = p;
  bad.scale = {1, 1};
  CHECK(refused(bad));
  options = {};
  options.loose = options.tight;
  CHECK(refused(p, options));
  options = {};
  options.stages = 1;
  CHECK(refused(p, options));
}

TEST_CASE("generic: error bounds from distances") {
  using D = std::vector<Distances<Long>>;
  // 2 (M + min(L, q S)) + floor
  CHECK(error_bounds(D{{4, 32, 64}}, 0.25L, 1.0L) == std::vector<Long>{2 * (4 + 16) + 1});
  CHECK(error_bounds(D{{4, 8, 64}}, 0.25L, 1.0L) == std::vector<Long>{2 * (4 + 8) + 1});
  // A distance that vanishes by chance does not lower the bound.
  CHECK(error_bounds(D{{4, 8, 64}, {0, 0, 0}}, 0.25L, 0.0L) == std::vector<Long>{24, 24});
  // One method may be missing its own check, not both, and never the comparison.
  CHECK(error_bounds(D{{4, infinity, 64}}, 0.0L, 0.0L) == std::vector<Long>{8});
  CHECK(error_bounds(D{{4, 8, infinity}}, 0.0L, 0.0L) == std::vector<Long>{24});
  CHECK(error_bounds(D{{4, infinity, infinity}}, 0.0L, 0.0L) == std::vector<Long>{infinity});
  CHECK(error_bounds(D{{infinity, 8, 64}}, 0.0L, 0.0L) == std::vector<Long>{infinity});
  const Long nan = std::numeric_limits<Long>::quiet_NaN();
  CHECK(error_bounds(D{{nan, 1, 1}, {1, 1, 1}}, 1.0L, 0.0L) == std::vector<Long>{infinity, infinity});
  CHECK(error_bounds(D{{1, 4, 2}}, nan, 0.0L) == std::vector<Long>{6});
  CHECK(error_bounds(D{{1, 4, 2}}, 7.0L, 0.0L) == std::vector<Long>{6});
}
