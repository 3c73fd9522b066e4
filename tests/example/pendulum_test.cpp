#include <cmath>
#include <fstream>
#include <sstream>

#include "integrators/sundials/schemes.hpp"
#include "src/measure/order.hpp"
#include "src/reference_states.hpp"
#include "tests/catch.hpp"
#include "tests/example/pendulum.hpp"

using namespace gnomon;
using example::Pendulum;
using example::Verlet;

namespace {

std::string read(const std::string& path) {
  std::ifstream in(path);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

double period(double g, double amplitude) {
  // 2 pi / (agm(1, cos(amplitude / 2)) sqrt(g)), C.F. Gauss
  double a = 1.0, b = std::cos(0.5 * amplitude);
  for (int k = 0; k < 8; ++k) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  return 2.0 * std::acos(-1.0) / (a * std::sqrt(g));
}

}  // namespace

TEST_CASE("example: the README shows the example that is compiled here", "[example]") {
  const std::string readme = read(GNOMON_SOURCE_DIR "/README.md");
  const std::string code = read(GNOMON_SOURCE_DIR "/tests/example/pendulum.hpp");
  REQUIRE(code.size() > 1000);
  CHECK(readme.find(code) != std::string::npos);
}

TEST_CASE("example: a model of one's own gets schemes, solvers and a reference", "[example]") {
  const Pendulum model(9.81);
  CHECK(example::catalogue().pairs.size() == 1);
  const double t_end = period(9.81, 1.0);

  const ReferenceStates reference = reference_states(model, {t_end});
  REQUIRE(reference.kind == "certified");
  CHECK(std::abs(reference.states[0][0] - 1.0) <= reference.bounds[0][0]);

  std::vector<OrderPoint> points;
  for (int n = 64; n <= 4096; n *= 2) {
    RunSpec spec;
    spec.t_end = t_end;
    spec.step = t_end / n;
    const RunResult result = run<Pendulum, Verlet>(model, spec);
    REQUIRE(result.status == Status::ok);
    points.push_back(
        {t_end / n, model.distance(model.restore(result.state), model.restore(reference.states[0]))[1]});
  }
  const ObservedOrder order = observe_order(points, {});
  REQUIRE(order.observed);
  CHECK(std::abs(*order.observed - 2.0) < 0.1);

  RunSpec spec;
  spec.t_end = t_end;
  spec.tol = 1e-9;
  const RunResult result = run<Pendulum, sundials::ArkodeErk5>(model, spec);
  CHECK(result.status == Status::ok);
  CHECK(std::abs(result.state[0] - 1.0) < 1e-6);
}
