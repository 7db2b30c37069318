#include "tools/app/execution_check.h"

#include <set>
#include <utility>

#include "harness/campaign/loop_samples.h"
#include "harness/campaign/loop_stream.h"
#include "harness/campaign/trial.h"

namespace parallax::tools {

base::Result<std::unique_ptr<ExecutionCheck>> ExecutionCheck::make(const ScenarioModel& loaded,
                                                                   std::uint64_t seed,
                                                                   Context& context) {
  auto loop = ClosedLoop::make(loaded, context);
  if (!loop) return context.sink().already_reported();
  const harness::ModelFluents fluents(*(*loop)->symbols());
  auto states = (*loop)->initial_states(harness::compared_fluents(loaded.scenario, fluents));
  if (!states) return context.sink().already_reported();
  if (!*states) return std::unique_ptr<ExecutionCheck>();
  std::unique_ptr<ExecutionCheck> out(new ExecutionCheck(loaded, seed, *std::move(loop)));
  out->states_ = **std::move(states);
  return out;
}

std::string ExecutionCheck::wrong(const harness::SampleRecord& record) const {
  const auto& scenario = loaded_.scenario;
  const auto& path = *record.path;
  const auto& holds = states_.holds;
  // The reader of journals has held a repetition against what it repeats.
  const bool is_drawn = record.phase == harness::DrawPhase::kCertify && harness::is_drawn(record);
  if (path.start < 1 || path.start > std::ssize(holds) ||
      (is_drawn &&
       path.start != harness::drawn_state(seed_, record.sample, holds.size(), states_.weights))) {
    return "its initial state is not that of its number";
  }
  base::DiagnosticSink unread;
  const harness::ModelFluents fluents(*loop_->symbols());
  std::set<std::string> names;
  for (const auto id : holds[static_cast<std::size_t>(path.start - 1)]) {
    names.emplace(loop_->symbols()->name(id));
  }
  const auto sampler = harness::start_sampler(scenario, fluents.ground(), names, unread);
  if (!sampler) return "it begins where no start can be drawn";
  auto why = harness::wrong_draw(record, *sampler, seed_, harness::loop_start_stream());
  if (!why.empty()) return why;
  return harness::wrong_path(scenario, loop_->plan(), {seed_, loop_->max_performs()}, record);
}

}  // namespace parallax::tools
