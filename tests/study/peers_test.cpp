#include "src/study/peers.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "integrators/rotation/munjiza_kernel.hpp"
#include "src/study/study_file.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

TEST_CASE("peers: a setting counts if the two next tighter ones reach the level, too", "[study][peers]") {
  using gnomon::loosest_that_counts;
  const double nan = std::nan("");
  const std::vector<double> errors{1.0, 1e-9, 1e-2, 1e-4, 1e-4, nan, 1e-5, 1e-6, 1e-6};
  CHECK(loosest_that_counts(errors, 2.0).value() == 0);
  CHECK(loosest_that_counts(errors, 1e-2).value() == 1);
  CHECK(loosest_that_counts(errors, 1e-4).value() == 6);
  CHECK(loosest_that_counts(errors, 1e-5).value() == 6);
  CHECK(!loosest_that_counts(errors, 1e-6));
  CHECK(!loosest_that_counts({1e-9, 1e-9}, 1.0));
}

TEST_CASE("peers: errors and evaluations at the levels", "[study][peers]") {
  using namespace gnomon;
  const Catalogue catalogue = test::full_catalogue();
  ReferenceStore references("");
  const std::atomic<bool> stop{false};
  Runner runner(catalogue, references, stop);
  const PeerPlan plan{
      "heavy-axis-fast", {1e-2, 1e-4}, {0.1667, 0.1667}, {"lanes-extrapolated-strang", "rkmk4"}};
  const PeerStudy study = measure_peers(runner, plan, true);
  REQUIRE(study.rows.size() == 4);
  CHECK(std::count_if(study.rows.begin(), study.rows.end(), [](const PeerRow& row) { return row.peer; }) ==
        2);
  for (const PeerRow& row : study.rows) {
    INFO(row.name);
    REQUIRE(row.levels.size() == 2);
    for (std::size_t k = 0; k < 2; ++k) {
      REQUIRE(row.levels[k]);
      CHECK(row.levels[k]->error <= plan.levels[k]);
      CHECK(row.levels[k]->error > 0.0);
      CHECK(row.levels[k]->evaluations >= 8);
      CHECK(row.levels[k]->run.repetitions >= 3);
      CHECK(row.levels[k]->run.median > 0.0);
    }
    CHECK(row.levels[0]->evaluations <= row.levels[1]->evaluations);
  }
  CHECK(study.best(0, true).value() > 0.0);
  const output::Table table = peers_table(study);
  CHECK(table.rows.size() == 4);
  CHECK(table.columns.size() == 5);
  CHECK(peer_runs_table(study).rows.size() == 8);
  const auto json = peers_json(study);
  CHECK(json["times"].size() == 8);
  CHECK(json["times"][0]["peer"] == true);
  CHECK(json["times"][0]["step"].is_null());
}

TEST_CASE("peers: they solve the same equations", "[study][peers]") {
  using namespace gnomon;
  const Catalogue catalogue = test::full_catalogue();
  for (const char* name : {"free-123", "heavy-axis-fast", "asymmetric-heavy-top"}) {
    const Scene scene = load_scene(catalogue, name);
    const ReferenceStates reference = scene.model->reference({scene.t_end});
    REQUIRE(!reference.states.empty());
    int found = 0;
    for (const Peer& peer : catalogue.peers) {
      if (peer.model_type != scene.model->type()) continue;
      ++found;
      std::vector<double> state;
      long evaluations = 0;
      CHECK(peer.run(scene.model->get(), scene.t_end, 1e-12, state, evaluations) >= 0.0);
      CHECK(evaluations > 100);
      const double error = scene.model->distance(state, reference.states.back())[0];
      INFO(name << ", " << peer.name << ": " << error);
      CHECK(error <= 1e-9);
      CHECK(peer.run(scene.model->get(), scene.t_end * 1.0001, 1e-12, state, evaluations) >= 0.0);
      CHECK(scene.model->distance(state, reference.states.back())[0] >= 1e-6);
    }
    CHECK(found == 2);
  }
}

TEST_CASE("peers: the plans of the study file fit", "[study][peers]") {
  using namespace gnomon;
  const Catalogue catalogue = test::full_catalogue();
  const StudyPlan plan = read_study(GNOMON_SOURCE_DIR "/models/rigid_body/study.toml");
  REQUIRE(plan.peers.size() == 2);
  for (const PeerPlan& peers : plan.peers) {
    const Scene scene = load_scene(catalogue, peers.scene);
    CHECK(std::is_sorted(peers.levels.rbegin(), peers.levels.rend()));
    CHECK(peers.goals.size() == peers.levels.size());
    for (const std::string& name : peers.integrators) {
      INFO(name);
      CHECK(catalogue.pair(name, *scene.model));
    }
  }
}

TEST_CASE("peers: the hand-written kernel makes the steps of munjiza", "[study][peers]") {
  using namespace gnomon;
  const Catalogue catalogue = test::full_catalogue();
  const Yardstick& kernel = rotation::munjiza_kernel_yardstick;
  const Scene scene = load_scene(catalogue, std::string(kernel.scene));
  RunSpec spec;
  spec.t_end = scene.t_end;
  for (double step : {0.01, 0.5, 2.0}) {
    spec.step = step;
    const RunResult run = test::run_scheme(catalogue, kernel.integrator, *scene.model, spec);
    std::vector<double> state;
    long evaluations = 0;
    CHECK(kernel.run(scene.model->get(), scene.t_end, step, state, evaluations) >= 0.0);
    CHECK(evaluations == run.cost.rhs);
    const auto apart = scene.model->distance(state, run.state);
    INFO("step " << step << ": " << apart[0] << ", " << apart[1]);
    CHECK(apart[0] <= 1e-12);
    CHECK(apart[1] <= 1e-12);
  }
}
