#include "src/reference.hpp"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "src/reference_file.hpp"
#include "tests/catch.hpp"
#include "tests/output/temporary_folder.hpp"
#include "tests/support/scenes.hpp"

using namespace gnomon;
using namespace gnomon::test;
namespace fs = std::filesystem;

namespace {

using FreeBody = RigidBody<Free>;

bool same_bits(const std::vector<std::vector<double>>& a, const std::vector<std::vector<double>>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t k = 0; k < a.size(); ++k)
    if (a[k].size() != b[k].size() ||
        std::memcmp(a[k].data(), b[k].data(), sizeof(double) * a[k].size()) != 0)
      return false;
  return true;
}

bool same(const ReferenceStates& a, const ReferenceStates& b) {
  return a.kind == b.kind && a.methods == b.methods && a.times == b.times && a.message == b.message &&
         same_bits(a.states, b.states) && same_bits(a.bounds, b.bounds);
}

// The only file of a folder.
fs::path only_file(const TemporaryFolder& folder) {
  REQUIRE(folder.entries() == 1);
  return fs::directory_iterator(folder.path())->path();
}

std::string content(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << text;
}

}  // namespace

TEST_CASE("reference: certified solutions agree with the closed form", "[reference]") {
  const Catalogue catalogue = full_catalogue();
  for (const char* name :
       {"asymmetric-free-top", "symmetric-free-top", "dzhanibekov", "free-123", "needle", "plate"}) {
    const Scene scene = load_scene(catalogue, name);
    const auto& body = typed<FreeBody>(scene);
    std::vector<double> times;
    for (int k = 1; k <= 5; ++k) times.push_back(scene.t_end * k / 5);
    const ReferenceStates closed = reference_states(body, times);
    const ReferenceStates certified =
        detail::certified_states<FreeBody, long double>(body, times, 50'000'000);
    REQUIRE(closed.kind == "analytic");
    REQUIRE(certified.kind == "certified");
    CHECK(certified.methods.size() == 4);
    CHECK(certified.message.empty());
    for (std::size_t k = 0; k < times.size(); ++k) {
      const auto apart = scene.model->distance(certified.states[k], closed.states[k]);
      for (std::size_t m = 0; m < apart.size(); ++m) {
        INFO(name << " at " << times[k] << ", metric " << m << ": " << apart[m] << " apart, bounds "
                  << certified.bounds[k][m] << " and " << closed.bounds[k][m]);
        CHECK(apart[m] <= certified.bounds[k][m] + closed.bounds[k][m]);
        // The bounds are those of rounded states, not larger ones that would hide an error.
        CHECK(certified.bounds[k][m] >= 1e-16);
        CHECK(certified.bounds[k][m] <= 1e-14);
        CHECK(closed.bounds[k][m] <= 1e-14);
      }
    }
    // Another body is another motion, by far more than the bounds.
    const FreeBody other(body.inertia() + Eigen::Vector3d(1e-9, 0, 0), body.initial(), {}, scene.t_end);
    const ReferenceStates changed = detail::certified_states<FreeBody, long double>(other, times, 50'000'000);
    CHECK(scene.model->distance(changed.states.back(), closed.states.back())[0] >= 1e-11);
  }
}

TEST_CASE("reference: double precision has bounds of its own", "[reference]") {
  const Catalogue catalogue = full_catalogue();
  const Scene scene = load_scene(catalogue, "asymmetric-free-top");
  const auto& body = typed<FreeBody>(scene);
  const ReferenceStates plain = detail::certified_states<FreeBody, double>(body, {10.0}, 50'000'000);
  const ReferenceStates closed = reference_states(body, {10.0});
  REQUIRE(plain.kind == "certified");
  const auto apart = scene.model->distance(plain.states[0], closed.states[0]);
  for (std::size_t m = 0; m < apart.size(); ++m) {
    CHECK(apart[m] <= plain.bounds[0][m] + closed.bounds[0][m]);
    CHECK(plain.bounds[0][m] <= 1e-12);
  }
}

TEST_CASE("reference: what cannot be certified has no states", "[reference]") {
  const Catalogue catalogue = full_catalogue();
  const Scene scene = load_scene(catalogue, "asymmetric-heavy-top");
  const ReferenceStates none =
      reference_states(typed<RigidBody<Gravity>>(scene), {10.0}, 500);  // too few evaluations
  CHECK(none.kind.empty());
  CHECK(none.states.empty());
  CHECK(none.bounds.empty());
  CHECK(!none.message.empty());
}

TEST_CASE("reference: the time zero is the start", "[reference]") {
  const Catalogue catalogue = full_catalogue();
  for (const char* name : {"asymmetric-free-top", "asymmetric-heavy-top", "rest-then-pushed"}) {
    const Scene scene = load_scene(catalogue, name);
    const ReferenceStates reference = scene.model->reference({0.0, 1.0});
    REQUIRE(reference.states.size() == 2);
    with_rigid_body(scene, [&](const auto& model) {
      CHECK(scene.model->distance(reference.states[0], model.flatten(model.initial()))[0] <= 1e-15);
    });
  }
}

