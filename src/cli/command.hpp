#pragma once
#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "src/catalogue.hpp"
#include "src/output/table.hpp"
#include "src/study/json.hpp"
#include "src/study/study.hpp"
#include "src/study/vary.hpp"

namespace gnomon::cli {

/// Exit codes, a contract.
inline constexpr int done = 0;         ///< all that was asked for was done
inline constexpr int run_failed = 1;   ///< a run that was asked for by name failed
inline constexpr int bad_usage = 2;    ///< bad usage or scene; nothing was written
inline constexpr int interrupted = 3;  ///< what was finished is kept

/// What the command line says, as text; `study_options` and the readers below turn it into numbers with clear
/// errors.
struct Request {
  std::vector<std::string> scenes;
  std::vector<std::string> what;  ///< of `list`, `survey` and `report`
  std::string integrators, step, steps, tol, tols, t_end, samples, max_steps, time_limit, newton_tol,
      spectral_radius, linear_solver;
  std::vector<std::string> set;
  std::string refine;      ///< of `converge`
  std::string vary;        ///< of `stability`, `compare` and `drift`
  std::string max_drift;   ///< of `stability`
  std::string error_at;    ///< of `drift`
  std::string load_steps;  ///< of `static`
  std::string study;       ///< of `bench`
  std::string jobs;        ///< runs at a time
  std::string json, csv, latex, out;
  bool modified_newton = false, arc_length = false;
  bool no_reference = false, no_timing = false, quick = false, quiet = false, fresh = false;
};

/// Everything a command works with.
struct Context {
  const Catalogue& catalogue;
  const std::atomic<bool>& stop;
  Request request;
};

StudyOptions study_options(const Request& request);
SceneChanges scene_changes(const Request& request);
/// All scenes of the request, with --vary all variants of each one after the other. Throws UsageError when
/// there is none.
std::vector<Scene> load_scenes(const Context& context);
/// What --vary says, if it is given.
std::optional<Variation> variation(const Request& request);
/// Their warnings, on standard error; for when all that can be refused has been checked.
void warn(const std::vector<Scene>& scenes);
/// A positive number from the command line, in the unit that `expected` names.
double positive_number(const std::string& option, const std::string& text, const std::string& expected);

/// A whole number from 1 to `most`.
long whole_number(const std::string& option, const std::string& text, long most);

/// The parts of a list with commas; an empty text has none.
std::vector<std::string> split(const std::string& text);

/// What --jobs says, else `otherwise`.
int jobs_of(const Request& request, int otherwise = 1);

/// Refuses output files that could not be written, before anything runs.
void check_outputs(const Request& request);
/// Prints a table unless standard output is taken by a file.
void show(const Request& request, const output::Table& table);
void say(const Request& request, const std::string& line);
/// Writes --json, --csv and --latex where asked for; the further tables are for LaTeX alone.
void write_outputs(const Request& request, const Document& document, const std::vector<output::Table>& tables,
                   const std::vector<output::Table>& further = {});

/// Write --json and --csv of commands that make no study.
void write_json(const Request& request, const nlohmann::ordered_json& json);
void write_csv(const Request& request, const std::vector<output::Table>& tables);
/// Where certified references are kept: beside the build.
std::string reference_folder();
/// Prints why the runs of a study failed, and gives the exit code: failures count where integrators were
/// named.
int verdict(const Context& context, const std::vector<const SceneStudy*>& studies);

/// Refuses --spectral-radius where no chosen integrator takes it or where one cannot take that value, and
/// --newton-tol, --modified-newton and --linear-solver where none does on any of the scenes.
void check_scheme_options(const Context& context, const std::vector<Scene>& scenes,
                          const StudyOptions& options);
/// Refuses --steps or --tols that no chosen integrator could use.
void check_ladders(const Context& context, const std::vector<Scene>& scenes, const StudyOptions& options);

int list(Context& context);
int run(Context& context);
int converge(Context& context);
/// `converge` with --refine.
int refine(Context& context);
int compare(Context& context);
int drift(Context& context);
/// The command `static`.
int statics(Context& context);
int stability(Context& context);
int scorecard(Context& context);
int reference(Context& context);
int survey(Context& context);
int bench(Context& context);
int report(Context& context);
int doctor(Context& context);

}  // namespace gnomon::cli
