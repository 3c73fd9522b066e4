#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <sstream>

#include "src/cli/command.hpp"
#include "src/cli/files.hpp"
#include "src/cli/session.hpp"
#include "src/cli/study_folder.hpp"
#include "src/cli/study_parts.hpp"
#include "src/environment.hpp"
#include "src/error.hpp"
#include "src/measure/core.hpp"
#include "src/output/files.hpp"
#include "src/study/keeper.hpp"
#include "src/study/published.hpp"

namespace gnomon::cli {
namespace {

namespace fs = std::filesystem;

/// Every core the program may use.
int bench_jobs() { return std::max(1, static_cast<int>(allowed_cores().size())); }

/// A study and what files of its parts are called by.
struct NamedPlan {
  std::string name;
  StudyPlan plan;
};

/// That of the session's file, as it was when the session began and called `file` in messages, or those that
/// are published. Throws UsageError if one cannot be made.
std::vector<NamedPlan> read_plans(const Context& context, const Session& session, const std::string& file) {
  std::vector<NamedPlan> plans;
  if (!file.empty()) {
    plans.push_back(
        {fs::path(file).stem().string(), read_study_text(session.study_text, file, &context.catalogue)});
    return plans;
  }
  for (const std::string& each : context.catalogue.study_files)
    plans.push_back({fs::path(each).parent_path().filename().string(), read_study(each, &context.catalogue)});
  return plans;
}

/// All parts of the published study, from what its store holds and, for `bench`, what is measured anew.
class Study {
 public:
  Study(Context& context, RunStore& store, Session session, const std::vector<NamedPlan>& plans,
        std::string folder, bool measure)
      : context_(context),
        request_(context.request),
        store_(store),
        session_(std::move(session)),
        references_(reference_folder(), true),
        runner_(context.catalogue, references_, context.stop),
        keeper_(store, {session_.code,
                        session_.machine,
                        measure,
                        {0.0, default_memory_limit(), &context.stop},
                        measure ? jobs_of(context.request, bench_jobs()) : 1}),
        files_(request_, session_, std::move(folder)),
        maker_(context, runner_, session_, files_) {
    runner_.keep_in(&keeper_);
    for (const auto& [name, plan] : plans) maker_.plan(plan, name, parts_);
    // What one looks at first. Its runs serve the other parts, too.
    std::stable_partition(parts_.begin(), parts_.end(),
                          [](const Part& part) { return part.name.ends_with("-scorecard"); });
  }

  /// False if it was interrupted.
  bool make() {
    std::size_t runs = 0;
    for (const Part& part : parts_) runs += part.runs;
    const std::optional<std::size_t> to_make = count_to_make();
    output::Progress progress(runs, output::progress_mode(request_.quiet || !keeper_.measures()), std::cerr);
    if (to_make) progress.expect(*to_make);
    keeper_.report_to(&progress);
    std::vector<Part> made;
    for (const Part& part : parts_) {
      const std::size_t known = keeper_.known(), missing = keeper_.missing();
      if (context_.stop.load() || !part.make(progress)) {
        keeper_.report_to(nullptr);
        return false;
      }
      if (keeper_.missing() == missing) {
        made.push_back(part);
      } else {
        const bool none = keeper_.known() == known;
        std::cerr << fmt::format("gnomon: {}: {} measurements are not in the store{}\n", part.name,
                                 none ? "its" : fmt::format("{} of its", keeper_.missing() - missing),
                                 none ? "" : "; what is there is shown");
        if (!none) made.push_back(part);
      }
    }
    progress.finish();
    keeper_.report_to(nullptr);
    parts_ = std::move(made);
    std::vector<StudyFolder::Entry> entries;
    for (const Part& part : parts_) entries.push_back({part.name, part.heading});
    files_.write_index(entries);
    files_.write_page();
    return true;
  }
  const Keeper& keeper() const { return keeper_; }