TEST_CASE("reference: a certified solution is kept and read again", "[reference]") {
  const Catalogue catalogue = full_catalogue();
  const Scene scene = load_scene(catalogue, "asymmetric-heavy-top");
  const std::vector<double> times{2.5, 10.0};
  const TemporaryFolder folder;
  const ReferenceStates direct = scene.model->reference(times);
  const ReferenceStates first = ReferenceStore(folder.path().string()).get(scene, times);
  CHECK(same(first, direct));
  const fs::path file = only_file(folder);
  const std::string text = content(file);
  const auto json = nlohmann::json::parse(text);
  CHECK(json.at("kind") == "certified");
  CHECK(json.at("scene").at("name") == "asymmetric-heavy-top");

  // A second store reads the file: what stands in it is what comes out, bit for bit.
  CHECK(same(ReferenceStore(folder.path().string()).get(scene, times), direct));
  CHECK(content(file) == text);
  auto marked = json;
  marked["methods"].push_back("read from the file");
  write(file, marked.dump());
  const ReferenceStates read = ReferenceStore(folder.path().string()).get(scene, times);
  REQUIRE(read.methods.size() == direct.methods.size() + 1);
  CHECK(read.methods.back() == "read from the file");
  CHECK(same_bits(read.states, direct.states));
  CHECK(same_bits(read.bounds, direct.bounds));

  // One store computes once, whatever becomes of the file.
  ReferenceStore store(folder.path().string());
  const ReferenceStates& one = store.get(scene, times);
  fs::remove(file);
  CHECK(&store.get(scene, times) == &one);
  CHECK(folder.entries() == 0);
}

TEST_CASE("reference: a damaged file is computed anew", "[reference]") {
  const Catalogue catalogue = full_catalogue();
  const Scene scene = load_scene(catalogue, "space-moment");
  const std::vector<double> times{5.0};
  const TemporaryFolder folder;
  const ReferenceStates direct = ReferenceStore(folder.path().string()).get(scene, times);
  const fs::path file = only_file(folder);
  const std::string text = content(file);
  const auto damaged = [&](const auto& change) {
    auto json = nlohmann::json::parse(text);
    change(json);
    return json.dump();
  };
  const std::vector<std::string> contents{
      "",
      "{}",
      "not JSON",
      text.substr(0, text.size() / 2),
      "[1, 2, 3]",
      "null",
      damaged([](auto& json) { json["key"] = "gnomon reference 1 0000000000000000 5"; }),
      damaged([](auto& json) { json.erase("bounds"); }),
      damaged([](auto& json) { json["states"] = nlohmann::json::array(); }),
      damaged([](auto& json) { json["states"] = "none"; }),
      damaged([](auto& json) { json["states"][0][3] = nullptr; })};
  for (const std::string& bad : contents) {
    INFO(bad.substr(0, 60));
    write(file, bad);
    CHECK(same(ReferenceStore(folder.path().string()).get(scene, times), direct));
    CHECK(content(file) == text);  // and written anew
    CHECK(folder.entries() == 1);
  }
}

TEST_CASE("reference: the key is the physics and the times", "[reference]") {
  const Catalogue catalogue = full_catalogue();
  const TemporaryFolder folder;
  ReferenceStore store(folder.path().string());
  const auto files_after = [&](const std::vector<std::string>& set, std::vector<double> times) {
    const Scene scene = load_scene(catalogue, "space-moment", {{}, set});
    store.get(scene, times);
    return folder.entries();
  };
  CHECK(files_after({}, {5.0}) == 1);
  // Not the name and the description ..
  CHECK(files_after({"name=\"another\""}, {5.0}) == 1);
  CHECK(files_after({"description=\"of the same\""}, {5.0}) == 1);
  // .. but everything else.
  CHECK(files_after({"body.inertia=[1.0, 2.0, 3.0000000001]"}, {5.0}) == 2);
  CHECK(files_after({"body.angular_velocity=[0.3, 1.0, 0.30000001]"}, {5.0}) == 3);
  CHECK(files_after({"load.moment=[0.2, 0.1, -0.30000000001]"}, {5.0}) == 4);
  CHECK(files_after({"load.kind=\"body_moment\""}, {5.0}) == 5);
  CHECK(files_after({}, {4.9999999999}) == 6);
  CHECK(files_after({}, {2.5, 5.0}) == 7);
  CHECK(files_after({}, {5.0}) == 7);
  const Scene scene = load_scene(catalogue, "space-moment");
  CHECK(scene.physics_hash() ==
        load_scene(catalogue, "space-moment", {{}, {"name=\"another\""}}).physics_hash());
  CHECK(scene.physics_hash() !=
        load_scene(catalogue, "space-moment", {{}, {"body.inertia=[1.0, 2.0, 3.1]"}}).physics_hash());
}

