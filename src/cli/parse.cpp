#include "src/cli/parse.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>

#include "src/cli/command.hpp"
#include "src/environment.hpp"
#include "src/error.hpp"
#include "src/scene_reader.hpp"

namespace gnomon::cli {
namespace {

/// A command with the options it knows.
struct Command {
  const char* name;
  const char* help;
  const char* options;  ///< letters, see add_options
  int (*run)(Context&);
};

constexpr Command commands[] = {
    {"list", "what exists: scenes, models, integrators", "wj", list},
    {"run", "one integration of one scene", "SiHTeaxlnsjcRMq", run},
    {"converge", "error against step or tolerance, observed order", "SIhteaxlnjcoRq", converge},
    {"compare", "work-precision: error against CPU time and evaluations", "SIhteaxlnjcoRMq", compare},
    {"drift", "invariants over a long run", "SIHTeaxlnjcoRq", drift},
    {"bench", "the published study: all tables and figures", "oqF", bench},
    {"doctor", "versions, build flags, is SUNDIALS optimised, timer noise", "j", doctor},
};

void add_options(CLI::App& app, Request& r, const std::string& letters) {
  const auto text = [&](const char* name, std::string& value, const char* help) {
    app.add_option(name, value, help)->type_name("");
  };
  for (const char letter : letters) switch (letter) {
      case 'S':
        app.add_option("SCENE", r.scenes, "name of a shipped scene, or a .toml file")->type_name("");
        break;
      case 'w':
        text("WHAT", r.what, "scenes, models or integrators; all without it");
        break;
      case 'i':
        text("--integrator", r.integrators, "NAME");
        break;
      case 'I':
        text("--integrators", r.integrators, "A,B,.. (default: all that run on the scene)");
        break;
      case 'H':
        text("--step", r.step, "H: equal steps, s; T/ceil(T/H) is used");
        break;
      case 'h':
        text("--steps", r.steps, "H1,H2,.. s");
        break;
      case 'T':
        text("--tol", r.tol, "X: relative tolerance; the absolute one is X times each component's scale");
        break;
      case 't':
        text("--tols", r.tols, "X1,X2,..");
        break;
      case 'e':
        text("--t-end", r.t_end, "T: end of the integration, s");
        break;
      case 'a':
        app.add_option("--set", r.set, "KEY.PATH=VALUE: override a key of the scene")
            ->type_name("")
            ->expected(1)
            ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
            ->take_all();
        break;
      case 's':
        text("--samples", r.samples, "N: equally spaced states kept in the output");
        break;
      case 'x':
        text("--max-steps", r.max_steps, "N");
        break;
      case 'l':
        text("--time-limit", r.time_limit, "SECONDS of wall-clock time a run");
        break;
      case 'n':
        text("--newton-tol", r.newton_tol, "X: of implicit fixed-step schemes (default 1e-10)");
        break;
      case 'j':
        text("--json", r.json, "FILE; - is standard output");
        break;
      case 'c':
        text("--csv", r.csv, "FILE; - is standard output");
        break;
      case 'o':
        text("--out", r.out, "DIR for tables and figures");
        break;
      case 'R':
        app.add_flag("--no-reference", r.no_reference, "errors become null");
        break;
      case 'M':
        app.add_flag("--no-timing", r.no_timing, "nothing is timed");
        break;
      case 'q':
        app.add_flag("--quick", r.quick, "shorter ladders");
        break;
      case 'F':
        app.add_flag("--fresh", r.fresh, "recompute the parts that an earlier call finished");
        break;
    }
  app.add_flag("--quiet", r.quiet, "no progress on standard error");
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

[[noreturn]] void refuse_extras(const CLI::App& app, const std::vector<std::string>& extras) {
  const std::string& extra = extras.front();
  const std::string name = extra.substr(0, extra.find('='));
  const std::vector<std::string> known = option_names(app);
  if (!extra.starts_with("-"))
    throw UsageError(fmt::format("{}: found '{}', expected no further argument", app.get_name(), extra));
  const std::string near = nearest(name, known);
  throw UsageError(fmt::format("{}: found the unknown option '{}', expected {}", app.get_name(), name,
                               near.empty() ? fmt::format("one of {}", fmt::join(known, ", ")) : near));
}

}  // namespace

int parse_and_run(const Catalogue& catalogue, const std::atomic<bool>& stop, int argc,
                  const char* const* argv) {
  CLI::App app{"gnomon compares integrators for mechanical ODEs and DAEs: accuracy, drift and cost",
               "gnomon"};
  app.set_version_flag("--version", std::string("gnomon ") + gnomon_version);
  app.footer(
      "`./gnomon test` builds and runs the test suite. Exit codes: 0 done, 1 a named run failed, 2 bad "
      "usage, "
      "3 interrupted.");
  Context context{catalogue, stop, {}};
  std::vector<std::string> names;
  for (const Command& command : commands) {
    CLI::App* sub = app.add_subcommand(command.name, command.help);
    sub->allow_extras();
    add_options(*sub, context.request, command.options);
    names.emplace_back(command.name);
  }
  if (argc < 2) {
    fmt::print("{}", app.help());
    return bad_usage;
  }
  const std::string first = argv[1];
  if (!first.starts_with("-") && std::find(names.begin(), names.end(), first) == names.end()) {
    const std::string near = nearest(first, names);
    throw UsageError(fmt::format("found the unknown command '{}', expected {}", first,
                                 near.empty() ? fmt::format("one of {}", fmt::join(names, ", ")) : near));
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);
  } catch (const CLI::ArgumentMismatch& error) {
    const std::string what = error.what();
    const std::string option = what.substr(0, what.find(':'));
    const bool several =
        what.find("received") != std::string::npos && what.find("At most") != std::string::npos;
    throw UsageError(
        fmt::format("{}: found {}, expected one value", option, several ? "several values" : "nothing"));
  } catch (const CLI::ParseError& error) {
    throw UsageError(error.what());
  }
  for (const Command& command : commands) {
    const CLI::App* sub = app.get_subcommand(command.name);
    if (!sub->parsed()) continue;
    if (const auto extras = sub->remaining(); !extras.empty()) refuse_extras(*sub, extras);
    check_outputs(context.request);
    return command.run(context);
  }
  throw UsageError(fmt::format("found no command, expected one of {}", fmt::join(names, ", ")));
}

}  // namespace gnomon::cli
