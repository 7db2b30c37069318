#include "tools/repair/repair_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/file_io.h"
#include "harness/report/run_report.h"
#include "tools/app/evidence.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

base::Result<ScenarioModel> load(const RepairOptions& options, const harness::JournalHeader& header,
                                 Context& context) {
  if (!options.other_model) {
    auto folder = options.folder;
    folder.may_use_kept = false;  // it edits the files
    return load_recorded_scenario(folder, header, ScenarioUse::kExplain, context);
  }
  const auto path =
      options.folder.scenario.empty() ? scenario_path(header) : fs::path(options.folder.scenario);
  return load_scenario_model(
      path, context, {.as_run = true, .execution = recorded_execution(header), .plain = true});
}

/// A run that was ended before its verdict has no report, or one that decides nothing.
bool is_finished(const fs::path& folder) {
  base::DiagnosticSink unread;
  const auto text = base::read_file_of(folder, "report.json", unread);
  if (!text) return false;
  const auto report = harness::read_run_report(*text);
  return report && !report->verdict.empty() &&
         report->verdict != to_string(harness::CampaignVerdict::kInconclusive);
}

/// Adds further runs of the same scenario: those that `explain` made to find the kind of cause,
/// which are like the others, as far as `paths` lacks them; those that `repair` made to tell
/// proposals apart.
base::Status add_paths(const char* name, const RepairOptions& options, const ScenarioModel& loaded,
                       const harness::JournalHeader& header, std::vector<ObservedPath>& paths,
                       Context& context) {
  const auto folder = fs::path(options.folder.folder) / name;
  const bool experiments = name == std::string_view(kExperiments);
  std::error_code error;
  if (!fs::exists(folder / "journal.ndjson", error)) return base::Unit{};
  const auto journal = harness::read_journal(folder, context.files(), context.sink());
  if (!journal) return context.sink().already_reported();
  if (!journal->header || journal->header->scenario_hash != header.scenario_hash ||
      journal->header->seed != header.seed) {
    context.remark(fmt::format("{}: runs of something else, left out", folder.string()));
    return base::Unit{};
  }
  // A scenario that may have changed draws other starts.
  if (!options.other_model && !check_recorded_starts(loaded, *journal, context)) {
    return context.sink().already_reported();
  }
  auto further = observed_paths(loaded, *journal, context);
  if (!further) return context.sink().already_reported();
  const auto known = paths.size();
  for (auto& path : *further) {
    path.experiment = experiments;
    const auto same = [&](const ObservedPath& other) {
      return other.id.trace == path.id.trace && other.id.sample == path.id.sample;
    };
    const auto end = paths.begin() + static_cast<std::ptrdiff_t>(known);
    if (experiments || std::none_of(paths.begin(), end, same)) paths.push_back(std::move(path));
  }
  return base::Unit{};
}

/// Does the model forbid the step that the world refused?
bool refused_by_both(EvidenceAdmission& admission, const Evidence& seen, std::size_t step) {
  return seen.steps[step].failed && admission.ask(seen, step).refused;
}

/// Finds where each way that runs went leaves the model. If the model is right that a step is
/// impossible, only the steps before it are evidence.
void find_partings(RepairInput& input, Context& context) {
  std::size_t horizon = 1;
  for (const auto& seen : input.evidence) horizon = std::max(horizon, seen.steps.size());
  std::string why;
  const auto model = compile_text(input.text, static_cast<std::int64_t>(horizon), context, why);
  if (!model) {
    input.remarks.push_back("the model by itself cannot be compiled: " + why);
    return;
  }
  EvidenceAdmission admission(*model, context.stop());
  std::vector<Evidence> usable;
  for (auto& seen : input.evidence) {
    const auto answer = admission.ask(seen);
    if (answer.stopped) return;
    if (!answer.start) {
      input.remarks.push_back(fmt::format(
          "run {} begins where the model cannot: what it says of the start is not repaired",
          seen.ids.front()));
      continue;
    }
    if (!answer.whole && refused_by_both(admission, seen, answer.reached)) {
      input.remarks.push_back(fmt::format(
          "run {}: {} at {} failed, and the model says that it cannot happen there: the "
          "plan tried it, or started where it should not",
          seen.ids.front(), seen.steps[answer.reached].event, answer.reached));
      seen.steps.resize(answer.reached);
      seen.states.resize(answer.reached + 1);
    } else if (!answer.whole) {
      seen.divergence = answer.reached + 1;
      const auto after = *seen.divergence;
      input.failed += seen.runs();
      input.partings.push_back(
          {seen.ids, after, seen.steps[after - 1], admission.impossible(seen, after)});
    }
    usable.push_back(std::move(seen));
  }
  input.evidence = std::move(usable);
}

