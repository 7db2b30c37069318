#include "compiler/sema/axiom_shapes.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "compiler/base/codes/names.h"
#include "compiler/sema/instance_existence.h"

namespace parallax::compiler {

namespace {

enum class Polarity : std::uint8_t { kPositive, kNegative, kBoth };

Polarity flipped(Polarity polarity) {
  if (polarity == Polarity::kBoth) return polarity;
  return polarity == Polarity::kPositive ? Polarity::kNegative : Polarity::kPositive;
}

/// An effect or trajectory atom and its context.
struct Occurrence {
  TypedFormulaId atom;
  Polarity polarity = Polarity::kPositive;
  /// Is the atom reached from the root through `[..]`, right sides of `->` and `&` alone?
  bool head = false;
  bool in_condition = false;  // does it stand on the left of some `->`?
  std::string_view place;     // of an atom that is no head, for the message
};

class ShapeReader {
 public:
  ShapeReader(std::string label, TypedModel& model, base::DiagnosticSink& sink)
      : label_(std::move(label)), model_(model), sink_(sink) {}

  void read(TypedFormulaId root) {
    find_occurrences(root);
    if (!check_occurrences()) return;
    const bool any_head = std::any_of(occurrences_.begin(), occurrences_.end(),
                                      [](const Occurrence& found) { return found.head; });
    if (any_head) {
      split(root);
    } else {
      model_.axioms.push_back({label_, root, model_.formulas[root].source, true});
    }
  }

 private:
  enum class StepKind : std::uint8_t { kVariables, kCondition, kBeside };
  /// One step on the way from the root to a conjunct.
  struct Prefix {
    std::optional<std::size_t> before;
    TypedFormulaId formula;  // a kForall, a condition, or a conjunct beside the way
    StepKind kind = StepKind::kCondition;
  };
  struct Task {
    TypedFormulaId formula;
    std::optional<std::size_t> prefix;
  };

  const TypedFormula& at(TypedFormulaId id) const { return model_.formulas[id]; }

  std::optional<EffectKind> effect(const TypedFormula& formula) const {
    if (formula.kind != FormulaKind::kAtom) return std::nullopt;
    if (formula.predicate == model_.core.initiates) return EffectKind::kInitiates;
    if (formula.predicate == model_.core.terminates) return EffectKind::kTerminates;
    if (formula.predicate == model_.core.releases) return EffectKind::kReleases;
    return std::nullopt;
  }
  std::optional<TrajectoryKind> trajectory(const TypedFormula& formula) const {
    if (formula.kind != FormulaKind::kAtom) return std::nullopt;
    if (formula.predicate == model_.core.trajectory) return TrajectoryKind::kTrajectory;
    if (formula.predicate == model_.core.anti_trajectory) return TrajectoryKind::kAntiTrajectory;
    return std::nullopt;
  }

  // --- where the atoms stand ---

