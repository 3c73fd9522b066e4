// The forms through which SUNDIALS integrates the beam: their derivatives, their agreement with each other,
// what holds where a prescribed rotation jumps in its rate, and their cost.

#include <klu.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "tests/catch.hpp"
#include "tests/planar_beam/beams.hpp"

using namespace gnomon;
using namespace gnomon::test;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// A curved beam, its start turned, its end pinned, with loads.
Data driven_beam(int elements) {
  Data data = flying_beam(elements, 100.0);
  data.curvature = 0.13;
  data.supports[0].motion = planar_beam::Motion{1.5, 5.0};
  data.supports[1].place = true;
  return data;
}

MatrixXd dense(int n, const std::optional<SparsePattern>& pattern, const std::vector<double>& values) {
  if (!pattern) return Eigen::Map<const MatrixXd>(values.data(), n, n);
  MatrixXd matrix = MatrixXd::Zero(n, n);
  for (int j = 0; j < n; ++j)
    for (long k = pattern->column_start[j]; k < pattern->column_start[j + 1]; ++k)
      matrix(pattern->row[k], j) = values[k];
  return matrix;
}
template <class Form, class Fill>
MatrixXd matrix_of(const Form& form, Fill&& fill) {
  const auto pattern = form.sparsity();
  const std::size_t n = form.size();
  std::vector<double> values(pattern ? pattern->row.size() : n * n);
  fill(values.data());
  return dense(form.size(), pattern, values);
}

/// d(values)/dx by central differences, both of size n.
template <class Function>
MatrixXd differences(VectorXd x, Function&& function, double step = 1e-6) {
  const int n = static_cast<int>(x.size());
  MatrixXd matrix(n, n);
  VectorXd up(n), down(n);
  for (int j = 0; j < n; ++j) {
    const double kept = x[j];
    x[j] = kept + step;
    function(x.data(), up.data());
    x[j] = kept - step;
    function(x.data(), down.data());
    x[j] = kept;
    matrix.col(j) = (up - down) / (2.0 * step);
  }
  return matrix;
}
double distance(const MatrixXd& a, const MatrixXd& b) { return (a - b).norm() / b.norm(); }

template <class Form>
void check_dae(const Form& form, double t) {
  const int n = form.size();
  const VectorXd y = random_values(n, 1.0, 4), rate = random_values(n, 1.0, 5);
  const double cj = 3.7;
  const MatrixXd by_y =
      differences(y, [&](const double* at, double* value) { form.residual(t, at, rate.data(), value); });
  const MatrixXd by_rate = differences(
      rate, [&](const double* at, double* value) { form.residual(t, y.data(), at, value); }, 1.0);
  const auto jacobian = [&](double c) {
    return matrix_of(form, [&](double* values) { form.jacobian(t, c, y.data(), rate.data(), values); });
  };
  CHECK(distance(jacobian(0.0), by_y) <= 1e-8);
  CHECK(distance(jacobian(cj) - jacobian(0.0), cj * by_rate) <= 1e-11);  // linear in the rates
}

/// A curved beam whose start is moved, slides nowhere and is sprung, whose end slides, with a follower and
/// damping.
Data loaded_beam(int elements) {
  using planar_beam::Motion;
  Data data = flying_beam(elements, 100.0);
  data.curvature = 0.13;
  data.damping = 0.9;
  data.supports[0].displacement = {Motion{1.5, 5.0, planar_beam::MotionKind::half_sine},
                                   Motion{2.0, 4.0, planar_beam::MotionKind::spin_up}};
  data.supports[0].spring = 30.0;
  data.supports[1].place = true;
  data.supports[1].slide = 0;
  data.loads[0].at = planar_beam::Place::end;
  data.loads[0].force = {-20.0, 70.0};
  data.loads[0].follower = true;
  return data;
}

