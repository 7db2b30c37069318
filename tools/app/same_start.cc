#include <algorithm>
#include <iterator>
#include <memory>
#include <set>
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
  /// Sample `first` has the seed seeds[0], and so on.
  OtherSeeds(SampleRecord record, std::vector<harness::ActionCall> calls, bool repeats_losses,
             std::int64_t first, std::vector<std::uint64_t> seeds)
      : record_(std::move(record)),
        calls_(std::move(calls)),
        repeats_losses_(repeats_losses),
        first_(first),
        seeds_(std::move(seeds)) {}

  std::optional<SampleRecord> make(std::int64_t sample, harness::Simulator& simulator,
                                   const std::function<bool()>& abandoned) const override {
    auto record = record_;
    record.sample = sample;
    record.rejected = 0;
    record.seed = seeds_[static_cast<std::size_t>(sample - first_)];
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
  std::int64_t first_;
  std::vector<std::uint64_t> seeds_;
};

std::uint64_t other_seed(const SampleRecord& record, std::int64_t number) {
  return harness::simulator_seed({record.seed, base::fnv1a64("other seeds"), DrawPhase::kCertify,
                                  static_cast<std::uint64_t>(number), 0});
}

const SampleRecord& failing_of(const RecordedDiscrepancy& found) {
  const auto& id = found.path.id;
  return found.journal.samples.at({id.trace, id.sample, DrawPhase::kCertify});
}

/// The recorded failure and its actions; of an executed plan, which would go on otherwise, those up
/// to where it went wrong.
SampleRecord failing_record(const RecordedDiscrepancy& found,
                            std::vector<harness::ActionCall>& calls) {
  auto record = failing_of(found);
  if (!record.path) {
    calls = found.journal.line_of(record).calls;
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

std::vector<SampleRecord> of_same_start(const RecordedDiscrepancy& found,
                                        const std::vector<SampleRecord>& records) {
  const auto& failing = failing_of(found);
  std::vector<SampleRecord> out;
  std::copy_if(records.begin(), records.end(), std::back_inserter(out), [&](const auto& one) {
    return one.status == harness::SampleStatus::kOk && one.trace == failing.trace &&
           one.start_state == failing.start_state && one.initial == failing.initial &&
           one.path.has_value() == failing.path.has_value();
  });
  return out;
}

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
    std::set<std::uint64_t> seeds;
    for (std::int64_t i = 1; i <= options.repeats; ++i) seeds.insert(other_seed(record, i));
    const auto is_one = [&](const SampleRecord& one) {
      return one.trace == record.trace && one.start_state == record.start_state &&
             one.initial == record.initial && seeds.contains(one.seed);
    };
    std::int64_t next = 1;
    auto missing = seeds;
    for (const auto& [key, one] : (*runs)->samples()) {
      next = std::max(next, one.sample + 1);
      if (is_one(one)) missing.erase(one.seed);
    }
    std::vector<std::uint64_t> fresh;
    for (std::int64_t i = 1; i <= options.repeats; ++i) {
      if (missing.contains(other_seed(record, i))) fresh.push_back(other_seed(record, i));
    }
    const auto last = next + std::ssize(fresh) - 1;
    const auto maker = std::make_shared<const OtherSeeds>(
        record, std::move(calls), harness::may_repeat_losses(info), next, std::move(fresh));
    ExtraRuns::Stream stream{nullptr, maker, std::make_shared<const harness::CampaignTrace>(start)};
    if (!found.path.executed) {
      stream.line = &found.journal.line_of(failing_of(found));
      if (stream.line->start_state > 1) stream.first = &found.journal.traces.at(id.trace);
    }
    if (!missing.empty()) {
      const auto made = (*runs)->make(stream, next, last);
      if (!made) return sink.already_reported();
    }
    std::vector<SampleRecord> records;
    for (const auto& [key, one] : (*runs)->samples()) {
      if (is_one(one) && one.status == harness::SampleStatus::kOk) records.push_back(one);
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
