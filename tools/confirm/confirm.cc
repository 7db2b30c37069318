#include "tools/confirm/confirm.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "compiler/base/codes/files.h"
#include "compiler/base/suggest.h"

namespace parallax::tools {
namespace {

using harness::StartVerdict;

/// Default tolerance of a border, as a fraction of the parameter's range.
constexpr double kUsualTolerance = 0.01;

double tolerance_of(const StartParameter& parameter, const std::optional<double>& asked) {
  return asked ? *asked : kUsualTolerance * parameter.range.width();
}

const harness::SampleRecord& record_of(const RecordedDiscrepancy& found) {
  const auto& id = found.path.id;
  return found.journal.samples.at({id.trace, id.sample, harness::DrawPhase::kCertify});
}

/// Simulates the failing start and seed once more.
std::optional<StartVerdict> repeat(TriedStarts& starts) {
  const auto verdicts = starts.probe({starts.failing()});
  return verdicts.empty() ? std::nullopt : std::optional(verdicts.front());
}

}  // namespace

std::string_view to_string(ConfirmVerdict verdict) {
  static constexpr std::array<std::string_view, 6> kWords = {"open",         "confirmed", "partly",
                                                             "not-repeated", "seed",      "step"};
  return kWords[static_cast<std::size_t>(verdict)];
}

ConfirmVerdict Confirmation::verdict() const {
  if (!repeated) return ConfirmVerdict::kOpen;
  if (*repeated != StartVerdict::kFails) return ConfirmVerdict::kNotRepeated;
  const auto vanishes = [](const std::optional<harness::Persistence>& seen) {
    return seen && seen->runs > 0 && !seen->in_most();
  };
  if (vanishes(other_seeds)) return ConfirmVerdict::kSeed;
  if (vanishes(half_step)) return ConfirmVerdict::kStep;
  const auto in_all = [](const std::optional<harness::Persistence>& seen) {
    return !seen || (seen->runs > 0 && seen->failures == seen->runs);
  };
  const bool all = in_all(other_seeds) && in_all(half_step);
  return all ? ConfirmVerdict::kConfirmed : ConfirmVerdict::kPartly;
}

bool Confirmation::may_move() const {
  const auto is = verdict();
  const bool same = repeats_itself && !difference;
  return is == ConfirmVerdict::kConfirmed || (is == ConfirmVerdict::kPartly && same);
}

bool Threshold::finished() const {
  return end == TriedStarts::End::kNot && scan.finished &&
         std::all_of(scan.borders.begin(), scan.borders.end(),
                     [](const auto& bracket) { return bracket.is_narrow(); });
}

base::Result<Confirmation> confirm_discrepancy(const std::string& run_dir,
                                               const RecordedDiscrepancy& found,
                                               const ScenarioModel& as_run,
                                               const ConfirmSimulators& simulators,
                                               const ConfirmOptions& options, Context& context) {
  auto& sink = context.sink();
  Confirmation out;
  out.sample = found.path.id;
  out.seed = record_of(found).seed;
  out.digest = record_of(found).digest;
  out.words = parting_words(found);
  out.world_is_model = as_run.world != nullptr;
  out.has_half_step = static_cast<bool>(simulators.half_step);
  out.budget = options.starts.runs;
  out.repeats = options.repeats;
  auto starts =
      TriedStarts::open(run_dir, found, as_run, simulators.usual, options.starts, context);
  if (!starts) return sink.already_reported();
  if (*starts == nullptr) {
    out.end = TriedStarts::End::kStopped;
    return out;
  }
  auto& tried = **starts;
  out.parameters = tried.parameters();
  out.fixed = tried.fixed();
  out.has_law = tried.has_law();
  out.place = tried.place();
  out.determinism = tried.simulator().determinism;
  out.repeats_itself = harness::may_repeat_losses(tried.simulator());
  out.repeated = repeat(tried);
  if (out.repeated) {
    const auto* again = tried.record(tried.failing());
    if (again != nullptr) out.difference = harness::first_difference(record_of(found), *again);
  }
  if (out.repeated && options.repeats > 0 && !context.stopped()) {
    FurtherRunsOptions again;
    again.jobs = options.starts.jobs;
    again.progress = options.starts.progress;
    again.repeats = options.repeats;
    again.without_seeds = true;
    const auto same = same_start_runs(run_dir, found, as_run, simulators.usual,
                                      simulators.half_step, again, context);
    if (!same) return sink.already_reported();
    out.has_seeds = same->has_seeds;
    out.other_seeds = same->other_seeds;
    out.half_step = same->half_step;
  }
  if (out.may_move() && !context.stopped() && !out.parameters.empty()) {
    std::vector<harness::CellParameter> cell;
    std::vector<double> tolerances;
    for (const auto& parameter : out.parameters) {
      cell.push_back(parameter.range);
      tolerances.push_back(tolerance_of(parameter, options.tolerance));
    }
    out.shrunk = harness::shrink_start(
        cell, tried.failing(), tolerances,
        [&](const std::vector<harness::StartPoint>& points) { return tried.probe(points); });
  }
  out.end = context.stopped() ? TriedStarts::End::kStopped : tried.end();
  out.runs = tried.asked() + (out.other_seeds ? options.repeats : 0) +
             (out.half_step ? options.repeats : 0);
  if (out.end == TriedStarts::End::kFailed) return sink.already_reported();
  if (context.stopped()) return out;  // as it is, the journal is good for the next time
  if (!tried.close() || !keep_finding(run_dir, out, sink)) return sink.already_reported();
  return out;
}

namespace {

/// The number of the parameter of this name. Reports one that there is not.
base::Result<std::size_t> find_parameter(const TriedStarts& starts, const std::string& name,
                                         base::DiagnosticSink& sink) {
  const auto& known = starts.parameters();
  std::vector<std::string> names;
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (known[i].range.name == name) return i;
    names.push_back(known[i].range.name);
  }
  const auto& fixed = starts.fixed();
  const auto code = codes::kUsage;
  if (std::find(fixed.begin(), fixed.end(), name) != fixed.end()) {
    return sink
        .error_about(
            code, "--parameter",
            fmt::format("`{}` has one value in every start of this trace: there is nothing "
                        "to vary",
                        name))
        .help(names.empty() ? std::string("No parameter of these starts has a width.")
                            : fmt::format("Those that vary: {}.", fmt::join(names, ", ")));
  }
  auto error = sink.error_about(code, "--parameter",
                                fmt::format("starts of this trace have no parameter `{}`", name));
  if (const auto near = base::nearest_name(name, names, 4)) {
    error.fix(fmt::format("replace `{}` with `{}`", name, *near));
  }
  error.help(names.empty() ? std::string("No parameter of these starts has a width.")
                           : fmt::format("They have: {}.", fmt::join(names, ", ")));
  return error;
}

}  // namespace