template <int p>
[[gnu::noinline]] void check_forms(const Data& data) {
  INFO("order " << p);
  const PlanarBeam<p> beam(data);
  const double t = 1.3;
  const auto ode = beam.ode();
  const auto mass_form = beam.mass_form();
  const int n = ode.size();
  const VectorXd y = random_values(n, 1.0, 4);

  const MatrixXd J = matrix_of(ode, [&](double* values) { ode.jacobian(t, y.data(), values); });
  CHECK(distance(J, differences(y, [&](const double* at, double* f) { ode.rhs(t, at, f); })) <= 1e-8);

  // The elimination solves with 1 - gamma J, also with a new gamma and the old J.
  auto newton = ode.newton_solver();
  newton.linearise(t, y.data());
  for (double gamma : {1e-4, 1e-2, 0.3, 1e-3}) {
    newton.factorise(gamma);
    const VectorXd b = random_values(n, 1.0, 6);
    VectorXd x = b;
    newton.solve(x.data());
    CHECK((x - gamma * (J * x) - b).norm() <= 1e-12 * (x.norm() + gamma * (J * x).norm()));
    CHECK((x - b).norm() >= 1e-6 * b.norm());
  }

  // M y' = f is the ODE multiplied by M.
  const MatrixXd M = matrix_of(mass_form, [&](double* values) { mass_form.mass(values); });
  const MatrixXd MJ = matrix_of(mass_form, [&](double* values) { mass_form.jacobian(t, y.data(), values); });
  VectorXd rate(n), right(n), residual(n);
  ode.rhs(t, y.data(), rate.data());
  mass_form.rhs(t, y.data(), right.data());
  CHECK((M * rate - right).norm() <= 1e-13 * right.norm());
  CHECK(distance(M * J, MJ) <= 1e-13);

  const auto dae = beam.dae();
  check_dae(dae, t);
  dae.residual(t, y.data(), rate.data(), residual.data());
  CHECK(residual.norm() <= 1e-13 * right.norm());
  VectorXd resumed = y, resumed_rate(n);
  dae.resume(t, resumed.data(), resumed_rate.data());
  CHECK(resumed == y);
  CHECK(resumed_rate == rate);

  // The constrained form has the same motion; its start is consistent, the hidden constraint included.
  const auto constrained = beam.dae_constraints();
  const int all = constrained.size(),
            m = static_cast<int>(beam.held().size() + beam.numbering().tied().size());
  check_dae(constrained, t);
  VectorXd z(all), z_rate(all), value(all);
  constrained.pack(t, ode.unpack(t, y.data()), z.data());
  constrained.resume(t, z.data(), z_rate.data());
  constrained.residual(t, z.data(), z_rate.data(), value.data());
  CHECK(value.norm() <= 1e-13 * z_rate.norm());
  for (int i : beam.held()) {
    const planar_beam::Motion* motion = beam.prescribed(i);
    CHECK(z_rate[beam.unknowns() + i] == (motion ? motion->acceleration_after(t) : 0.0));
  }
  CHECK(z_rate.tail(m).norm() >= 1.0);                          // forces of the supports and hinges,
  CHECK(z_rate.segment(2 * beam.unknowns(), m).norm() == 0.0);  // whose other multipliers vanish
  const auto& free = beam.free();
  for (std::size_t i = 0; i < free.size(); ++i) {
    CHECK(std::abs(z_rate[free[i]] - rate[i]) <= 1e-13 * rate.norm());
    // w is v without what s' gives it at once.
    double answer = 0.0;
    for (const auto& one : beam.driven())
      if (free[i] % 3 == one.unknown % 3)
        answer += one.motion.acceleration_after(t) * one.response[free[i] / 3];
    CHECK(std::abs(z_rate[beam.unknowns() + free[i]] - answer - rate[n / 2 + i]) <= 1e-13 * rate.norm());
  }
}

/// Entries of L and U of a form's matrix, by KLU.
template <class Form>
double fill_in(const Form& form) {
  SparsePattern pattern = *form.sparsity();
  klu_l_common common;
  klu_l_defaults(&common);
  std::vector<SuiteSparse_long> start(pattern.column_start.begin(), pattern.column_start.end());
  std::vector<SuiteSparse_long> row(pattern.row.begin(), pattern.row.end());
  klu_l_symbolic* symbolic = klu_l_analyze(form.size(), start.data(), row.data(), &common);
  REQUIRE(symbolic);
  const VectorXd y = random_values(form.size(), 0.01, 1);
  std::vector<double> values(row.size());
  form.jacobian(0.1, 100.0, y.data(), y.data(), values.data());
  klu_l_numeric* numeric = klu_l_factor(start.data(), row.data(), values.data(), symbolic, &common);
  REQUIRE(numeric);
  const double count = static_cast<double>(numeric->lnz + numeric->unz);
  klu_l_free_numeric(&numeric, &common);
  klu_l_free_symbolic(&symbolic, &common);
  return count;
}

}  // namespace

TEST_CASE("planar beam: the forms and their derivatives", "[planar_beam]") {
  check_forms<1>(driven_beam(3));
  check_forms<2>(driven_beam(3));
  check_forms<4>(driven_beam(3));
}

TEST_CASE("planar beam: the forms with a moved, a sliding and a sprung end, a follower and damping",
          "[planar_beam]") {
  check_forms<1>(loaded_beam(3));
  check_forms<2>(loaded_beam(3));
  // A follower's tangent is not symmetric; the other parts are.
  const PlanarBeam<2> beam(loaded_beam(3));
  const VectorXd u = random_values(beam.unknowns(), 1.0, 8);
  const auto inner = beam.element_tangent(u.data(), 2), whole = beam.element_tangent(1.3, u.data(), 2);
  CHECK((inner - inner.transpose()).norm() <= 1e-14 * inner.norm());
  CHECK((whole - whole.transpose()).norm() >= 10.0);
}

