// The model of many bodies: what is drawn, how errors are measured, what scenes may say.

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "src/error.hpp"
#include "tests/catch.hpp"
#include "tests/ensemble/bodies.hpp"
#include "tests/support/scenes.hpp"

using namespace gnomon;
using namespace gnomon::test;

namespace {

// The shipped scene with changes, small.
Scene small_scene(const Catalogue& catalogue, std::vector<std::string> set, double t_end = 10.0) {
  set.insert(set.begin(), "ensemble.bodies=48");
  SceneChanges changes;
  changes.t_end = t_end;
  changes.set = std::move(set);
  return load_scene(catalogue, "ensemble", changes);
}

std::string ensemble_refusal(const Catalogue& catalogue, const std::string& change) {
  try {
    small_scene(catalogue, {change});
  } catch (const UsageError& error) {
    return error.what();
  }
  return "nothing";
}

}  // namespace

TEST_CASE("ensemble: random numbers are those of the published generators", "[ensemble]") {
  // From another implementation of both in Python.
  const auto first = [](std::uint64_t seed, std::uint64_t stream) {
    rigid_body_ensemble::Random random(seed, stream);
    return std::array<std::uint64_t, 3>{random.bits(), random.bits(), random.bits()};
  };
  CHECK(first(1, 0) ==
        std::array<std::uint64_t, 3>{17154914556750032435U, 15481925071032317162U, 3049712571244418729U});
  CHECK(first(1, 1) ==
        std::array<std::uint64_t, 3>{13775863373465642557U, 14946417357426938299U, 4120684976151361363U});
  CHECK(first(42, 7) ==
        std::array<std::uint64_t, 3>{15084523808955195758U, 3751774649734410950U, 6532979611665974307U});
}

TEST_CASE("ensemble: bodies are drawn as the scene says", "[ensemble]") {
  rigid_body_ensemble::Distribution from;
  from.seed = 9;
  from.inertia = {0.2, 2.0};
  from.spin = {0.5, 4.0};
  from.load = {0.1, 0.3};
  const int count = 20'000;
  const std::vector<Body> bodies = draw_bodies(from, static_cast<std::size_t>(count));
  Eigen::Vector3d spin_mean = Eigen::Vector3d::Zero(), load_mean = spin_mean;
  Eigen::Matrix3d attitude_mean = Eigen::Matrix3d::Zero();
  double least = 1e9, most = 0.0, square = 0.0;
  bool real = true, orthonormal = true, sized = true;
  for (const Body& body : bodies) {
    least = std::min(least, body.inertia.minCoeff());
    most = std::max(most, body.inertia.maxCoeff());
    real = real && 2.0 * body.inertia.maxCoeff() <= body.inertia.sum();
    orthonormal =
        orthonormal &&
        (body.attitude.transpose() * body.attitude - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <
            2e-15;
    const Eigen::Vector3d spin = body.angular_momentum.cwiseQuotient(body.inertia);
    sized = sized && spin.norm() >= 0.5 * (1 - 1e-14) && spin.norm() <= 4.0 * (1 + 1e-14) &&
            body.load.norm() >= 0.1 * (1 - 1e-14) && body.load.norm() <= 0.3 * (1 + 1e-14);
    spin_mean += spin.normalized() / count;
    load_mean += body.load.normalized() / count;
    square += std::pow(spin.normalized()[0], 4) / count;
    attitude_mean += body.attitude / count;
  }
  CHECK(real);
  CHECK(orthonormal);
  CHECK(sized);
  CHECK(least >= 0.2);
  CHECK(least < 0.25);
  CHECK(most <= 2.0);
  CHECK(most > 1.99);
  // Means of 20000 numbers of standard deviation 0.577 are within 5 of their own, 0.0041.
  CHECK(spin_mean.cwiseAbs().maxCoeff() < 0.0205);
  CHECK(load_mean.cwiseAbs().maxCoeff() < 0.0205);
  CHECK(attitude_mean.cwiseAbs().maxCoeff() < 0.0205);
  CHECK(std::abs(square - 0.2) < 0.0095);  // of the fourth power of a direction's component
  // A body depends on its number and the seed alone.
  CHECK(rigid_body_ensemble::draw_body(from, 77).inertia == bodies[77].inertia);
  CHECK(bodies[76].inertia != bodies[77].inertia);
  from.seed = 10;
  CHECK(rigid_body_ensemble::draw_body(from, 77).inertia != bodies[77].inertia);
}

TEST_CASE("ensemble: errors are the largest and the root mean square over the bodies", "[ensemble]") {
  const std::vector<Body> bodies = bodies_turning(4, {0.1}, 0.01, 1);
  const Ensemble<rigid_body::Free> model(bodies, {}, 1.0);
  auto turned = model.initial();
  turned.bodies[1].attitude = turned.bodies[1].attitude * Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX());
  turned.bodies[2].attitude = turned.bodies[2].attitude * Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitY());
  turned.bodies[3].angular_momentum *= 0.98;
  const auto error = model.distance(turned, model.initial());
  CHECK(std::abs(error[0] - 0.4) < 1e-14);
  CHECK(std::abs(error[1] - 0.25) < 1e-14);
  CHECK(std::abs(error[2] - 0.02) < 1e-14);
  CHECK(std::abs(error[3] - 0.01) < 1e-14);
  turned.bodies[0].angular_momentum[0] = std::nan("");
  CHECK(!std::isfinite(model.distance(turned, model.initial())[2]));
  CHECK(model.restore(model.flatten(turned)).bodies[2].attitude == turned.bodies[2].attitude);
}

