#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "src/cli/command.hpp"
#include "src/study/run_store.hpp"

namespace gnomon::cli {

/// What a store says of a call of `bench`: with what program, where and what it measured.
struct Session {
  std::string code;     ///< hash of the program
  std::string machine;  ///< its processor
  bool quick = false, timed = true;
  std::string study;  ///< a file of the user's; empty: the published study
  /// What stood in that file.
  std::string study_text;
  nlohmann::ordered_json environment;
};

Session session_here(const Context& context);
/// The last one of a store. Throws UsageError if there is none that can be read.
Session session_of(const RunStore& store);
/// Puts measurements of another program aside, or all of them if `fresh`, and notes the session.
void begin_session(RunStore& store, const Session& session, bool fresh);
/// What was found damaged, on standard error.
void tell_notes(const RunStore& store);

}  // namespace gnomon::cli
