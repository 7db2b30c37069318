#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/ground/ground_model.h"
#include "compiler/ground/instance_search.h"
#include "compiler/ground/term_grounder.h"

namespace parallax::compiler {

/// Expands typed formulas into propositional ones under an assignment of the free variables.
///
/// The horizon is finite, so an instance can name a timepoint, an event occurrence or an integer
/// that does not exist. Such an instance says nothing: it leaves the innermost quantifier around
/// it; a quantifier none of whose instances exists passes this on. In the 2005 reasoner's meaning
/// such a quantifier is empty, a conjunction with a false part is false all the same, a disjunction
/// with a true part true.
///
/// Quantifiers do not run through the product of their sorts: a plan of equations and table
/// look-ups finds the instances that can say anything.
class FormulaGrounder {
 public:
  FormulaGrounder(GroundModel& model, const GroundOptions& options, base::DiagnosticSink& sink);

  /// From now on Initiates, Terminates and Releases in formulas mean these rows; before, they name
  /// nothing. `rows` outlives the grounder.
  void use_effects(EffectRows& rows) { rows_ = &rows; }
  /// Is the formula grounded next a whole axiom? To the 2005 reasoner Happens at the last timepoint
  /// is an atom where no quantifier stands around it.
  void read_whole_axiom(bool whole) { whole_axiom_ = whole; }
  /// Do events at the last timepoint get an atom of their own, `happens_last`? Otherwise they do
  /// not exist.
  void name_last_events(bool name) { names_last_events_ = name; }
  /// From now on an effect in a formula is the atom that the function gives; null: as before.
  using EffectAtoms =
      std::function<FormulaId(EffectKind, std::uint32_t event, std::uint32_t fluent, Timepoint)>;
  void use_effect_atoms(EffectAtoms atoms) { effect_atoms_ = std::move(atoms); }
  /// From now on instances are looked up among the atoms that may be true (null: in whole sorts).
  /// `possible` outlives the grounder.
  void use_possible(PossibleAtoms* possible);
  PossibleAtoms* possible() const { return possible_; }

  /// Gives a variable a value; a quantifier over it then has the one instance.
  void bind(VariableId variable, GroundTermId value) { terms_.bind(variable, value); }
  void unbind(VariableId variable) { terms_.unbind(variable); }
  void start(base::SourceRange blame) { terms_.start(blame); }
  bool failed() const { return terms_.failed(); }
  bool spend(std::int64_t more) { return terms_.spend(more); }
  TermGrounder& terms() { return terms_; }

  /// None: the formula names something that does not exist (or an error was reported).
  std::optional<FormulaId> ground(TypedFormulaId formula);
  /// None: the term does not denote.
  std::optional<GroundTermId> term(TermId term) { return terms_.term(term); }
  /// The assignments of the variables that have no value yet under which all conjuncts can hold,
  /// as InstanceSearch gives them.
  std::vector<GroundTermId> instances(const std::vector<VariableId>& variables,
                                      const std::vector<Conjunct>& conjuncts);

 private:
  struct Frame;
  struct Quantifier {
    InstancePlan plan;
    std::vector<TypedFormulaId> outer_atoms;  // timed atoms inside that its variables do not touch
  };
  std::optional<FormulaId> leaf(const TypedFormula& formula);
  std::optional<FormulaId> atom(const TypedFormula& formula);
  std::optional<FormulaId> timed_atom(const TypedFormula& formula);
  bool take_part(Frame& frame, std::optional<FormulaId> part);
  std::optional<FormulaId> combine(Frame& frame);
  std::optional<FormulaId> compared_sum(Frame& frame);
  std::optional<std::int64_t> number(TermId term);
  void begin_instances(Frame& frame, TypedFormulaId id);
  bool next_instance(Frame& frame);
  bool next_of_product(Frame& frame);
  const Quantifier& quantifier(TypedFormulaId id, const Frame& frame);
  std::vector<TypedFormulaId> outer_atoms(const TypedFormula& quantifier) const;
  bool beyond_horizon(const TypedFormula& atom);
  bool runnable(const InstancePlan& plan, const std::vector<VariableId>& variables);
  std::optional<FormulaId> occurrence(GroundTermId event, Timepoint t) const;
  std::optional<FormulaId> effect_atom(EffectKind kind, const std::vector<GroundTermId>& arguments);
  FormulaId effect_in_place(EffectKind kind, std::uint32_t event, std::uint32_t fluent,
                            Timepoint t) const;

  GroundModel* model_;
  const TypedModel* typed_;
  TermGrounder terms_;
  Meaning meaning_;
  EffectRows* rows_ = nullptr;
  EffectAtoms effect_atoms_;
  PossibleAtoms* possible_ = nullptr;
  bool whole_axiom_ = false;
  bool names_last_events_ = false;
  std::size_t depth_ = 0;  // quantifiers around what is being grounded
  /// By formula; made for the set of variables that are bound when it is first met.
  std::map<std::uint32_t, Quantifier> quantifiers_;
};

}  // namespace parallax::compiler