TEST_CASE("ensemble: invariants hold on the motion and show what does not", "[ensemble]") {
  const Catalogue catalogue = full_catalogue();
  struct Case {
    std::vector<std::string> set;
    std::size_t momentum;  // its place among the invariants
  };
  const std::vector<Case> cases{{{}, 3},
                                {{"load.kind=\"space_moment\"", "load.moment_N_m=[0.1, 0.5]"}, 1},
                                {{"load.kind=\"gravity\"", "load.weight_times_arm_N_m=[0.1, 0.5]"}, 3}};
  for (const Case& each : cases) {
    const Scene scene = small_scene(catalogue, each.set, 2.0);
    INFO(scene.model->load_class());
    RunSpec spec;
    spec.t_end = 2.0;
    spec.step = 0.002;
    const RunResult result = run_scheme(catalogue, "rkmk4", *scene.model, spec);
    REQUIRE(result.status == Status::ok);
    std::vector<double> values = scene.model->invariants(2.0, result.state);
    REQUIRE(values.size() > each.momentum);
    for (const double value : values) CHECK(std::abs(value) < 1e-9);
    CHECK(values.back() < (scene.model->load_class() == "gravity" ? 1e-9 : 1e-12));
    // One body of 48 that turns faster, a momentum of 1.01 times its size.
    std::vector<double> wrong = result.state;
    for (std::size_t k = 9; k < 12; ++k) wrong[12 * 5 + k] *= 1.01;
    values = scene.model->invariants(2.0, wrong);
    CHECK(values[each.momentum] > 1e-5);
    if (each.momentum == 3) {
      CHECK(values[1] > 1e-6);
      CHECK(values[2] > 1e-5);
    }
    wrong = result.state;
    wrong[12 * 40] += 1e-6;
    CHECK(scene.model->invariants(2.0, wrong)[0] > 1e-8);
  }
}

TEST_CASE("ensemble: orders against the closed form of every body", "[ensemble]") {
  const Catalogue catalogue = full_catalogue();
  const Scene scene = small_scene(catalogue, {"execution.threads=2"});
  const ReferenceStates reference = scene.model->reference({10.0});
  REQUIRE(reference.kind == "analytic");
  CHECK(reference.bounds[0][0] < 1e-13);
  const auto error = [&](const char* scheme, double step) {
    RunSpec spec;
    spec.t_end = 10.0;
    spec.step = step;
    return scene.model->distance(run_scheme(catalogue, scheme, *scene.model, spec).state,
                                 reference.states[0]);
  };
  const auto munjiza = error("munjiza", 0.02), munjiza_half = error("munjiza", 0.01);
  const auto rkmk4 = error("rkmk4", 0.04), rkmk4_half = error("rkmk4", 0.02);
  for (std::size_t metric = 0; metric < 4; ++metric) {
    INFO("metric " << metric);
    CHECK(std::abs(std::log2(munjiza[metric] / munjiza_half[metric]) - 2.0) < 0.1);
    CHECK(std::abs(std::log2(rkmk4[metric] / rkmk4_half[metric]) - 4.0) < 0.1);
  }
  RunSpec closed;
  closed.t_end = 10.0;
  const RunResult exact = run_scheme(catalogue, "exact-free-top", *scene.model, closed);
  CHECK(scene.model->distance(exact.state, reference.states[0])[0] < 1e-13);
}

