#include <algorithm>
#include <memory>

#include "harness/campaign/loop_judge.h"
#include "harness/campaign/loop_stream.h"
#include "tools/app/closed_loop.h"
#include "tools/app/evidence.h"
#include "tools/app/extra_runs.h"

namespace parallax::tools {
namespace {

using harness::DrawPhase;
using harness::SampleStatus;

/// Size of a batch, whatever the number of workers.
constexpr std::int64_t kAtOnce = 5;
constexpr const char* kWhy = "to tell the kind of cause";

std::int64_t last_sample(const harness::JournalText& journal) {
  std::int64_t last = 0;
  for (const auto& [key, record] : journal.samples) last = std::max(last, record.sample);
  return last;
}

}  // namespace

base::Result<FurtherRecords> further_executions(const std::string& run_dir,
                                                const RecordedDiscrepancy& found,
                                                const ScenarioModel& as_run,
                                                const harness::SimulatorFactory& make_simulator,
                                                const FurtherRunsOptions& options,
                                                Context& context) {
  auto& sink = context.sink();
  FurtherRecords out;
  const ExtraRunsOptions extra{options.jobs, options.runs, options.progress};
  auto runs = ExtraRuns::open({run_dir, kFurtherRuns, *found.journal.header}, as_run,
                              make_simulator, extra, context);
  auto loop = ClosedLoop::make(as_run, context);
  if (!runs || !loop) return sink.already_reported();
  if (*runs == nullptr) return out;
  harness::LoopStream stream(as_run.scenario, **loop, (*runs)->bench(), (*runs)->seed(), sink);
  const auto prepared = stream.prepare();
  if (!prepared) return sink.already_reported();
  if (!*prepared) return out;
  const harness::SampleKey key(found.path.id.trace, found.path.id.sample, DrawPhase::kCertify);
  const auto start = found.journal.samples.at(key).path->start;
  const auto maker = std::make_shared<const harness::GuidedSample>(
      stream.samples(), harness::GuidedStart{start, kWhy});
  const auto& state = stream.samples()->starts()[static_cast<std::size_t>(start) - 1].state;
  const auto& scenario = as_run.scenario;
  const auto first = last_sample(found.journal) + 1;
  std::int64_t made = 0, failures = 0, clean = 0;
  while (!is_enough(options, failures, clean) && made < options.runs) {
    const auto batch = std::min(kAtOnce, options.runs - made);
    const auto goes_on =
        (*runs)->make({nullptr, maker, state}, first + made, first + made + batch - 1);
    if (!goes_on) return sink.already_reported();
    if (!*goes_on) break;
    for (std::int64_t i = 0; i < batch; ++i, ++made) {
      const auto& record = (*runs)->samples().at({1, first + made, DrawPhase::kCertify});
      if (record.status != SampleStatus::kOk) continue;
      const auto judged = harness::judge_path(*scenario.mapping, (*runs)->bench().fluents(), **loop,
                                              record, scenario.comparison());
      ++(judged.admitted == base::Known::kNo ? failures : clean);
      out.samples.push_back(record);
    }
  }
  if (!context.stopped() && !(*runs)->close()) return sink.already_reported();
  return out;
}

}  // namespace parallax::tools
