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

const Pair* Catalogue::pair(std::string_view scheme_name, const AnyModel& model) const {
  for (const Pair& candidate : pairs)
    if (candidate.scheme == scheme_name && candidate.model_type == model.type()) return &candidate;
  return nullptr;
}

std::vector<const SchemeInfo*> Catalogue::schemes_for(const AnyModel& model) const {
  std::vector<const SchemeInfo*> valid;
  for (const SchemeInfo& info : schemes)
    if (!info.control && pair(info.name, model)) valid.push_back(&info);
  return valid;
}

}  // namespace gnomon
