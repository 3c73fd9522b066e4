#include "src/study/study_check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "src/error.hpp"
#include "src/nearest.hpp"
#include "src/study/static_refine.hpp"
#include "src/study/study.hpp"

namespace gnomon {
namespace {

void check_once(const Section& section, std::string_view key, const std::vector<std::string>& names) {
  for (std::size_t k = 0; k < names.size(); ++k)
    if (std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(k), names[k]) !=
        names.begin() + static_cast<std::ptrdiff_t>(k))
      section.refuse(key, fmt::format("found '{}' twice, expected every name once", names[k]), k);
}

/// The key of a study's file that says what the command line says by an option.
struct Spelling {
  std::string_view option, key;
};
constexpr Spelling spellings[] = {{"--set ", "set"}, {"--vary ", "values"}, {"--t-end: ", "t_end"}};

}  // namespace

Scene StudyCheck::load(const Section& section, std::string_view key, const std::string& name,
                       const SceneChanges& changes, std::optional<std::size_t> entry) const {
  try {
    return load_scene(*catalogue_, name, changes);
  } catch (const UsageError& error) {
    const std::string_view why = error.what();
    for (const auto& [option, own_key] : spellings)
      if (why.starts_with(option) && section.has(own_key)) section.refuse(own_key, why.substr(option.size()));
    section.refuse(key, why, entry);
  }
}

void StudyCheck::integrators(const Section& section, const std::vector<std::string>& names,
                             const Scene& scene) const {
  check_once(section, "integrators", names);
  for (std::size_t k = 0; k < names.size(); ++k)
    if (const std::string why = misfit(*catalogue_, scene, names[k]); !why.empty())
      section.refuse("integrators", why, k);
}

void StudyCheck::scenes(const Section& root, std::string_view key, const std::vector<std::string>& names) {
  if (!catalogue_) return;
  check_once(root, key, names);
  for (std::size_t k = 0; k < names.size(); ++k) listed_.push_back(load(root, key, names[k], {}, k));
}

void StudyCheck::shared_integrators(const Section& root, const std::vector<std::string>& names) const {
  if (!catalogue_ || names.empty()) return;
  check_once(root, "integrators", names);
  std::vector<std::string> all;
  for (const SchemeInfo& each : catalogue_->schemes) all.emplace_back(each.name);
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (catalogue_->scheme(names[k])) continue;
    const std::string near = nearest(names[k], all);
    root.refuse("integrators",
                fmt::format("found the unknown name '{}', expected {}", names[k],
                            near.empty() ? choices_text(all) : near),
                k);
  }
  for (const Scene& scene : listed_) {
    const auto runs = [&](const std::string& name) {
      return catalogue_->pair(name, *scene.model) != nullptr;
    };
    if (std::ranges::any_of(names, runs)) continue;
    std::vector<std::string> valid;
    for (const SchemeInfo* each : catalogue_->schemes_for(*scene.model)) valid.emplace_back(each->name);
    root.refuse("integrators",
                fmt::format("found none that runs on scene '{}' (model {}, load {}), expected "
                            "at least one of {}",
                            scene.name, scene.model_name, scene.model->load_class(), fmt::join(valid, ", ")));
  }
}

void StudyCheck::drift(const Section& section, const DriftPlan& plan) const {
  if (!catalogue_) return;
  SceneChanges changes;
  changes.t_end = plan.t_end;
  integrators(section, plan.integrators, load(section, "scene", plan.scene, changes));
}

void StudyCheck::work(const Section& section, const WorkPlan& plan) const {
  if (catalogue_) integrators(section, plan.integrators, load(section, "scene", plan.scene));
}

void StudyCheck::speed(const Section& section, const SpeedPlan& plan) const {
  if (!catalogue_) return;
  SceneChanges changes;
  changes.set = plan.set;
  integrators(section, plan.integrators, load(section, "scene", plan.scene, changes));
  if (plan.instructions_key.empty()) return;
  for (const std::string& name : plan.instructions()) {
    const std::string chosen = fmt::format("{}=\"{}\"", plan.instructions_key, name);
    try {
      load_scene(*catalogue_, plan.scene, {{}, {chosen}});
    } catch (const UsageError& error) {
      std::string_view why = error.what();
      if (const std::string_view option = "--set "; why.starts_with(option)) why.remove_prefix(option.size());
      section.refuse("instructions_key", why);
    }
  }
}

void StudyCheck::survey(const Section& section, const SurveyPlan& plan) const {
  if (!catalogue_) return;
  SceneChanges changes;
  changes.t_end = plan.t_end;
  load(section, "scene", plan.scene, changes);
  if (!plan.closed_form_scene.empty()) load(section, "closed_form_scene", plan.closed_form_scene, changes);
}

void StudyCheck::peers(const Section& section, const PeerPlan& plan) const {
  if (catalogue_) integrators(section, plan.integrators, load(section, "scene", plan.scene));
}

void StudyCheck::vary(const Section& section, const VaryPlan& plan) const {
  if (!catalogue_) return;
  SceneChanges changes;
  changes.t_end = plan.t_end;
  changes.set = plan.set;
  for (std::size_t k = 0; k < plan.variation.values.size(); ++k) {
    changes.vary = plan.variation.assignment(k);
    integrators(section, plan.integrators, load(section, "scene", plan.scene, changes));
  }
  if (!plan.stability) return;
  for (std::size_t k = 0; k < plan.integrators.size(); ++k) {
    const SchemeInfo& scheme = *catalogue_->scheme(plan.integrators[k]);
    if (scheme.stepping != Stepping::fixed)
      section.refuse("integrators",
                     fmt::format("found '{}' ({}), expected schemes that take equal steps, as what = "
                                 "\"stability\"",
                                 scheme.name, to_string(scheme.stepping)),
                     k);
  }
}

void StudyCheck::refine(const Section& section, const StaticRefinePlan& plan) const {
  if (!catalogue_) return;
  const auto check = [&](std::string_view key, auto&& make) {
    try {
      return make();
    } catch (const UsageError& error) {
      std::string_view why = error.what();
      if (const std::string_view option = "--set "; why.starts_with(option)) why.remove_prefix(option.size());
      section.refuse(key, why);
    }
  };
  check("scene", [&] { return load_scene(*catalogue_, plan.scene); });
  for (std::size_t column = 0; column < plan.columns.values.size(); ++column) {
    for (std::size_t row = 0; row < plan.rows.values.size(); ++row) {
      const Scene scene = check("values", [&] { return static_variant(*catalogue_, plan, row, column); });
      if (const std::string why = static_misfit(plan, scene); !why.empty())
        section.refuse(why.starts_with("found '") ? "components" : "scene", why);
    }
    for (const bool coarser : {false, true})
      check(coarser ? "coarser" : "reference",
            [&] { return static_reference(*catalogue_, plan, column, coarser); });
  }
}

}  // namespace gnomon
