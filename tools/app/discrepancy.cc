#include "tools/app/discrepancy.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "harness/campaign/judge.h"

namespace parallax::tools {
namespace {

using Json = nlohmann::json;

/// A discrepancy as report.json has it.
struct ReportedDiscrepancy {
  struct Fluent {
    std::string name;
    std::int64_t timepoint = 0;
    bool observed = false;
  };
  std::int64_t trace = 0, sample = 0, first_divergence = 0;
  std::vector<Fluent> first;  // that differed there

  std::string id() const { return fmt::format("{}.{}", trace, sample); }
};

/// None if an entry is not in the format of `parallax run`.
std::optional<ReportedDiscrepancy> decode(const Json& entry) {
  const auto integer = [](const Json& object, const char* name) {
    const auto* value = base::json_member(object, name);
    return value == nullptr ? std::nullopt : base::json_as<std::int64_t>(*value);
  };
  const auto trace = integer(entry, "trace"), sample = integer(entry, "sample"),
             divergence = integer(entry, "first_divergence");
  const auto* first = base::json_member(entry, "first");
  if (!trace || !sample || !divergence || *divergence < 0 || first == nullptr ||
      !first->is_array()) {
    return std::nullopt;
  }
  ReportedDiscrepancy out{*trace, *sample, *divergence, {}};
  for (const auto& fluent : *first) {
    const auto time = integer(fluent, "timepoint");
    const auto *name = base::json_member(fluent, "fluent"),
               *observed = base::json_member(fluent, "observed");
    if (!time || name == nullptr || !name->is_string() || observed == nullptr ||
        !observed->is_boolean()) {
      return std::nullopt;
    }
    out.first.push_back({name->get<std::string>(), *time, observed->get<bool>()});
  }
  return out;
}

/// One discrepancy of report.json; none if the run has none. Reports a number that does not exist.
base::Result<std::optional<ReportedDiscrepancy>> find_discrepancy(const std::string& run_dir,
                                                                  const std::string& sample,
                                                                  base::DiagnosticSink& sink) {
  const auto path = (std::filesystem::path(run_dir) / "report.json").string();
  const auto text = base::read_file_of(run_dir, "report.json", sink);
  if (!text) return sink.already_reported();
  const auto report = base::parse_json(*text);
  const auto refuse = [&] {
    return sink.error_about(codes::kUsage, path, "this is no report of a run");
  };
  const auto* list = base::json_member(report, "discrepancies");
  if (list == nullptr || !list->is_array()) return refuse();
  std::string others;
  for (const auto& entry : *list) {
    auto found = decode(entry);
    if (!found) return refuse();
    if (sample.empty() || sample == found->id()) return std::optional(*std::move(found));
    others += (others.empty() ? "" : ", ") + found->id();
  }
  if (sample.empty()) return std::optional<ReportedDiscrepancy>();
  return sink.error_about(codes::kNoSuchSample, run_dir, sample + " with a discrepancy")
      .note(others.empty() ? "the run found no discrepancy"
                           : "it found discrepancies in " + others);
}

/// Does the journal confirm the report? For a trace, the observations differ there in these
/// fluents; for an executed plan, each of the fluents was observed so.
bool is_what_was_seen(const ReportedDiscrepancy& reported, const ScenarioModel& loaded,
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
                        return seen.fluent == told.name && seen.timepoint == told.timepoint &&
                               seen.observed == told.observed;
                      });
  }
  if (reported.first_divergence >= static_cast<std::int64_t>(path.points.size())) return false;
  const compiler::SymbolTable symbols(loaded.compilation.model);
  const auto& seen = path.points[static_cast<std::size_t>(reported.first_divergence)];
  return std::all_of(reported.first.begin(), reported.first.end(), [&](const auto& told) {
    const auto fluent = symbols.fluent(told.name);
    if (!fluent) {
      return std::find(seen.outside.begin(), seen.outside.end(), told.name) != seen.outside.end();
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
  const harness::SampleId id{(*discrepancy)->trace, (*discrepancy)->sample};
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
  if (!is_what_was_seen(**discrepancy, *loaded, *trace, recorded, *path)) {
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
