// The model as induction over time needs it.
//
// A window is any stretch of k steps of a trace that begins after the last timepoint that an axiom
// names as a number. Each axiom that the rest of the model has is a template (time_profile.h): it
// relates a timepoint to its neighbours in the same way everywhere. So a window is a trace, of
// horizon k, of the model without the axioms about single timepoints; only its start is more open,
// because fluents may have been released before. Leaving axioms out admits more windows, which is
// the safe side, but for completion: a reason that is left out would forbid. Reasons are therefore
// required to lie in the step of the event itself, where every window has them.
//
// Cost: linear in the typed model for the check; a window is grounded like a model of its horizon.

#include "compiler/pipeline/induction_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "compiler/base/codes/grounding.h"
#include "compiler/cnf/encoder.h"
#include "compiler/formula/formula.h"
#include "compiler/ground/conjuncts.h"
#include "compiler/ground/formula_grounder.h"
#include "compiler/ground/grounder.h"
#include "compiler/ground/time_profile.h"
#include "compiler/lint/lint_context.h"
#include "compiler/sema/axiom_shapes.h"

namespace parallax::compiler {
namespace {

constexpr const char* kMixedTime =
    "this relates timepoints otherwise than as `time` and its neighbours";

class ShapeReader {
 public:
  ShapeReader(const TypedModel& model, base::DiagnosticSink& sink) : model_(model), sink_(sink) {}

  base::Result<InductionShape> read(const StateConstraint& property) {
    const auto errors_before = sink_.error_count();
    look_at_declarations();
    for (const auto& path : model_.trajectories) refuse(path.source, "this is a trajectory");
    for (const auto& effect : model_.effects) look_at(effect);
    for (const auto& axiom : model_.axioms) look_at(axiom);
    look_at(property);
    if (sink_.error_count() != errors_before) return sink_.already_reported();
    return shape_;
  }

 private:
  void refuse(base::SourceRange source, const std::string& why) {
    sink_.error(codes::kNoInduction, source, why);
  }
  /// Do elements of the sort depend on the horizon?
  bool has_timepoints(SortId sort) const {
    const auto time = *model_.core.time;
    return model_.is_subsort(time, sort) || model_.is_subsort(sort, time);
  }
  bool takes_timepoints(const Symbol& symbol) const {
    return std::any_of(symbol.arguments.begin(), symbol.arguments.end(),
                       [&](SortId sort) { return has_timepoints(sort); }) ||
           (symbol.kind == SymbolKind::kFunction && has_timepoints(*symbol.result));
  }
  bool is_core(SymbolId predicate) const {
    const auto& core = model_.core;
    for (const auto& one : {core.happens, core.holds_at, core.released_at, core.initiates,
                            core.terminates, core.releases}) {
      if (predicate == one) return true;
    }
    return false;
  }

  void look_at_declarations() {
    for (const auto& symbol : model_.symbols) {
      if (symbol.kind == SymbolKind::kPredicate || !takes_timepoints(symbol)) continue;
      refuse(symbol.declared, fmt::format("a timepoint can stand in `{}`", symbol.name));
    }
  }

  /// Quantifiers over timepoints, but for the one that says "at every timepoint", and predicates
  /// about timepoints.
  std::optional<std::string> foreign_time(TypedFormulaId root, const TimeProfile& profile) const {
    std::optional<std::string> why;
    for_each_formula(model_, root, [&](TypedFormulaId id) {
      const auto& formula = model_.formulas[id];
      for (const auto variable : formula.variables) {
        if (is_counted(variable, profile)) why = goes_through(variable);
      }
      if (formula.kind != FormulaKind::kAtom || is_core(formula.predicate)) return;
      const auto& symbol = model_.symbols[formula.predicate];
      if (takes_timepoints(symbol)) {
        why = fmt::format("a timepoint can stand in `{}`", symbol.name);
      }
    });
    return why;
  }
  bool is_counted(VariableId variable, const TimeProfile& profile) const {
    const bool own = profile.shape == TimeShape::kUniform && variable == profile.variable;
    return !own && has_timepoints(model_.variables[variable].sort);
  }
  std::string goes_through(VariableId variable) const {
    return fmt::format("`{}` goes through timepoints up to the horizon",
                       model_.variables[variable].name);
  }

  void look_at(const EffectAxiom& effect) {
    const auto profile = time_profile(model_, effect);
    if (profile.shape == TimeShape::kFixed) {
      return refuse(effect.source, "this effect is one of a single timepoint");
    }
    if (profile.shape != TimeShape::kUniform) return refuse(effect.source, kMixedTime);
    auto why = foreign_time(effect.condition, profile);
    for (const auto variable : effect.variables) {
      if (is_counted(variable, profile)) why = goes_through(variable);
    }
    if (why) refuse(effect.source, *why);
  }

  void look_at(const Axiom& axiom) {
    const auto profile = time_profile(model_, axiom.formula);
    if (const auto why = foreign_time(axiom.formula, profile)) return refuse(axiom.source, *why);
    switch (profile.shape) {
      case TimeShape::kMixed:
        return refuse(axiom.source, kMixedTime);
      case TimeShape::kFixed:
        shape_.last_fixed = std::max(shape_.last_fixed, profile.last);
        break;
      case TimeShape::kUniform:
        shape_.width = std::max(shape_.width, profile.width);
        break;
      case TimeShape::kRigid:
        break;
    }
    if (!defines_by_effects(model_, axiom)) look_at_reasons(axiom, profile);
  }