TEST_CASE("reference: closed forms and stores without a folder keep no files", "[reference]") {
  const Catalogue catalogue = full_catalogue();
  const TemporaryFolder folder;
  ReferenceStore store(folder.path().string());
  CHECK(store.get(load_scene(catalogue, "asymmetric-free-top"), {10.0}).kind == "analytic");
  CHECK(folder.entries() == 0);
  ReferenceStore none("");
  CHECK(none.get(load_scene(catalogue, "space-moment"), {5.0}).kind == "certified");
  // A folder that cannot be written costs time, nothing else.
  ReferenceStore unwritable("/proc/no-such-folder");
  CHECK(unwritable.get(load_scene(catalogue, "space-moment"), {5.0}).kind == "certified");
}

TEST_CASE("reference: beside a scene it is a text that comes back bit for bit, or not at all",
          "[reference]") {
  const Catalogue catalogue = full_catalogue();
  const TemporaryFolder folder;
  const fs::path toml = folder.path() / "mine.toml", file = folder.path() / "mine.reference.txt";
  const std::string body =
      "model = \"rigid_body\"\nt_end = 1.5\n[body]\ninertia = [0.6, 0.8, 1.0]\nangular_momentum = [1.8, 0.4, "
      "-0.9]\n[load]\nkind = \"space_moment\"\nmoment = [0.1, 0.2, ";
  write(toml, "name = \"mine\"\n" + body + "0.3]\n");
  const Scene scene = load_scene(catalogue, toml.string());
  REQUIRE(reference_file(scene, {1.5}) == file.string());
  const ReferenceStates made = ReferenceStore("").get(scene, {1.5});
  REQUIRE(made.kind == "certified");
  const std::string text = reference_text(scene, made);
  CHECK(text.find("\nmethod " + made.methods[0] + "\n") != std::string::npos);
  CHECK(text.find("\nhash " + scene.physics_hash() + "\n") != std::string::npos);
  const auto read = read_reference_text(text, scene);
  REQUIRE(read);
  CHECK(same(*read, made));

  // It is used where it fits, and only by those who look beside scenes.
  auto marked = made;
  marked.methods.push_back("read from beside the scene");
  write(file, reference_text(scene, marked));
  CHECK(same(ReferenceStore("", true).get(scene, {1.5}), marked));
  CHECK(same(ReferenceStore("").get(scene, {1.5}), made));
  // Not for another end, another moment, or a scene that the command line changes.
  CHECK(reference_file(scene, {1.0}).empty());
  CHECK(reference_file(scene, {0.75, 1.5}).empty());
  for (const SceneChanges& changes :
       {SceneChanges{1.25, {}}, SceneChanges{{}, {"load.moment=[0.1, 0.2, 0.4]"}},
        SceneChanges{{}, {}, "load.moment=[0.1, 0.2, 0.4]"}})
    CHECK(reference_file(load_scene(catalogue, toml.string(), changes), {1.25}).empty());
  CHECK(reference_file(load_scene(catalogue, toml.string(), {1.5, {}}), {1.5}) == file.string());
  write(toml, "name = \"mine\"\n" + body + "0.30000000001]\n");
  const Scene other = load_scene(catalogue, toml.string());
  CHECK_FALSE(ReferenceStore("", true).beside(other, {1.5}));
  CHECK(ReferenceStore("", true).get(other, {1.5}).methods == made.methods);
  // A name says nothing of the motion.
  write(toml, "name = \"yours\"\n" + body + "0.3]\n");
  CHECK(ReferenceStore("", true).beside(load_scene(catalogue, toml.string()), {1.5}));
  // A closed form needs none.
  CHECK(reference_file(load_scene(catalogue, "asymmetric-free-top"), {10.0}).empty());

  // Any damage is seen.
  CHECK_FALSE(read_reference_text("", scene));
  for (std::size_t k = 0; k < text.size(); ++k) {
    std::string damaged = text;
    damaged[k] = damaged[k] == '7' ? '8' : '7';
    if (read_reference_text(damaged, scene)) FAIL_CHECK("a changed character " << k << " is not seen");
    if (read_reference_text(text.substr(0, k), scene)) FAIL_CHECK("a cut at " << k << " is not seen");
  }
}

TEST_CASE("reference: what stands beside the shipped scenes belongs to them", "[reference]") {
  const Catalogue catalogue = full_catalogue();
  int kept = 0;
  for (const ShippedScene& shipped : shipped_scenes(catalogue)) {
    const Scene scene = load_scene(catalogue, shipped.name);
    const std::string file = reference_file(scene, {scene.t_end});
    if (file.empty() || !fs::exists(file)) continue;
    INFO(file << ": made for another scene or by another version; ./gnomon reference " << shipped.name);
    const auto reference = ReferenceStore("", true).beside(scene, {scene.t_end});
    CHECK(reference);
    ++kept;
  }
  CHECK(kept >= 10);
}