/// Looks for starts that the world excludes, where these may be why the run came to no verdict. The
/// starts of an open-loop run depend on the plan and the constraints, too: there a conflict is that
/// the world has no start of the model at all.
void find_start_conflict(RepairInput& input, Context& context) {
  if (input.finished || !input.partings.empty() || context.stopped()) return;
  const auto comparison = StartComparison::make(input.loaded, context);
  if (comparison == nullptr) return;
  std::string why;
  const auto model = compile_text(input.text, 1, context, why);
  if (!model) return;
  const bool closed = recorded_execution(input.header) == harness::Execution::kClosedLoop;
  input.start = comparison->conflict(*model, closed);
  if (input.start) input.partings.push_back({{}, 0, {}, input.start->differs});
}

void find_contradictions(RepairInput& input) {
  for (const auto& a : input.evidence) {
    if (!a.divergence) continue;
    const auto t = *a.divergence;
    for (const auto& b : input.evidence) {
      if (&a == &b || !goes_like(a, b, t) || a.states[t] == b.states[t]) continue;
      input.contradictions.push_back(
          fmt::format("runs {} and {} go the same way up to {}, and after {} they differ",
                      a.ids.front(), b.ids.front(), t - 1, a.steps[t - 1].event));
      break;
    }
  }
}

}  // namespace

bool goes_like(const Evidence& a, const Evidence& b, std::size_t t) {
  if (b.steps.size() < t || a.executed != b.executed) return false;
  for (std::size_t k = 0; k < t; ++k) {
    if (a.states[k] != b.states[k] || a.steps[k].event != b.steps[k].event) return false;
  }
  return true;
}

bool set_aside(const std::vector<Evidence>& failed, std::vector<Evidence>& taken) {
  bool any = false;
  for (const auto& a : failed) {
    if (!a.divergence || !a.steps[*a.divergence - 1].failed) continue;
    const auto t = *a.divergence;
    for (auto& b : taken) {
      if (b.divergence && *b.divergence <= t) continue;
      if (!goes_like(a, b, t) || a.states[t] == b.states[t]) continue;
      b.until = std::min(b.until.value_or(t - 1), t - 1);
      any = true;
    }
  }
  return any;
}

base::Result<RepairInput> load_repair_input(const RepairOptions& options, Context& context) {
  auto& sink = context.sink();
  const auto journal = harness::read_journal(options.folder.folder, context.files(), sink);
  if (!journal) return sink.already_reported();
  if (!journal->header) {
    return sink.error_about(codes::kNoJournal, options.folder.folder);
  }
  if (!expect_traces(options.folder, *journal->header, sink)) return sink.already_reported();
  auto loaded = load(options, *journal->header, context);
  if (!loaded) return sink.already_reported();
  auto paths = observed_paths(*loaded, *journal, context);
  if (!paths) return sink.already_reported();
  for (const auto* name : {kFurtherRuns, kExperiments}) {
    if (!add_paths(name, options, *loaded, *journal->header, *paths, context)) {
      return sink.already_reported();
    }
  }
  auto domain = load_domain(loaded->scenario, context);
  if (domain == nullptr) {
    return sink.error_about(codes::kReplayImpossible, options.folder.folder,
                            "the texts of the model changed meanwhile");
  }
  auto text = compiler::flat_text(domain->ast, domain->files, {});
  auto evidence = evidence_of(*paths, loaded->compilation.model);
  RepairInput input{options,         *journal->header,  *std::move(loaded), std::move(domain),
                    std::move(text), *std::move(paths), std::move(evidence)};
  for (const auto& seen : input.evidence) input.runs += seen.runs();
  input.finished = is_finished(options.folder.folder);
  input.experiments = static_cast<std::size_t>(std::count_if(
      input.paths.begin(), input.paths.end(), [](const auto& path) { return path.experiment; }));
  find_partings(input, context);
  if (!input.partings.empty()) find_contradictions(input);
  find_start_conflict(input, context);
  return input;
}

}  // namespace parallax::tools
