#include "compiler/pipeline/plan_encoder.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>

#include "compiler/base/diagnostic_codes.h"

namespace parallax::compiler {

using base::DiagnosticCode;

namespace {

/// A place of control: locations first, then terminals.
using NodeNumber = std::size_t;

class PlanEncoder {
 public:
  PlanEncoder(const PlanGraph& graph, const PlanFormulas& formulas, GroundModel& model,
              FormulaGrounder& grounder, base::DiagnosticSink& sink)
      : graph_(graph), formulas_(formulas), model_(model), grounder_(grounder), sink_(sink) {
    for (std::uint32_t i = 0; i < model.events().size(); ++i) {
      event_numbers_.emplace(model.terms().text(model.events()[i], model.typed()), i);
    }
    for (const auto& location : graph.locations) {
      origins_.push_back(model.add_origin(location.source, "plan step"));
    }
  }

  base::Status run(const std::set<std::string>& plan_events) {
    if (!resolve_events()) return sink_.already_reported();
    const auto count = graph_.locations.size() + graph_.terminals.size();
    auto incoming = std::vector<std::vector<FormulaId>>(count);
    route(graph_.entry, model_.formulas().truth(), 0, incoming);
    for (Timepoint t = 0;; ++t) {
      const auto here = place_control(incoming, t);
      if (t == model_.horizon()) {
        mark_running(here, t);
        break;
      }
      perform(here, t, plan_events);
      incoming.assign(count, {});
      leave(here, t, incoming);
      if (grounder_.failed() || sink_.error_count() != errors_at_start_) {
        return sink_.already_reported();
      }
    }
    return base::Unit{};
  }

 private:
  bool resolve_events() {
    for (const auto& location : graph_.locations) {
      const auto found = event_numbers_.find(location.event);
      if (found != event_numbers_.end()) {
        events_.push_back(found->second);
        continue;
      }
      if (!location.event.empty() && location.event.find('?') != std::string::npos) {
        sink_.error(DiagnosticCode::kPlanModelValue, location.source, location.event);
      } else {
        sink_.error(DiagnosticCode::kPlanEventUnknown, location.source, location.event);
      }
    }
    return sink_.error_count() == errors_at_start_;
  }

  std::string node_name(NodeNumber node) const {
    if (node < graph_.locations.size()) return fmt::format("L{}", node);
    const auto& terminal = graph_.terminals[graph_.terminals.id_at(node - graph_.locations.size())];
    switch (terminal.kind) {
      case TerminalKind::kDone:
        return "DONE";
      case TerminalKind::kFailed:
        return fmt::format("FAILED({})", terminal.detail);
      case TerminalKind::kBound:
        return fmt::format("BOUND({},{})", node - graph_.locations.size(), terminal.detail);
    }
    return {};
  }

  std::uint32_t origin_of(NodeNumber node) const {
    // A terminal's clauses belong to the plan's first step: it has no text of its own.
    return origins_.empty() ? 0 : origins_[node < origins_.size() ? node : 0];
  }

  std::optional<FormulaId> at(const CheckedFormula& formula, Timepoint t, base::SourceRange blame) {
    grounder_.start(blame);
    if (formula.time) grounder_.bind(*formula.time, model_.terms().integer(t));
    const auto value = grounder_.ground(formula.formula);
    if (!value && !grounder_.failed()) {
      sink_.error(DiagnosticCode::kNothingToSay, blame, model_.horizon());
    }
    return value;
  }

