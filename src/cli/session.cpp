#include "src/cli/session.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <iostream>

#include "src/environment.hpp"
#include "src/error.hpp"
#include "src/output/files.hpp"
#include "src/study/study_file.hpp"

namespace gnomon::cli {

Session session_here(const Context& context) {
  const Request& request = context.request;
  Session session;
  session.environment = environment(context.catalogue);
  session.code = hash_text(output::read_file("/proc/self/exe"));
  session.machine = session.environment.at("cpu");
  session.quick = request.quick;
  session.timed = !request.no_timing;
  if (request.study.empty()) return session;
  session.study = std::filesystem::absolute(request.study).string();
  session.study_text = gnomon::study_text(request.study);
  return session;
}

Session session_of(const RunStore& store) {
  const auto record = store.last("session");
  if (!record)
    throw UsageError(fmt::format("{}: found no session of `gnomon bench`, expected one", store.path()));
  try {
    Session session;
    session.environment = record->at("environment");
    session.code = record->at("code");
    session.machine = session.environment.at("cpu");
    session.quick = record->at("quick");
    session.timed = record->value("timed", true);
    session.study = record->at("study");
    session.study_text = record->value("study_text", "");
    return session;
  } catch (const nlohmann::json::exception&) {
    throw UsageError(
        fmt::format("{}: found a session of another version of gnomon, expected one of this", store.path()));
  }
}

void begin_session(RunStore& store, const Session& session, bool fresh) {
  const auto last = store.last("session");
  const bool other = !last || last->value("code", "") != session.code;
  if (store.size() > 0 && (fresh || other)) {
    store.put_aside();
    std::cerr << fmt::format("gnomon: {} are put aside in runs.previous.jsonl\n",
                             fresh ? "earlier measurements" : "the measurements of another build of gnomon");
  }
  const std::string date = session.environment.at("date");
  store.append({{"key", fmt::format("session {} {}", date, ::getpid())},
                {"kind", "session"},
                {"code", session.code},
                {"quick", session.quick},
                {"timed", session.timed},
                {"study", session.study},
                {"study_text", session.study_text},
                {"environment", session.environment}});
}

void tell_notes(const RunStore& store) {
  for (const std::string& note : store.notes()) std::cerr << "gnomon: " << note << '\n';
}

}  // namespace gnomon::cli
