#include "harness/campaign/replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/contract.h"
#include "compiler/base/whole_number.h"
#include "harness/campaign/journal.h"
#include "harness/campaign/sample_record.h"
#include "harness/campaign/sample_runner.h"

namespace parallax::harness {
namespace {

std::optional<std::int64_t> positive(std::string_view text) {
  const auto value = base::whole_number<std::int64_t>(text);
  return value && *value >= 1 ? value : std::nullopt;
}

/// Which simulations there are instead.
void note_samples(const JournalText& journal, base::DiagnosticBuilder& report) {
  constexpr std::size_t kMaxTraces = 5;
  std::map<std::int64_t, std::pair<std::int64_t, std::int64_t>> first_and_last;  // by trace
  for (const auto& [key, record] : journal.samples) {
    const auto [at, fresh] =
        first_and_last.emplace(record.trace, std::pair(record.sample, record.sample));
    if (!fresh) at->second.second = std::max(at->second.second, record.sample);
  }
  std::size_t noted = 0;
  for (const auto& [trace, samples] : first_and_last) {
    if (++noted > kMaxTraces) {
      report.note(fmt::format("and {} further traces", first_and_last.size() - kMaxTraces));
      break;
    }
    report.note(fmt::format("trace {} has simulations from {}.{} to {}.{}", trace, trace,
                            samples.first, trace, samples.second));
  }
  if (first_and_last.empty()) report.note("its journal holds no simulation yet");
}

}  // namespace

std::optional<SampleId> parse_sample_id(std::string_view text) {
  const auto dot = text.find('.');
  if (dot == std::string_view::npos) return std::nullopt;
  const auto trace = positive(text.substr(0, dot));
  const auto sample = positive(text.substr(dot + 1));
  if (!trace || !sample) return std::nullopt;
  return SampleId{*trace, *sample};
}

ReplayResult replay_sample(const RecordedRun& run, const std::string& scenario_hash,
                           const SimulatorFactory& make_simulator,
                           std::optional<Recording>* moved) {
  const auto& record = run.record;
  ReplayResult result;
  result.id = run.id;
  result.seed = record.seed;
  result.digest = record.digest;
  result.timepoints = record.observations.size();
  result.outcome = ReplayOutcome::kCannot;
  result.reason = scenario_change(run.header, scenario_hash);
  if (result.reason.empty() && record.status == SampleStatus::kLost) {
    result.reason = "the simulator was lost in this simulation, so there is nothing to compare";
  }
  if (!result.reason.empty()) return result;
  const auto simulator = make_simulator();
  const auto info = simulator->info();
  result.reason = simulator_change(run.header, info);
  if (!result.reason.empty()) return result;
  MotionTap tap(*simulator, moved != nullptr);
  const auto again =
      repeat_sample(run.line.calls, may_repeat_losses(info), record, tap, [] { return false; });
  if (again->status != SampleStatus::kOk) {
    result.reason =
        fmt::format("the simulator was {}: {}", to_string(again->status), again->reason);
    return result;
  }
  if (moved != nullptr) {
    std::vector<std::string> events;
    for (std::size_t t = 0; t < run.line.trace->event_count(); ++t) {
      events.push_back(run.line.trace->event(t));
    }
    *moved = recording_of(info, *again, events, tap.log());
  }
  result.outcome = ReplayOutcome::kIdentical;
  if (auto differs = first_difference(record, *again)) {
    result.outcome = ReplayOutcome::kDiffers;
    result.difference =
        ReplayDifference{differs->timepoint, differs->variable, differs->a, differs->b};
  }
  return result;
}

std::optional<SampleId> default_sample(const JournalText& journal) {
  std::optional<SampleId> first;
  for (const auto& [key, record] : journal.samples) {
    if (record.status != SampleStatus::kOk) continue;
    if (record.phase == DrawPhase::kConfirm) return SampleId{record.trace, record.sample};
    if (!first) first = SampleId{record.trace, record.sample};
  }
  return first;
}

namespace {

/// The performs of an executed plan as a trace: its events and what was asked of the simulator.
TraceLine line_of(const SampleRecord& record) {
  auto symbols = std::make_shared<compiler::SymbolTable>();
  auto trace = std::make_shared<CampaignTrace>();
  TraceLine line;
  trace->number = record.trace;
  for (std::size_t t = 0; t <= record.outcomes.size(); ++t) {
    std::vector<std::string> happens;
    if (t < record.outcomes.size()) {
      const auto& step = record.path->steps[t];
      happens.push_back(step.event);
      trace->plan.push_back({step.source, {}});
      trace->key += step.event + ";";
      line.calls.push_back(step.call);
    }
    trace->points.push_back(runtime::point_of_names({}, happens, *symbols));
  }
  trace->symbols = std::move(symbols);
  line.trace = std::move(trace);
  return line;
}

}  // namespace

RecordedRun recorded_run(const JournalText& journal, SampleId id) {
  PARALLAX_REQUIRE(journal.header.has_value(), "a journal with records has a header");
  const SampleKey key(id.trace, id.sample, DrawPhase::kCertify);
  const auto& record = journal.samples.at(key);
  if (record.path) {
    const auto place = journal.places.at(key);
    return {*journal.header, id, record, line_of(record), place, place};
  }
  return {*journal.header,
          id,
          record,
          journal.line_of(record),
          journal.places.at(key),
          journal.line_place_of(record)};
}

base::Result<RecordedRun> read_recorded_run(const std::filesystem::path& run_dir,
                                            std::optional<SampleId> id, base::SourceFiles& files,
                                            base::DiagnosticSink& sink) {
  const auto journal = read_journal(run_dir, files, sink);
  if (!journal) return sink.already_reported();
  if (!journal->header) return sink.error_about(codes::kNoJournal, run_dir.string());
  if (!id) id = default_sample(*journal);
  const auto found = id ? journal->samples.find({id->trace, id->sample, DrawPhase::kCertify})
                        : journal->samples.end();
  if (found == journal->samples.end()) {
    const auto name = id ? fmt::format("{}.{}", id->trace, id->sample) : std::string("at all");
    auto report = sink.error_about(codes::kNoSuchSample, run_dir.string(), name);
    note_samples(*journal, report);
    return report;
  }
  return recorded_run(*journal, *id);
}

std::string scenario_change(const JournalHeader& header, const std::string& scenario_hash) {
  if (header.scenario_hash == scenario_hash) return {};
  return fmt::format(
      "the scenario, or a file that it reads, has changed: its hash was {}, now it is {}",
      header.scenario_hash, scenario_hash);
}

std::string simulator_change(const JournalHeader& header, const SimulatorInfo& simulator) {
  if (simulator.name.empty()) {
    return fmt::format("the simulator did not start: {}", simulator.version);
  }
  if (header.simulator.name != simulator.name || header.simulator.version != simulator.version) {
    return fmt::format("it was recorded with {} {}, this is {} {}", header.simulator.name,
                       header.simulator.version, simulator.name, simulator.version);
  }
  return {};
}

}  // namespace parallax::harness