  void find_occurrences(TypedFormulaId root) {
    struct Visit {
      TypedFormulaId formula;
      Polarity polarity;
      bool head;
      bool in_condition;
      std::string_view place;
    };
    std::vector<Visit> stack = {{root, Polarity::kPositive, true, false, {}}};
    while (!stack.empty()) {
      const Visit visit = stack.back();
      stack.pop_back();
      const TypedFormula& formula = at(visit.formula);
      const auto go = [&](TypedFormulaId child, Polarity polarity, bool head,
                          std::string_view place) {
        // The outermost construct that is in the way is the one to name.
        const bool keep = !visit.head;
        stack.push_back(
            {child, polarity, visit.head && head, visit.in_condition, keep ? visit.place : place});
      };
      switch (formula.kind) {
        case FormulaKind::kTrue:
        case FormulaKind::kFalse:
        case FormulaKind::kCompare:
        case FormulaKind::kAggregate:  // it has no effects in it
        case FormulaKind::kTemporal:
          break;
        case FormulaKind::kAtom:
          if (effect(formula) || trajectory(formula)) {
            occurrences_.push_back(
                {visit.formula, visit.polarity, visit.head, visit.in_condition, visit.place});
          }
          break;
        case FormulaKind::kNot:
          go(formula.children[0], flipped(visit.polarity), false, "under a negation");
          break;
        case FormulaKind::kAnd:
          for (const auto child : formula.children) go(child, visit.polarity, true, {});
          break;
        case FormulaKind::kOr:
          for (const auto child : formula.children) {
            go(child, visit.polarity, false, "in a disjunction");
          }
          break;
        case FormulaKind::kImplies:
          go(formula.children[0], flipped(visit.polarity), false, "in a condition");
          stack.back().in_condition = true;
          go(formula.children[1], visit.polarity, true, {});
          break;
        case FormulaKind::kIff:
          for (const auto child : formula.children) iff_side(child, go);
          break;
        case FormulaKind::kForall:
          go(formula.children[0], visit.polarity, true, {});
          break;
        case FormulaKind::kExists:
          go(formula.children[0], visit.polarity, false, "below an existential quantifier");
          break;
      }
    }
    // The stack turned the order round.
    std::reverse(occurrences_.begin(), occurrences_.end());
  }

  /// An atom that is a whole side of `<->` looks like an effect axiom but is not one; inside a side
  /// it is part of the definition of the other.
  template <typename Go>
  void iff_side(TypedFormulaId side, const Go& go) {
    const bool whole = effect(at(side)) || trajectory(at(side));
    go(side, whole ? Polarity::kPositive : Polarity::kBoth, false, "on a side of `<->`");
  }

  /// In a condition an effect stands for its completed meaning, negated or not. Elsewhere it would
  /// assert an effect where a formula that is no effect axiom cannot.
  bool check_occurrences() {
    bool fine = true;
    for (const auto& found : occurrences_) {
      if (found.head) continue;
      const auto& atom = at(found.atom);
      const auto& name = model_.symbols[atom.predicate].name;
      const bool is_trajectory = trajectory(atom).has_value();
      if (is_trajectory && found.in_condition) {
        sink_.error(codes::kTrajectoryInCondition, atom.source, name);
        fine = false;
      } else if (is_trajectory || (!found.in_condition && found.polarity == Polarity::kPositive)) {
        auto report = sink_.error(codes::kEffectShape, atom.source, name, found.place);
        if (found.place.starts_with("below")) {
          report.fix(
              "a quantifier reaches to the end of the formula: put parentheses around the "
              "condition, as in `({x} P(x)) -> ...`");
        }
        fine = false;
      }
    }
    return fine;
  }

  // --- taking it apart ---

  void split(TypedFormulaId root) {
    std::vector<Task> stack = {{root, std::nullopt}};
    while (!stack.empty()) {
      const Task task = stack.back();
      stack.pop_back();
      const TypedFormula& formula = at(task.formula);
      switch (formula.kind) {
        case FormulaKind::kForall:
          stack.push_back(
              {formula.children[0], extend(task.prefix, task.formula, StepKind::kVariables)});
          break;
        case FormulaKind::kImplies:
          stack.push_back({formula.children[1],
                           extend(task.prefix, formula.children[0], StepKind::kCondition)});
          break;
        case FormulaKind::kAnd:
          has_conjuncts_ = true;
          for (auto child = formula.children.rbegin(); child != formula.children.rend(); ++child) {
            auto prefix = task.prefix;
            for (const auto other : formula.children) {
              if (other != *child) prefix = extend(prefix, other, StepKind::kBeside);
            }
            stack.push_back({*child, prefix});
          }
          break;
        case FormulaKind::kTrue:
        case FormulaKind::kFalse:
        case FormulaKind::kAtom:
        case FormulaKind::kCompare:
        case FormulaKind::kNot:
        case FormulaKind::kOr:
        case FormulaKind::kIff:
        case FormulaKind::kExists:
        case FormulaKind::kAggregate:
        case FormulaKind::kTemporal:
          add_conjunct(task, root);
          break;
      }
    }
  }

