#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <typeindex>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "src/any_model.hpp"
#include "src/run.hpp"
#include "src/scheme.hpp"

namespace gnomon {

class Section;

/// What a model's reader makes of a scene.
struct ParsedModel {
  std::shared_ptr<const AnyModel> model;
  std::shared_ptr<const nlohmann::ordered_json> resolved;  ///< every key with its value, defaults included
  std::vector<std::string> warnings;
};

/// A model as scenes name it: how its part of a scene file is read.
struct ModelEntry {
  std::string_view name;
  std::string_view summary;
  std::string_view citation;
  ParsedModel (*read)(Section& root, double t_end);
  std::span<const std::string_view>
      loads{};  ///< the kinds of `[load]`, where a scene has one load by its kind
  /// Keys of a scene by which its mesh is made finer, as "beam.elements"; none of a model without a mesh.
  std::span<const std::string_view> mesh{};
};

/// One valid pair of scheme and model type.
struct Pair {
  std::string_view scheme;
  std::string_view model;
  std::string_view variant;
  std::type_index model_type;
  RunResult (*run)(const void* model, const RunSpec& spec);
  /// Why the scheme cannot run a model of that type all the same, decided by its data; empty if it can.
  std::string_view (*refusal)(const void* model);
};

/// A library that integrators are built on, for the record of the environment.
struct Library {
  std::string name;
  std::string version;
  std::optional<bool> optimised;  ///< compiled with optimisation; not known for most
  std::string build;              ///< its build record, may be empty
};

/// An integration written without gnomon that one of its integrators is held against, on the same scene and
/// with the same tolerance or step.
struct Yardstick {
  std::string_view name;
  std::string_view summary;
  std::string_view scene;
  std::string_view integrator;
  double tol;         ///< 0 where it takes equal steps
  double step = 0.0;  ///< s
  /// Integrates the scene's model to t_end by the tolerance or step; returns thread CPU seconds (negative on
  /// failure), flattened final state and number of evaluations.
  double (*run)(const void* model, double t_end, double setting, std::vector<double>& state,
                long& evaluations);
  double setting() const { return tol > 0.0 ? tol : step; }
};

/// An integrator of another library, called as its users would, that ours are timed against on models of one
/// type.
struct Peer {
  std::string_view name;
  std::string_view summary;
  std::type_index model_type;
  /// As in Yardstick.
  double (*run)(const void* model, double t_end, double tol, std::vector<double>& state, long& evaluations);
};

/// A part of a model's steps that is timed by itself, one cell of the table "`what`, by `part`": `variant` of
/// it at a size.
struct PartTask {
  std::string_view model, what, part, variant, size_name;
  int size, index;
  double (*run)(int index, int size);  ///< thread CPU seconds; not finite on failure
  bool full_only = false;              ///< left out of a quick study
};

/// An integrator that references of stiff motions are made with.
struct ReferenceSolver {
  std::string_view integrator;
  double tight, loose;  ///< tolerances; 0 of one that takes equal steps
  double share = 0.25;  ///< of the time for all solvers
};

template <class... T>
struct TypeList {};

namespace detail {
template <class... A, class... B>
TypeList<A..., B...> join(TypeList<A...>, TypeList<B...>);
}  // namespace detail
template <class A, class B>
using Joined = decltype(detail::join(A{}, B{}));

/// Everything that exists: the models, the schemes and which of them go together.
struct Catalogue {
  std::vector<ModelEntry> models;
  std::vector<SchemeInfo> schemes;
  std::vector<std::string> scene_folders;  ///< of the shipped scenes
  std::vector<Pair> pairs;
  std::vector<Library> libraries;
  std::vector<Yardstick> yardsticks;
  std::vector<Peer> peers;
  std::vector<PartTask> parts;
  std::vector<ReferenceSolver> reference_solvers;  ///< independent of one another
  std::vector<std::string> study_files;            ///< what `bench` does with each model
  /// Number of model types of a model, to tell whether a scheme runs all of them.
  int variants(std::string_view model) const;

  const SchemeInfo* scheme(std::string_view name) const;
  /// None where the scheme does not run on the model, by its type or its data.
  const Pair* pair(std::string_view scheme, const AnyModel& model) const;
  /// Why a scheme that runs on models of its type does not run on this one; empty otherwise.
  std::string_view refusal(std::string_view scheme, const AnyModel& model) const;
  /// The schemes that run on a model; negative controls are left out.
  std::vector<const SchemeInfo*> schemes_for(const AnyModel& model) const;

  std::vector<std::pair<std::string_view, std::type_index>> model_types;
};

namespace detail {

template <Model M, class S>
RunResult run_pair(const void* model, const RunSpec& spec) {
  return run<M, S>(*static_cast<const M*>(model), spec);
}

/// A scheme may refuse a model by its data: `refusal(model)` says why not, or is empty.
template <Model M, class S>
std::string_view refusal_of(const void* model) {
  if constexpr (requires(const M& m) { S::refusal(m); })
    return S::refusal(*static_cast<const M*>(model));
  else
    return {};
}

template <class S, class... M>
void add_pairs(Catalogue& catalogue, TypeList<M...>) {
  const auto add_one = [&]<class One>(TypeList<One>) {
    if constexpr (Runs<S, One>)
      catalogue.pairs.push_back(
          {S::info.name, One::model_name, One::variant, typeid(One), run_pair<One, S>, refusal_of<One, S>});
  };
  (add_one(TypeList<M>{}), ...);
}

}  // namespace detail

/// Adds the schemes of a list with every model of another that they run on.
template <class Models, class... S>
void add_schemes(Catalogue& catalogue, TypeList<S...>) {
  (catalogue.schemes.push_back(S::info), ...);
  (detail::add_pairs<S>(catalogue, Models{}), ...);
}

/// The same with schemes that are there already, written anew for other models: each has the SchemeInfo of
/// the one it stands for.
template <class Models, class... S>
void add_implementations(Catalogue& catalogue, TypeList<S...>) {
  (detail::add_pairs<S>(catalogue, Models{}), ...);
}

template <class... M>
void add_model_types(Catalogue& catalogue, TypeList<M...>) {
  (catalogue.model_types.push_back({M::model_name, typeid(M)}), ...);
}

}  // namespace gnomon
