#include <cstdio>
#include <exception>
#include <new>
#include <optional>
#include <system_error>
#include <vector>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/suggest.h"
#include "tools/cli/command.h"
#include "tools/cli/diff_command.h"
#include "tools/cli/explain_command.h"
#include "tools/cli/limits.h"
#include "tools/cli/signals.h"
#include "tools/cli/version.h"

namespace parallax::tools {
namespace {

constexpr const char* kDescription =
    "Finds where a formal model of a robot's environment and physics part.";
constexpr const char* kFooter =
    "Examples:\n"
    "  parallax run scenarios/two_regions/edge.yaml --jobs 2\n"
    "  parallax replay out/edge\n"
    "  parallax traces model.e --limit 0\n"
    "  parallax verify scenario.yaml --property \"!HoldsAt(Broken(),time)\"\n"
    "  parallax compile model.e -o model.dec.cnf\n"
    "  parallax explain model.e --why \"HoldsAt(F(),3)\"\n"
    "Exit codes: 0 nothing to report, 1 finding, 2 usage, 3 input rejected, 4 inconclusive,\n"
    "5 internal error, 130 and 143 interrupted.";

bool wants_json(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    if (std::string_view(argv[i]) == "--json") return true;
  }
  return false;
}

/// The long options of the application and of the subcommand that was parsed.
std::vector<std::string> known_options(const CLI::App& app) {
  std::vector<std::string> names;
  const auto collect = [&](const CLI::App& from) {
    for (const auto* option : from.get_options()) {
      for (const auto& name : option->get_lnames()) names.push_back("--" + name);
    }
  };
  collect(app);
  for (const auto* sub : app.get_subcommands()) collect(*sub);
  if (app.get_subcommands().empty()) {
    for (const auto* sub : app.get_subcommands([](const CLI::App*) { return true; })) {
      names.push_back(sub->get_name());
    }
  }
  return names;
}

int usage_error(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
  base::DiagnosticSink sink;
  const base::SourceFiles files;
  auto built = sink.error_about(base::DiagnosticCode::kUsage, "", error.what());
  const auto names = known_options(app);
  for (int i = 1; i < argc; ++i) {
    const std::string word = std::string(argv[i]).substr(0, std::string(argv[i]).find('='));
    bool known = false;
    for (const auto& name : names) known = known || name == word;
    const bool could_be_command = i == 1 && app.get_subcommands().empty();
    if (known || (!word.starts_with("--") && !could_be_command)) continue;
    if (const auto near = base::nearest_name(word, names)) {
      built.fix(fmt::format("replace `{}` with `{}`", word, *near));
      break;
    }
  }
  const auto* sub = app.get_subcommands().empty() ? nullptr : app.get_subcommands().front();
  built.note(fmt::format("see `parallax {}--help`", sub ? sub->get_name() + " " : ""));
  const auto diagnostics = sink.sorted();
  if (wants_json(argc, argv)) {
    const auto document = error_document(diagnostics, files);
    std::fwrite(document.data(), 1, document.size(), stdout);
  }
  write_error(base::to_text(diagnostics.front(), files, {}));
  return 2;
}

int run(int argc, char** argv) {
  CLI::App app(kDescription, "parallax");
  app.footer(kFooter);
  app.require_subcommand(1);
  app.set_version_flag("--version",
                       fmt::format("parallax {} (CaDiCaL {})", kVersion, kCadicalVersion));
  CommonOptions options;
  std::vector<Command> commands = {
      add_run_command(app),    add_replay_command(app),      add_suite_command(app),
      add_check_command(app),  add_traces_command(app),      add_compile_command(app),
      add_verify_command(app), add_diagnostics_command(app), add_explain_command(app),
      add_fmt_command(app),    add_diff_command(app),        add_worker_command(app),
      add_rates_command(app),  add_draw_command(app)};
  for (auto& command : commands) add_common_options(*command.app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {  // --help, --version
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    return usage_error(app, error, argc, argv);
  }
  install_signal_handlers();
  for (auto& command : commands) {
    if (!command.app->parsed()) continue;
    const LimitGuard limits(options);
    Invocation invocation(options);
    const int code = invocation.finish(command.run(invocation));
    if (signal_exit_code() != 0) return signal_exit_code();
    return code == 0 && limits.time_is_over() && !invocation.is_answered() ? 4 : code;
  }
  return 2;
}

}  // namespace
}  // namespace parallax::tools

int main(int argc, char** argv) {
  namespace base = parallax::base;
  try {
    return parallax::tools::run(argc, argv);
  } catch (const std::exception& error) {
    // A broken contract, or the machine has no memory or threads left.
    base::DiagnosticSink sink;
    const bool starved = dynamic_cast<const std::bad_alloc*>(&error) != nullptr ||
                         dynamic_cast<const std::system_error*>(&error) != nullptr;
    if (starved) {
      sink.error_about(base::DiagnosticCode::kLimitReached, "", error.what());
    } else {
      sink.error_about(base::DiagnosticCode::kInternal, "", error.what());
    }
    const base::SourceFiles files;
    parallax::tools::write_error(base::to_text(sink.sorted().front(), files, {}));
    if (parallax::tools::wants_json(argc, argv)) {
      const auto document = parallax::tools::error_document(sink.sorted(), files);
      std::fwrite(document.data(), 1, document.size(), stdout);
    }
    return sink.exit_code();
  }
}
