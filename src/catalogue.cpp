#include "src/catalogue.hpp"

#include <algorithm>

namespace gnomon {

int Catalogue::variants(std::string_view model) const {
  return static_cast<int>(std::count_if(model_types.begin(), model_types.end(),
                                        [&](const auto& entry) { return entry.first == model; }));
}

const SchemeInfo* Catalogue::scheme(std::string_view name) const {
  for (const SchemeInfo& info : schemes)
    if (info.name == name) return &info;
  return nullptr;
}

namespace {

const Pair* of_types(const Catalogue& catalogue, std::string_view scheme, const AnyModel& model) {
  for (const Pair& candidate : catalogue.pairs)
    if (candidate.scheme == scheme && candidate.model_type == model.type()) return &candidate;
  return nullptr;
}

}  // namespace

const Pair* Catalogue::pair(std::string_view scheme_name, const AnyModel& model) const {
  const Pair* found = of_types(*this, scheme_name, model);
  return found && found->refusal(model.get()).empty() ? found : nullptr;
}

std::string_view Catalogue::refusal(std::string_view scheme_name, const AnyModel& model) const {
  const Pair* found = of_types(*this, scheme_name, model);
  return found ? found->refusal(model.get()) : std::string_view{};
}

std::vector<const SchemeInfo*> Catalogue::schemes_for(const AnyModel& model) const {
  std::vector<const SchemeInfo*> valid;
  for (const SchemeInfo& info : schemes)
    if (!info.control && pair(info.name, model)) valid.push_back(&info);
  return valid;
}

}  // namespace gnomon
