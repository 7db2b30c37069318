#include "tools/app/discrepancy.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/file_io.h"
#include "harness/campaign/judge.h"
#include "harness/report/run_report.h"

namespace parallax::tools {
namespace {

using harness::ReportedDiscrepancy;

/// One discrepancy of report.json; none if the run has none. Reports a number that does not exist.
base::Result<std::optional<ReportedDiscrepancy>> find_discrepancy(const std::string& run_dir,
                                                                  const std::string& sample,
                                                                  base::DiagnosticSink& sink) {
  const auto path = (std::filesystem::path(run_dir) / "report.json").string();
  const auto text = base::read_file_of(run_dir, "report.json", sink);
  if (!text) return sink.already_reported();
  const auto report = harness::read_run_report(*text);
  const auto refuse = [&] {
    return sink.error_about(codes::kUsage, path, "this is no report of a run");
  };
  if (!report || !report->discrepancies) return refuse();
  std::string others;
  for (const auto& found : *report->discrepancies) {
    if (!found.is_whole) return refuse();
    if (sample.empty() || sample == found.id()) return std::optional(found);
    others += (others.empty() ? "" : ", ") + found.id();
  }
  if (sample.empty()) return std::optional<ReportedDiscrepancy>();
  return sink.error_about(codes::kNoSuchSample, run_dir, sample + " with a discrepancy")
      .note(others.empty() ? "the run found no discrepancy"
                           : "it found discrepancies in " + others);
}

/// Does the journal confirm the report? For a trace, the observations differ there in these
/// fluents; for an executed plan, each of the fluents was observed so.
bool is_what_was_seen(const harness::Discrepancy& reported, const ScenarioModel& loaded,
                      const harness::CampaignTrace& trace, const harness::RecordedRun& run,
                      const ObservedPath& path) {
  if (run.record.status != harness::SampleStatus::kOk) return false;
  if (!path.executed) {
    const harness::ModelFluents fluents(*trace.symbols);
    const auto judgement =
        harness::judge(*loaded.scenario.mapping, fluents, trace, run.record.observations);
    return judgement.first_divergence == reported.first_divergence &&
           std::equal(judgement.first.begin(), judgement.first.end(), reported.first.begin(),
                      reported.first.end(), [](const auto& seen, const auto& told) {
                        return seen.fluent == told.fluent && seen.timepoint == told.timepoint &&
                               seen.observed == told.observed;
                      });
  }
  if (reported.first_divergence >= static_cast<std::int64_t>(path.points.size())) return false;
  const compiler::SymbolTable symbols(loaded.compilation.model);
  const auto& seen = path.points[static_cast<std::size_t>(reported.first_divergence)];
  return std::all_of(reported.first.begin(), reported.first.end(), [&](const auto& told) {
    const auto fluent = symbols.fluent(told.fluent);
    if (!fluent) {
      return std::find(seen.outside.begin(), seen.outside.end(), told.fluent) != seen.outside.end();
    }
    const auto value = seen.state.holds.find(*fluent);
    return value == seen.state.holds.end() || value->second == told.observed;
  });
}

}  // namespace

base::Result<std::optional<RecordedDiscrepancy>> load_discrepancy(const RunFolderOptions& folder,
                                                                  const std::string& sample,
                                                                  Context& context) {
  auto& sink = context.sink();
  auto journal = harness::read_journal(folder.folder, context.files(), sink);
  if (!journal) return sink.already_reported();
  const auto discrepancy = find_discrepancy(folder.folder, sample, sink);
  if (!discrepancy) return sink.already_reported();
  if (!*discrepancy || !journal->header) return std::optional<RecordedDiscrepancy>();
  const harness::SampleId id{(*discrepancy)->found.trace, (*discrepancy)->found.sample};
  if (!journal->samples.contains({id.trace, id.sample, harness::DrawPhase::kCertify})) {
    return sink.error_about(codes::kNoSuchSample, folder.folder, (*discrepancy)->id())
        .note("report.json tells of it, the journal does not");
  }
  const auto recorded = harness::recorded_run(*journal, id);
  auto loaded = load_recorded_scenario(folder, recorded.header, ScenarioUse::kExplain, context);
  if (!loaded) return sink.already_reported();
  const auto trace = check_recorded_run(*loaded, recorded, context);
  if (!trace) return sink.already_reported();
  auto path = observed_path(*loaded, recorded, context);
  if (!path) return sink.already_reported();
  if (!is_what_was_seen((*discrepancy)->found, *loaded, *trace, recorded, *path)) {
    return sink.error(codes::kForeignJournalLine, recorded.source,
                      "what it observed is not the discrepancy that report.json tells of");
  }
  auto parting = find_parting(loaded->compilation.model, *path, context);
  if (!parting) return sink.already_reported();
  return std::optional(RecordedDiscrepancy{*std::move(loaded), *std::move(journal),
                                           *std::move(path), *std::move(parting)});
}

ObservedRun observed_run(const RecordedDiscrepancy& found) {
  ObservedRun run;
  const auto& path = found.path;
  const auto last = found.parting ? found.parting->after : path.steps.size();
  if (found.parting) run.observed = found.parting->observed;
  for (std::size_t t = 0; t < last; ++t) {
    run.lines.push_back(fmt::format("{} happens at {}", path.steps[t].name, t));
  }
  run.shown_from = last == 0 ? 0 : last - 1;
  if (!found.parting) return run;
  if (last > 0 && path.steps[last - 1].outcome.status != harness::SimStatus::kOk) {
    const auto& step = path.steps[last - 1];
    run.lines.push_back(
        fmt::format("{} fails at {}: {}", step.name, last - 1, reason_of(step.outcome)));
  }
  for (const auto& [fluent, holds] : found.parting->needed) {
    run.lines.push_back(fmt::format("{} {} at {}",
                                    found.loaded.compilation.model.fluents[fluent.index()].name,
                                    holds ? "holds" : "does not hold", last));
  }
  for (const auto& difference : found.parting->differences) {
    run.lines.push_back(fmt::format("{} {} at {}", difference.name,
                                    difference.neither    ? "neither holds nor does not"
                                    : difference.observed ? "holds"
                                                          : "does not hold",
                                    last));
  }
  return run;
}

base::Result<runtime::MinimalSets> blamed_sets(const RecordedDiscrepancy& found,
                                               const SetOptions& options,
                                               ContradictionSearch& search) {
  const auto& parting = *found.parting;
  if (!options.all && !parting.differences.empty()) {
    return search.within(parting.differences.front().blamed);
  }
  auto sets = search.sets(options);
  if (!sets) return sets;
  const auto& model = found.loaded.compilation.model;
  const auto of_event = groups_of_event(model, runtime::group_axioms(model), found.path, parting);
  std::stable_partition(sets->sets.begin(), sets->sets.end(), [&](const auto& set) {
    return std::any_of(set.begin(), set.end(), [&](std::uint32_t group) {
      return std::binary_search(of_event.begin(), of_event.end(), group);
    });
  });
  return sets;
}

}  // namespace parallax::tools
