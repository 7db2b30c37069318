#include "harness/campaign/recorded_run.h"

#include <fmt/format.h>

#include "compiler/base/diagnostic_codes.h"

namespace parallax::harness {

std::optional<SampleId> default_sample(const JournalText& journal) {
  std::optional<SampleId> first;
  for (const auto& [key, record] : journal.samples) {
    if (record.status != SampleStatus::kOk) continue;
    if (record.phase == DrawPhase::kConfirm) return SampleId{record.trace, record.sample};
    if (!first) first = SampleId{record.trace, record.sample};
  }
  return first;
}

base::Result<RecordedRun> read_recorded_run(const std::filesystem::path& run_dir,
                                            std::optional<SampleId> id, base::SourceFiles& files,
                                            base::DiagnosticSink& sink) {
  using base::DiagnosticCode;
  const auto journal = read_journal(run_dir, files, sink);
  if (!journal) return sink.already_reported();
  if (!journal->header) return sink.error_about(DiagnosticCode::kNoJournal, run_dir.string());
  if (!id) id = default_sample(*journal);
  const auto found = id ? journal->samples.find({id->trace, id->sample, DrawPhase::kCertify})
                        : journal->samples.end();
  if (found == journal->samples.end()) {
    const auto name = id ? fmt::format("{}.{}", id->trace, id->sample) : std::string("at all");
    return sink.error_about(DiagnosticCode::kNoSuchSample, run_dir.string(), name);
  }
  const auto& trace = journal->traces.at(found->second.trace);
  return RecordedRun{*journal->header, *id, found->second, trace.calls, trace.events};
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
