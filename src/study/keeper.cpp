#include "src/study/keeper.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "src/run.hpp"
#include "src/scene.hpp"

namespace gnomon {

namespace {

Keeper::Kept failure(const ChildResult& result) {
  Keeper::Kept kept{Status::crashed, result.text, {}, result.task};
  if (result.end == ChildEnd::time_limit) kept.status = Status::time_limit;
  if (result.end == ChildEnd::interrupted) kept.status = Status::interrupted;
  return kept;
}

}  // namespace

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
            record->value("task", -1),
            record->value("seconds", std::numeric_limits<double>::quiet_NaN())};
  if (record->contains("result")) kept.result = record->at("result");
  return kept;
}

void Keeper::count_known(const Kept& kept) {
  ++known_;
  if (progress_) progress_->known(kept.seconds);
}

void Keeper::store(const std::string& name, std::string_view kind, const Json& identity, const Kept& kept,
                   double seconds) {
  ++made_;
  Json record{{"key", name}, {"kind", kind}, {"seconds", std::round(1e4 * seconds) / 1e4}};
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
      count_known(*kept);
      if (!take(k++, *kept)) return;
      continue;
    }
    if (!plan_.measure) {
      ++missing_;
      if (!take(k++, {Status::interrupted, "not in the store", {}})) return;
      continue;
    }
    if (progress_) progress_->made();
    std::size_t end = k + 1;
    while (end < names.size() && !store_.holds(names[end])) ++end;
    bool more = true;
    const std::size_t first = k;
    double since = wall_seconds();
    const ChildResult result = in_child(
        [&](Pulse& pulse, const Say& say) {
          store_.abandon();
          for (std::size_t j = first; j < end; ++j) {
            pulse.beat(0);
            const Kept kept{Status::ok, "", work(j, pulse)};
            say(kept.result.dump(-1, ' ', false, Json::error_handler_t::replace));
            if (!take(j, kept)) return;
          }
        },
        plan_.limits,
        [&](const std::string& line) {
          const Kept kept{Status::ok, "", Json::parse(line)};
          store(names[k], kind, identities[k], kept, wall_seconds() - since);
          more = take(k++, kept);
          if (!more || k >= end) return;
          begin(k);
          if (progress_) progress_->made();
          since = wall_seconds();
        });
    if (!more) return;
    if (result.end == ChildEnd::done) continue;
    // It was number k that ended the child.
    const Kept kept = failure(result);
    if (kept.status != Status::interrupted)
      store(names.at(k), kind, identities.at(k), kept, wall_seconds() - since);
    if (!take(k++, kept) || kept.status == Status::interrupted) return;
  }
}

void Keeper::get_each(std::string_view kind, const std::vector<Json>& identities,
                      const std::function<Json(std::size_t, Pulse&)>& work,
                      const std::function<void(std::size_t)>& begin,
                      const std::function<void(std::size_t, const Kept&)>& take) {
  if (plan_.jobs <= 1 || !plan_.measure) {
    get_all(kind, identities, false, work, begin, [&](std::size_t k, const Kept& kept) {
      take(k, kept);
      return true;
    });
    return;
  }
  struct Open {
    std::size_t number;
    std::string name;
    double since = 0.0;
  };
  std::vector<std::optional<Kept>> results(identities.size());
  std::vector<Open> open;
  for (std::size_t k = 0; k < identities.size(); ++k) {
    const std::string name = key(kind, identities[k], false);
    results[k] = stored(name);
    if (!results[k]) {
      open.push_back({k, name});
      continue;
    }
    begin(k);
    count_known(*results[k]);
  }
  std::size_t next = 0;
  const auto hand_over = [&] {
    for (; next < results.size() && results[next]; ++next) take(next, *std::exchange(results[next], Kept{}));
  };
  const auto settle = [&](std::size_t i, const Kept& kept) {
    const Open& it = open[i];
    if (kept.status != Status::interrupted)
      store(it.name, kind, identities[it.number], kept, wall_seconds() - it.since);
    results[it.number] = kept;
    if (kept.status != Status::interrupted) hand_over();
  };
  hand_over();
  ChildLimits limits = plan_.limits;
  limits.bytes /= static_cast<std::uint64_t>(plan_.jobs);
  std::vector<bool> heard(open.size(), false);
  in_children({open.size(),
               [&](std::size_t i, Pulse& pulse, const Say& say) {
                 store_.abandon();
                 pulse.beat(0);
                 say(work(open[i].number, pulse).dump(-1, ' ', false, Json::error_handler_t::replace));
               },
               [&](std::size_t i) {
                 begin(open[i].number);
                 if (progress_) progress_->made();
                 open[i].since = wall_seconds();
               },
               [&](std::size_t i, const std::string& line) {
                 heard[i] = true;
                 settle(i, {Status::ok, "", Json::parse(line)});
               },
               [&](std::size_t i, const ChildResult& end) {
                 if (!heard[i]) settle(i, failure(end));
               }},
              plan_.jobs, limits);
  hand_over();
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
