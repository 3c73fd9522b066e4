// The beam scenes that ship.
#include <algorithm>
#include <cmath>

#include "tests/planar_beam/beams.hpp"

using namespace gnomon;
using namespace gnomon::test;

TEST_CASE("planar beam: every shipped scene runs with both midpoint schemes", "[planar_beam]") {
  const Catalogue catalogue = full_catalogue();
  std::vector<std::string> names;
  for (const ShippedScene& shipped : shipped_scenes(catalogue)) {
    const Scene scene = load_scene(catalogue, shipped.name);
    if (scene.model_name != "planar_beam") continue;
    CHECK(scene.name == shipped.name);
    names.push_back(scene.name);
    for (const char* scheme : {"beam-midpoint", "beam-energy-momentum"}) {
      RunSpec spec;
      spec.t_end = scene.t_end / 1000.0;
      spec.step = spec.t_end / 10.0;
      const RunResult result = run_scheme(catalogue, scheme, *scene.model, spec);
      INFO(scene.name << " / " << scheme << ": " << result.message);
      CHECK(result.status == Status::ok);
    }
  }
  for (const char* name : {"flying-beam",
                           "flying-spaghetti",
                           "free-flight",
                           "spaghetti-free-flight",
                           "cantilever-two-big-steps",
                           "robot-arm",
                           "slender-pendulum",
                           "curved-cantilever",
                           "curved-free",
                           "axial-wave",
                           "spinning-rod",
                           "soft-beam",
                           "spin-up",
                           "spin-up-short",
                           "stiff-cantilever",
                           "released-cantilever",
                           "elastica",
                           "roll-up",
                           "shallow-arch",
                           "lee-frame",
                           "double-pendulum",
                           "four-bar-mechanism"})
    CHECK(std::count(names.begin(), names.end(), name) == 1);
}

TEST_CASE("planar beam: free flights begin where the flying beams are at 2.5 s", "[planar_beam]") {
  const Catalogue catalogue = full_catalogue();
  for (const auto& [pushed, then] :
       {std::pair{"flying-beam", "free-flight"}, std::pair{"flying-spaghetti", "spaghetti-free-flight"}}) {
    const Scene flying = load_scene(catalogue, pushed), free = load_scene(catalogue, then);
    const auto& model = typed<PlanarBeam<1>>(free);
    RunSpec spec;
    spec.t_end = 2.5;
    spec.tol = 1e-10;
    const RunResult result = run_scheme(catalogue, "arkode-erk8", *flying.model, spec);
    REQUIRE(result.status == Status::ok);
    for (double error : model.distance(model.restore(result.state), model.initial())) CHECK(error <= 1e-7);
    CHECK(free.model->invariant_info().size() == 3);
    CHECK(free.model->breaks().empty());
  }
}
