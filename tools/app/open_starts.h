#pragma once

#include <compare>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "compiler/artifact/symbol_table.h"
#include "harness/campaign/loop_input.h"
#include "harness/campaign/trace_input.h"
#include "tools/app/scenario_model.h"

namespace parallax::tools {

/// Warns of fluents that the model leaves open at timepoint 0 and that no start decides: the
/// mapping ignores them, and two initial states differ in them alone. The simulated world then
/// begins in the same way for both initial states.
void report_open_starts(const ScenarioModel& loaded, Context& context);

/// Finds initial states that lead to the events of traces and that no start of the world can be.
class UnrealisableStarts {
 public:
  /// All of it outlives the object.
  UnrealisableStarts(const ScenarioModel& loaded, const harness::ModelFluents& fluents,
                     Context& context)
      : loaded_(loaded), fluents_(fluents), context_(context) {}

  /// Looks at the initial states of a trace that `traces` gave, and returns it from the first ones
  /// that a start can be, `most` of them; as it is where none can, or the search was stopped. Fails
  /// as TraceFeed::starts does.
  base::Result<std::vector<harness::CampaignTrace>> look(harness::CampaignTrace trace,
                                                         harness::TraceFeed& traces,
                                                         std::size_t most);
  /// Looks at the initial states of executions.
  void look(const harness::LoopStates& states, const compiler::SymbolTable& symbols);
  /// Warns of fluents that every start has with one value though the model leaves them open
  /// (kFixedStart), and of the other states that were found (kUnrealisableStart), the first few.
  void report() const;

 private:
  struct Value {
    std::string fluent;
    bool holds = false;
    auto operator<=>(const Value&) const = default;
  };
  struct Found {
    std::set<Value> values;  // of the fluents in which initial states differ
    std::string reason;
  };

  /// Keeps the values of the `open` fluents in the state; `why`: no start of the world can be it.
  void note(const std::vector<compiler::FluentId>& state, std::span<const compiler::FluentId> open,
            const compiler::SymbolTable& symbols, const std::optional<std::string>& why);

  const ScenarioModel& loaded_;
  const harness::ModelFluents& fluents_;
  Context& context_;
  std::set<Value> realised_;  // values that some start has
  std::vector<Found> found_;
};

}  // namespace parallax::tools
