#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/write_gate.h"
#include "harness/campaign/trial.h"
#include "tools/app/evidence.h"
#include "tools/app/trace_feed.h"

namespace parallax::tools {
namespace {

using harness::DrawPhase;
using harness::SampleRecord;

class FurtherRuns {
 public:
  FurtherRuns(const RecordedDiscrepancy& found, const ScenarioModel& as_run,
              const FurtherRunsOptions& options, Context& context)
      : found_(found),
        scenario_(as_run.scenario),
        options_(options),
        context_(context),
        feed_(as_run, context,
              {.all_hits = found.journal.header->asked.all_hits,
               .split_initial = found.journal.header->asked.split_initial}) {
    // Judged as the run was.
    scenario_.compare = recorded_comparison(*found.journal.header).value_or(scenario_.comparison());
  }

  base::Result<FurtherRecords> run(const std::string& run_dir,
                                   const harness::SimulatorFactory& make_simulator) {
    auto& sink = context_.sink();
    auto journal = open(run_dir);
    if (!journal) return sink.already_reported();
    harness::TrialBench bench(
        scenario_, feed_, make_simulator,
        {found_.journal.header->seed, options_.jobs, &context_.stop()},
        [&](const SampleRecord& record) { (*journal)->append(record); }, sink);
    const auto started = bench.start();
    if (!started) return sink.already_reported();
    if (!*started) return FurtherRecords();
    auto trace = this_trace();
    if (!trace) return sink.already_reported();
    if (!*trace) return FurtherRecords();
    auto trial = harness::Trial::prepare(bench, *std::move(*trace));
    if (!trial) return sink.already_reported();
    if (!check_draws(**journal, trial->plan())) return sink.already_reported();
    trial->continue_from(**journal);
    if ((*journal)->find(found_.path.id.trace) == nullptr) {
      (*journal)->append(found_.journal.traces.at(found_.path.id.trace));
    }
    trial->announce_by([&](const harness::TracePlan& plan) { return announce(**journal, plan); });
    if (!sample(**journal, bench, *trial)) return sink.already_reported();
    trial->end();
    bench.close();
    const auto error = (*journal)->write_error();
    if (!error.empty()) {
      return sink.error_about(codes::kFileNotWritable, run_dir, error);
    }
    return std::move(made_);
  }

 private:
  /// Opens the journal of further runs with the run's own records in it, so that none is made
  /// again.
  base::Result<std::unique_ptr<harness::Journal>> open(const std::string& run_dir) {
    auto& sink = context_.sink();
    const auto& header = *found_.journal.header;
    const auto place = std::filesystem::path(run_dir) / kFurtherRuns;
    if (!base::check_unnamed_output(place, run_dir, "another run folder", sink)) {
      return sink.already_reported();
    }
    auto folder = harness::RunFolder::claim(place, true, sink);
    if (!folder) return sink.already_reported();
    auto recorded = harness::read_for_continuation(*folder, header, context_.files(), sink);
    if (!recorded) return sink.already_reported();
    auto journal =
        harness::Journal::open(*std::move(folder), header, *std::move(recorded),
                               scenario_.limits.max_lost_in_a_row, context_.files(), sink);
    if (!journal) return sink.already_reported();
    std::map<harness::SampleKey, SampleRecord> samples;
    for (const auto& [key, record] : found_.journal.samples) {
      if (record.trace != found_.path.id.trace || record.phase != DrawPhase::kCertify) continue;
      samples.emplace(key, record);
      last_ = std::max(last_, record.sample);
    }
    (*journal)->know(samples);
    return journal;
  }

  /// None if the trace is not found again: it belongs to a run with other options.
  base::Result<std::optional<harness::CampaignTrace>> this_trace() {
    const auto& id = found_.path.id;
    while (true) {
      auto trace = feed_.next();
      if (!trace || !*trace) return trace;
      if ((*trace)->key == found_.journal.traces.at(id.trace).trace->key) {
        (*trace)->number = id.trace;
        return trace;
      }
      if ((*trace)->number >= id.trace) return std::optional<harness::CampaignTrace>();
    }
  }

