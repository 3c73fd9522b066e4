#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <typeindex>
#include <vector>

#include "src/model.hpp"
#include "src/reference_states.hpp"
#include "src/statics.hpp"

namespace gnomon {

/// A model whose type is forgotten: what studies and output need of it. States are flattened.
class AnyModel {
 public:
  virtual ~AnyModel() = default;
  virtual std::type_index type() const = 0;
  virtual const void* get() const = 0;
  virtual std::vector<MetricInfo> metrics() const = 0;
  virtual std::vector<InvariantInfo> invariant_info() const = 0;
  virtual std::vector<double> breaks() const = 0;
  virtual std::string_view load_class() const = 0;
  virtual double time_scale() const = 0;
  virtual std::vector<Named> observe(const std::vector<double>& state) const = 0;
  /// Empty where the model has none.
  virtual std::vector<Probe> probes(const std::vector<double>& state) const = 0;
  /// Values of all invariants one after the other.
  virtual std::vector<double> invariants(double t, const std::vector<double>& state) const = 0;
  virtual std::vector<double> distance(const std::vector<double>& state,
                                       const std::vector<double>& reference) const = 0;
  /// Closed form, else two independent methods in extended precision; kind is empty where neither is to be
  /// had.
  virtual ReferenceStates reference(const std::vector<double>& times) const = 0;
  /// Equilibrium under the model's loads; none where it has no statics. Refers to the model.
  virtual std::unique_ptr<StaticSystem> statics() const = 0;
  virtual bool has_exact() const = 0;
  /// For models with a mesh (see HasField); empty for others.
  virtual bool has_field() const = 0;
  virtual std::vector<double> field(const std::vector<double>& state,
                                    const std::vector<double>& places) const = 0;
  virtual std::vector<double> field_distance(const std::vector<double>& field,
                                             const std::vector<double>& reference) const = 0;
};

template <Model M>
class ModelBox final : public AnyModel {
 public:
  explicit ModelBox(M model) : model_(std::move(model)) {}
  std::type_index type() const override { return typeid(M); }
  const void* get() const override { return &model_; }
  std::vector<MetricInfo> metrics() const override { return {M::metrics.begin(), M::metrics.end()}; }
  std::vector<InvariantInfo> invariant_info() const override { return model_.invariant_info(); }
  std::vector<double> breaks() const override { return model_.breaks(); }
  std::string_view load_class() const override { return model_.load_class(); }
  double time_scale() const override { return model_.time_scale(); }
  std::vector<Named> observe(const std::vector<double>& state) const override {
    return model_.observe(model_.restore(state));
  }
  std::vector<Probe> probes(const std::vector<double>& state) const override {
    if constexpr (HasProbes<M>)
      return model_.probes(model_.restore(state));
    else
      return {};
  }
  std::vector<double> invariants(double t, const std::vector<double>& state) const override {
    std::size_t count = 0;
    for (const InvariantInfo& info : model_.invariant_info()) count += static_cast<std::size_t>(info.size);
    std::vector<double> values(count);
    model_.invariants(t, model_.restore(state), values.data());
    return values;
  }
  std::vector<double> distance(const std::vector<double>& state,
                               const std::vector<double>& reference) const override {
    const auto d = model_.distance(model_.restore(state), model_.restore(reference));
    return {d.begin(), d.end()};
  }
  ReferenceStates reference(const std::vector<double>& times) const override {
    return reference_states(model_, times);
  }
  std::unique_ptr<StaticSystem> statics() const override {
    if constexpr (requires { model_.statics(); }) return model_.statics();
    return nullptr;
  }
  bool has_exact() const override { return HasExact<M>; }
  bool has_field() const override { return HasField<M>; }
  std::vector<double> field(const std::vector<double>& state,
                            const std::vector<double>& places) const override {
    if constexpr (HasField<M>) return model_.field(model_.restore(state), places);
    return {};
  }
  std::vector<double> field_distance(const std::vector<double>& field,
                                     const std::vector<double>& reference) const override {
    if constexpr (HasField<M>) {
      const auto d = M::field_distance(field, reference);
      return {d.begin(), d.end()};
    }
    return {};
  }

 private:
  M model_;
};

template <Model M>
std::shared_ptr<const AnyModel> box(M model) {
  return std::make_shared<ModelBox<M>>(std::move(model));
}

}  // namespace gnomon
