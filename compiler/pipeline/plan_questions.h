#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "compiler/pipeline/plan_formulas.h"
#include "compiler/plan/plan_graph.h"
#include "compiler/plan/plan_walk.h"
#include "compiler/reference/expanded_model.h"
#include "compiler/reference/model_expander.h"

namespace parallax::compiler {

/// Evaluates the formulas of a plan in one observed state: guards of branches, whether a perform
/// has succeeded, and which objects it can have found. The formulas are expanded once for all
/// values of the registers. Queries change nothing, so threads may share the object.
class PlanQuestions {
 public:
  /// Value of the fluent with this number in `fluents()`.
  using FluentValue = std::function<bool(std::uint32_t)>;

  PlanQuestions(const PlanGraph& graph, const PlanFormulas& formulas, const TypedModel& model);

  /// The formulas have too many instances to be expanded: no query is allowed.
  bool too_large() const { return too_large_; }
  /// "RobotAt(r1)"
  const std::vector<std::string>& fluents() const { return expanded_.fluents(); }
  /// The user's predicates that the formulas mention: "Kind(cup1,cup)". Taken as false until they
  /// are settled.
  const std::vector<std::string>& predicates() const { return predicates_; }
  void settle(std::size_t predicate, bool value);

  /// Inputs that an answer depends on. `one_state`: fluents of one timepoint and predicates alone.
  struct Needs {
    bool one_state = true;
    std::vector<std::uint32_t> fluents;  // ascending
  };
  const Needs& of_guard(BranchId branch) const { return guards_[branch.index()].needs; }
  const Needs& of_success(LocationId location) const { return success_[location.index()].needs; }

  /// Does the guard of the branch hold? The branch must not be a free one.
  bool holds(BranchId branch, const RegisterObjects& registers, const FluentValue& fluent) const;
  /// Does the success formula of a perform hold in the state that its binding names?
  bool succeeds(LocationId location, const RegisterObjects& registers,
                const FluentValue& fluent) const;
  /// Objects for which the success formula holds, in the order of their declaration. Only for a
  /// perform that returns something.
  std::vector<std::string> found(LocationId location, const RegisterObjects& registers,
                                 const FluentValue& fluent) const;

 private:
  struct Question {
    std::vector<ModelValueId> registers;
    std::vector<std::string> objects;  // candidates for the result
    /// By the objects in the registers, followed by the object that is found. Formulas that do not
    /// exist are absent.
    std::map<std::vector<std::string>, FormulaTrees::Node> formulas;
    Needs needs;
  };
  Question write_out(const PlanFormula& formula, ModelExpander& expander);
  void note_needs(FormulaTrees::Node node, Needs& needs);
  bool value(const Question& question, const std::vector<std::string>& key,
             const FluentValue& fluent) const;
  static std::vector<std::string> key_of(const Question& question,
                                         const RegisterObjects& registers);

  ExpandedModel expanded_;
  std::vector<Question> guards_;   // by branch
  std::vector<Question> success_;  // by location
  std::vector<std::string> predicates_;
  FormulaTrees::Values values_;  // by atom: settled predicates
  bool too_large_ = false;
};

}  // namespace parallax::compiler
