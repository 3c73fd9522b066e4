#include "src/study/keeper.hpp"

#include <fmt/format.h>

#include "src/scene.hpp"

namespace gnomon {

std::string Keeper::key(std::string_view kind, const Json& identity, bool timed) const {
  const std::string text = Json{kind, plan_.code, timed ? plan_.machine : "", identity}.dump();
  // Two hashes of 64 bits of different texts, so that no two measurements ever meet.
  return hash_text(text) + hash_text("gnomon " + text);
}

std::optional<Keeper::Kept> Keeper::stored(const std::string& name) const {
  const auto record = store_.find(name);
  if (!record) return std::nullopt;
  Kept kept{status_named(record->value("status", "ok")),
            record->value("message", ""),
            {},
            record->value("task", -1)};
  if (record->contains("result")) kept.result = record->at("result");
  return kept;
}

void Keeper::store(const std::string& name, std::string_view kind, const Json& identity, const Kept& kept) {
  ++made_;
  Json record{{"key", name}, {"kind", kind}};
  if (kept.status == Status::ok) {
    record["result"] = kept.result;
  } else {
    record["status"] = to_string(kept.status);
    record["message"] = kept.message;
    record["task"] = kept.task;
    record["of"] = identity;
  }
  store_.append(record);
}

void Keeper::get_all(std::string_view kind, const std::vector<Json>& identities, bool timed,
                     const std::function<Json(std::size_t, Pulse&)>& work,
                     const std::function<void(std::size_t)>& begin,
                     const std::function<bool(std::size_t, const Kept&)>& take) {
  std::vector<std::string> names;
  for (const Json& identity : identities) names.push_back(key(kind, identity, timed));
  std::size_t k = 0;
  while (k < names.size()) {
    begin(k);
    if (const auto kept = stored(names[k])) {
      ++known_;
      if (progress_) progress_->known();
      if (!take(k++, *kept)) return;
      continue;
    }
    if (!plan_.measure) {
      ++missing_;
      if (!take(k++, {Status::interrupted, "not in the store", {}, -1})) return;
      continue;
    }
    std::size_t end = k + 1;
    while (end < names.size() && !store_.holds(names[end])) ++end;
    bool more = true;
    const std::size_t first = k;
    const ChildResult result = in_child(
        [&](Pulse& pulse, const Say& say) {
          store_.abandon();
          for (std::size_t j = first; j < end; ++j) {
            pulse.beat(0);
            const Kept kept{Status::ok, "", work(j, pulse), -1};
            say(kept.result.dump(-1, ' ', false, Json::error_handler_t::replace));
            if (!take(j, kept)) return;
          }
        },
        plan_.limits,
        [&](const std::string& line) {
          const Kept kept{Status::ok, "", Json::parse(line), -1};
          store(names[k], kind, identities[k], kept);
          more = take(k++, kept);
          if (more && k < end) begin(k);
        });
    if (!more) return;
    if (result.end == ChildEnd::done) continue;
    // It was number k that ended the child.
    Kept kept{Status::crashed, result.text, {}, result.task};
    if (result.end == ChildEnd::time_limit) kept.status = Status::time_limit;
    if (result.end == ChildEnd::interrupted) kept.status = Status::interrupted;
    if (kept.status != Status::interrupted) store(names.at(k), kind, identities.at(k), kept);
    if (!take(k++, kept) || kept.status == Status::interrupted) return;
  }
}

Keeper::Kept Keeper::get(std::string_view kind, const Json& identity, bool timed,
                         const std::function<Json(Pulse&)>& work) {
  Kept only;
  get_all(
      kind, {identity}, timed, [&](std::size_t, Pulse& pulse) { return work(pulse); }, [](std::size_t) {},
      [&](std::size_t, const Kept& kept) {
        only = kept;
        return true;
      });
  return only;
}

Keeper::Json Keeper::recall(std::string_view kind, const Json& identity) const {
  const auto record = store_.find(key(kind, identity, false));
  return record && record->contains("result") ? record->at("result") : Json();
}

void Keeper::remember(std::string_view kind, const Json& identity, const Json& what) {
  const std::string name = key(kind, identity, false);
  if (!store_.find(name)) store_.append({{"key", name}, {"kind", kind}, {"result", what}});
}

}  // namespace gnomon
