// Constraints by which a ground model follows the graph of a plan.
//
// Control is at one place at each timepoint, a location or a terminal. A location performs its
// event at t. Whether that succeeds is a formula of the binding table; success and failure lead
// on through branches, each side under its guard or its negation. A place's atom at t + 1 is
// equal to the disjunction of the conditions that lead to it. These conditions split the atoms
// at t, so control is again at exactly one place; only places that can be reached at t get an
// atom. Terminals keep control. Events that the plan may perform happen only where it performs
// them.
//
// A perform that returns something picks one object for which its formula is true. Registers
// have exactly one value while the plan may still read them, and none elsewhere.
//
// Cost: for each timepoint the reachable places with all ways through the branches behind them;
// for registers and results the squares of the numbers of values.

#include "compiler/pipeline/plan_encoder.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compiler/base/codes/grounding.h"
#include "compiler/pipeline/plan_register_step.h"
#include "compiler/pipeline/plan_registers.h"
#include "compiler/plan/plan_graph.h"

namespace parallax::compiler {

namespace {

/// A place of control: locations first, then terminals.
using NodeNumber = std::size_t;

/// The branches of a graph, each before those that it leads to: no cycle consists of branches
/// alone. Linear.
std::vector<BranchId> branches_in_order(const PlanGraph& graph) {
  std::vector<BranchId> out;
  std::vector<std::uint8_t> ways(graph.branches.size());  // taken so far
  for (std::size_t i = 0; i < graph.branches.size(); ++i) {
    std::vector<BranchId> open = {graph.branches.id_at(i)};
    if (ways[i] > 0) continue;
    while (!open.empty()) {
      const auto id = open.back();
      const auto way = ways[id.index()]++;
      if (way == 2) {
        out.push_back(id);
        open.pop_back();
        continue;
      }
      const auto& to = way == 0 ? graph.branches[id].if_false : graph.branches[id].if_true;
      const auto* next = std::get_if<BranchId>(&to);
      if (next != nullptr && ways[next->index()] == 0) open.push_back(*next);
    }
  }
  std::reverse(out.begin(), out.end());
  return out;
}

/// How many of the terminals before this one are bounds.
std::size_t cut_number(const PlanGraph& graph, std::size_t terminal) {
  std::size_t number = 0;
  for (std::size_t i = 0; i < terminal; ++i) {
    if (graph.terminals[graph.terminals.id_at(i)].kind == TerminalKind::kBound) ++number;
  }
  return number;
}

/// The value of an argument; a register gives its name, which stands for the object it holds.
PlanValue artifact_value(const PlanGraph& graph, const PlanArgument& argument) {
  if (const auto* id = std::get_if<ModelValueId>(&argument)) return graph.values[*id].name;
  if (const auto* text = std::get_if<std::string>(&argument)) return *text;
  if (const auto* integer = std::get_if<std::int64_t>(&argument)) return *integer;
  return std::get<double>(argument);
}

class PlanEncoder {
 public:
  PlanEncoder(const PlanGraph& graph, const PlanFormulas& formulas, GroundModel& model,
              FormulaGrounder& grounder, base::DiagnosticSink& sink)
      : graph_(graph),
        formulas_(formulas),
        liveness_(plan_liveness(graph)),
        branch_order_(branches_in_order(graph)),
        registers_(graph, formulas, model, grounder, sink),
        model_(model),
        grounder_(grounder),
        sink_(sink) {
    for (std::uint32_t i = 0; i < model.events().size(); ++i) {
      event_numbers_.emplace(model.events()[i], i);
    }
    for (const auto& location : graph.locations) {
      origins_.push_back(model.add_origin(location.source, OriginKind::kPlanStep));
    }
  }

  base::Result<std::vector<FormulaId>> run(const std::set<std::string>& plan_events,
                                           RunningAtoms running) {
    std::vector<FormulaId> cut;
    if (!resolve_events()) return sink_.already_reported();
    const auto count = graph_.locations.size() + graph_.terminals.size() + graph_.branches.size();
    auto incoming = std::vector<std::vector<FormulaId>>(count);
    route(graph_.entry, model_.formulas().truth(), incoming);
    choose_inputs();
    for (Timepoint t = 0;; ++t) {
      if (!decide(t, incoming)) return sink_.already_reported();
      const auto here = place_control(incoming, t);
      const bool at_horizon = t == model_.horizon();
      cut.push_back(cut_off(here));
      if (at_horizon || running == RunningAtoms::kEverywhere) mark_running(here, t);
      if (at_horizon) break;
      perform(here, t, plan_events);
      incoming.clear();
      incoming.resize(count);
      leave(here, t, incoming);
      if (grounder_.failed() || sink_.error_count() != errors_at_start_) {
        return sink_.already_reported();
      }
    }
    return cut;
  }

 private:
  /// Event that a location performs, one for every reading of the registers it depends on.
  struct Performed {
    PlanRegisters::Reading reading;
    std::uint32_t event = 0;
  };