base::Result<Threshold> find_threshold(const std::string& run_dir, const RecordedDiscrepancy& found,
                                       const ScenarioModel& as_run,
                                       const harness::SimulatorFactory& simulator,
                                       const ThresholdOptions& options, Context& context) {
  auto& sink = context.sink();
  Threshold out;
  out.sample = found.path.id;
  out.seed = record_of(found).seed;
  out.digest = record_of(found).digest;
  out.words = parting_words(found);
  out.budget = options.starts.runs;
  auto starts = TriedStarts::open(run_dir, found, as_run, simulator, options.starts, context);
  if (!starts) return sink.already_reported();
  if (*starts == nullptr) {
    out.end = TriedStarts::End::kStopped;
    return out;
  }
  auto& tried = **starts;
  const auto index = find_parameter(tried, options.parameter, sink);
  if (!index) return sink.already_reported();
  out.parameter = tried.parameters()[*index];
  out.has_law = tried.has_law();
  out.place = tried.place();
  out.tolerance = tolerance_of(out.parameter, options.tolerance);
  out.repeats = harness::may_repeat_losses(tried.simulator());
  out.repeated = repeat(tried);
  if (out.repeated == StartVerdict::kFails) {
    out.scan = harness::scan_line(
        out.parameter.range, *index, tried.failing(), options.points, out.tolerance,
        [&](const std::vector<harness::StartPoint>& points) { return tried.probe(points); });
  }
  out.end = context.stopped() ? TriedStarts::End::kStopped : tried.end();
  out.runs = tried.asked();
  if (out.end == TriedStarts::End::kFailed) return sink.already_reported();
  if (context.stopped()) return out;
  if (!tried.close() || !keep_finding(run_dir, out, sink)) return sink.already_reported();
  return out;
}

std::string parting_words(const RecordedDiscrepancy& found) {
  const auto& parting = *found.parting;
  const auto& path = found.path;
  if (parting.after == 0) return "in its first state";
  const auto& step = path.steps[parting.after - 1];
  if (step.outcome.status != harness::SimStatus::kOk) {
    return fmt::format("`{}` fails at {}: {}", step.name, parting.after - 1,
                       reason_of(step.outcome));
  }
  const auto after = fmt::format("after `{}` at {}", step.name, parting.after - 1);
  if (parting.differences.empty()) return after;
  const auto& first = parting.differences.front();
  return fmt::format("{} `{}` {}", after, first.name,
                     first.neither    ? "neither holds nor does not"
                     : first.observed ? "holds"
                                      : "does not hold");
}

}  // namespace parallax::tools
