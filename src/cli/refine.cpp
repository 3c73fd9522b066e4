#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "src/cli/command.hpp"
#include "src/cli/files.hpp"
#include "src/error.hpp"
#include "src/study/refine_output.hpp"

namespace gnomon::cli {
namespace {

RefinePlan read_plan(const Request& request) {
  if (request.scenes.size() != 1)
    throw UsageError(fmt::format("--refine: found {} scenes, expected one", request.scenes.size()));
  RefinePlan plan;
  plan.scene = request.scenes.front();
  plan.changes = scene_changes(request);
  const std::size_t equals = request.refine.find('=');
  plan.key = request.refine.substr(0, equals);
  const std::string expected =
      "KEY=V1,V2,.. with at least two ascending numbers, as in beam.elements=4,8,16,32";
  const auto refuse = [&] {
    throw UsageError(fmt::format("--refine: found '{}', expected {}", request.refine, expected));
  };
  if (equals == std::string::npos || plan.key.empty()) refuse();
  for (const std::string& part : split(request.refine.substr(equals + 1)))
    plan.values.push_back(positive_number("--refine", part, "positive numbers in KEY=V1,V2,.."));
  if (plan.values.size() < 2 || !std::ranges::is_sorted(plan.values, std::less_equal<double>())) refuse();
  return plan;
}

}  // namespace

int refine(Context& context) {
  const Request& request = context.request;
  const RefinePlan plan = read_plan(request);
  const StudyOptions options = study_options(request);
  if (request.modified_newton || !request.newton_tol.empty() || !request.spectral_radius.empty() ||
      !request.linear_solver.empty())
    check_scheme_options(context, {load_scene(context.catalogue, plan.scene, plan.changes)}, options);
  ReferenceStore references(reference_folder(), true);
  Runner runner(context.catalogue, references, context.stop);
  output::Progress progress(refine_runs(plan), output::progress_mode(request.quiet), std::cerr);
  const Refinement study = refine(runner, plan, options, progress);
  progress.finish();
  if (study.meshes.empty()) {
    std::cerr << "gnomon: interrupted before the first mesh was done\n";
    return interrupted;
  }

  Document document(context.catalogue, "converge");
  add_refinement(document, study);
  const output::Table meshes = refinement_table(study), orders = refinement_orders_table(study);
  show(request, meshes);
  show(request, orders);
  if (!request.out.empty())
    for (const std::string& file : write_study(request.out, "refine-" + study.meshes.front().scene.name,
                                               {orders, meshes}, document, refinement_figure(study), ""))
      say(request, "wrote " + file);
  write_outputs(request, document, {meshes}, {orders});
  std::vector<const SceneStudy*> pointers;
  for (const SceneStudy& mesh : study.meshes) pointers.push_back(&mesh);
  return verdict(context, pointers);
}

}  // namespace gnomon::cli