TEST_CASE("ensemble: a scene that does not fit is refused", "[ensemble]") {
  const Catalogue catalogue = full_catalogue();
  const auto refusal = [&](const std::string& change) { return ensemble_refusal(catalogue, change); };
  CHECK(refusal("ensemble.seed=3") == "nothing");
  CHECK(refusal("ensemble.bodies=0") ==
        "--set ensemble.bodies=0: ensemble.bodies: found 0, expected a whole number of bodies from 1 to 1e7");
  CHECK(refusal("ensemble.bodies=2.5").find("found 2.5, expected a whole number") != std::string::npos);
  CHECK(refusal("ensemble.spin_rad_s=[2.0, 1.0]").find("found [2.0, 1.0], expected two numbers") !=
        std::string::npos);
  CHECK(refusal("ensemble.inertia_kg_m2=[0.0, 1.0]").find("expected two positive numbers") !=
        std::string::npos);
  CHECK(refusal("ensemble.inertia=[1.0, 1.0]") ==
        "--set ensemble.inertia=[1.0, 1.0]: ensemble.inertia: found an unknown key, expected one of bodies, "
        "seed, inertia_kg_m2, spin_rad_s");
  CHECK(refusal("execution.threads=0").find("a whole number of threads from 1 to 1024") != std::string::npos);
  CHECK(refusal("execution.instructions=\"mmx\"").find("widest") != std::string::npos);
  CHECK(refusal("load.kind=\"body_moment\"").find("gravity") != std::string::npos);
  CHECK(refusal("load.kind=\"gravity\"").find("load.weight_times_arm_N_m: found nothing") !=
        std::string::npos);
}

TEST_CASE("ensemble: loaded bodies are compared with certified solutions of the first ones", "[ensemble]") {
  const Catalogue catalogue = full_catalogue();
  const double t_end = 2.0;
  for (const std::vector<std::string>& load : std::vector<std::vector<std::string>>{
           {"load.kind=\"space_moment\"", "load.moment_N_m=[0.1, 0.5]"},
           {"load.kind=\"gravity\"", "load.weight_times_arm_N_m=[0.1, 0.5]"}}) {
    std::vector<std::string> set = load;
    set.push_back("ensemble.bodies=6");
    const Scene scene = small_scene(catalogue, set, t_end);
    INFO(scene.model->load_class());
    const ReferenceStates reference = scene.model->reference({t_end});
    REQUIRE(reference.kind == "certified");
    REQUIRE(reference.states[0].size() == 6 * 12);
    for (const double bound : reference.bounds[0]) CHECK((bound > 0.0 && bound < 1e-13));
    const auto error = [&](const char* scheme, double step) {
      RunSpec spec;
      spec.t_end = t_end;
      spec.step = step;
      return scene.model->distance(run_scheme(catalogue, scheme, *scene.model, spec).state,
                                   reference.states[0]);
    };
    const double order = *catalogue.scheme("munjiza")->order_for(scene.model->load_class(), "orientation");
    const auto munjiza = error("munjiza", 0.02), munjiza_half = error("munjiza", 0.01);
    const auto rkmk4 = error("rkmk4", 0.04), rkmk4_half = error("rkmk4", 0.02);
    for (const std::size_t metric : {0U, 1U}) {
      CHECK(std::abs(std::log2(munjiza[metric] / munjiza_half[metric]) - order) < 0.1);
      CHECK(std::abs(std::log2(rkmk4[metric] / rkmk4_half[metric]) - 4.0) < 0.15);
    }
    // More bodies than are compared change no error of these.
    std::vector<double> more = reference.states[0];
    more.insert(more.end(), 12, 0.0);
    CHECK(scene.model->distance(more, reference.states[0])[0] == 0.0);
  }
}
