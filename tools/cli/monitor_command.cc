#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>

#include "compiler/base/codes/files.h"
#include "compiler/base/descriptor.h"
#include "tools/app/file_kind.h"
#include "tools/app/monitor.h"
#include "tools/cli/command.h"
#include "tools/cli/shared_options.h"

namespace parallax::tools {
namespace {

struct MonitorOptions {
  std::string scenario, log;
  std::vector<std::string> unobserved;
  bool no_plan = false;
  std::int64_t max_states = 20'000;
  LogTolerance tolerance;
  std::string outliers;
};

int exit_code(MonitorVerdict verdict) {
  switch (verdict) {
    case MonitorVerdict::kConsistent:
      return 0;
    case MonitorVerdict::kInconsistent:
      return 1;
    case MonitorVerdict::kUndecided:
      return 4;
  }
  return 5;
}

WatchOptions watch_options(const MonitorOptions& options) {
  WatchOptions out;
  out.with_plan = !options.no_plan;
  out.max_states = static_cast<std::size_t>(options.max_states);
  out.unobserved = options.unobserved;
  out.tolerance = options.tolerance.reading;
  return out;
}

/// The tolerance that the options give; none: reported.
std::optional<LogTolerance> log_tolerance(const MonitorOptions& options, Invocation& invocation) {
  auto out = options.tolerance;
  if (options.outliers.empty()) return out;
  const auto rate = harness::read_outlier_rate(options.outliers);
  if (rate) {
    out.outliers = *rate;
    return out;
  }
  invocation.sink().error_about(
      codes::kUsage, "",
      fmt::format("`--outliers {}` is not `N/OF` with less than half of OF, such as `2/100`",
                  options.outliers));
  return std::nullopt;
}

int check_run(const MonitorOptions& options, Invocation& invocation) {
  const auto runs =
      monitor_run({options.log, options.scenario}, watch_options(options), invocation);
  if (!runs) return 0;
  if (invocation.options().json) {
    invocation.document(monitor_json(*runs, options.scenario));
  } else {
    invocation.result(monitor_text(*runs));
  }
  const auto verdict = verdict_of(*runs);
  // A run that was not checked completely is undecided, so a consistent one was checked to its end.
  if (verdict == MonitorVerdict::kConsistent) invocation.answered();
  return exit_code(verdict);
}

MonitorProgress progress_of(const Invocation& invocation) {
  if (invocation.options().quiet || isatty(STDERR_FILENO) == 0) return {};
  return [](const MonitorResult& result) {
    const double rate =
        result.wall_s > 0 ? static_cast<double>(result.observations) / result.wall_s : 0.0;
    show_progress(fmt::format("{} observations, {} steps, {:.0f} observations/s",
                              result.observations, result.events, rate));
  };
}

/// Files, FIFOs and devices are all logs.
base::Result<base::Descriptor> open_log(const std::string& name, base::DiagnosticSink& sink) {
  base::Descriptor file(name == "-" ? ::dup(STDIN_FILENO)
                                    : ::open(name.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() >= 0) return file;
  return sink.error_about(errno == ENOENT ? codes::kFileNotFound : codes::kFileUnreadable, name,
                          std::strerror(errno));
}

int monitor(const MonitorOptions& options, Invocation& invocation) {
  if (!expect_kind(options.scenario, {FileKind::kScenario}, "a scenario", invocation)) return 0;
  const auto tolerance = log_tolerance(options, invocation);
  if (!tolerance) return 0;
  std::error_code error;
  if (options.log != "-" && std::filesystem::is_directory(options.log, error)) {
    if (!expect_kind(options.log, {FileKind::kRun}, "a log or the folder of a run", invocation)) {
      return 0;
    }
    if (!tolerance->is_exact()) {
      invocation.sink().error_about(codes::kUsage, "",
                                    "--tolerance-m, --tolerance-rad and --outliers are for logs; "
                                    "what a run folder has is exact");
      return 0;
    }
    return check_run(options, invocation);
  }
  auto file = open_log(options.log, invocation.sink());
  if (!file) return 0;
  const auto loaded = load_scenario_model(options.scenario, invocation, {.watched = true});
  if (!loaded) return 0;
  const auto watch = Watch::make(*loaded, watch_options(options), invocation);
  if (!watch) return 0;
  const auto progress = progress_of(invocation);
  const auto name = options.log == "-" ? std::string("<stdin>") : options.log;
  const auto result = monitor_log(**watch, file->get(), name, invocation, *tolerance, progress);
  if (progress) clear_progress();
  if (invocation.options().json) {
    invocation.document(monitor_json(result, options.scenario));
  } else {
    invocation.result(monitor_text(result));
  }
  if (invocation.options().verbosity > 0) {
    invocation.remark(fmt::format(
        "{:.0f} observations/s",
        result.wall_s > 0 ? static_cast<double>(result.observations) / result.wall_s : 0.0));
  }
  return result.failed ? 0 : exit_code(result.verdict);  // the error says 3
}

}  // namespace

Command monitor_command() {
  auto options = std::make_shared<MonitorOptions>();
  OptionTable command("monitor", "Hold a robot's log, as it comes, against the model and the plan");
  command.footer(
      "Examples:\n"
      "  parallax monitor kitchen.yaml robot.jsonl\n"
      "  tail -f robot.jsonl | parallax monitor kitchen.yaml -\n"
      "  parallax monitor kitchen.yaml log.csv --no-plan --unobserved Slip\n"
      "  parallax monitor kitchen.yaml robot.jsonl --tolerance-m 0.005 --outliers 1/100\n"
      "  parallax monitor kitchen.yaml out/kitchen      every simulation of a run\n"
      "Lines of a log: {\"t\": 1.5, \"event\": \"Go(bTable)\", \"outcome\": \"ok\"}\n"
      "                {\"t\": 1.6, \"state\": {\"robot.x\": 0.1}}\n"
      "Exit codes: 0 consistent, 1 not, 3 a line cannot be read, 4 undecided.");
  command.option("scenario", options->scenario, "Scenario file (YAML)").required().file({"yaml"});
  command
      .option("log", options->log,
              "Log (JSON lines or CSV), - for standard input, or the folder of a run")
      .required()
      .file();
  command
      .option("--unobserved", options->unobserved,
              "Event that may happen without being logged; may be given again")
      .list(ListForm::kOneEachTime);
  command.flag("--no-plan", options->no_plan, "Against the model alone: any events may happen");
  command
      .option("--max-states", options->max_states,
              "States that may be possible at once; with more the answer is `undecided`")
      .check(WholeNumber{1, 1'000'000})
      .show_default();
  command
      .option("--tolerance-m", options->tolerance.reading.m,
              "A reported length may be off by so much [m]; the verdict counts where it mattered")
      .check(FiniteNumber{0.0, 10.0});
  command
      .option("--tolerance-rad", options->tolerance.reading.rad,
              "The same for yaw, roll and pitch [rad]")
      .check(FiniteNumber{0.0, 1.0});
  command
      .option("--outliers", options->outliers,
              "At most N of OF compared observations in a row may be wrong; they are listed")
      .named_value("N/OF");
  return command_of(std::move(command), options, monitor);
}

}  // namespace parallax::tools
