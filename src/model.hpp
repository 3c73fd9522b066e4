#pragma once
#include <array>
#include <concepts>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gnomon {

/// A named list of numbers: one component class of a state.
struct Named {
  std::string name;
  std::vector<double> values;
};

/// A place of a model at which a state is looked at: named components.
struct Probe {
  std::string name;
  std::vector<std::pair<std::string, double>> components;
};

/// A quantity that the exact motion keeps. Its drift is |value - initial value| / scale, a norm for a vector.
struct InvariantInfo {
  std::string name;
  int size = 1;        ///< number of components
  double since = 0.0;  ///< the time from which on it is constant, s
  double scale = 1.0;  ///< what its drift is divided by, in its own unit
};

/// One class of error. Classes are never mixed: an angle is not added to a momentum.
struct MetricInfo {
  std::string_view name;
  std::string_view unit;
  double saturation;  ///< the error of a result that is wrong altogether; no order is fitted near it
};

/// A state of the exact motion and the bound of its error in each metric.
template <class M>
struct Exact {
  typename M::State state;
  std::array<double, M::metrics.size()> bound;
};

/// The one model interface. A model is a plain value; what else it can do it declares by the forms it offers:
/// `ode()` (src/ode.hpp), `dae()`, the inertia and moment of a rotation (integrators/rotation/rotation.hpp),
/// `exact(t)`, `probes(state)`.
template <class M>
concept Model = requires(const M& model, const typename M::State& state, double t, double* out,
                         const std::vector<double>& flat) {
  { M::model_name } -> std::convertible_to<std::string_view>;  // as scenes name it
  { M::variant } -> std::convertible_to<std::string_view>;  // which of the types of that model; may be empty
  { M::metrics[0] } -> std::convertible_to<MetricInfo>;
  { model.initial() } -> std::same_as<typename M::State>;
  {
    model.flatten(state)
    } -> std::same_as<std::vector<double>>;  // for storage; `restore` undoes it bit for bit
  { model.restore(flat) } -> std::same_as<typename M::State>;
  { model.observe(state) } -> std::same_as<std::vector<Named>>;  // what JSON calls "state"
  { model.invariant_info() } -> std::same_as<std::vector<InvariantInfo>>;
  {model.invariants(t, state, out)};  // their values one after the other; allocates nothing
  {
    model.distance(state, state)
    } -> std::same_as<std::array<double, M::metrics.size()>>;       // (state, reference)
  { model.breaks() } -> std::same_as<std::vector<double>>;          // where its data jump, s
  { model.load_class() } -> std::convertible_to<std::string_view>;  // decides which declared order applies
  {
    model.time_scale()
    } -> std::convertible_to<double>;  // s; a step of this size resolves the motion coarsely
};

/// A model on a mesh: what it is at places from 0 to 1 along it, equally spaced and equally weighted, so that
/// different meshes can be compared; `field_distance` is the distance of the model between two such fields.
template <class M>
concept HasField = requires(const M& model, const typename M::State& state, const std::vector<double>& at) {
  { model.field(state, at) } -> std::same_as<std::vector<double>>;
  { M::field_distance(at, at) } -> std::same_as<std::array<double, M::metrics.size()>>;
};

/// A model whose motion is known in closed form.
template <class M>
concept HasExact = requires(const M& model, double t) {
  { model.exact(t) } -> std::same_as<Exact<M>>;
};

/// A model whose motion is known in closed form for some data, for which a value is returned.
template <class M>
concept HasExactForSome = requires(const M& model, double t) {
  { model.exact_if_known(t) } -> std::same_as<std::optional<Exact<M>>>;
};

/// A model with places to look at.
template <class M>
concept HasProbes = requires(const M& model, const typename M::State& state) {
  { model.probes(state) } -> std::same_as<std::vector<Probe>>;
};

}  // namespace gnomon