  /// Each input that the plan reads has exactly one value, any one of its sort.
  void choose_inputs() {
    for (const auto input : graph_.inputs) {
      if (!liveness_.at(graph_.entry).contains(input)) continue;
      std::vector<FormulaId> held;
      for (const auto& value : registers_.values(input)) {
        held.push_back(registers_.holds(input, value, 0));
      }
      model_.require(model_.formulas().disjunction(held), origin_of(0));
      require_at_most_one(held, origin_of(0), model_);
    }
  }

  bool resolve_events() {
    for (const auto& location : graph_.locations) {
      events_.emplace_back();
      for (auto& reading : registers_.readings(location.event)) {
        const auto term = registers_.event(location.event, reading);
        const auto found = term ? event_numbers_.find(*term) : event_numbers_.end();
        if (found == event_numbers_.end()) {
          sink_.error(codes::kPlanEventUnknown, location.source,
                      registers_.event_text(location.event, reading));
          break;
        }
        events_.back().push_back({std::move(reading), found->second});
      }
    }
    return sink_.error_count() == errors_at_start_;
  }

  PlanAtom place_of(NodeNumber node) const {
    if (node < graph_.locations.size()) return step_of(node);
    const auto place = node - graph_.locations.size();
    const auto& terminal = graph_.terminals[graph_.terminals.id_at(place)];
    switch (terminal.kind) {
      case TerminalKind::kDone:
        return PlanEnd{"DONE"};
      case TerminalKind::kFailed:
        return PlanEnd{fmt::format("FAILED({})", terminal.detail)};
      case TerminalKind::kNever:
        return PlanEnd{"NEVER"};
      case TerminalKind::kBound:
        return PlanCutId(static_cast<std::uint32_t>(cut_number(graph_, place)));
    }
    return {};
  }

  static PlanStepId step_of(NodeNumber node) {
    return PlanStepId(static_cast<std::uint32_t>(node));
  }

  std::uint32_t origin_of(NodeNumber node) const {
    // A terminal's clauses belong to the plan's first step: it has no text of its own.
    return origins_.empty() ? 0 : origins_[node < origins_.size() ? node : 0];
  }

  /// Adds `condition` to the incoming conditions of the target. Those of branches stand behind the
  /// nodes.
  void route(const PlanTarget& target, FormulaId condition,
             std::vector<std::vector<FormulaId>>& incoming) const {
    if (condition == model_.formulas().falsity()) return;
    const auto terminals = graph_.locations.size();
    const auto branches = terminals + graph_.terminals.size();
    if (const auto* location = std::get_if<LocationId>(&target)) {
      incoming[location->index()].push_back(condition);
    } else if (const auto* terminal = std::get_if<TerminalId>(&target)) {
      incoming[terminals + terminal->index()].push_back(condition);
    } else {
      incoming[branches + std::get<BranchId>(target).index()].push_back(condition);
    }
  }

  /// Leads control through the branches at t, each once, however many ways lead to it. False:
  /// reported.
  bool decide(Timepoint t, std::vector<std::vector<FormulaId>>& incoming) {
    const auto nodes = graph_.locations.size() + graph_.terminals.size();
    auto& formulas = model_.formulas();
    for (const auto id : branch_order_) {
      const auto& ways = incoming[nodes + id.index()];
      if (ways.empty()) continue;
      const auto reached = ways.size() == 1 ? ways.front() : formulas.disjunction(ways);
      const auto guard = decision(id, t);
      if (!guard) return false;
      route(graph_.branches[id].if_true, formulas.conjunction(reached, *guard), incoming);
      route(graph_.branches[id].if_false, formulas.conjunction(reached, ~*guard), incoming);
    }
    incoming.resize(nodes);
    return true;
  }

  /// Condition of a branch at t. None: reported.
  std::optional<FormulaId> decision(BranchId id, Timepoint t) {
    const auto& branch = graph_.branches[id];
    if (branch.free) {
      return model_.plan_atom(AtomKind::kLocation, PlanChoiceId(id.index()), t);
    }
    return registers_.ground(formulas_.guards[id.index()], t, t, branch.source);
  }

  bool is_never(NodeNumber node) const {
    if (node < graph_.locations.size()) return false;
    const auto id = graph_.terminals.id_at(node - graph_.locations.size());
    return graph_.terminals[id].kind == TerminalKind::kNever;
  }

  /// Makes the location atoms of timepoint t: control is where it came to, and nowhere else.
  std::vector<std::optional<FormulaId>> place_control(std::vector<std::vector<FormulaId>>& incoming,
                                                      Timepoint t) {
    std::vector<std::optional<FormulaId>> here(incoming.size());
    for (NodeNumber node = 0; node < incoming.size(); ++node) {
      if (incoming[node].empty()) continue;
      if (is_never(node)) {
        for (const auto reached : incoming[node]) model_.require(~reached, origin_of(0));
        continue;
      }
      const auto pc = model_.plan_atom(AtomKind::kLocation, place_of(node), t);
      auto& formulas = model_.formulas();
      model_.require(formulas.equivalence(pc, formulas.disjunction(incoming[node])),
                     origin_of(node));
      here[node] = pc;
    }
    return here;
  }

