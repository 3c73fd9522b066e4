// The Butcher tables that the schemes name: that they exist and are what the summaries say.

#include <cstdio>  // SUNDIALS 6.4 needs it first

#include <arkode/arkode_butcher_dirk.h>
#include <arkode/arkode_butcher_erk.h>
#include <arkode/arkode_erkstep.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_config.h>

#include <cmath>
#include <memory>
#include <regex>

#include "integrators/sundials/compat.hpp"
#include "integrators/sundials/tables.hpp"
#include "tests/catch.hpp"
#include "tests/sundials/systems.hpp"

using namespace gnomon;
using namespace gnomon::test;

namespace {

using Real = long double;

using gnomon::sundials::Table;

/// One of the schemes, and what its summary says of its table.
struct Declared {
  std::string scheme, table;
  bool implicit;
  int order;
};

Declared parse(const SchemeInfo& info) {
  const std::string summary(info.summary);
  std::smatch name, order;
  REQUIRE(std::regex_search(summary, name, std::regex("ARKODE_[A-Z0-9_]+")));
  REQUIRE(std::regex_search(summary, order, std::regex("order ([0-9])")));
  return {std::string(info.name), name.str(), summary.find("implicit") != std::string::npos,
          std::stoi(order[1].str())};
}

std::vector<Declared> tables() {
  return {parse(gnomon::sundials::ArkodeErk4::info), parse(gnomon::sundials::ArkodeErk5::info),
          parse(gnomon::sundials::ArkodeErk8::info), parse(gnomon::sundials::ArkodeDirk::info)};
}

Table load(const Declared& named) {
  Table table(named.implicit ? ARKodeButcherTable_LoadDIRKByName(named.table.c_str())
                             : ARKodeButcherTable_LoadERKByName(named.table.c_str()));
  REQUIRE(table);
  return table;
}

// A planar orbit of eccentricity 0.3, in long double.
void orbit(const Real* y, Real* rate) {
  const Real r2 = y[0] * y[0] + y[1] * y[1], r3 = r2 * std::sqrt(r2);
  rate[0] = y[2], rate[1] = y[3], rate[2] = -y[0] / r3, rate[3] = -y[1] / r3;
}

// N equal steps over time 2 by the coefficients of a table, the stages of implicit ones by iteration.
std::vector<Real> integrate(const ARKodeButcherTable table, const sunrealtype* weights, int steps) {
  const int s = table->stages;
  const Real h = Real(2) / steps;
  std::vector<Real> y{1, 0, 0, std::sqrt(Real(1.3))}, stage(4);
  std::vector<std::vector<Real>> k(s, std::vector<Real>(4));
  for (int n = 0; n < steps; ++n) {
    for (int i = 0; i < s; ++i) {
      if (i > 0) k[i] = k[i - 1];
      for (int sweep = 0; sweep < (table->A[i][i] != 0.0 ? 60 : 1); ++sweep) {
        for (int c = 0; c < 4; ++c) {
          stage[c] = y[c];
          for (int j = 0; j <= i; ++j)
            if (table->A[i][j] != 0.0) stage[c] += h * Real(table->A[i][j]) * k[j][c];
        }
        orbit(stage.data(), k[i].data());
      }
    }
    for (int c = 0; c < 4; ++c)
      for (int i = 0; i < s; ++i) y[c] += h * Real(weights[i]) * k[i][c];
  }
  return y;
}

double observed_order(const ARKodeButcherTable table, const sunrealtype* weights,
                      const std::vector<Real>& exact, int steps) {
  const auto error = [&](int n) {
    const std::vector<Real> y = integrate(table, weights, n);
    Real sum = 0;
    for (int c = 0; c < 4; ++c) sum += (y[c] - exact[c]) * (y[c] - exact[c]);
    return std::sqrt(sum);
  };
  return static_cast<double>(std::log2(error(steps) / error(2 * steps)));
}

int orbit_rates(sunrealtype, N_Vector y, N_Vector rate, void* calls) {
  const sunrealtype* at = N_VGetArrayPointer(y);
  const Real state[4] = {at[0], at[1], at[2], at[3]};
  Real rates[4];
  orbit(state, rates);
  for (int c = 0; c < 4; ++c) N_VGetArrayPointer(rate)[c] = static_cast<double>(rates[c]);
  ++*static_cast<long*>(calls);
  return 0;
}

/// Error of ERKStep after equal steps over time 2, and its evaluations.
struct Stepped {
  double error;
  long calls;
};
Stepped by_erkstep(ARKodeButcherTable table, int steps, const std::vector<Real>& exact) {
  SUNContext context = nullptr;
  gnomon::sundials::Messages messages;
  REQUIRE(gnomon::sundials::create_context(&context, &messages) == 0);
  N_Vector y = N_VNew_Serial(4, context);
  sunrealtype* at = N_VGetArrayPointer(y);
  at[0] = 1.0, at[1] = at[2] = 0.0, at[3] = std::sqrt(1.3);
  void* memory = ERKStepCreate(orbit_rates, 0.0, y, context);
  Stepped result{0.0, 0};
  gnomon::sundials::arkode_set_user_data(true)(memory, &result.calls);
  REQUIRE(ERKStepSetTable(memory, table) == 0);
#if SUNDIALS_VERSION_MAJOR >= 7
  ARKodeSetFixedStep(memory, 2.0 / steps);
#else
  ERKStepSetFixedStep(memory, 2.0 / steps);
#endif
  gnomon::sundials::arkode_set_stop_time(true)(memory, 2.0);
  sunrealtype t = 0.0;
  REQUIRE(gnomon::sundials::arkode_evolve(true)(memory, 2.0, y, &t, ARK_NORMAL) >= 0);
  for (int c = 0; c < 4; ++c)
    result.error = std::max(result.error, std::abs(static_cast<double>(at[c] - exact[c])));
  gnomon::sundials::arkode_free(true)(&memory);
  N_VDestroy(y);
  SUNContext_Free(&context);
  return result;
}

}  // namespace

