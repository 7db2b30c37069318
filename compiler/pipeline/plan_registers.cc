#include "compiler/pipeline/plan_registers.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "compiler/base/codes/grounding.h"

namespace parallax::compiler {
namespace {

/// Counts through all combinations of one value for each register; false behind the last one.
bool advance(std::vector<std::size_t>& choice, const std::vector<std::size_t>& sizes) {
  for (std::size_t i = choice.size(); i-- > 0;) {
    if (++choice[i] < sizes[i]) return true;
    choice[i] = 0;
  }
  return false;
}

}  // namespace

PlanRegisters::PlanRegisters(const PlanGraph& graph, const PlanFormulas& formulas,
                             GroundModel& model, FormulaGrounder& grounder,
                             base::DiagnosticSink& sink)
    : graph_(graph), model_(model), grounder_(grounder), sink_(sink) {
  for (const auto sort : formulas.register_sorts) {
    values_.emplace_back();
    for (const auto term : model.universe().domain(sort)) {
      values_.back().push_back({term, model.terms().text(term, model.typed())});
    }
  }
}

FormulaId PlanRegisters::holds(ModelValueId id, const Value& value, Timepoint t) {
  return model_.plan_atom(AtomKind::kRegister, RegisterValue{graph_.values[id].name, value.name},
                          t);
}

FormulaId PlanRegisters::returned(const Value& value, Timepoint t) {
  return model_.plan_atom(AtomKind::kResult, ReturnedObject{value.name}, t);
}

std::vector<PlanRegisters::Reading> PlanRegisters::readings(const FormulaTree& event) const {
  const auto read = registers_in(event);
  const std::vector<ModelValueId> ids(read.begin(), read.end());
  std::vector<std::size_t> choice(ids.size(), 0);
  std::vector<std::size_t> sizes;
  for (const auto id : ids) sizes.push_back(values(id).size());
  std::vector<Reading> out;
  if (std::count(sizes.begin(), sizes.end(), 0U) > 0) return out;
  do {
    Reading reading;
    for (std::size_t i = 0; i < ids.size(); ++i) reading.emplace(ids[i], choice[i]);
    out.push_back(std::move(reading));
  } while (advance(choice, sizes));
  return out;
}

std::optional<GroundTermId> PlanRegisters::event(const FormulaTree& event, const Reading& reading) {
  const auto& typed = model_.typed();
  auto& terms = model_.terms();
  std::vector<std::optional<GroundTermId>> made;
  for (const auto& node : event.nodes) {
    std::vector<GroundTermId> arguments;
    for (const auto child : node.children) {
      if (made[child]) arguments.push_back(*made[child]);
    }
    auto& term = made.emplace_back();
    if (arguments.size() != node.children.size()) continue;
    const auto name = event.name(node);
    if (node.leaf == LeafKind::kRegister) {
      const ModelValueId id(node.number);
      term = values(id)[reading.at(id)].term;
    } else if (node.kind == NodeKind::kName) {
      if (const auto object = typed.find_object(name)) term = terms.object(*object);
    } else if (node.kind == NodeKind::kNumber) {
      std::int64_t value = 0;
      const auto* end = name.data() + name.size();
      const auto [stop, error] = std::from_chars(name.data(), end, value);
      if (error == std::errc() && stop == end) term = terms.integer(value);
    } else if (node.kind == NodeKind::kUnary && node.op == Operator::kNegate) {
      const auto& operand = terms[arguments[0]];
      if (operand.kind == TermKind::kInteger) term = terms.integer(-operand.integer);
    } else if (node.kind == NodeKind::kApply) {
      if (const auto symbol = typed.find_symbol(name)) term = terms.apply(*symbol, arguments);
    }
  }
  return made.back();
}

std::string PlanRegisters::event_text(const FormulaTree& event, const Reading& reading) const {
  const auto value = [&](const FormulaNode& node) -> std::optional<FormulaTree> {
    if (node.leaf != LeafKind::kRegister) return std::nullopt;
    const ModelValueId id(node.number);
    return constant_term(values(id)[reading.at(id)].name);
  };
  return with_leaves(event, value).text;
}

FormulaId PlanRegisters::condition(const Reading& reading, Timepoint t) {
  std::vector<FormulaId> parts;
  for (const auto& [id, place] : reading) parts.push_back(holds(id, values(id)[place], t));
  return model_.formulas().conjunction(std::move(parts));
}

std::optional<FormulaId> PlanRegisters::ground(const PlanFormula& formula, Timepoint when,
                                               Timepoint read, base::SourceRange blame,
                                               std::optional<GroundTermId> returned) {
  auto& formulas = model_.formulas();
  grounder_.start(blame);
  if (formula.checked.time) {
    grounder_.bind(*formula.checked.time, model_.terms().integer(when));
  }
  if (returned) grounder_.bind(*formula.returned, *returned);
  std::vector<std::size_t> choice(formula.registers.size(), 0);
  std::vector<std::size_t> sizes;
  for (const auto& entry : formula.registers) sizes.push_back(values(entry.first).size());
  if (std::count(sizes.begin(), sizes.end(), 0U) > 0) return formulas.falsity();
  std::vector<FormulaId> ways;
  bool says_something = false;
  do {
    auto condition = formulas.truth();
    std::size_t i = 0;
    for (const auto& [id, variable] : formula.registers) {
      const auto& value = values(id)[choice[i++]];
      condition = formulas.conjunction(condition, holds(id, value, read));
      grounder_.bind(variable, value.term);
    }
    const auto body = grounder_.ground(formula.checked.formula);
    if (grounder_.failed()) return std::nullopt;
    says_something = says_something || body.has_value();
    if (body) ways.push_back(formulas.conjunction(condition, *body));
  } while (advance(choice, sizes));
  if (returned) grounder_.unbind(*formula.returned);
  if (says_something || returned) return formulas.disjunction(ways);
  sink_.error(codes::kNothingToSay, blame, model_.horizon());
  return std::nullopt;
}

}  // namespace parallax::compiler