TEST_CASE("planar beam: the forms with hinges", "[planar_beam]") {
  Data driven = driven_beam(4);
  driven.hinges = {{2.5, 30.0}, {5.0}};
  check_forms<1>(driven);
  check_forms<2>(driven);
  Data loaded = loaded_beam(4);
  loaded.hinges = {{2.5}, {7.5, 30.0}};
  check_forms<1>(loaded);
  check_forms<2>(loaded);
  // Forces of the hinges act on both sides, in opposite directions.
  const PlanarBeam<2> beam(driven);
  const VectorXd u = random_values(beam.unknowns(), 1.0, 8);
  VectorXd joined(beam.unknowns()), apart(beam.unknowns());
  beam.internal_force(u.data(), joined.data());
  beam.internal_force(u.data(), apart.data(), planar_beam::Sides::apart);
  for (int i : beam.numbering().tied()) {
    CHECK(joined[i] == 0.0);
    CHECK(joined[i + 3] == apart[i] + apart[i + 3]);
    CHECK(std::abs(apart[i]) >= 1.0);
  }
}

TEST_CASE("planar beam: the forms where a prescribed rate jumps", "[planar_beam]") {
  const PlanarBeam<2> beam(driven_beam(3));
  const auto ode = beam.ode();
  const auto constrained = beam.dae_constraints();
  const int n = ode.size(), all = beam.unknowns();
  for (double at : {0.0, 5.0}) {
    const double before = at == 0.0 ? 0.0 : 0.3, after = 0.3 - before;
    VectorXd y(n), again(n);
    if (at == 0.0) {
      ode.pack(0.0, beam.initial(), y.data());
      CHECK(y.norm() == 0.0);
    } else {
      y = random_values(n, 1.0, 3);
    }
    const auto left = ode.unpack(at, y.data()), right = ode.unpack(at + 1e-13, y.data());
    CHECK(left.u[2] == (at == 0.0 ? 0.0 : 1.5));
    CHECK(std::abs(left.v[2] - before) <= 1e-15);
    CHECK(std::abs(right.v[2] - after) <= 1e-15);
    ode.pack(at, left, again.data());
    CHECK((again - y).norm() <= 1e-15 * y.norm());
    // The impulse acts at the held unknowns alone.
    VectorXd impulse(all);
    const VectorXd jump = right.v - left.v;
    beam.momentum(jump.data(), impulse.data());
    for (int i : beam.free()) CHECK(std::abs(impulse[i]) <= 1e-13 * impulse.norm());
    CHECK(impulse.norm() >= 1e-3);
    CHECK(jump.norm() >= 1.01 * std::abs(jump[2]));
    // The constrained form jumps like it, and only where it is resumed.
    VectorXd z(constrained.size()), rate(constrained.size()), value(constrained.size());
    constrained.pack(at, left, z.data());
    CHECK(z.segment(all, all) == left.v);
    constrained.resume(at, z.data(), rate.data());
    CHECK((z.segment(all, all) - right.v).norm() <= 1e-14 * right.v.norm() + 1e-15);
    constrained.residual(at, z.data(), rate.data(), value.data());
    CHECK(value.norm() <= 1e-12 * (1.0 + rate.norm()));
    // Before the jump its rates would be others.
    constrained.residual(std::nextafter(at, -1.0), z.data(), rate.data(), value.data());
    CHECK(std::abs(value[2 * all + 2 * beam.held().size() - 1]) <= 1e-12);
    if (at > 0.0) CHECK(value.tail(beam.held().size()).norm() >= 0.29);
  }
}

TEST_CASE("planar beam: the matrices grow linearly with the mesh", "[planar_beam]") {
  const auto counts = [](int elements) {
    const PlanarBeam<2> beam(driven_beam(elements));
    const auto entries = [](const auto& form) { return static_cast<double>(form.sparsity()->row.size()); };
    return std::array{entries(beam.mass_form()), entries(beam.dae()), entries(beam.dae_constraints()),
                      fill_in(beam.dae()), fill_in(beam.dae_constraints())};
  };
  const auto small = counts(20), middle = counts(40), large = counts(80);
  for (std::size_t k = 0; k < small.size(); ++k) {
    INFO(k << ": " << small[k] << " " << middle[k] << " " << large[k]);
    if (k < 3) CHECK(large[k] - middle[k] == 2.0 * (middle[k] - small[k]));
    CHECK(large[k] <= 2.1 * middle[k]);
    CHECK(large[k] >= 1.9 * middle[k]);
  }
}