TEST_CASE("sundials: ERKStep steps at the orders of its tables", "[sundials]") {
  const Declared eighth = tables()[2];
  const Table reference = load(eighth);
  const std::vector<Real> exact = integrate(reference.get(), reference->b, 1600);
  struct Case {
    ARKODE_ERKTableID id;
    int order, stages;  ///< evaluations a step
  };
  const auto observed = [&](ARKodeButcherTable table, int steps) {
    return std::log2(by_erkstep(table, steps, exact).error / by_erkstep(table, 2 * steps, exact).error);
  };
  for (const Case& each : {Case{ARKODE_ZONNEVELD_5_3_4, 4, 5}, Case{ARKODE_DORMAND_PRINCE_7_4_5, 5, 6},
                           Case{ARKODE_FEHLBERG_13_7_8, 8, 13}}) {
    const Table table = gnomon::sundials::explicit_table(each.id);
    REQUIRE(table);
    INFO(each.order);
    const int steps = each.order == 8 ? 16 : 100;
    CHECK(std::abs(observed(table.get(), steps) - each.order) <= 0.35);
    const long calls = by_erkstep(table.get(), steps, exact).calls;
    CHECK(std::abs(calls - static_cast<long>(each.stages) * steps) <= 8);
  }
#if SUNDIALS_VERSION_MAJOR == 6 && SUNDIALS_VERSION_MINOR < 7
  // Given the table as it is, it leaves an evaluation out, and an order.
  CHECK(observed(reference.get(), 16) <= 7.5);
  CHECK(by_erkstep(reference.get(), 16, exact).calls <= 12 * 16 + 8);
#endif
}

TEST_CASE("sundials: the Butcher tables fulfil their order conditions", "[sundials]") {
  for (const Declared& named : tables()) {
    const Table table = load(named);
    const int s = table->stages;
    INFO(named.table);
    CHECK(table->q == named.order);
    CHECK(table->p < table->q);
    // SUNDIALS checks the conditions up to order 6.
    int q = 0, p = 0;
    ARKodeButcherTable_CheckOrder(table.get(), &q, &p, nullptr);
    CHECK(q == std::min(named.order, 6));
    // Row sums, quadrature, and the tall tree b A^(k-2) c = 1/k!, up to the order and not beyond.
    for (int i = 0; i < s; ++i) {
      Real sum = 0;
      for (int j = 0; j < s; ++j) sum += table->A[i][j];
      CHECK(std::abs(static_cast<double>(sum - table->c[i])) <= 1e-14);
      for (int j = i + (named.implicit ? 1 : 0); j < s; ++j) CHECK(table->A[i][j] == 0.0);
    }
    double quadrature = 0.0, tall = 0.0;
    std::vector<Real> vector(s, 1), product(s);
    Real factorial = 1;
    for (int k = 1; k <= named.order + 1; ++k) {
      Real sum = 0, chain = 0;
      factorial *= k;
      for (int i = 0; i < s; ++i) {
        sum += Real(table->b[i]) * std::pow(Real(table->c[i]), k - 1);
        chain += Real(table->b[i]) * vector[i];
        product[i] = 0;
        for (int j = 0; j < s; ++j) product[i] += Real(table->A[i][j]) * vector[j];
      }
      vector = product;
      quadrature = static_cast<double>(std::abs(sum - Real(1) / k));
      tall = static_cast<double>(std::abs(chain - 1 / factorial));
      if (k > named.order) break;
      CHECK(quadrature <= 1e-13);
      CHECK(tall <= 1e-13);
    }
    CHECK(std::max(quadrature, tall) >= 1e-7);
  }
}

TEST_CASE("sundials: the Butcher tables converge at their orders", "[sundials]") {
  const Declared eighth = tables()[2];
  REQUIRE(eighth.order == 8);
  const Table exact_table = load(eighth);
  const std::vector<Real> exact = integrate(exact_table.get(), exact_table->b, 1600);
  for (const Declared& named : tables()) {
    const Table table = load(named);
    INFO(named.table);
    const int steps = named.order == 8 ? 24 : 100;
    CHECK(std::abs(observed_order(table.get(), table->b, exact, steps) - named.order) <= 0.25);
    // The embedded solution that the step control compares with is of its own, lower order.
    REQUIRE(table->d);
    CHECK(std::abs(observed_order(table.get(), table->d, exact, steps) - table->p) <= 0.25);
    // A coefficient that is wrong in its sixth digit shows.
    table->b[0] += 1e-6;
    CHECK(observed_order(table.get(), table->b, exact, 4 * steps) <= named.order - 1.0);
  }
}