  void perform(const std::vector<std::optional<FormulaId>>& here, Timepoint t,
               const std::set<std::string>& plan_events) {
    auto& formulas = model_.formulas();
    std::map<std::uint32_t, std::vector<FormulaId>> performed_by;
    for (NodeNumber node = 0; node < graph_.locations.size(); ++node) {
      if (!here[node]) continue;
      for (const auto& performed : events_[node]) {
        const auto now =
            formulas.conjunction(*here[node], registers_.condition(performed.reading, t));
        model_.require(formulas.implication(now, model_.happens(performed.event, t)),
                       origin_of(node));
        performed_by[performed.event].push_back(now);
      }
    }
    for (std::uint32_t e = 0; e < model_.events().size(); ++e) {
      const auto& symbol = model_.typed().symbols[model_.terms()[model_.events()[e]].symbol];
      if (!plan_events.contains(symbol.name)) continue;
      model_.require(
          formulas.implication(model_.happens(e, t), formulas.disjunction(performed_by[e])),
          origin_of(0));
    }
  }

  void leave(const std::vector<std::optional<FormulaId>>& here, Timepoint t,
             std::vector<std::vector<FormulaId>>& incoming) {
    RegisterStep step(graph_, formulas_, liveness_, registers_, model_, t);
    for (NodeNumber node = 0; node < here.size(); ++node) {
      if (!here[node]) continue;
      if (node >= graph_.locations.size()) {
        incoming[node].push_back(*here[node]);
        continue;
      }
      const auto id = graph_.locations.id_at(node);
      const auto& location = graph_.locations[id];
      const auto success = step.success(id);
      if (!success) return;
      auto& formulas = model_.formulas();
      const auto ok = model_.plan_atom(AtomKind::kSucceeded, step_of(node), t + 1);
      model_.require(formulas.equivalence(ok, formulas.conjunction(*here[node], *success)),
                     origin_of(node));
      const auto failed = formulas.conjunction(*here[node], ~ok);
      step.leave(id, ok, failed, origin_of(node));
      route(location.on_success, ok, incoming);
      route(location.on_failure, failed, incoming);
    }
    step.finish(origin_of(0));
  }

  bool is_cut(NodeNumber node) const {
    if (node < graph_.locations.size()) return false;
    const auto id = graph_.terminals.id_at(node - graph_.locations.size());
    return graph_.terminals[id].kind == TerminalKind::kBound;
  }

  /// Control is where unrolling was cut, now or since an earlier timepoint.
  FormulaId cut_off(const std::vector<std::optional<FormulaId>>& here) {
    std::vector<FormulaId> cut;
    for (NodeNumber node = 0; node < here.size(); ++node) {
      if (here[node] && is_cut(node)) cut.push_back(*here[node]);
    }
    return model_.formulas().disjunction(std::move(cut));
  }

  /// True at t if the plan would go on: at a location, or where unrolling was cut.
  void mark_running(const std::vector<std::optional<FormulaId>>& here, Timepoint t) {
    std::vector<FormulaId> open;
    for (NodeNumber node = 0; node < here.size(); ++node) {
      if (!here[node]) continue;
      if (node >= graph_.locations.size() && !is_cut(node)) continue;
      open.push_back(*here[node]);
    }
    const auto running = model_.plan_atom(AtomKind::kRunning, {}, t);
    model_.require(model_.formulas().equivalence(running, model_.formulas().disjunction(open)),
                   origin_of(0));
  }

  const PlanGraph& graph_;
  const PlanFormulas& formulas_;
  PlanLiveness liveness_;
  std::vector<BranchId> branch_order_;
  PlanRegisters registers_;
  GroundModel& model_;
  FormulaGrounder& grounder_;
  base::DiagnosticSink& sink_;
  std::size_t errors_at_start_ = sink_.error_count();
  std::map<GroundTermId, std::uint32_t> event_numbers_;
  std::vector<std::vector<Performed>> events_;  // by location
  std::vector<std::uint32_t> origins_;          // by location
};

}  // namespace

base::Result<std::vector<FormulaId>> encode_plan(const PlanGraph& graph,
                                                 const PlanFormulas& formulas,
                                                 const std::set<std::string>& plan_events,
                                                 RunningAtoms running, GroundModel& model,
                                                 FormulaGrounder& grounder,
                                                 base::DiagnosticSink& sink) {
  return PlanEncoder(graph, formulas, model, grounder, sink).run(plan_events, running);
}

std::vector<PlanCut> plan_cuts(const PlanGraph& graph) {
  std::vector<PlanCut> cuts;
  for (const auto& terminal : graph.terminals) {
    if (terminal.kind != TerminalKind::kBound) continue;
    cuts.push_back({terminal.detail, terminal.source.value_or(base::SourceRange{}), {}});
  }
  return cuts;
}

std::vector<PlanPerform> plan_steps(const PlanGraph& graph) {
  std::vector<PlanPerform> steps;
  for (const auto& location : graph.locations) {
    PlanPerform step{location.event.text, location.source, location.failure_class, {}};
    for (const auto& [name, value] : location.arguments) {
      step.arguments.emplace(name, artifact_value(graph, value));
    }
    steps.push_back(std::move(step));
  }
  return steps;
}

}  // namespace parallax::compiler