  void update_readme() const {
    const std::string path = std::string(GNOMON_SOURCE_DIR) + "/README.md";
    std::string text = output::read_file(path);
    for (const Part& part : parts_) {
      const std::string content = files_.text(part.name);
      std::string shown = content.substr(0, content.find("**Runs**"));
      if (const std::size_t table = shown.find("**"); table != std::string::npos) shown = shown.substr(table);
      // Of these the first table is enough.
      if (part.name.ends_with("-survey") || part.name.starts_with("steps-"))
        shown = shown.substr(0, shown.find("\n**", 2) + 1);
      text = replace_section(text, part.name, shown);
    }
    output::write_file_atomically(path, text);
  }

 private:
  /// How many runs of a study that goes on are not in its store, for the time left: by going through it
  /// without measuring.
  std::optional<std::size_t> count_to_make() {
    // A session alone is a study that begins.
    if (request_.quiet || !keeper_.measures() || store_.size() < 2) return std::nullopt;
    std::ostringstream nowhere;
    output::Progress counter(0, output::ProgressMode::silent, nowhere);
    Keeper reader(store_, {session_.code, session_.machine, false, {}});
    reader.report_to(&counter);
    runner_.keep_in(&reader);
    files_.counting = true;
    for (const Part& part : parts_) part.make(counter);
    files_.counting = false;
    runner_.keep_in(&keeper_);
    files_.clear();
    return counter.made_so_far();
  }

  Context& context_;
  const Request& request_;
  RunStore& store_;
  Session session_;
  ReferenceStore references_;
  Runner runner_;
  Keeper keeper_;
  StudyFolder files_;
  PartMaker maker_;
  std::vector<Part> parts_;
};

std::string results_folder() { return std::string(GNOMON_SOURCE_DIR) + "/results"; }

/// The tables in README.md are those of the published study with times.
void keep_readme(const Study& study, const std::string& folder, bool published) {
  if (published && fs::weakly_canonical(folder) == fs::weakly_canonical(results_folder()))
    study.update_readme();
}

}  // namespace

int bench(Context& context) {
  const Request& request = context.request;
  const std::string results = results_folder();
  // The published tables have times.
  const bool own = !request.study.empty() || (request.no_timing && !request.quick);
  const std::string usual = own ? "gnomon-out" : request.quick ? results + "/quick" : results;
  const std::string folder = request.out.empty() ? usual : request.out;
  // What cannot be made is refused before anything is written.
  const Session session = session_here(context);
  const std::vector<NamedPlan> plans = read_plans(context, session, request.study);
  jobs_of(request);
  RunStore store(folder, RunStore::Access::append);
  tell_notes(store);
  begin_session(store, session, request.fresh);
  Study study(context, store, session, plans, folder, true);
  if (!study.make()) {
    std::cerr << fmt::format(
        "gnomon: interrupted; what was measured is kept in {}, the next call goes on from there\n",
        store.path());
    return interrupted;
  }
  keep_readme(study, folder, !own && !request.no_timing);
  return done;
}

int report(Context& context) {
  const std::vector<std::string>& folders = context.request.what;
  if (folders.size() != 1)
    throw UsageError(fmt::format("report: found {} folders, expected one that `gnomon bench` has written",
                                 folders.size()));
  context.request.out = folders.front();
  check_outputs(context.request);
  RunStore store(folders.front(), RunStore::Access::read);
  tell_notes(store);
  const Session session = session_of(store);
  Study study(context, store, session, read_plans(context, session, session.study), folders.front(), false);
  try {
    if (!study.make()) return interrupted;
    keep_readme(study, folders.front(), session.study.empty() && session.timed && !session.quick);
    return done;
  } catch (const nlohmann::json::exception& error) {
    throw UsageError(
        fmt::format("{}: found measurements of another version of gnomon ({}), expected those of this one",
                    store.path(), error.what()));
  }
}

}  // namespace gnomon::cli
