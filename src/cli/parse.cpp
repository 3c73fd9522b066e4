#include "src/cli/parse.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>
#include <variant>

#include "src/cli/command.hpp"
#include "src/environment.hpp"
#include "src/error.hpp"
#include "src/nearest.hpp"
#include "src/output/text.hpp"

namespace gnomon::cli {
namespace {

using Text = std::string Request::*;
using Texts = std::vector<std::string> Request::*;
using Switch = bool Request::*;

struct Argument {
  const char* name;
  const char* help;
  Texts target;
};

constexpr Argument scene{"SCENE", "the name of a shipped scene or a .toml file", &Request::scenes};
constexpr Argument some_scenes{"SCENE", "a shipped scene or a .toml file; those of the study without it",
                               &Request::scenes};
constexpr Argument model_name{"MODEL", "a model with a survey; all without it", &Request::what};
constexpr Argument folder{"DIR", "a folder that `gnomon bench` has written", &Request::what};
constexpr Argument what{"WHAT", "scenes, models or integrators; all without it", &Request::what};

struct Option {
  char letter;
  const char* name;
  const char* value;  ///< what stands for its value in the help; empty for a switch
  const char* help;
  std::variant<Text, Texts, Switch> target;
};

constexpr Option every_option[] = {
    {'i', "--integrator", "NAME", "see `gnomon list integrators`", &Request::integrators},
    {'I', "--integrators", "A,B,..", "default: all that run on the scene", &Request::integrators},
    {'H', "--step", "H", "equal steps, s; T/ceil(T/H) is used", &Request::step},
    {'h', "--steps", "H1,H2,..", "equal steps, s", &Request::steps},
    {'T', "--tol", "X", "relative tolerance; the absolute one is X times each component's scale",
     &Request::tol},
    {'t', "--tols", "X1,X2,..", "relative tolerances", &Request::tols},
    {'e', "--t-end", "T", "end of the integration, s", &Request::t_end},
    {'a', "--set", "KEY.PATH=VALUE", "override a key of the scene; may be given several times",
     &Request::set},
    {'r', "--refine", "KEY=V1,V2,..", "error in space: meshes of the scene, e.g. beam.elements=4,8,16,32",
     &Request::refine},
    {'k', "--load-steps", "N", "the loads change by at most a part in N at once (default 10)",
     &Request::load_steps},
    {'K', "--arc-length", "", "follow the path by its length, past limit points", &Request::arc_length},
    {'v', "--vary", "KEY=V1,V2,..",
     "every value makes a variant of the scene, e.g. beam.EA=1e4,1e6; of several keys: "
     "beam.EA,beam.GA=1e4,1e6",
     &Request::vary},
    {'D', "--max-drift", "X", "of an invariant, in its scale, beyond which a run is wrong (default 0.5)",
     &Request::max_drift},
    {'E', "--error-at", "T1,T2,..",
     "times at which errors are looked at, s; where no reference reaches the end (default: the end)",
     &Request::error_at},
    {'x', "--max-steps", "N", "steps after which a run ends", &Request::max_steps},
    {'l', "--time-limit", "SECONDS", "wall-clock time after which a run ends", &Request::time_limit},
    {'J', "--jobs", "N", "runs made at a time, each in a process of its own; what is timed runs alone",
     &Request::jobs},
    {'n', "--newton-tol", "X", "of Newton's method for beams (default 1e-10)", &Request::newton_tol},
    {'S', "--spectral-radius", "X",
     "from 0 to 1, at infinite frequency; of beam-generalized-alpha and beam-hht (default 0.8)",
     &Request::spectral_radius},
    {'m', "--modified-newton", "", "implicit beam schemes keep the tangent while it serves",
     &Request::modified_newton},
    {'Z', "--linear-solver", "NAME",
     "of the midpoint beam schemes: block (default), band, lapack, klu, sparselu", &Request::linear_solver},
    {'s', "--samples", "N", "equally spaced states kept in the output", &Request::samples},
    {'j', "--json", "FILE", "- is standard output", &Request::json},
    {'c', "--csv", "FILE", "- is standard output", &Request::csv},
    {'L', "--latex", "FILE", "tables for LaTeX (booktabs); - is standard output", &Request::latex},
    {'o', "--out", "DIR", "folder for tables and figures", &Request::out},
    {'R', "--no-reference", "", "errors become null", &Request::no_reference},
    {'M', "--no-timing", "", "nothing is timed", &Request::no_timing},
    {'y', "--study", "FILE.toml", "a study of yours, written as models/*/study.toml are", &Request::study},
    {'q', "--quick", "", "shorter ladders", &Request::quick},
    {'F', "--fresh", "", "make all anew; what is there is put aside", &Request::fresh},
    {'Q', "--quiet", "", "no progress on standard error", &Request::quiet},
};

struct Command {
  const char* name;
  const char* usage;
  const char* help;
  const Argument* argument;
  const char* letters;  ///< of its options, in the order of the help
  int (*run)(Context&);
  const char* out = "";  ///< default of --out
};

constexpr Command commands[] = {
    {"list", "[scenes | models | integrators]", "what exists: scenes, models, integrators", &what, "jQ",
     list},
    {"run", "SCENE --integrator NAME (--step H | --tol X)", "one integration of one scene", &scene,
     "iHTeaxlnSmZsjcLoRMQ", run},
    {"converge",
     "SCENE.. [--integrators A,B,..] [--steps H1,H2,..] [--tols X1,X2,..] [--refine KEY=V1,V2,..]",
     "error against step, tolerance or mesh, observed order", &scene, "IhtreaxlJnSmZsjcLoRMqQ", converge},
    {"compare", "SCENE.. [--integrators A,B,..] [--steps H1,H2,..] [--tols X1,X2,..] [--vary KEY=V1,V2,..]",
     "work-precision: error against CPU time and evaluations", &scene, "IhtveaxlJnSmZsjcLoRMqQ", compare,
     "gnomon-out"},
    {"drift",
     "SCENE.. [--integrators A,B,..] [--step H | --steps H1,H2,..] [--tol X | --tols X1,X2,..] [--t-end T]",
     "invariants over a long run", &scene, "IHhTtveEaxlJnSmZsjcLoRMQ", drift},
    {"stability", "SCENE.. [--integrators A,B,..] [--vary KEY=V1,V2,..]",
     "the largest step that each scheme of equal steps survives, and how it fails beyond", &scene,
     "IvDeaxlJnSmZjcLoRQ", stability},
    {"scorecard", "[SCENE..] [--integrators A,B,..]",
     "one line a scheme: order, cost at 3, 6 and 9 digits, energy, largest step, failures", &some_scenes,
     "IeaxlJnjcLoMqQ", scorecard},
    {"static", "SCENE [--load-steps N] [--arc-length]",
     "equilibrium under the loads by Newton's method, from no load on", &scene, "kKaxnjcQ", statics},
    {"survey", "[MODEL..] [--quick]",
     "all schemes of a model: order, cost, invariants, what is too large a step", &model_name, "xlJjcLoRMqQ",
     survey},
    {"reference", "SCENE.. [--t-end T] [--fresh]",
     "the reference solution: kind, methods, bounds of its error, state at the end; a certified one is kept "
     "beside its scene",
     &scene, "eaFjcLQ", reference},
    {"bench", "[--quick] [--out DIR]", "the published study: all tables and figures", nullptr, "oqyMJFQ",
     bench},
    {"report", "DIR", "tables, figures and one HTML page from the measurements of a study; runs nothing",
     &folder, "Q", report},
    {"doctor", "", "versions, build flags, is SUNDIALS optimised, timer noise", nullptr, "jQ", doctor},
};

std::vector<std::string> command_names() {
  std::vector<std::string> names;
  for (const Command& command : commands) names.emplace_back(command.name);
  return names;
}

std::vector<const Option*> options_of(const Command& command) {
  std::vector<const Option*> list;
  for (const char letter : std::string_view(command.letters))
    list.push_back(std::ranges::find(every_option, letter, &Option::letter));
  return list;
}

std::string help_line(std::string_view left, std::string_view right) {
  return fmt::format("  {:<24} {}\n", left, right);
}

std::string general_help() {
  std::string text =
      "gnomon compares integrators for mechanical ODEs and DAEs: accuracy, drift and cost\n"
      "\nUsage: gnomon COMMAND [options]\n\nCommands:\n";
  for (const Command& command : commands) text += help_line(command.name, command.help);
  text += help_line("test", "builds and runs the test suite (only ./gnomon at the top of the repository)");
  text += "\nOptions:\n" + help_line("--help", "this text, or that of a command: gnomon run --help") +
          help_line("--version", "") +
          "\nExit codes: 0 done, 1 a run that was asked for by name failed, 2 bad usage or scene, "
          "3 interrupted.\n";
  return text;
}

std::string command_help(const Command& command) {
  std::string text = fmt::format("{}\n\nUsage: gnomon {} {}{}[options]\n\n", command.help, command.name,
                                 command.usage, *command.usage ? " " : "");
  if (command.argument) text += help_line(command.argument->name, command.argument->help) + "\n";
  text += "Options:\n";
  for (const Option* option : options_of(command))
    text += help_line(fmt::format("{} {}", option->name, option->value), option->help);
  text += help_line("--help", "this text");
  return *command.out ? text + fmt::format("\nWithout --out, {} writes to {}.\n", command.name, command.out)
                      : text;
}

const Command& find_command(const std::string& name) {
  for (const Command& command : commands)
    if (command.name == name) return command;
  const std::vector<std::string> names = command_names();
  if (name.starts_with("-"))
    throw UsageError(fmt::format("found '{}' where the command stands, expected {} (or --help, --version)",
                                 name, choices_text(names)));
  const std::string near = nearest(name, names);
  throw UsageError(fmt::format("found the unknown command '{}', expected {}", name,
                               near.empty() ? choices_text(names) : near));
}

const Option& find_option(const Command& command, const std::string& name) {
  std::vector<std::string> names;
  for (const Option* option : options_of(command)) {
    if (option->name == name) return *option;
    names.emplace_back(option->name);
  }
  names.emplace_back("--help");
  const std::string near = nearest(name, names);
  throw UsageError(fmt::format("{}: found the unknown option '{}', expected {}", command.name, name,
                               near.empty() ? choices_text(names) : near));
}

void take_argument(const Command& command, Request& request, const std::string& text) {
  const Argument* argument = command.argument;
  if (!argument)
    throw UsageError(fmt::format("{}: found '{}', expected no further argument", command.name, text));
  if (text.empty())
    throw UsageError(fmt::format("{}: found '', expected {}", argument->name, argument->help));
  (request.*argument->target).push_back(text);
}

/// A value of an option; once only, unless the option collects them. That of a switch is "true".
void take_value(const Option& option, Request& request, const std::string& value) {
  if (const Switch* flag = std::get_if<Switch>(&option.target)) {
    if (value != "true")
      throw UsageError(fmt::format("{}: found the value '{}', expected none", option.name, value));
    request.** flag = true;
    return;
  }
  // A value may begin with one dash, as negative numbers and "-" do, but not with two.
  if (value.empty() || value.starts_with("--"))
    throw UsageError(fmt::format("{0}: found no value, expected {0} {1}", option.name, option.value));
  if (const Texts* several = std::get_if<Texts>(&option.target)) {
    (request.**several).push_back(value);
    return;
  }
  std::string& target = request.*std::get<Text>(option.target);
  if (!target.empty())
    throw UsageError(
        fmt::format("{}: found twice, as '{}' and '{}', expected once", option.name, target, value));
  target = value;
}

/// Has CLI11 read `words`. It prints nothing: help and what is wrong are told here, the same for all its
/// versions.
void read_words(CLI::App& app, const std::vector<std::string>& words) {
  app.set_help_flag();
  app.add_flag("-h,--help");
  app.parse(std::vector<std::string>(words.rbegin(), words.rend()));  // it wants the last word first
}

/// Reads what follows the command. True if its help was asked for.
bool read_request(const Command& command, const std::vector<std::string>& words, Request& request) {
  const std::vector<const Option*> known = options_of(command);
  CLI::App app;
  app.allow_extras();
  for (const Option* option : known) {
    app.add_option(option->name)->take_all()->expected(*option->value ? 1 : 0);
    // With `--option=` CLI11 would take the next word for the value.
    if (std::ranges::count(words, option->name + std::string("=")) > 0) take_value(*option, request, "");
  }
  try {
    read_words(app, words);
  } catch (const CLI::ArgumentMismatch&) {
    take_value(find_option(command, words.back()), request, "");  // refused: the last value is missing
  }
  if (app.count("--help") > 0) return true;
  bool options_ended = false;
  for (const std::string& word : app.remaining()) {
    if (options_ended || word.size() < 2 || word.front() != '-')
      take_argument(command, request, word);
    else if (word == "--")
      options_ended = true;
    else
      find_option(command, word.substr(0, word.find('=')));  // refused: CLI11 knows all that there are
  }
  for (const Option* option : known)
    for (const std::string& value : app.get_option(option->name)->results())
      take_value(*option, request, value);
  return false;
}

int dispatch(const Catalogue& catalogue, const std::atomic<bool>& stop,
             const std::vector<std::string>& arguments) {
  CLI::App app;
  app.prefix_command();
  app.add_flag("--version");
  read_words(app, arguments);
  std::vector<std::string> words = app.remaining();
  if (app.count("--help") > 0) {
    fmt::print("{}", general_help());
    return done;
  }
  if (app.count("--version") > 0) {
    if (!words.empty())
      throw UsageError(fmt::format("--version: found '{}', expected no further argument", words.front()));
    fmt::print("gnomon {}\n", gnomon_version);
    return done;
  }
  if (words.empty())
    throw UsageError(fmt::format("found no command, expected {} (gnomon --help explains them)",
                                 choices_text(command_names())));
  const Command& command = find_command(words.front());
  words.erase(words.begin());
  Context context{catalogue, stop, {}};
  if (read_request(command, words, context.request)) {
    fmt::print("{}", command_help(command));
    return done;
  }
  if (context.request.out.empty()) context.request.out = command.out;
  check_outputs(context.request);
  return command.run(context);
}

}  // namespace

int parse_and_run(const Catalogue& catalogue, const std::atomic<bool>& stop, int argc,
                  const char* const* argv) {
  try {
    return dispatch(catalogue, stop, std::vector<std::string>(argv + std::min(argc, 1), argv + argc));
  } catch (const UsageError& error) {
    // What the user wrote stands in the message; whatever it was, the message is one line of text.
    throw UsageError(output::plain_text(error.what()));
  }
}

}  // namespace gnomon::cli
