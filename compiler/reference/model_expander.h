#pragma once

#include <functional>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "compiler/reference/expanded_model.h"

namespace parallax::compiler {

/// Deeper formulas are not expanded: the functions below call themselves for every level.
inline constexpr std::size_t kMaxReferenceDepth = 1'000;

/// Writes every instance of a typed model's formulas into an ExpandedModel. The parts below do what
/// their names say, in this order; recursion is as deep as the formulas are nested.
class ModelExpander {
 public:
  ModelExpander(const TypedModel& model, ReferenceBudget& budget, ExpandedModel& out);
  void run();

  using Value = ReferenceTerms::Value;
  using Node = FormulaTrees::Node;
  /// Instead of `run`: numbers the atoms alone, for `instance`.
  void begin();
  /// Fixes the object that a variable stands for in the formulas expanded from now on, also where
  /// one binds it. False if its sort has no object of that name.
  bool bind(VariableId variable, const std::string& value);
  /// The objects that a variable can stand for.
  std::vector<std::string> values(VariableId variable) const;
  /// From now on nothing happens at the last timepoint; before, such events do not exist.
  void end_events() { events_end_ = true; }
  /// A formula of the model's stores, written out. None: it does not exist.
  std::optional<Node> instance(TypedFormulaId formula) { return expand(formula); }

 private:
  bool too_deep() const;
  void number_atoms();
  void expand_effects();
  void expand_effect(std::size_t index);
  void measure_effects();
  void expand_axioms();
  void expand_trajectories();
  void expand_trajectory(std::size_t index);
  bool is_definition(TypedFormulaId id) const;
  void complete();
  /// The atoms of the predicate that exist so far.
  std::vector<std::uint32_t> atoms_of(SymbolId predicate) const;

  /// Calls `visit` under every assignment of the variables from `position` on.
  void for_each(const std::vector<VariableId>& variables, const std::function<void()>& visit,
                std::size_t position = 0);
  /// None: the formula does not exist.
  std::optional<Node> expand(TypedFormulaId formula);
  std::optional<Node> quantified(const TypedFormula& formula);
  std::optional<Node> aggregate(const TypedFormula& formula);
  std::optional<Node> connected(const TypedFormula& formula);
  std::optional<Node> atom(const TypedFormula& formula);
  std::optional<Node> event_atom(const std::vector<Value>& arguments);
  std::optional<Node> effect_atom(EffectKind kind, const std::vector<Value>& arguments);
  std::optional<Node> compare(const TypedFormula& formula);
  std::optional<Value> term(TermId id) { return terms_.term(id, environment_); }
  ReferenceFormula measured(Node node) const;

  const TypedModel& model_;
  ReferenceBudget& budget_;
  ExpandedModel& out_;
  ReferenceTerms terms_;
  ReferenceTerms::Environment environment_;
  std::vector<bool> bound_;  // by variable
  bool effects_known_ = false;
  bool events_end_ = false;
  /// By kind, event, fluent and timepoint: the number among the expanded model's effects.
  std::map<std::tuple<EffectKind, std::uint32_t, std::uint32_t, std::int64_t>, std::uint32_t>
      effect_numbers_;
};

}  // namespace parallax::compiler