  std::size_t extend(std::optional<std::size_t> before, TypedFormulaId formula, StepKind kind) {
    prefixes_.push_back({before, formula, kind});
    return prefixes_.size() - 1;
  }

  /// From the root to the conjunct.
  std::vector<Prefix> way(std::optional<std::size_t> last) const {
    std::vector<Prefix> steps;
    for (; last; last = prefixes_[*last].before) steps.push_back(prefixes_[*last]);
    std::reverse(steps.begin(), steps.end());
    return steps;
  }

  void add_conjunct(const Task& task, TypedFormulaId root) {
    std::vector<VariableId> variables;
    std::vector<TypedFormulaId> conditions;
    auto steps = way(task.prefix);
    const auto beside = take_beside(steps, task.formula);
    for (const auto& step : steps) {
      if (step.kind == StepKind::kCondition) {
        conditions.push_back(step.formula);
      } else {
        const auto& own = at(step.formula).variables;
        variables.insert(variables.end(), own.begin(), own.end());
      }
    }
    const auto source = at(root).source;
    const auto kind = effect(at(task.formula));
    if (kind) warn_about_shape(steps, task.formula, root);
    if (!beside.empty()) {
      const auto condition = conjunction(conditions, task.formula);
      model_.shared_instances.push_back({variables, condition,
                                         existence_formula(model_, task.formula), beside,
                                         at(task.formula).source});
      for (const auto& other : beside) {
        conditions.push_back(other.existence);
        steps.push_back({std::nullopt, other.existence, StepKind::kCondition});
      }
    }
    const bool shares = !beside.empty();
    if (kind) {
      const auto condition = conjunction(std::move(conditions), task.formula);
      const auto& terms = at(task.formula).terms;
      model_.effects.push_back({*kind, std::move(variables), condition, terms[0], terms[1],
                                terms[2], label_, source, shares});
    } else if (const auto path = trajectory(at(task.formula))) {
      const auto condition = conjunction(std::move(conditions), task.formula);
      const auto& terms = at(task.formula).terms;
      model_.trajectories.push_back({*path, std::move(variables), condition, terms[0], terms[1],
                                     terms[2], terms[3], label_, source});
    } else {
      const auto formula = rebuilt(steps, task.formula);
      model_.axioms.push_back({label_, formula, source, mentions_effects(model_, formula)});
    }
  }

  /// Takes the conjuncts beside the way out of `steps`. Those that may be missing where this one
  /// exists come back, each as a formula that exists with it: an instance says all or nothing.
  std::vector<SharedInstance::Part> take_beside(std::vector<Prefix>& steps,
                                                TypedFormulaId conjunct) {
    std::set<std::uint32_t> before_last;
    collect_event_times(model_, conjunct, before_last);
    if (trajectory(at(conjunct))) {
      const auto& time = model_.terms[at(conjunct).terms[1]];
      if (time.kind == TermKind::kVariable) before_last.insert(time.variable.index());
    }
    for (const auto& step : steps) {
      if (step.kind == StepKind::kCondition) collect_event_times(model_, step.formula, before_last);
    }
    std::vector<SharedInstance::Part> found;
    for (const auto& step : steps) {
      if (step.kind != StepKind::kBeside) continue;
      if (!may_lack_instances(model_, step.formula, before_last)) continue;
      found.push_back({existence_formula(model_, step.formula), at(step.formula).source});
    }
    std::erase_if(steps, [](const Prefix& step) { return step.kind == StepKind::kBeside; });
    return found;
  }

  TypedFormulaId conjunction(std::vector<TypedFormulaId> parts, TypedFormulaId head) {
    if (parts.size() == 1) return parts.front();
    TypedFormula formula;
    formula.kind = parts.empty() ? FormulaKind::kTrue : FormulaKind::kAnd;
    formula.source = parts.empty() ? at(head).source : at(parts.front()).source;
    if (!parts.empty()) formula.source.end = at(parts.back()).source.end;
    formula.children = std::move(parts);
    return model_.formulas.add(std::move(formula));
  }

