#include <memory>
#include <utility>

#include "compiler/base/hash.h"
#include "harness/campaign/sample_maker.h"
#include "tools/app/evidence.h"
#include "tools/app/extra_runs.h"

namespace parallax::tools {
namespace {

using harness::DrawPhase;
using harness::SampleRecord;

/// One recorded simulation with other seeds.
class OtherSeeds final : public harness::SampleMaker {
 public:
  OtherSeeds(SampleRecord record, std::vector<harness::ActionCall> calls, bool repeats_losses)
      : record_(std::move(record)), calls_(std::move(calls)), repeats_losses_(repeats_losses) {}

  std::optional<SampleRecord> make(std::int64_t sample, harness::Simulator& simulator,
                                   const std::function<bool()>& abandoned) const override {
    auto record = record_;
    record.sample = sample;
    record.rejected = 0;
    record.seed =
        harness::simulator_seed({record_.seed, base::fnv1a64("other seeds"), DrawPhase::kCertify,
                                 static_cast<std::uint64_t>(sample), 0});
    auto again = harness::repeat_sample(calls_, repeats_losses_, record, simulator, abandoned);
    if (!again) return again;
    again->phase = DrawPhase::kCertify;
    if (again->path) told_anew(*again);
    return again;
  }
  std::optional<SampleRecord> repeat(const SampleRecord& record, harness::Simulator& simulator,
                                     const std::function<bool()>& abandoned) const override {
    return harness::repeat_sample(calls_, repeats_losses_, record, simulator, abandoned);
  }

 private:
  /// Sets the outcomes of the performs as the plan would be told them.
  static void told_anew(SampleRecord& record) {
    for (std::size_t i = 0; i < record.outcomes.size(); ++i) {
      auto& step = record.path->steps[i];
      step.succeeded = record.outcomes[i].status == harness::SimStatus::kOk;
      if (step.succeeded) step.condition.clear();
    }
  }

  SampleRecord record_;
  std::vector<harness::ActionCall> calls_;
  bool repeats_losses_;
};

/// The recorded failure and its actions; of an executed plan, which would go on otherwise, those up
/// to where it went wrong.
SampleRecord failing_record(const RecordedDiscrepancy& found,
                            std::vector<harness::ActionCall>& calls) {
  const auto& id = found.path.id;
  auto record = found.journal.samples.at({id.trace, id.sample, DrawPhase::kCertify});
  if (!record.path) {
    calls = found.journal.line_of(record).calls;
    record.start_state = 0;  // the folder has the trace from this state only
    return record;
  }
  auto& path = *record.path;
  path.steps.resize(std::min(path.steps.size(), found.parting->after));
  path.end = harness::PathEnd::kCut;
  path.detail.clear();
  for (const auto& step : path.steps) calls.push_back(step.call);
  return record;
}

}  // namespace

base::Result<SameStart> same_start_runs(const std::string& run_dir,
                                        const RecordedDiscrepancy& found,
                                        const ScenarioModel& as_run,
                                        const harness::SimulatorFactory& make_simulator,
                                        const harness::SimulatorFactory& half_step,
                                        const FurtherRunsOptions& options, Context& context) {
  auto& sink = context.sink();
  SameStart out;
  const ExtraRunsOptions extra{options.jobs, options.repeats, options.progress};
  const auto again = [&](const char* folder, const harness::SimulatorFactory& simulator,
                         std::optional<harness::Persistence>& seen) -> base::Status {
    auto runs = ExtraRuns::open({run_dir, folder, *found.journal.header}, as_run, simulator, extra,
                                context);
    if (!runs) return sink.already_reported();
    if (*runs == nullptr) return base::Unit{};
    const auto& info = (*runs)->bench().simulator();
    out.has_seeds = info.seeds;
    const bool draws_anew = options.without_seeds && info.determinism != "bitwise";
    if (!info.seeds && !draws_anew && folder == std::string_view(kOtherSeeds)) return base::Unit{};
    std::vector<harness::ActionCall> calls;
    auto record = failing_record(found, calls);
    // The state that the trace, or the execution, begins in, as the simulator shows it.
    const auto& id = found.path.id;
    harness::CampaignTrace start;
    start.number = id.trace;
    start.points.resize(1);
    auto symbols = std::make_shared<compiler::SymbolTable>(as_run.compilation.model);
    const auto& names = found.loaded.compilation.model.fluents;
    std::vector<std::string> holds;
    for (const auto& [fluent, value] : found.path.states.front()) {
      if (value) holds.push_back(names[fluent.index()].name);
    }
    start.points.front() = runtime::point_of_names(holds, {}, *symbols);
    start.symbols = std::move(symbols);
    const auto maker = std::make_shared<const OtherSeeds>(std::move(record), std::move(calls),
                                                          harness::may_repeat_losses(info));
    const bool executed = found.path.executed;
    std::optional<harness::TraceLine> line;
    if (!executed) {
      const harness::SampleKey failing(id.trace, found.path.id.sample, DrawPhase::kCertify);
      line = found.journal.line_of(found.journal.samples.at(failing));
    }
    if (line) line->start_state = 0;
    const auto made = (*runs)->make(
        {line ? &*line : nullptr, maker, std::make_shared<const harness::CampaignTrace>(start)}, 1,
        options.repeats);
    if (!made) return sink.already_reported();
    std::vector<SampleRecord> records;
    for (const auto& [key, one] : (*runs)->samples()) {
      if (one.sample > options.repeats) continue;  // an earlier call made more
      if (one.status == harness::SampleStatus::kOk) records.push_back(one);
    }
    if (!context.stopped() && !(*runs)->close()) return sink.already_reported();
    const auto counted = count_failures(found, records, context);
    if (!counted) return sink.already_reported();
    seen = *counted;
    return base::Unit{};
  };
  if (!again(kOtherSeeds, make_simulator, out.other_seeds)) return sink.already_reported();
  if (half_step && !context.stopped() && !again(kHalfStep, half_step, out.half_step)) {
    return sink.already_reported();
  }
  return out;
}

}  // namespace parallax::tools
