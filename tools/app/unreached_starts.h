#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "harness/campaign/trace_input.h"
#include "tools/app/context.h"
#include "tools/app/scenario_model.h"

namespace parallax::tools {

/// Finds the initial states of a model that lead to no trace. No simulation begins there, because
/// only traces are simulated, so a verdict has to name them.
class UnreachedStarts {
 public:
  explicit UnreachedStarts(const ScenarioModel& loaded);

  /// A trace. Its own initial state counts; where there are others they have to be noted, too.
  void note(const harness::CampaignTrace& trace);
  /// All initial states of the trace of that number, by their true compared fluents.
  void note(std::int64_t trace, const std::vector<std::vector<compiler::FluentId>>& states);

  /// One sentence; none if every initial state leads to a trace, or if that cannot be known.
  std::vector<std::string> texts(Context& context) const;

 private:
  const ScenarioModel* loaded_;
  std::vector<compiler::FluentId> fluents_;  // compared ones, ascending
  std::set<std::vector<compiler::FluentId>> reached_;
  std::set<std::int64_t> awaited_;  // traces with further states, which were not noted yet
};

}  // namespace parallax::tools