  /// The ordinary conjunct with its own quantifiers and conditions around it.
  TypedFormulaId rebuilt(const std::vector<Prefix>& steps, TypedFormulaId conjunct) {
    for (auto step = steps.rbegin(); step != steps.rend(); ++step) {
      TypedFormula formula;
      formula.source = at(conjunct).source;
      if (step->kind == StepKind::kCondition) {
        formula.kind = FormulaKind::kImplies;
        formula.children = {step->formula, conjunct};
      } else {
        formula.kind = FormulaKind::kForall;
        formula.variables = at(step->formula).variables;
        formula.children = {conjunct};
      }
      conjunct = model_.formulas.add(std::move(formula));
    }
    return conjunct;
  }

  /// The 2005 reasoner accepts exactly `[..] atom` and `[..] condition -> atom`; it asserts other
  /// shapes without telling its frame axioms.
  void warn_about_shape(const std::vector<Prefix>& steps, TypedFormulaId head,
                        TypedFormulaId root) {
    if (std::exchange(warned_, true)) return;
    std::string_view reason;
    const bool one_quantifier = !steps.empty() && steps.front().kind == StepKind::kVariables;
    const std::size_t expected =
        one_quantifier && steps.size() == 2 && steps[1].kind == StepKind::kCondition ? 2 : 1;
    if (!label_.empty()) {
      reason = "takes it for an ordinary formula, because it has a label";
    } else if (steps.empty() || !one_quantifier) {
      reason = "loses sight of it, because it does not start with `[...]`";
    } else if (steps.size() != expected) {
      reason = "loses sight of it, because it has more than one `[...]` or `->`";
    } else if (std::count_if(occurrences_.begin(), occurrences_.end(),
                             [](const Occurrence& found) { return found.head; }) > 1) {
      reason = "loses sight of it, because it has more than one effect";
    } else if (has_conjuncts_) {
      reason = "loses sight of it, because it is a part of a conjunction";
    } else if (occurrences_.size() > 1) {
      reason = "takes the effect in its condition for what that effect would bring about";
    } else if (model_.terms[at(head).terms[2]].kind != TermKind::kVariable) {
      reason = "lets the fluent change at every timepoint, because its time is no variable";
    } else {
      return;
    }
    sink_.warning(codes::kEffectShapeOldReasoner, at(root).source, reason);
  }

  const std::string label_;
  TypedModel& model_;
  base::DiagnosticSink& sink_;
  std::vector<Occurrence> occurrences_;
  std::vector<Prefix> prefixes_;
  bool warned_ = false;
  bool has_conjuncts_ = false;  // the asserted formula is a conjunction
};

}  // namespace

bool mentions_effects(const TypedModel& model, TypedFormulaId root) {
  const auto& core = model.core;
  std::vector<TypedFormulaId> todo = {root};
  while (!todo.empty()) {
    const auto& formula = model.formulas[todo.back()];
    todo.pop_back();
    if (formula.kind == FormulaKind::kAtom &&
        (formula.predicate == core.initiates || formula.predicate == core.terminates ||
         formula.predicate == core.releases)) {
      return true;
    }
    todo.insert(todo.end(), formula.children.begin(), formula.children.end());
  }
  return false;
}

bool defines_by_effects(const TypedModel& model, const Axiom& axiom) {
  if (!axiom.mentions_effects) return false;
  auto root = axiom.formula;
  while (model.formulas[root].kind == FormulaKind::kForall) {
    root = model.formulas[root].children.front();
  }
  return model.formulas[root].kind == FormulaKind::kIff;
}

void add_effect_formula(TypedFormulaId formula, std::string label, TypedModel& model,
                        base::DiagnosticSink& sink) {
  ShapeReader(std::move(label), model, sink).read(formula);
}

}  // namespace parallax::compiler
