#include "tools/learn/outcome_facts.h"

#include <algorithm>
#include <map>
#include <vector>

#include "compiler/artifact/symbol_table.h"
#include "compiler/base/ground_name.h"
#include "compiler/plan/plan_walk.h"

namespace parallax::tools {

namespace {

constexpr std::size_t kMostUnseen = 12;  // fluents of one formula that are tried each way

/// One perform and the state that its success formula is about.
class OutcomeReading {
 public:
  OutcomeReading(const compiler::PlanQuestions& questions, compiler::LocationId location,
                 const compiler::RegisterObjects& registers, bool returns)
      : questions_(questions), location_(location), registers_(registers), returns_(returns) {}

  bool fits(const ObservedStep& step, const std::map<std::uint32_t, bool>& values) const {
    const auto value = [&](std::uint32_t fluent) {
      const auto known = values.find(fluent);
      return known != values.end() && known->second;
    };
    if (!returns_) return questions_.succeeds(location_, registers_, value) == step.succeeded;
    const auto found = questions_.found(location_, registers_, value);
    if (!step.succeeded) return found.empty();
    return std::find(found.begin(), found.end(), step.object) != found.end();
  }

 private:
  const compiler::PlanQuestions& questions_;
  compiler::LocationId location_;
  const compiler::RegisterObjects& registers_;
  bool returns_;
};

}  // namespace

void add_outcome_facts(const compiler::PlanGraph& graph, const compiler::PlanQuestions& questions,
                       const compiler::CompiledModel& model, ObservedPath& path,
                       std::set<std::string>& symbols) {
  if (!path.executed || questions.too_large()) return;
  const compiler::SymbolTable names(model);
  compiler::RegisterObjects registers;
  for (std::size_t t = 0; t < path.steps.size(); ++t) {
    const auto& step = path.steps[t];
    if (!step.perform) continue;
    const compiler::LocationId location(step.perform->index());
    const auto& performed = graph.locations[location];
    const auto at = t + static_cast<std::size_t>(performed.success.time_offset);
    const auto& needs = questions.of_success(location);
    auto& state = path.states[at];
    std::map<std::uint32_t, bool> values;
    std::vector<std::uint32_t> unseen;
    for (const auto fluent : needs.fluents) {
      const auto id = names.fluent(questions.fluents()[fluent]);
      const auto seen = id ? state.find(*id) : state.end();
      if (seen != state.end()) {
        values[fluent] = seen->second;
      } else if (id) {
        unseen.push_back(fluent);
      }
    }
    if (needs.one_state && !unseen.empty() && unseen.size() <= kMostUnseen) {
      const OutcomeReading reading(questions, location, registers, performed.result.has_value());
      std::vector<bool> can_hold(unseen.size(), false), can_fail(unseen.size(), false);
      for (std::size_t way = 0; way < std::size_t{1} << unseen.size(); ++way) {
        for (std::size_t i = 0; i < unseen.size(); ++i) values[unseen[i]] = (way >> i & 1U) != 0;
        if (!reading.fits(step, values)) continue;
        for (std::size_t i = 0; i < unseen.size(); ++i) {
          (values[unseen[i]] ? can_hold : can_fail)[i] = true;
        }
      }
      for (std::size_t i = 0; i < unseen.size(); ++i) {
        if (can_hold[i] == can_fail[i]) continue;  // either is possible, or the formula is wrong
        const auto& name = questions.fluents()[unseen[i]];
        state[*names.fluent(name)] = can_hold[i];
        symbols.insert(base::symbol_of(name));
      }
    }
    if (step.succeeded && performed.result) registers[*performed.result] = step.object;
  }
}

}  // namespace parallax::tools
