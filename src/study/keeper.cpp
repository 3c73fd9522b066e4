#include "src/study/keeper.hpp"

#include <fmt/format.h>

#include "src/scene.hpp"

namespace gnomon {

std::string Keeper::key(std::string_view kind, const Json& identity, bool timed) const {
  const std::string text = Json{kind, plan_.code, timed ? plan_.machine : "", identity}.dump();
  // Two hashes of 64 bits of different texts, so that no two measurements ever meet.
  return hash_text(text) + hash_text("gnomon " + text);
}

Keeper::Kept Keeper::get(std::string_view kind, const Json& identity, bool timed,
                         const std::function<Json(Pulse&)>& work, bool keep_failures) {
  Kept kept;
  const std::string name = key(kind, identity, timed);
  if (const auto record = store_.find(name)) {
    ++known_;
    if (progress_) progress_->known();
    kept.status = status_named(record->value("status", "ok"));
    kept.message = record->value("message", "");
    kept.task = record->value("task", -1);
    if (record->contains("result")) kept.result = record->at("result");
    return kept;
  }
  if (!plan_.measure) {
    ++missing_;
    kept.status = Status::interrupted;
    kept.message = "not in the store";
    return kept;
  }
  const ChildResult result = in_child(
      [&](Pulse& pulse) {
        store_.abandon();
        return work(pulse).dump(-1, ' ', false, Json::error_handler_t::replace);
      },
      plan_.limits);
  switch (result.end) {
    case ChildEnd::done:
      kept.result = Json::parse(result.text);
      break;
    case ChildEnd::crashed:
      kept.status = Status::crashed;
      break;
    case ChildEnd::time_limit:
      kept.status = Status::time_limit;
      break;
    case ChildEnd::interrupted:
      kept.status = Status::interrupted;
      break;
  }
  if (kept.status != Status::ok) {
    kept.message = result.text;
    kept.task = result.task;
  }
  ++made_;
  if (kept.status == Status::interrupted || (kept.status != Status::ok && !keep_failures)) return kept;
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
  return kept;
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
