#include <fmt/format.h>
#include "integrators/catalogue.hpp"
#include "models/catalogue.hpp"
#include "src/reference.hpp"
using namespace gnomon;
int main(int argc, char** argv) {
  Catalogue c; add_models(c); add_integrators(c);
  ReferenceStore store("/tmp/refs");
  for (auto& s : shipped_scenes(c)) {
    if (argc > 1 && s.name != argv[1]) continue;
    Scene scene = load_scene(c, s.name);
    for (auto&w: scene.warnings) fmt::print("{}\n", w);
    double b = wall_seconds();
    const auto& r = store.get(scene, {scene.t_end});
    fmt::print("{} {} bound {} {} ({:.2f} s) {}\n", s.name, r.kind, r.bounds.empty()?-1:r.bounds[0][0], r.bounds.empty()?-1:r.bounds[0][1], wall_seconds()-b, r.message);
    for (const auto* info : c.schemes_for(*scene.model)) {
      const Pair* p = c.pair(info->name, *scene.model);
      for (double x : {1.0, 0.25}) {
      RunSpec spec; spec.t_end = scene.t_end;
      if (info->stepping == Stepping::fixed) spec.step = scene.model->time_scale()*0.1*x; else if (info->stepping==Stepping::adaptive) spec.tol = x==1?1e-6:1e-11;
      spec.record=false;
      auto q = p->run(scene.model->get(), spec);
      if (q.status==Status::ok) q = p->run(scene.model->get(), spec);
      std::vector<double> e{-1,-1};
      if (!r.states.empty()) e = scene.model->distance(q.state, r.states[0]);
      fmt::print("  {:24} {:8} err {:.3e} {:.3e} steps {} rhs {} cpu {:.1f} us {:.1f} ns/step {}\n", info->name, to_string(q.status), e[0], e[1], q.cost.steps, q.cost.rhs, q.cpu_seconds*1e6, q.cpu_seconds*1e9/double(std::max(1L,q.cost.steps)), q.message);
      }
    }
  }
}
