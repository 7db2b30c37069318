#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "compiler/base/diagnostic.h"
#include "compiler/base/result.h"
#include "compiler/plan/failure_classes.h"
#include "compiler/plan/model_names.h"
#include "compiler/plan/plan_binding.h"
#include "compiler/plan/plan_graph.h"
#include "compiler/plan/plan_value.h"
#include "compiler/plan/pose_locator.h"

namespace parallax::compiler {

/// Says what one performed designator means in the model: event, success formula, failure class
/// and the arguments for a controller.
class PerformResolver {
 public:
  PerformResolver(const PlanBinding& binding, const PoseLocator& locator, ModelNames constants,
                  ModelNames fluents, const FailureClasses& classes, const PlanGraph& graph,
                  const ValueStore& values, base::DiagnosticSink& sink)
      : binding_(binding),
        locator_(locator),
        constants_(std::move(constants)),
        fluents_(std::move(fluents)),
        classes_(classes),
        graph_(graph),
        values_(values),
        sink_(sink) {}

  struct Resolved {
    PlanLocation location;  // without targets, calls and result
    const BindingEntry* entry = nullptr;
  };
  /// CPL030 without a binding, CPL031 outside all regions, CPL032 and CPL033 for wrong values.
  base::Result<Resolved> resolve(ValueId designator, base::SourceRange source);

  /// The text of `(holds '(fluent argument...))`.
  base::Result<std::string> fluent(ValueId list, base::SourceRange source);

  /// A value as an argument of the model: a constant, an integer, the name of a model value.
  base::Result<std::string> constant(ValueId value, std::string_view what,
                                     base::SourceRange source);

 private:
  struct Target {
    std::optional<Pose> pose;
    std::string relation;  // otherwise: in, on, ... and the object there
    std::optional<ValueId> object;
  };
  const BindingEntry* find_entry(ValueId designator, base::SourceRange source);
  base::DiagnosticBuilder unbound(ValueId designator, base::SourceRange source);
  std::optional<ValueId> key_value(ValueId designator, std::string_view key) const;
  base::Result<ValueId> variable(const BindingEntry& entry, ValueId designator,
                                 std::string_view name, base::SourceRange source);
  Target target(ValueId value) const;
  base::Result<std::string> mapped(std::string_view function, ValueId value, std::string_view key,
                                   base::SourceRange source);
  base::Result<std::string> substitute(const BindingEntry& entry, const Template& pieces,
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
  const ValueStore& values_;
  base::DiagnosticSink& sink_;
};

}  // namespace parallax::compiler