  /// Completion has to make the same of the axiom in every window.
  void look_at_reasons(const Axiom& axiom, const TimeProfile& profile) {
    for (const auto id : positive_atoms(model_, axiom.formula)) {
      const auto predicate = model_.formulas[id].predicate;
      const bool completed = std::any_of(
          model_.completions.begin(), model_.completions.end(), [&](const Completion& one) {
            return one.predicate == predicate && (!one.label || *one.label == axiom.label);
          });
      if (!completed || lies_in_its_step(model_.formulas[id], profile)) continue;
      return refuse(axiom.source,
                    fmt::format("this is a reason of the completed `{}` and speaks of {}",
                                model_.symbols[predicate].name,
                                is_core(predicate) ? "another timepoint" : "timepoints"));
    }
  }
  bool lies_in_its_step(const TypedFormula& atom, const TimeProfile& profile) const {
    if (!is_core(atom.predicate)) return profile.shape == TimeShape::kRigid;
    if (profile.shape != TimeShape::kUniform) return true;
    const bool event = atom.predicate == model_.core.happens;
    return profile.width == (event ? 1 : 0) && (profile.width == 0 || is_earliest(atom, profile));
  }
  bool is_earliest(const TypedFormula& atom, const TimeProfile& profile) const {
    const auto& time = model_.terms[atom.terms[1]];
    if (profile.back == 0) return time.kind == TermKind::kVariable;
    if (time.kind != TermKind::kArithmetic || time.op != ArithmeticOp::kSubtract) return false;
    const auto& by = model_.terms[time.arguments[1]];
    return model_.terms[time.arguments[0]].kind == TermKind::kVariable &&
           by.kind == TermKind::kInteger && by.integer == profile.back;
  }

  void look_at(const StateConstraint& property) {
    shape_.source = property.source;
    shape_.formula = property.formula.formula;
    shape_.time = property.formula.time;
    shape_.negated = property.temporal;
    if (property.temporal) {
      const auto& root = model_.formulas[shape_.formula];
      if (root.kind == FormulaKind::kTemporal && root.temporal == TemporalOp::kAlways) {
        shape_.formula = root.children[0];
      }
      bool plain = true;
      for_each_formula(model_, shape_.formula, [&](TypedFormulaId id) {
        plain = plain && model_.formulas[id].kind != FormulaKind::kTemporal;
      });
      if (!plain) {
        return refuse(property.source,
                      "the property has a temporal operator other than an `always` around it");
      }
    }
    const auto profile = time_profile(model_, shape_.formula, shape_.time);
    const bool rigid = profile.shape == TimeShape::kRigid && !shape_.time;
    if (!rigid && profile.shape != TimeShape::kUniform) return refuse(property.source, kMixedTime);
    if (const auto why = foreign_time(shape_.formula, profile)) {
      return refuse(property.source, *why);
    }
    shape_.back = profile.back;
    shape_.ahead = profile.width - profile.back;
  }

  const TypedModel& model_;
  base::DiagnosticSink& sink_;
  InductionShape shape_;
};

/// Leaves the axioms about single timepoints out, and what was released before open.
void make_window(TypedModel& model, Timepoint steps) {
  const auto releasable = releasable_symbols(model);
  for (std::size_t i = 0; i < releasable.size(); ++i) {
    auto& symbol = model.symbols[model.symbols.id_at(i)];
    if (symbol.kind == SymbolKind::kFluent && releasable[i]) symbol.manual_release = true;
  }
  std::erase_if(model.axioms, [&](const Axiom& axiom) {
    return time_profile(model, axiom.formula).shape == TimeShape::kFixed;
  });
  auto& ranges = model.sorts[*model.core.time].ranges;
  ranges.resize(1);
  ranges.front().lower = 0;
  ranges.front().upper = steps;
}

/// Is the formula true, whatever else, where no event happens?
bool true_without_events(GroundModel& model, FormulaId formula) {
  RewriteMemo memo;
  auto& formulas = model.formulas();
  const auto without = rewrite_atoms(
      formulas, formula,
      [&](std::int32_t variable) {
        return model.atom(variable).kind == AtomKind::kHappens ? formulas.falsity()
                                                               : formulas.atom(variable);
      },
      memo);
  return without == formulas.truth();
}

}  // namespace

base::Result<InductionShape> induction_shape(const Compilation& compilation,
                                             base::DiagnosticSink& sink) {
  return ShapeReader(*compilation.typed, sink).read(compilation.constraints.front());
}

base::Result<CompiledModel> compile_breaks(const TypedModel& checked, const InductionShape& shape,
                                           std::optional<Timepoint> stretch,
                                           const GroundOptions& options,
                                           base::DiagnosticSink& sink) {
  auto model = checked;
  if (stretch) make_window(model, *stretch);
  auto ground = ground_model(model, options, sink);
  if (!ground) return sink.already_reported();
  FormulaGrounder grounder(*ground, options, sink);
  const auto origin = ground->add_origin(shape.source, OriginKind::kStateConstraint);
  auto& formulas = ground->formulas();
  for (Timepoint t = shape.back; t + shape.ahead <= ground->horizon(); ++t) {
    grounder.start(shape.source);
    if (shape.time) grounder.bind(*shape.time, ground->terms().integer(t));
    const auto said = grounder.ground(shape.formula);
    if (grounder.failed()) return sink.already_reported();
    if (said && shape.ahead > 0 && !true_without_events(*ground, *said)) {
      return sink.error(codes::kNoInduction, shape.source,
                        "nothing happens at the last timepoint, and the property asks for more "
                        "than that; say it of `time-1`");
    }
    const auto broken = !said ? formulas.falsity() : shape.negated ? ~*said : *said;
    const auto hit = ground->plan_atom(AtomKind::kHit, {}, t);
    ground->require(formulas.equivalence(hit, broken), origin);
  }
  auto compiled = encode(*ground);
  compiled.has_constraints = true;
  return compiled;
}

}  // namespace parallax::compiler
