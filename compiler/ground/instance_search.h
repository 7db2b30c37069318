#pragma once

#include <vector>

#include "compiler/ground/instance_plan.h"
#include "compiler/ground/term_grounder.h"

namespace parallax::compiler {

/// Runs a plan: finds the assignments of `variables` under which every conjunct of the plan can be
/// true, given the values bound in `terms`. Assignments come out sorted and without repetition,
/// one after the other in one array (`variables.size()` values each). Every row that is looked at
/// and every assignment counts against the budget.
class InstanceSearch {
 public:
  InstanceSearch(TermGrounder& terms, PossibleAtoms* possible)
      : terms_(terms), possible_(possible) {}
  std::vector<GroundTermId> run(const InstancePlan& plan, const std::vector<VariableId>& variables);

 private:
  void step(std::size_t number);
  bool filter(const Conjunct& conjunct);
  bool may_be_true(const TypedFormula& atom);
  bool match(TermId pattern, GroundTermId value);
  /// Has the term a variable without a value?
  bool is_open(TermId id) const;
  bool match_arithmetic(const Term& pattern, GroundTermId value);
  void match_rows(const InstancePlan::Step& step, std::size_t number);
  bool take(VariableId variable, GroundTermId value);
  void undo(std::size_t mark);

  TermGrounder& terms_;
  PossibleAtoms* possible_;
  const InstancePlan* plan_ = nullptr;
  const std::vector<VariableId>* variables_ = nullptr;
  std::vector<VariableId> trail_;
  std::vector<GroundTermId> found_;
};

}  // namespace parallax::compiler
