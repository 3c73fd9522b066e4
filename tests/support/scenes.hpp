#pragma once
// The catalogue, the shipped scenes and their models by type, for tests.

#include <stdexcept>
#include <string>
#include <vector>

#include "integrators/catalogue.hpp"
#include "models/catalogue.hpp"
#include "src/run.hpp"
#include "src/scene.hpp"

namespace gnomon::test {

using rigid_body::AttitudePotential;
using rigid_body::BodyMoment;
using rigid_body::Free;
using rigid_body::Gravity;
using rigid_body::RigidBody;
using rigid_body::SpaceMoment;
using BodyState = rigid_body::State;

/// Everything that the program ships.
inline Catalogue full_catalogue() {
  Catalogue catalogue;
  add_models(catalogue);
  add_integrators(catalogue);
  return catalogue;
}

/// The schemes of one kind of stepping, negative controls left out.
inline std::vector<SchemeInfo> schemes(const Catalogue& catalogue, Stepping stepping) {
  std::vector<SchemeInfo> chosen;
  for (const SchemeInfo& info : catalogue.schemes)
    if (info.stepping == stepping && !info.control) chosen.push_back(info);
  return chosen;
}

/// Those of them that run on a model.
inline std::vector<SchemeInfo> schemes(const Catalogue& catalogue, Stepping stepping, const AnyModel& model) {
  std::vector<SchemeInfo> chosen;
  for (const SchemeInfo* info : catalogue.schemes_for(model))
    if (info->stepping == stepping) chosen.push_back(*info);
  return chosen;
}

/// CVODE, ARKODE and IDA as far as they run on a model.
inline std::vector<SchemeInfo> solvers(const Catalogue& catalogue, const AnyModel& model) {
  std::vector<SchemeInfo> chosen = schemes(catalogue, Stepping::adaptive, model);
  std::erase_if(chosen, [](const SchemeInfo& info) { return info.family != "sundials"; });
  return chosen;
}

/// The model of a scene as the type it has.
template <class M>
const M& typed(const Scene& scene) {
  if (scene.model->type() != typeid(M)) throw std::logic_error(scene.name + " has another model type");
  return *static_cast<const M*>(scene.model->get());
}

/// Calls `body(model)` with the rigid body of a scene as the type it has.
template <class Body>
auto with_rigid_body(const Scene& scene, Body&& body) {
  const auto is = [&](const std::type_info& type) { return scene.model->type() == type; };
  if (is(typeid(RigidBody<Free>))) return body(typed<RigidBody<Free>>(scene));
  if (is(typeid(RigidBody<Gravity>))) return body(typed<RigidBody<Gravity>>(scene));
  if (is(typeid(RigidBody<SpaceMoment>))) return body(typed<RigidBody<SpaceMoment>>(scene));
  if (is(typeid(RigidBody<AttitudePotential>))) return body(typed<RigidBody<AttitudePotential>>(scene));
  return body(typed<RigidBody<BodyMoment>>(scene));
}

/// Runs a scheme of the catalogue on a model. Throws where they do not go together.
inline RunResult run_scheme(const Catalogue& catalogue, std::string_view scheme, const AnyModel& model,
                            const RunSpec& spec) {
  const Pair* pair = catalogue.pair(scheme, model);
  if (!pair) throw std::logic_error(std::string(scheme) + " does not run on this model");
  return pair->run(model.get(), spec);
}

}  // namespace gnomon::test
