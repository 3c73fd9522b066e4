#include "src/solver_reference.hpp"

#include <string>

#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

using namespace gnomon;
using namespace gnomon::test;

TEST_CASE("reference: implicit solvers bound their own error", "[reference]") {
  const Catalogue catalogue = full_catalogue();
  for (const char* name : {"soft-beam", "asymmetric-heavy-top"}) {
    const Scene scene = load_scene(catalogue, name);
    const ReferenceStates certified = scene.model->reference({scene.t_end});
    const ReferenceStates found = solver_reference(catalogue, scene);
    REQUIRE(found.kind == "certified");
    REQUIRE(found.methods.size() == 2);
    const std::vector<double> error = scene.model->distance(found.states.at(0), certified.states.at(0));
    for (std::size_t k = 0; k < error.size(); ++k) {
      INFO(name << ", metric " << k << ": " << error[k] << " and " << found.bounds.at(0)[k]);
      CHECK(error[k] <= found.bounds[0][k]);
      CHECK(found.bounds[0][k] <= 1e-5);
    }
  }
}

TEST_CASE("reference: a solver that does not come to the end leaves no reference", "[reference]") {
  Catalogue catalogue = full_catalogue();
  const Scene scene = load_scene(catalogue, "soft-beam");
  const auto is_none = [&](const std::string& message) {
    const ReferenceStates found = solver_reference(catalogue, scene, 10.0);
    CHECK(found.kind.empty());
    CHECK(found.states.empty());
    CHECK(found.bounds.empty());
    CHECK(found.message.find(message) != std::string::npos);
  };
  catalogue.reference_solvers = {{"cvode-bdf", 1e-8, 1e-7}, {"munjiza", 1e-8, 1e-7}};
  is_none("munjiza does not run on the model");
  catalogue.reference_solvers = {{"cvode-bdf", 1e-8, 1e-7}, {"arkode-dirk", 1e-30, 1e-7}};
  is_none("arkode-dirk, tolerance 1e-30: ");
  catalogue.reference_solvers.clear();
  is_none("");
}

TEST_CASE("reference: steps are halved where no tolerance is to be had, and breaks are met", "[reference]") {
  Catalogue catalogue = full_catalogue();
  catalogue.reference_solvers = {{"beam-energy-momentum-4", 0.0, 0.0}, {"arkode-dirk", 1e-7, 1e-6}};
  const auto within_bounds = [&](const Scene& scene, double most) {
    const ReferenceStates certified = scene.model->reference({scene.t_end});
    const ReferenceStates found = solver_reference(catalogue, scene);
    REQUIRE(found.kind == "certified");
    REQUIRE(found.methods.size() == 2);
    CHECK(found.methods[0].starts_with("arkode-dirk, tolerances 1e-07 and 1e-06"));
    CHECK(found.methods[1].starts_with("beam-energy-momentum-4, steps "));
    const std::vector<double> error = scene.model->distance(found.states.at(0), certified.states.at(0));
    for (std::size_t k = 0; k < error.size(); ++k) {
      INFO(scene.name << ", metric " << k << ": " << error[k] << " and " << found.bounds.at(0)[k]);
      CHECK(error[k] <= found.bounds[0][k] + certified.bounds.at(0)[k]);
      CHECK(found.bounds[0][k] <= most);
    }
    return found;
  };
  within_bounds(load_scene(catalogue, "soft-beam", {0.5, {}}), 1e-4);
  SceneChanges pushed{
      0.5, {"loads=[{at = \"end\", force = [0.3, 0.8], profile = {kind = \"step\", until = 0.3}}]"}};
  within_bounds(load_scene(catalogue, "soft-beam", pushed), 1e-4);
  catalogue.reference_solvers.erase(catalogue.reference_solvers.begin());  // one alone certifies nothing
  CHECK(solver_reference(catalogue, load_scene(catalogue, "soft-beam")).kind.empty());
}

TEST_CASE("reference: another solver takes the place of one that fails", "[reference]") {
  Catalogue catalogue = full_catalogue();
  const Scene scene = load_scene(catalogue, "soft-beam");
  catalogue.reference_solvers = {{"munjiza", 1e-8, 1e-7},
                                 {"arkode-dirk", 1e-30, 1e-7},
                                 {"cvode-bdf", 1e-9, 1e-8},
                                 {"ida-bdf", 1e-9, 1e-8}};
  const ReferenceStates found = solver_reference(catalogue, scene);
  REQUIRE(found.methods.size() == 2);
  CHECK(found.methods[0].starts_with("cvode-bdf"));
  CHECK(found.methods[1].starts_with("ida-bdf"));
  const std::vector<double> error =
      scene.model->distance(found.states.at(0), scene.model->reference({scene.t_end}).states.at(0));
  for (std::size_t k = 0; k < error.size(); ++k) CHECK(error[k] <= found.bounds.at(0)[k]);
}

TEST_CASE("reference: the stiff cantilever's over eight decades of stiffness", "[reference][long]") {
  const Catalogue catalogue = full_catalogue();
  for (const char* stiffness : {"1e2", "1e6", "1e10"}) {
    SceneChanges changes{0.2, {}};
    changes.vary = std::string("beam.EA,beam.GA=") + stiffness;
    const Scene scene = load_scene(catalogue, "stiff-cantilever", changes);
    const ReferenceStates found = solver_reference(catalogue, scene);
    INFO(stiffness << ": " << found.message);
    REQUIRE(found.kind == "certified");
    CHECK(found.bounds.at(0)[0] <= 1e-6);
    RunSpec spec;
    spec.t_end = scene.t_end;
    spec.step = 2e-4;
    const RunResult run = run_scheme(catalogue, "beam-midpoint", *scene.model, spec);
    REQUIRE(run.status == Status::ok);
    CHECK(scene.model->distance(run.state, found.states.at(0))[0] <= 1e-6);
  }
}
