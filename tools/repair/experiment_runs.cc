#include "tools/repair/experiment_runs.h"

#include <algorithm>
#include <set>
#include <utility>

#include "compiler/base/hash.h"
#include "harness/campaign/loop_samples.h"
#include "harness/campaign/sample_runner.h"

namespace parallax::tools {
namespace {

/// Most samples of one experiment: enough for the open outcomes of the world to show, and a bound
/// where nothing is open.
constexpr std::int64_t kMostInModel = 5, kMostInPhysics = 20;
constexpr const char* kTarget = "to tell proposals of repair apart";

}  // namespace

base::Result<std::unique_ptr<ExperimentRuns>> ExperimentRuns::open(
    const ExtraFolder& folder, const ScenarioModel& as_run, std::int64_t last_sample,
    const harness::SimulatorFactory& make_simulator, const ExtraRunsOptions& options,
    Context& context) {
  auto& sink = context.sink();
  auto runs = ExtraRuns::open(folder, as_run, make_simulator, options, context);
  if (!runs) return sink.already_reported();
  if (*runs == nullptr) return std::unique_ptr<ExperimentRuns>();
  std::unique_ptr<ExperimentRuns> out(new ExperimentRuns(as_run, last_sample, context));
  out->runs_ = *std::move(runs);
  if (as_run.scenario.execution == harness::Execution::kClosedLoop) {
    const auto prepared = out->prepare_loop();
    if (!prepared) return sink.already_reported();
    if (!*prepared) return std::unique_ptr<ExperimentRuns>();
  }
  return out;
}

base::Result<bool> ExperimentRuns::prepare_loop() {
  auto loop = ClosedLoop::make(as_run_, context_);
  if (!loop) return context_.sink().already_reported();
  loop_ = *std::move(loop);
  stream_ = std::make_unique<harness::LoopStream>(as_run_.scenario, *loop_, runs_->bench(),
                                                  runs_->seed(), context_.sink());
  return stream_->prepare();
}

/// The initial state of executions that looks like the trace's.
std::optional<std::int64_t> ExperimentRuns::state_of(const harness::CampaignTrace& trace) const {
  const auto& mapping = *as_run_.scenario.mapping;
  std::set<std::string> compared;
  for (const auto& fluent : runs_->bench().fluents().ground()) {
    const auto* binding = mapping.find(fluent.symbol);
    if (binding != nullptr && !binding->is_ignored()) compared.insert(fluent.text);
  }
  std::vector<std::string> wanted;
  for (const auto& name : trace.holds(0)) {
    if (compared.contains(std::string(name))) wanted.emplace_back(name);
  }
  const auto& starts = stream_->samples()->starts();
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const auto names = starts[i].state->holds(0);
    if (std::equal(names.begin(), names.end(), wanted.begin(), wanted.end())) {
      return static_cast<std::int64_t>(i) + 1;
    }
  }
  return std::nullopt;
}

std::int64_t ExperimentRuns::samples_of(std::int64_t trace) const {
  const auto& samples = runs_->samples();
  return std::count_if(samples.begin(), samples.end(),
                       [&](const auto& entry) { return entry.second.trace == trace; });
}

bool ExperimentRuns::usable(const harness::CampaignTrace& trace) const {
  if (no_start_.contains(trace.key)) return false;
  const auto most = as_run_.world != nullptr ? kMostInModel : kMostInPhysics;
  if (stream_ != nullptr) {
    const auto state = state_of(trace);
    const auto& samples = runs_->samples();
    return state && std::count_if(samples.begin(), samples.end(), [&](const auto& entry) {
                      return entry.second.path->start == *state;
                    }) < most;
  }
  for (const auto& [number, line] : runs_->traces()) {
    if (line.trace->key == trace.key) return samples_of(number) < most;
  }
  return true;
}

base::Result<bool> ExperimentRuns::batch(const harness::TraceLine& line, std::int64_t budget) {
  auto& sink = context_.sink();
  auto prepared = runs_->prepare_start(*line.trace);
  if (!prepared) return sink.already_reported();
  auto start = std::make_shared<harness::CampaignTrace>(*line.trace);
  start->points.resize(1);
  start->points.front().happens.clear();
  start->plan.clear();
  auto plan = std::make_shared<const harness::TracePlan>(harness::TracePlan{
      line.trace, line.calls, std::move(prepared->sampler), runs_->seed(),
      base::fnv1a64(line.trace->key), as_run_.scenario.limits.max_rejected_starts,
      harness::may_repeat_losses(runs_->bench().simulator())});
  const auto maker = std::make_shared<const harness::TraceSamples>(std::move(plan));
  const auto done = samples_of(line.trace->number);
  const auto last = (done / batch_size() + 1) * batch_size();
  return runs_->make({&line, maker, start}, 1, std::min(last, done + budget));
}

base::Result<bool> ExperimentRuns::batch_from(std::int64_t start, std::int64_t budget) {
  const auto& samples = stream_->samples();
  const auto maker =
      std::make_shared<const harness::GuidedSample>(samples, harness::GuidedStart{start, kTarget});
  const auto done = made();
  const auto last = (done / batch_size() + 1) * batch_size();
  const auto& state = samples->starts()[static_cast<std::size_t>(start) - 1].state;
  return runs_->make({nullptr, maker, state}, last_sample_ + 1,
                     last_sample_ + std::min(last, done + budget));
}

base::Result<bool> ExperimentRuns::complete(std::int64_t budget) {
  if (budget <= 0 || runs_->samples().empty()) return true;
  if (stream_ != nullptr) {
    if (made() % batch_size() == 0) return true;
    return batch_from(runs_->samples().rbegin()->second.path->start, budget);
  }
  const auto last = runs_->traces().rbegin()->first;
  if (samples_of(last) % batch_size() == 0) return true;
  auto line = runs_->traces().at(last);
  line.trace = std::make_shared<const harness::CampaignTrace>(runs_->in_symbols(*line.trace));
  return batch(line, budget);
}

base::Result<bool> ExperimentRuns::make(const Experiment& experiment, std::int64_t budget) {
  auto& sink = context_.sink();
  const auto before = sink;
  // The model may begin where the simulator cannot; then it is no experiment.
  const auto cannot_begin = [&] {
    sink = before;
    no_start_.insert(experiment.trace.key);
    return false;
  };
  if (stream_ != nullptr) {
    auto made = batch_from(*state_of(experiment.trace), budget);
    return !made && runs_->rejected() ? cannot_begin() : made;
  }
  harness::TraceLine line;
  std::int64_t number = 1;
  for (const auto& [known, other] : runs_->traces()) {
    if (other.trace->key == experiment.trace.key) break;
    ++number;
  }
  auto trace = runs_->in_symbols(experiment.trace);
  trace.number = number;
  const auto prepared = runs_->prepare_start(trace);
  auto calls = harness::action_calls(as_run_.scenario, trace, sink);
  if (!prepared || !calls) return cannot_begin();
  line.calls = *std::move(calls);
  line.trace = std::make_shared<const harness::CampaignTrace>(std::move(trace));
  auto made = batch(line, budget);
  return !made && runs_->rejected() ? cannot_begin() : made;
}

}  // namespace parallax::tools