  /// Writes the trace from another initial state down before the first simulation of it.
  base::Status announce(harness::Journal& journal, const harness::TracePlan& plan) {
    if (!check_draws(journal, plan)) return context_.sink().already_reported();
    const auto number = plan.trace->number;
    harness::TraceLine line{plan.trace, plan.calls, plan.start_state, {}};
    if (journal.find(number, plan.start_state) == nullptr) {
      journal.append(line);
    }
    made_.starts.emplace(harness::StartKey(number, plan.start_state), std::move(line));
    return base::Unit{};
  }

  /// Recorded samples must be the draws for their numbers.
  base::Status check_draws(const harness::Journal& journal, const harness::TracePlan& plan) {
    for (const auto& [key, record] : journal.recorded().samples) {
      const auto place = journal.recorded().places.find(key);
      if (place == journal.recorded().places.end() || is_recorded(record)) continue;
      if (record.start_state != plan.start_state) continue;
      const auto why =
          harness::wrong_draw(record, plan.sampler, plan.campaign_seed, plan.trace_key);
      if (why.empty()) continue;
      return context_.sink().error(codes::kForeignJournalLine, place->second, why);
    }
    return base::Unit{};
  }

  bool is_recorded(const SampleRecord& record) const {
    return found_.journal.samples.contains({record.trace, record.sample, record.phase});
  }

  base::Status sample(const harness::Journal& journal, const harness::TrialBench& bench,
                      harness::Trial& trial) {
    const auto started = std::chrono::steady_clock::now();
    std::int64_t failures = 0, clean = 0, made = 0;
    // Initial states are drawn as the run drew them, so that its own samples are found on record.
    const auto& asked = found_.journal.header->asked;
    if (asked.search.runs > 0) trial.begin_after(asked.search.runs);
    if (asked.criterion == harness::CriterionKind::kClopperPearson) trial.draw_independently();
    while (!is_enough(options_, failures, clean) && made < options_.runs) {
      // Samples on record count as failures or clean runs, but not towards the limit of runs.
      const auto ahead = std::min(options_.jobs == 1 ? 1 : 2 * options_.jobs, options_.runs - made);
      const auto next = trial.next_sample();
      if (next > last_) trial.submit_to(next + ahead - 1);
      const auto* known = journal.find(found_.path.id.trace, next, DrawPhase::kCertify);
      auto sample =
          known != nullptr && known->visit ? trial.visit(known->start_state) : trial.next();
      if (!sample) return context_.sink().already_reported();
      if (!*sample || (*sample)->verdict == harness::SampleVerdict::kLostTooOften) break;
      const auto verdict = (*sample)->verdict;
      const bool is_lost = verdict == harness::SampleVerdict::kLost;
      if (!is_lost) ++(verdict == harness::SampleVerdict::kDiscrepancy ? failures : clean);
      if (is_lost && !(*sample)->record.visit) trial.draw_independently();
      if (is_recorded((*sample)->record)) continue;
      ++made;
      if (!journal.write_error().empty()) break;
      if (!is_lost) made_.samples.push_back(std::move((*sample)->record));
      if (!options_.progress) continue;
      const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - started;
      const auto rate = static_cast<double>(bench.runs_made()) / std::max(elapsed.count(), 1e-9);
      options_.progress({found_.path.id.trace, made, options_.runs, rate});
    }
    return base::Unit{};
  }

  const RecordedDiscrepancy& found_;
  harness::Scenario scenario_;
  const FurtherRunsOptions& options_;
  Context& context_;
  EnumeratedTraces feed_;
  FurtherRecords made_;
  std::int64_t last_ = 0;  // sample of the run
};

}  // namespace

base::Result<FurtherRecords> further_runs(const std::string& run_dir,
                                          const RecordedDiscrepancy& found,
                                          const ScenarioModel& as_run,
                                          const harness::SimulatorFactory& make_simulator,
                                          const FurtherRunsOptions& options, Context& context) {
  return FurtherRuns(found, as_run, options, context).run(run_dir, make_simulator);
}

}  // namespace parallax::tools
