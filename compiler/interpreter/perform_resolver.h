#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/base/result.h"
#include "compiler/builtins/plan_value.h"
#include "compiler/plan/failure_classes.h"
#include "compiler/plan/model_names.h"
#include "compiler/plan/plan_binding.h"
#include "compiler/plan/plan_graph.h"
#include "compiler/plan/pose_locator.h"

namespace parallax::compiler {

/// The key of a location that says where it is; the others only narrow it.
std::optional<std::size_t> leading_key(const Value& location);

/// Says what one performed designator means in the model: event, success
/// formula, failure class and the arguments for a controller.
class PerformResolver {
 public:
  PerformResolver(const PlanBinding& binding, const PoseLocator& locator, ModelNames constants,
                  ModelNames fluents, const FailureClasses& classes, const PlanGraph& graph,
                  ValueStore& values, base::DiagnosticSink& sink)
      : binding_(binding),
        locator_(locator),
        constants_(std::move(constants)),
        fluents_(std::move(fluents)),
        classes_(classes),
        graph_(graph),
        values_(values),
        sink_(sink) {}

  /// The first entry in written order all of whose keys the designator has;
  /// null: CPL030.
  const BindingEntry* find_entry(ValueId designator, base::SourceRange source);
  /// The same without a report, if it is an action that a function of the plan
  /// carries out.
  const BindingEntry* find_plan(ValueId designator) const;
  /// The location without targets, calls and result. CPL031 outside all
  /// regions, CPL032 and CPL033 for wrong values.
  base::Result<PlanLocation> resolve(const BindingEntry& entry, ValueId designator,
                                     base::SourceRange source);
  /// The value that a variable of the entry stands for.
  base::Result<ValueId> variable(const BindingEntry& entry, ValueId designator,
                                 std::string_view name, base::SourceRange source);

  /// Whether some entry of the table is the designator's.
  bool has_entry(ValueId designator) const { return matching_entry(designator) != nullptr; }
  /// The formula of `(holds '(fluent argument...))`, or of a query.
  base::Result<FormulaTree> question(ValueId list, base::SourceRange source);
  std::span<const QueryBinding> queries() const { return binding_.queries; }
  /// The model's constant that a plan calls so.
  std::optional<std::string> model_constant(std::string_view name) const {
    return constants_.find(name);
  }
  const QueryBinding* find_query(std::string_view name, std::size_t arguments) const;
  /// Formula of the goal, a list, that an action designator has; none if the table does not bind
  /// it. Another error was reported.
  base::Result<std::optional<FormulaTree>> goal_formula(ValueId goal, base::SourceRange source);
  /// Says once (W-GOAL) that nothing tells whether the goal holds.
  void tell_unbound_goal(ValueId goal, base::SourceRange source);
  /// The goals that W-GOAL told of, with the performs that have them, each once.
  const std::vector<std::pair<base::SourceRange, std::string>>& unbound_goals() const {
    return unbound_goals_;
  }
  base::Result<FormulaTree> query_formula(const QueryBinding& query,
                                          std::span<const ValueId> arguments,
                                          base::SourceRange source);
  /// Reports that the table has no such query (CPL030).
  base::DiagnosticBuilder unbound_query(std::string_view name, std::size_t arguments,
                                        base::SourceRange source);

  /// An object that the event needs the name of and the plan has neither named
  /// nor detected; the way there: designators from the value of a key inwards,
  /// each with the key that leads on.
  struct Reference {
    const ObjectBinding* binding = nullptr;
    std::vector<std::pair<ValueId, std::size_t>> path;  // the performed designator first
    ValueId object;
  };
  std::optional<Reference> reference(const BindingEntry& entry, ValueId designator) const;
  /// Condition under which the object of the reference is the one with this name.
  base::Result<FormulaTree> candidate(const Reference& reference, std::string_view name,
                                      base::SourceRange source);

  /// A value as an argument of the model: a constant, an integer, a register.
  base::Result<FormulaTree> constant(ValueId value, std::string_view what,
                                     base::SourceRange source);

 private:
  struct Target {
    std::optional<PlanPose> pose;
    std::optional<ValueId> object;  // otherwise: what it is in, on or of
  };
  using Variables = std::map<std::string, ValueId, std::less<>>;
  base::Result<FormulaTree> fill(const FormulaTree& formula, const Variables& variables,
                                 base::SourceRange source);
  base::DiagnosticBuilder unbound(ValueId designator, base::SourceRange source);
  const BindingEntry* matching_entry(ValueId designator) const;
  std::optional<ValueId> key_value(ValueId designator, std::string_view key) const;
  Target target(ValueId value) const;
  base::Result<FormulaTree> mapped(std::string_view function, ValueId value, std::string_view key,
                                   base::SourceRange source);
  base::Result<FormulaTree> fill(const BindingEntry& entry, const FormulaTree& formula,
                                 ValueId designator, base::SourceRange source);
  base::Result<std::string> model_name(const ModelNames& names, std::string_view name,
                                       base::SourceRange source);
  void flatten(const std::string& name, ValueId value, PlanArguments& out) const;
  PlanArguments arguments(ValueId designator) const;

  const PlanBinding& binding_;
  const PoseLocator& locator_;
  ModelNames constants_;
  ModelNames fluents_;
  const FailureClasses& classes_;
  const PlanGraph& graph_;
  ValueStore& values_;
  base::DiagnosticSink& sink_;
  std::vector<std::pair<base::SourceRange, std::string>> unbound_goals_;
};

}  // namespace parallax::compiler
