#include <algorithm>
#include <exception>
#include <new>
#include <vector>

#include "compiler/base/codes/files.h"
#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/suggest.h"
#include "tools/app/version.h"
#include "tools/cli/command.h"
#include "tools/cli/command_line.h"
#include "tools/cli/limits.h"
#include "tools/cli/manual_commands.h"

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
    "5 internal error, 130 and 143 interrupted.\n"
    "More: parallax help exit-codes, files, output, seeds, trust, limits; parallax COMMAND --help.";

/// The arguments of this program: those behind `--` are a command of another program.
std::vector<std::string> own_words(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + std::max(argc, 1));
  words.erase(std::find(words.begin(), words.end(), "--"), words.end());
  return words;
}

bool wants_json(int argc, char** argv) {
  const auto words = own_words(argc, argv);
  return std::find(words.begin(), words.end(), "--json") != words.end();
}

int usage_error(const ParsedLine& line, std::string_view command, int argc, char** argv) {
  base::DiagnosticSink sink;
  const base::SourceFiles files;
  const bool no_such_command = command.empty() && argc > 1 && argv[1][0] != '-';
  auto built = sink.error_about(
      codes::kUsage, "",
      no_such_command ? fmt::format("there is no command `{}`", base::printable(argv[1]))
                      : line.error);
  const auto words = own_words(argc, argv);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto word = words[i].substr(0, words[i].find('='));
    bool known = false;
    for (const auto& name : line.known) known = known || name == word;
    const bool could_be_command = i == 0 && command.empty();
    if (known || (!word.starts_with("--") && !could_be_command)) continue;
    if (const auto near = base::nearest_name(word, line.known)) {
      built.fix(fmt::format("replace `{}` with `{}`", word, *near));
      break;
    }
  }
  built.note(fmt::format("see `parallax {}{}--help`", command, command.empty() ? "" : " "));
  const auto diagnostics = sink.sorted();
  if (wants_json(argc, argv)) {
    print(error_document(diagnostics, files));
  }
  write_error(base::to_text(diagnostics.front(), files, {}));
  return 2;
}

/// Groups of commands by task, in the order of a user's work.
std::vector<Command> all_commands(const Program& program) {
  std::vector<Command> all;
  all.reserve(64);  // to grow is to copy every table
  const auto add = [&all](const char* subject, std::vector<Command> commands) {
    for (auto& command : commands) {
      command.options.set_subject(subject);
      all.push_back(std::move(command));
    }
  };
  add("Begin", {new_command(), check_command(), fmt_command(), lsp_command()});
  add("Find where model and world part",
      {run_command(), rates_command(), monitor_command(), prove_command(), suite_command()});
  add("Look into a run",
      {report_command(), draw_command(), replay_command(), explain_command(), confirm_command(),
       threshold_command(), coverage_command(), export_command()});
  add("Ask the model",
      {traces_command(), verify_command(), consequences_command(), compile_command()});
  add("Change the model", {repair_command(), learn_command()});
  add("Keep it right", {diff_command(), bisect_command(), ledger_command(), calibrate_command()});
  add("Bring a simulator of your own",
      {adapter_check_command(), record_command(), replay_adapter_command()});
  add("The program itself", {doctor_command(), diagnostics_command(), schema_command()});
  add("The program itself", manual_commands(program, all));
  add("", {worker_command(), supervise_command()});
  return all;
}

std::int64_t memory_limit_mb = 0;  // for when nothing else is left; 0: none

int run(int argc, char** argv) {
  OptionTable table("parallax", kDescription);
  table.footer(kFooter);
  CommonOptions options;
  Program program{
      table, fmt::format("parallax {} (CaDiCaL {})", kVersion, kCadicalVersion), true, {}};
  auto commands = all_commands(program);
  for (auto& command : commands) {
    add_common_options(command.options, options);
    program.commands.push_back(&command.options);
  }
  const auto line = parse_command_line(program, argc, argv);
  const auto* command = line.command ? &commands[*line.command] : nullptr;
  if (!line.error.empty()) {
    return usage_error(line, command != nullptr ? command->options.name() : "", argc, argv);
  }
  if (line.exit_code) {  // --help, --version
    print(line.output);
    return *line.exit_code;
  }
  memory_limit_mb = options.memory_limit_mb;
  install_signal_handlers();
  const LimitGuard limits(options);
  Invocation invocation(options);
  const int code = invocation.finish(command->run(invocation));
  if (signal_exit_code() != 0) return signal_exit_code();
  return code == 0 && limits.time_is_over() && !invocation.is_answered() ? 4 : code;
}

}  // namespace
}  // namespace parallax::tools

int main(int argc, char** argv) {
  namespace base = parallax::base;
  using parallax::tools::close_output;
  try {
    return close_output(parallax::tools::run(argc, argv));
  } catch (const std::exception& error) {
    // A broken contract, or the machine is out of memory or threads.
    base::DiagnosticSink sink;
    const bool starved = dynamic_cast<const std::bad_alloc*>(&error) != nullptr ||
                         dynamic_cast<const std::system_error*>(&error) != nullptr;
    if (starved) {
      sink.error_about(parallax::codes::kLimitReached, "",
                       parallax::tools::memory_limit_mb > 0
                           ? fmt::format("--memory-limit {}", parallax::tools::memory_limit_mb)
                           : fmt::format("of memory and threads ({})", error.what()));
    } else {
      sink.error_about(parallax::codes::kInternal, "", error.what());
    }
    const base::SourceFiles files;
    parallax::tools::write_error(base::to_text(sink.sorted().front(), files, {}));
    if (parallax::tools::wants_json(argc, argv)) {
      parallax::tools::print(parallax::tools::error_document(sink.sorted(), files));
    }
    return close_output(sink.exit_code());
  }
}
