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
