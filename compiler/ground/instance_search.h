#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "compiler/ground/conjuncts.h"
#include "compiler/ground/possible_atoms.h"
#include "compiler/ground/term_grounder.h"

namespace parallax::compiler {

/// How to find the instances of a quantified formula that can say anything: an order of filters,
/// equations, table look-ups and, as the last resort, enumerations of sorts. Made once per formula;
/// the variables bound outside are the same for all its uses.
struct InstancePlan {
  enum class StepKind : std::uint8_t {
    kFilter,     // every variable of the conjunct is bound: drop the instance if it is false
    kSolve,      // an equation: `pattern` takes the value of `value`
    kMatch,      // a table row: `pattern` is the atom's fluent or event, or the atom itself
    kEnumerate,  // every element of the variable's sort
  };
  struct Step {
    StepKind kind = StepKind::kEnumerate;
    Conjunct conjunct;
    TermId pattern, value;
    VariableId variable;
    double fan_out = 1.0;  // expected instances per instance so far
  };
  std::vector<Step> steps;
  /// Expected number of instances.
  double estimate = 1.0;
  /// Nothing but enumeration: the number of instances is the product of the sorts.
  bool is_product = true;
};

/// `bound`: variables with a value from outside. `possible` may be null: then atoms are not joined.
/// Cost: quadratic in conjuncts and variables.
InstancePlan plan_instances(const std::vector<VariableId>& variables,
                            const std::vector<Conjunct>& conjuncts, const GroundModel& model,
                            PossibleAtoms* possible, const std::function<bool(VariableId)>& bound);

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
  bool may_meet(const TypedFormula& happens, const TypedFormula& holds);
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
