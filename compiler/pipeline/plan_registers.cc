#include "compiler/pipeline/plan_registers.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/pipeline/plan_formula_text.h"

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
    : graph_(graph), names_(graph), model_(model), grounder_(grounder), sink_(sink) {
  for (const auto sort : formulas.register_sorts) {
    values_.emplace_back();
    for (const auto term : model.universe().domain(sort)) {
      values_.back().push_back({term, model.terms().text(term, model.typed())});
    }
  }
}

FormulaId PlanRegisters::holds(ModelValueId id, const Value& value, Timepoint t) {
  return model_.named_atom(AtomKind::kRegister,
                           fmt::format("{}={}", graph_.values[id].name, value.name), t);
}

FormulaId PlanRegisters::returned(const Value& value, Timepoint t) {
  return model_.named_atom(AtomKind::kResult, value.name, t);
}

std::vector<PlanRegisters::Reading> PlanRegisters::readings(const std::string& text) const {
  const auto read = names_.in(text);
  const std::vector<ModelValueId> ids(read.begin(), read.end());
  std::vector<std::size_t> choice(ids.size(), 0);
  std::vector<std::size_t> sizes;
  for (const auto id : ids) sizes.push_back(values(id).size());
  std::vector<Reading> out;
  if (std::count(sizes.begin(), sizes.end(), 0U) > 0) return out;
  do {
    Reading reading{{}, text};
    for (std::size_t i = 0; i < ids.size(); ++i) {
      reading.choice.emplace_back(ids[i], choice[i]);
      reading.text =
          replace_word(reading.text, graph_.values[ids[i]].name, values(ids[i])[choice[i]].name);
    }
    out.push_back(std::move(reading));
  } while (advance(choice, sizes));
  return out;
}

FormulaId PlanRegisters::condition(const Reading& reading, Timepoint t) {
  std::vector<FormulaId> parts;
  for (const auto& [id, place] : reading.choice) parts.push_back(holds(id, values(id)[place], t));
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
  sink_.error(base::DiagnosticCode::kNothingToSay, blame, model_.horizon());
  return std::nullopt;
}

}  // namespace parallax::compiler
