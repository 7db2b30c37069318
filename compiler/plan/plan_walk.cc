// One execution of a plan, as a walk through its graph.
//
// Between two performs control passes branches. Those with a guard ask the surroundings, and
// free ones go either way. The ways from here to a perform or an end that an execution can come
// to are counted first, guards being asked once each; then one number below the count chooses a
// way, so that all are equally likely however the branches are nested. Branches make no cycles,
// so the count ends; it is remembered by branch. Cost: linear in the branches between two
// performs.

#include "compiler/plan/plan_walk.h"

#include <algorithm>
#include <limits>

#include "compiler/base/contract.h"

namespace parallax::compiler {

std::string event_text(const PlanLocation& location, const RegisterObjects& registers) {
  const auto object = [&](const FormulaNode& node) -> std::optional<FormulaTree> {
    if (node.leaf != LeafKind::kRegister) return std::nullopt;
    return constant_term(registers.at(ModelValueId(node.number)));
  };
  return with_leaves(location.event, object).text;
}

PlanArguments arguments_of(const PlanLocation& location, const RegisterObjects& registers) {
  auto arguments = location.arguments;
  for (auto& [name, value] : arguments) {
    if (const auto* id = std::get_if<ModelValueId>(&value)) value = registers.at(*id);
  }
  return arguments;
}

PlanWalk::PlanWalk(const PlanGraph& graph) : graph_(&graph), at_(graph.entry) {}

/// How many ways lead from here to a perform or an end that an execution can come to. Guards are
/// asked once each; branches have no cycle, and the recursion is as deep as they follow each other.
std::uint64_t PlanWalk::ways(const PlanTarget& target, PlanSurroundings& surroundings,
                             std::map<BranchId, std::uint64_t>& known) {
  constexpr auto kMany = std::numeric_limits<std::uint64_t>::max() / 4;
  if (std::holds_alternative<LocationId>(target)) return 1;
  if (const auto* terminal = std::get_if<TerminalId>(&target)) {
    return graph_->terminals[*terminal].kind == TerminalKind::kNever ? 0 : 1;
  }
  const auto id = std::get<BranchId>(target);
  if (const auto found = known.find(id); found != known.end()) return found->second;
  const auto& branch = graph_->branches[id];
  std::uint64_t count = 0;
  if (branch.free) {
    count = ways(branch.if_true, surroundings, known) + ways(branch.if_false, surroundings, known);
  } else {
    const bool holds = surroundings.holds(id, registers_);
    count = ways(holds ? branch.if_true : branch.if_false, surroundings, known);
  }
  return known[id] = std::min(count, kMany);
}

void PlanWalk::go_on(PlanSurroundings& surroundings) {
  std::map<BranchId, std::uint64_t> known;
  const auto count = ways(at_, surroundings, known);
  PARALLAX_REQUIRE(count > 0, "some way through a plan's branches is open");
  auto number = count > 1 ? surroundings.choose(count) : 0;
  while (const auto* id = std::get_if<BranchId>(&at_)) {
    const auto& branch = graph_->branches[*id];
    if (!branch.free) {
      // Asked before: the way that was counted is the one.
      const bool holds = surroundings.holds(*id, registers_);
      passed_.emplace_back(*id, holds);
      at_ = holds ? branch.if_true : branch.if_false;
      continue;
    }
    const auto first = ways(branch.if_true, surroundings, known);
    const bool take = number < first;
    if (!take) number -= first;
    passed_.emplace_back(*id, take);
    at_ = take ? branch.if_true : branch.if_false;
  }
}

std::optional<LocationId> PlanWalk::location() const {
  const auto* id = std::get_if<LocationId>(&at_);
  return id != nullptr ? std::optional(*id) : std::nullopt;
}

const PlanTerminal* PlanWalk::end() const {
  const auto* id = std::get_if<TerminalId>(&at_);
  return id != nullptr ? &graph_->terminals[*id] : nullptr;
}

std::string PlanWalk::event() const {
  return event_text(graph_->locations[std::get<LocationId>(at_)], registers_);
}

void PlanWalk::succeed(const std::string& returned) {
  const auto& location = graph_->locations[std::get<LocationId>(at_)];
  if (location.result) registers_[*location.result] = returned;
  passed_.clear();
  at_ = location.on_success;
}

std::optional<std::string> PlanWalk::fail(std::string_view reason) {
  const auto& location = graph_->locations[std::get<LocationId>(at_)];
  if (location.failures.empty()) {
    passed_.clear();
    at_ = location.on_failure;
    return location.failure_class;
  }
  for (std::size_t way = 0; way < location.failures.size(); ++way) {
    const auto& [failure_class, reasons] = location.failures[way];
    if (std::find(reasons.begin(), reasons.end(), reason) == reasons.end()) continue;
    auto raised = failure_class;
    passed_ = decisions_of_way(*graph_, location, way);
    at_ = failure_target(*graph_, location, way);
    return raised;
  }
  return std::nullopt;
}

}  // namespace parallax::compiler
