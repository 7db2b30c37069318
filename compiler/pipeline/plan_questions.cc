#include "compiler/pipeline/plan_questions.h"

#include <algorithm>
#include <set>
#include <utility>

#include "compiler/base/contract.h"

namespace parallax::compiler {
namespace {

constexpr std::int64_t kMaxInstances = 5'000'000;

/// Goes to the next choice of one value for each variable; false behind the last.
bool next_choice(std::vector<std::size_t>& choice,
                 const std::vector<std::vector<std::string>>& values) {
  for (std::size_t i = choice.size(); i-- > 0;) {
    if (++choice[i] < values[i].size()) return true;
    choice[i] = 0;
  }
  return false;
}

}  // namespace

PlanQuestions::PlanQuestions(const PlanGraph& graph, const PlanFormulas& formulas,
                             const TypedModel& model) {
  ReferenceBudget budget(kMaxInstances, nullptr);
  ModelExpander expander(model, budget, expanded_);
  expander.begin();
  for (std::size_t i = 0; i < graph.branches.size() && !budget.spent(); ++i) {
    const bool free = graph.branches[graph.branches.id_at(i)].free;
    guards_.push_back(free ? Question{} : write_out(formulas.guards[i], expander));
  }
  for (std::size_t i = 0; i < graph.locations.size() && !budget.spent(); ++i) {
    success_.push_back(write_out(formulas.success[i], expander));
  }
  too_large_ = budget.spent();
  if (too_large_) return;
  values_.assign(expanded_.atom_count(), 0);
  for (std::uint32_t atom = 0; atom < values_.size(); ++atom) {
    if (!expanded_.timepoint(atom)) predicates_.push_back(expanded_.atom_text(atom));
  }
}

void PlanQuestions::settle(std::size_t predicate, bool value) {
  values_[*expanded_.predicate(predicates_[predicate])] = value ? 1 : 0;
}

PlanQuestions::Question PlanQuestions::write_out(const PlanFormula& formula,
                                                 ModelExpander& expander) {
  Question question;
  std::vector<VariableId> variables;
  std::vector<std::vector<std::string>> values;
  for (const auto& [id, variable] : formula.registers) {
    question.registers.push_back(id);
    variables.push_back(variable);
  }
  if (formula.returned) variables.push_back(*formula.returned);
  for (const auto variable : variables) {
    values.push_back(expander.values(variable));
    if (values.back().empty()) return question;
  }
  if (formula.returned) question.objects = values.back();
  // The state that is asked about stands at timepoint 0.
  if (formula.checked.time && !expander.bind(*formula.checked.time, "0")) return question;
  std::vector<std::size_t> choice(variables.size(), 0);
  do {
    std::vector<std::string> key;
    for (std::size_t i = 0; i < variables.size(); ++i) {
      key.push_back(values[i][choice[i]]);
      expander.bind(variables[i], key.back());
    }
    const auto node = expander.instance(formula.checked.formula);
    if (!node) continue;
    note_needs(*node, question.needs);
    question.formulas.emplace(std::move(key), *node);
  } while (next_choice(choice, values));
  if (question.formulas.empty()) question.needs.one_state = false;
  return question;
}

void PlanQuestions::note_needs(FormulaTrees::Node node, Needs& needs) {
  const auto& trees = expanded_.trees();
  const bool effects =
      !trees.effects_of(node, false).empty() || !trees.effects_of(node, true).empty();
  if (effects) needs.one_state = false;
  std::set<std::uint32_t> fluents(needs.fluents.begin(), needs.fluents.end());
  for (const auto atom : trees.atoms_of(node)) {
    if (!expanded_.timepoint(atom)) continue;
    // HoldsAt of the state has the numbers of the fluents.
    if (atom < expanded_.fluents().size()) {
      fluents.insert(atom);
    } else {
      needs.one_state = false;
    }
  }
  needs.fluents.assign(fluents.begin(), fluents.end());
}

bool PlanQuestions::value(const Question& question, const std::vector<std::string>& key,
                          const FluentValue& fluent) const {
  const auto found = question.formulas.find(key);
  if (found == question.formulas.end()) return false;
  auto values = values_;
  for (const auto atom : question.needs.fluents) values[atom] = fluent(atom) ? 1 : 0;
  return expanded_.trees().value(found->second, values);
}

std::vector<std::string> PlanQuestions::key_of(const Question& question,
                                               const RegisterObjects& registers) {
  std::vector<std::string> key;
  for (const auto id : question.registers) key.push_back(registers.at(id));
  return key;
}

bool PlanQuestions::holds(BranchId branch, const RegisterObjects& registers,
                          const FluentValue& fluent) const {
  const auto& question = guards_[branch.index()];
  return value(question, key_of(question, registers), fluent);
}

bool PlanQuestions::succeeds(LocationId location, const RegisterObjects& registers,
                             const FluentValue& fluent) const {
  const auto& question = success_[location.index()];
  if (!question.objects.empty()) return !found(location, registers, fluent).empty();
  return value(question, key_of(question, registers), fluent);
}

std::vector<std::string> PlanQuestions::found(LocationId location, const RegisterObjects& registers,
                                              const FluentValue& fluent) const {
  const auto& question = success_[location.index()];
  auto key = key_of(question, registers);
  key.emplace_back();
  std::vector<std::string> out;
  for (const auto& object : question.objects) {
    key.back() = object;
    if (value(question, key, fluent)) out.push_back(object);
  }
  return out;
}

}  // namespace parallax::compiler
