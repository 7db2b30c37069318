#include "compiler/plan/plan_state.h"

#include <limits>

namespace parallax::compiler {
namespace {

class KeyWriter {
 public:
  KeyWriter(const ValueStore& values, bool counters) : values_(values), counters_(counters) {}

  void part(const std::vector<PlanFrame>& frames, const std::vector<PlanGuard>& guards,
            const std::vector<ValueId>& stack) {
    number(frames.size());
    number(guards.size());
    number(stack.size());
    for (const auto& frame : frames) {
      const std::uint32_t kinds = static_cast<std::uint32_t>(frame.kind) * 4U +
                                  static_cast<std::uint32_t>(frame.pending.kind);
      key.insert(key.end(), {frame.unit, frame.pc, frame.link, frame.base, frame.guard_base, kinds,
                             frame.skip_to, frame.failure.index(), frame.pending.frame,
                             frame.pending.exit, frame.pending.value.index()});
    }
    for (const auto& guard : guards) {
      key.insert(key.end(), {guard.cleanup ? 1U : 0U, guard.index, guard.frame, guard.height});
    }
    for (const auto value : stack) {
      const bool hidden = !counters_ && values_.kind(value) == ValueKind::kCounter;
      key.push_back(hidden ? std::numeric_limits<std::uint32_t>::max() : value.index());
    }
  }

  /// As deep as the text nests `par`.
  void pars(const std::vector<PlanPar>& pars) {
    number(pars.size());
    for (const auto& par : pars) {
      number(par.frames);
      number(par.active);
      number(par.form.index());
      for (const auto& branch : par.branches) {
        number((branch.started ? 1U : 0U) + (branch.done ? 2U : 0U) + (branch.turn ? 4U : 0U));
        number(branch.result.index());
        if (branch.turn) number(branch.turn->designator.index());
        part(branch.frames, branch.guards, branch.stack);
        this->pars(branch.pars);
      }
    }
  }

  std::vector<std::uint32_t> key;

 private:
  void number(std::size_t value) { key.push_back(static_cast<std::uint32_t>(value)); }
  const ValueStore& values_;
  bool counters_;
};

void visit_part(const std::vector<PlanFrame>& frames, const std::vector<ValueId>& stack,
                const std::function<void(ValueId)>& visit) {
  for (const auto value : stack) visit(value);
  for (const auto& frame : frames) visit(frame.pending.value);
}

void visit_pars(const std::vector<PlanPar>& pars, const std::function<void(ValueId)>& visit) {
  for (const auto& par : pars) {
    for (const auto& branch : par.branches) {
      visit(branch.result);
      if (branch.turn) visit(branch.turn->designator);
      visit_part(branch.frames, branch.stack, visit);
      visit_pars(branch.pars, visit);
    }
  }
}

}  // namespace

void for_each_value(const PlanState& state, const std::function<void(ValueId)>& visit) {
  visit_part(state.frames, state.stack, visit);
  visit_pars(state.pars, visit);
}

std::vector<std::uint32_t> state_key(const PlanState& state, const ValueStore& values,
                                     bool counters) {
  KeyWriter writer(values, counters);
  writer.part(state.frames, state.guards, state.stack);
  if (!state.pars.empty()) writer.pars(state.pars);
  return std::move(writer.key);
}

}  // namespace parallax::compiler