  /// Adds `condition` to the incoming conditions of every node that `target` leads to at t.
  void route(const PlanTarget& target, FormulaId condition, Timepoint t,
             std::vector<std::vector<FormulaId>>& incoming) {
    std::vector<std::pair<PlanTarget, FormulaId>> todo = {{target, condition}};
    while (!todo.empty()) {
      const auto [to, reached] = todo.back();
      todo.pop_back();
      if (reached == model_.formulas().falsity()) continue;
      if (const auto* location = std::get_if<LocationId>(&to)) {
        incoming[location->index()].push_back(reached);
      } else if (const auto* terminal = std::get_if<TerminalId>(&to)) {
        incoming[graph_.locations.size() + terminal->index()].push_back(reached);
      } else {
        const auto id = std::get<BranchId>(to);
        const auto& branch = graph_.branches[id];
        const auto guard = at(formulas_.guards[id.index()], t, branch.source);
        if (!guard) return;
        todo.emplace_back(branch.if_false, model_.formulas().conjunction(reached, ~*guard));
        todo.emplace_back(branch.if_true, model_.formulas().conjunction(reached, *guard));
      }
    }
  }

  /// Makes the location atoms of timepoint t: control is where it came to, and nowhere else.
  std::vector<std::optional<FormulaId>> place_control(std::vector<std::vector<FormulaId>>& incoming,
                                                      Timepoint t) {
    std::vector<std::optional<FormulaId>> here(incoming.size());
    for (NodeNumber node = 0; node < incoming.size(); ++node) {
      if (incoming[node].empty()) continue;
      const auto pc = model_.named_atom(AtomKind::kLocation, node_name(node), t);
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
      model_.require(formulas.implication(*here[node], model_.happens(events_[node], t)),
                     origin_of(node));
      performed_by[events_[node]].push_back(*here[node]);
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
    for (NodeNumber node = 0; node < here.size(); ++node) {
      if (!here[node]) continue;
      if (node >= graph_.locations.size()) {
        incoming[node].push_back(*here[node]);
        continue;
      }
      const auto id = graph_.locations.id_at(node);
      const auto& location = graph_.locations[id];
      const auto success =
          at(formulas_.success[node], t + location.success.time_offset, location.success.source);
      if (!success) return;
      auto& formulas = model_.formulas();
      route(location.on_success, formulas.conjunction(*here[node], *success), t + 1, incoming);
      route(location.on_failure, formulas.conjunction(*here[node], ~*success), t + 1, incoming);
    }
  }

  /// True at the horizon if the plan would go on: at a location, or where unrolling was cut.
  void mark_running(const std::vector<std::optional<FormulaId>>& here, Timepoint t) {
    std::vector<FormulaId> open;
    for (NodeNumber node = 0; node < here.size(); ++node) {
      if (!here[node]) continue;
      if (node >= graph_.locations.size()) {
        const auto id = graph_.terminals.id_at(node - graph_.locations.size());
        if (graph_.terminals[id].kind != TerminalKind::kBound) continue;
      }
      open.push_back(*here[node]);
    }
    const auto running = model_.named_atom(AtomKind::kRunning, "running", t);
    model_.require(model_.formulas().equivalence(running, model_.formulas().disjunction(open)),
                   origin_of(0));
  }

  const PlanGraph& graph_;
  const PlanFormulas& formulas_;
  GroundModel& model_;
  FormulaGrounder& grounder_;
  base::DiagnosticSink& sink_;
  std::size_t errors_at_start_ = sink_.error_count();
  std::map<std::string, std::uint32_t> event_numbers_;
  std::vector<std::uint32_t> events_;   // by location
  std::vector<std::uint32_t> origins_;  // by location
};

}  // namespace

base::Status encode_plan(const PlanGraph& graph, const PlanFormulas& formulas,
                         const std::set<std::string>& plan_events, GroundModel& model,
                         FormulaGrounder& grounder, base::DiagnosticSink& sink) {
  return PlanEncoder(graph, formulas, model, grounder, sink).run(plan_events);
}

std::vector<PlanStep> plan_steps(const PlanGraph& graph) {
  std::vector<PlanStep> steps;
  for (const auto& location : graph.locations) {
    PlanStep step{location.event, location.source, location.failure_class, {}};
    for (const auto& [name, value] : location.arguments) step.arguments.emplace(name, value);
    steps.push_back(std::move(step));
  }
  return steps;
}

}  // namespace parallax::compiler
