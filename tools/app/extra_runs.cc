#include "tools/app/extra_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <limits>
#include <utility>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/write_gate.h"
#include "harness/campaign/judge.h"
#include "harness/campaign/start_check.h"

namespace parallax::tools {

using harness::DrawPhase;
using harness::SampleRecord;
using harness::SampleStatus;

base::Result<std::unique_ptr<ExtraRuns>> ExtraRuns::open(
    const ExtraFolder& folder, const ScenarioModel& as_run,
    const harness::SimulatorFactory& make_simulator, const ExtraRunsOptions& options,
    Context& context) {
  auto& sink = context.sink();
  const auto place = std::filesystem::path(folder.run_dir) / folder.name;
  std::error_code ignored;
  if (std::filesystem::is_symlink(place, ignored)) {
    return sink.error_about(codes::kFileNotWritable, place.string(),
                            "it is a link, which may lead out of the run folder");
  }
  if (!base::check_unnamed_output(place, folder.run_dir, "another run folder", sink)) {
    return sink.already_reported();
  }
  auto claimed = harness::RunFolder::claim(place, true, sink);
  if (!claimed) return sink.already_reported();
  auto recorded = harness::read_for_continuation(*claimed, folder.header, context.files(), sink);
  if (!recorded) return sink.already_reported();
  std::unique_ptr<ExtraRuns> out(new ExtraRuns(as_run, options, context));
  out->header_ = folder.header;
  out->traces_ = recorded->traces;
  out->starts_ = recorded->starts;
  auto* self = out.get();
  out->bench_ = std::make_unique<harness::SimulatorBench>(
      as_run.scenario, *out->symbols_, make_simulator,
      harness::TrialOptions{folder.header.seed, options.jobs, &context.stop()},
      [self](const SampleRecord& record) {
        const bool is_result =
            record.status == SampleStatus::kOk || record.status == SampleStatus::kLost;
        if (is_result) self->journal_->append(record);
      },
      sink);
  const auto started = out->bench_->start();
  if (!started) return sink.already_reported();
  if (!*started) return std::unique_ptr<ExtraRuns>();
  auto journal =
      harness::Journal::open(*std::move(claimed), folder.header, *std::move(recorded),
                             as_run.scenario.limits.max_lost_in_a_row, context.files(), sink);
  if (!journal) return sink.already_reported();
  out->journal_ = *std::move(journal);
  out->samples_ = out->journal_->recorded().samples;
  return out;
}

harness::CampaignTrace ExtraRuns::in_symbols(const harness::CampaignTrace& trace) const {
  auto symbols = std::make_shared<compiler::SymbolTable>(*symbols_);
  harness::CampaignTrace out = trace;
  for (std::size_t t = 0; t < trace.points.size(); ++t) {
    const auto strings = [](const runtime::Names& names) {
      return std::vector<std::string>(names.begin(), names.end());
    };
    auto point =
        runtime::point_of_names(strings(trace.holds(t)), strings(trace.happens(t)), *symbols);
    out.points[t].holds = std::move(point.holds);
    out.points[t].happens = std::move(point.happens);
    out.points[t].released.clear();
  }
  out.symbols = std::move(symbols);
  return out;
}

base::Result<harness::PreparedTrace> ExtraRuns::prepare_start(const harness::CampaignTrace& trace) {
  harness::CampaignTrace start = trace;
  start.points.resize(1);
  start.points.front().happens.clear();
  start.plan.clear();
  return harness::prepare_trace(scenario(), bench_->fluents().ground(), bench_->simulator(), start,
                                context_.sink());
}

const harness::TraceLine* ExtraRuns::find_line(std::int64_t trace, std::int64_t start_state) const {
  if (start_state > 1) {
    const auto found = starts_.find({trace, start_state});
    return found == starts_.end() ? nullptr : &found->second;
  }
  const auto found = traces_.find(trace);
  return found == traces_.end() ? nullptr : &found->second;
}

void ExtraRuns::announce(const harness::TraceLine& line) {
  const auto trace = line.trace->number;
  const bool is_new = line.start_state > 1
                          ? starts_.emplace(harness::StartKey(trace, line.start_state), line).second
                          : traces_.emplace(trace, line).second;
  if (is_new) journal_->append(line);
}

base::Result<bool> ExtraRuns::make(const Stream& stream, std::int64_t first, std::int64_t last) {
  const auto trace = stream.line == nullptr ? 1 : stream.line->trace->number;
  if (stream.first != nullptr) announce(*stream.first);
  if (stream.line != nullptr) announce(*stream.line);
  std::vector<std::int64_t> missing;
  for (auto sample = first; sample <= last; ++sample) {
    if (samples_.contains({trace, sample, DrawPhase::kCertify})) continue;
    missing.push_back(sample);
    bench_->pool().submit(stream.maker, sample);
  }
  const auto started = std::chrono::steady_clock::now();
  const auto made_before = bench_->runs_made();
  for (const auto sample : missing) {
    auto record = bench_->pool().wait(sample, DrawPhase::kCertify);
    if (!record) return false;
    const auto kept = keep(*std::move(record), stream);
    if (!kept || !*kept) {
      bench_->pool().abandon();
      return kept;
    }
    ++made_;
    if (!options_.progress) continue;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - started;
    const auto rate =
        static_cast<double>(bench_->runs_made() - made_before) / std::max(elapsed.count(), 1e-9);
    options_.progress({trace, made_, options_.most, rate});
  }
  bench_->pool().abandon();  // the results of another stream have the same numbers
  return true;
}

base::Result<bool> ExtraRuns::keep(SampleRecord record, const Stream& stream) {
  const auto& start = *stream.start;
  auto& sink = context_.sink();
  const auto in = fmt::format("in simulation {}.{}", record.trace, record.sample);
  rejected_ = record.status == SampleStatus::kRejected;
  if (rejected_ && stream.chosen) {
    samples_.emplace(harness::SampleKey(record.trace, record.sample, record.phase),
                     std::move(record));
    return true;
  }
  if (rejected_) {
    return report_rejected(scenario(), start, record.rejected, record.sample, record.reason, sink);
  }
  if (record.status == SampleStatus::kRefused) {
    return sink.error(codes::kSimulatorRefused, scenario().actions_source,
                      fmt::format("refused the start or an action {}", in), record.reason);
  }
  const auto error = journal_->write_error();
  if (!error.empty()) return sink.error_about(codes::kFileNotWritable, "", error);
  if (record.status == SampleStatus::kLost) {
    const bool too_often = bench_->lost_too_often(record, false);
    samples_.emplace(harness::SampleKey(record.trace, record.sample, record.phase),
                     std::move(record));
    return !too_often;
  }
  const auto first =
      harness::judge(*scenario().mapping, bench_->fluents(), start, {record.observations.front()});
  if (first.missing.empty() && first.first_divergence && !stream.chosen) {
    return report_other_start(scenario(), record, first.first.front(), sink);
  }
  bench_->end_row_of_losses();
  samples_.emplace(harness::SampleKey(record.trace, record.sample, record.phase),
                   std::move(record));
  return true;
}

base::Status ExtraRuns::close() {
  bench_->close();
  std::vector<harness::TraceLine> lines;
  for (const auto& [number, line] : traces_) {
    lines.push_back(line);
    const auto end = starts_.upper_bound({number, std::numeric_limits<std::int64_t>::max()});
    for (auto at = starts_.lower_bound({number, 0}); at != end; ++at) lines.push_back(at->second);
  }
  std::vector<SampleRecord> records;
  for (const auto& [key, record] : samples_) {
    if (record.status != SampleStatus::kRejected) records.push_back(record);  // it is no result
  }
  return journal_->rewrite(lines, std::move(records), context_.sink());
}

}  // namespace parallax::tools
