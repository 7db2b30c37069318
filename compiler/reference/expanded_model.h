#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// Budget of the naive expansion. Once overdrawn it stays so, and all work ends soon.
class ReferenceBudget {
 public:
  /// `stop`, if there is one, outlives the budget: once raised, all is spent.
  ReferenceBudget(std::int64_t units, const std::atomic<bool>* stop) : left_(units), stop_(stop) {}
  /// False from the moment on at which more was spent than there is.
  bool spend(std::int64_t units = 1) {
    const bool stopped = stop_ != nullptr && stop_->load(std::memory_order_relaxed);
    left_ = stopped || units > left_ ? -1 : left_ - units;
    return left_ >= 0;
  }
  bool spent() const { return left_ < 0; }
  void spend_all() { left_ = -1; }

 private:
  std::int64_t left_;
  const std::atomic<bool>* stop_;
};

/// The ground terms of a typed model as the reference evaluator sees them: by their printed form
/// and nothing else (unique names). Numbered, so that sets and environments stay small.
class ReferenceTerms {
 public:
  using Value = std::uint32_t;
  using Environment = std::vector<Value>;  // by variable

  /// Lists the domain of every sort; `model` and `budget` outlive the object.
  ReferenceTerms(const TypedModel& model, ReferenceBudget& budget);

  const std::vector<Value>& domain(SortId sort) const { return domains_[sort.index()]; }
  /// An integer sort without any range has every integer.
  bool member(SortId sort, Value value) const;
  const std::string& text(Value value) const { return texts_[value]; }
  std::optional<std::int64_t> number(Value value) const { return numbers_[value]; }
  /// None: an argument lies outside its sort, a function has no value, arithmetic leaves the
  /// integers (division by zero, overflow). Recursion as deep as the term.
  std::optional<Value> term(TermId term, const Environment& environment);
  /// The values of an atom's or constructor's arguments, each a member of its sort.
  std::optional<std::vector<Value>> arguments(const Symbol& symbol,
                                              const std::vector<TermId>& terms,
                                              const Environment& environment);
  /// `Name(a,b)`
  std::string applied(const Symbol& symbol, const std::vector<Value>& arguments) const;
  /// How deep the model's terms nest, at most `limit` + 1.
  static std::size_t depth(const TypedModel& model, std::size_t limit);

 private:
  Value intern(const std::string& text, std::optional<std::int64_t> number);
  Value integer(std::int64_t value) { return intern(std::to_string(value), value); }
  void list_domain(SortId sort);
  void list_instances(const Symbol& symbol, std::vector<Value>& out);
  std::optional<Value> arithmetic(ArithmeticOp op, Value left, Value right);

  const TypedModel& model_;
  ReferenceBudget& budget_;
  std::vector<std::string> texts_;
  std::vector<std::optional<std::int64_t>> numbers_;
  std::unordered_map<std::string, Value> values_;
  std::vector<std::vector<Value>> domains_;         // by sort
  std::vector<std::unordered_set<Value>> members_;  // by sort
  std::vector<bool> listed_;                        // by sort
  std::unordered_map<Value, Value> function_values_;
};

/// Formulas without variables or quantifiers as plain trees. They are written down as they come;
/// only the constants `true` and `false` are worked out.
class FormulaTrees {
 public:
  using Node = std::uint32_t;
  /// Truth values by number.
  using Values = std::vector<std::uint8_t>;

  FormulaTrees() : nodes_(2) { nodes_[kTruth].kind = FormulaKind::kTrue; }
  static constexpr Node kFalsity = 0, kTruth = 1;
  static Node constant(bool value) { return value ? kTruth : kFalsity; }

  Node atom(std::uint32_t number);
  /// An effect predicate's atom: what its value is follows from other atoms.
  Node effect(std::uint32_t number);
  /// kNot, kAnd, kOr, kImplies or kIff over its parts.
  Node connect(FormulaKind kind, const std::vector<Node>& parts);

  /// The sum of the weights of its true parts, compared with a number.
  struct Sum {
    CompareOp compare = CompareOp::kEqual;
    std::int64_t number = 0;
    std::vector<std::int64_t> weights;  // by part
  };
  Node compared(Sum sum, const std::vector<Node>& parts);

  std::size_t size() const { return nodes_.size(); }
  /// Forgets the nodes made since there were `size` of them; nobody refers to them.
  void rewind(std::size_t size);

  /// The conjuncts of a conjunction, else the node itself.
  std::vector<Node> conjuncts(Node node) const;
  /// The atoms below a node, ascending, each once; effects are not included.
  std::vector<std::uint32_t> atoms_of(Node node) const;
  /// The effects below a node that count for it (against it: `negative`), ascending, each once.
  std::vector<std::uint32_t> effects_of(Node node, bool negative) const;

  /// Values of the effects in a formula: of those that count for the formula, and of those that
  /// count against it.
  struct Effects {
    const Values* positive = nullptr;
    const Values* negative = nullptr;
  };
  /// The same for atoms: values of those that count for the formula, and against it.
  struct Sides {
    const Values* positive = nullptr;
    const Values* negative = nullptr;
    Effects effects;
    Sides turned() const { return {negative, positive, {effects.negative, effects.positive}}; }
  };
  /// The truth value where each value a tells whether atom a is true. As deep as the tree.
  bool sided_value(Node node, const Sides& sides) const;
  bool value(Node node, const Values& values, const Effects& effects) const {
    return sided_value(node, {&values, &values, effects});
  }
  /// The truth value of a tree without effects.
  bool value(Node node, const Values& values) const { return value(node, values, {}); }

 private:
  struct Entry {
    FormulaKind kind = FormulaKind::kFalse;
    std::uint32_t first = 0;  // the atom or effect, or the place of the first part in parts_
    std::uint32_t count = 0;
    bool is_effect = false;  // kAtom
    std::uint32_t sum = 0;   // kAggregate: its place in sums_
  };
  Node add(FormulaKind kind, const std::vector<Node>& parts);
  bool sided_value(const Sum& sum, const Entry& entry, const Sides& sides) const;
  Node junction(bool conjunction, const std::vector<Node>& parts);

  std::vector<Entry> nodes_;
  std::vector<Node> parts_;
  std::vector<Sum> sums_;
};

/// A formula of the expanded model, and the last timepoint that must exist for its atoms to.
struct ReferenceFormula {
  FormulaTrees::Node node = FormulaTrees::kTruth;
  std::int64_t needed = 0;
};

/// A typed model with every instance of every formula written out. A formula without quantifiers
/// exists if all its atoms and comparisons do; `[x] f` and `{x} f` are the conjunction and the
/// disjunction of the instances that exist, and exist themselves unless all of at least one
/// instance do not. Nothing is joined, solved, shared or replicated as in the grounder, which is
/// tested against this expansion.
///
/// Atoms are numbered by timepoint: HoldsAt of every fluent, ReleasedAt of every fluent, and before
/// the last timepoint Happens of every event; then the atoms of user predicates as they are met.
class ExpandedModel {
 public:
  using Value = ReferenceTerms::Value;
  struct Conjunct {
    std::size_t axiom = 0;  // index into the typed model's axioms
    ReferenceFormula formula;
    std::int64_t size = 1;  // atoms in it, each counted once
  };
  /// `Initiates(event,fluent,t)` under a condition; listed by t and fluent.
  struct EffectRow {
    EffectKind kind = EffectKind::kInitiates;
    std::uint32_t event = 0;
    ReferenceFormula condition;
    std::size_t effect = 0;  // index into the typed model's effects
  };
  /// An effect that a condition mentions; the rows that bring it about are those of its kind.
  struct EffectAtom {
    EffectKind kind = EffectKind::kInitiates;
    std::uint32_t event = 0, fluent = 0;
    std::int64_t time = 0;
    std::int64_t needed = 0;  // the last timepoint that must exist for all of its rows to
  };
  /// DEC3 or DEC4: while `fluent` has developed since `begin`, `target` holds at `end`.
  struct Path {
    ReferenceFormula condition;
    std::uint32_t fluent = 0, target = 0;
    std::int64_t begin = 0, end = 0;
    std::size_t trajectory = 0;  // index into the typed model's trajectories
  };
  /// A completed atom and the conjuncts that can be a reason for it.
  struct Completed {
    std::size_t completion = 0;
    std::uint32_t atom = 0;
    std::vector<std::size_t> reasons;  // indices into conjuncts()
  };

  /// `model` and `budget` outlive the object, which is incomplete when the budget is spent.
  ExpandedModel(const TypedModel& model, ReferenceBudget& budget);
  /// Nothing yet: for a ModelExpander that expands single formulas.
  ExpandedModel() = default;

  /// Its formulas nest too deep to be expanded; the budget counts as spent.
  bool too_deep() const { return too_deep_; }
  std::int64_t horizon() const { return horizon_; }
  const std::vector<std::string>& fluents() const { return fluents_; }
  const std::vector<std::string>& events() const { return events_; }
  const Symbol& symbol_of(std::uint32_t fluent) const { return *fluent_symbols_[fluent]; }
  std::size_t atom_count() const { return timed_atoms() + predicates_.size(); }
  std::optional<std::uint32_t> fluent(const std::string& text) const;
  std::optional<std::uint32_t> event(const std::string& text) const;
  std::optional<std::uint32_t> predicate(const std::string& text) const;

  std::uint32_t holds(std::uint32_t fluent, std::int64_t t) const { return place(t, fluent); }
  std::uint32_t released(std::uint32_t fluent, std::int64_t t) const;
  std::uint32_t happens(std::uint32_t event, std::int64_t t) const;
  /// `HoldsAt(F(),2)`
  std::string atom_text(std::uint32_t atom) const;
  /// None for the atoms of user predicates, which are not bound to a timepoint.
  std::optional<std::int64_t> timepoint(std::uint32_t atom) const;
  /// The last timepoint that must exist for the atom to: an event's effects come one later.
  std::int64_t needed(std::uint32_t atom) const;

  const FormulaTrees& trees() const { return trees_; }
  const std::vector<Conjunct>& conjuncts() const { return conjuncts_; }
  const std::vector<EffectRow>& rows(std::uint32_t fluent, std::int64_t t) const {
    return rows_[static_cast<std::size_t>(t) * fluents_.size() + fluent];
  }
  /// By the numbers that they have in the trees.
  const std::vector<EffectAtom>& effects() const { return effects_; }
  /// Does some effect depend on its own absence?
  bool has_circular_effect() const;
  const std::vector<Path>& paths() const { return paths_; }
  const std::vector<Completed>& completed() const { return completed_; }
  /// The axioms that do not exist: every instance names something beyond the horizon or its sort.
  const std::vector<std::size_t>& silent_axioms() const { return silent_axioms_; }

 private:
  friend class ModelExpander;
  std::uint32_t place(std::int64_t t, std::size_t offset) const {
    const auto stride = 2 * fluents_.size() + events_.size();
    return static_cast<std::uint32_t>(static_cast<std::size_t>(t) * stride + offset);
  }
  std::size_t timed_atoms() const {
    return horizon_ < 0 ? 0 : place(horizon_, 2 * fluents_.size());
  }

  bool too_deep_ = false;
  std::int64_t horizon_ = -1;
  std::vector<std::string> fluents_, events_;
  std::vector<const Symbol*> fluent_symbols_;
  std::map<std::string, std::uint32_t> fluent_numbers_, event_numbers_, predicate_numbers_;
  std::vector<std::string> predicates_;
  FormulaTrees trees_;
  std::vector<Conjunct> conjuncts_;
  std::vector<std::vector<EffectRow>> rows_;
  std::vector<EffectAtom> effects_;
  std::vector<Path> paths_;
  std::vector<Completed> completed_;
  std::vector<std::size_t> silent_axioms_;
};

}  // namespace parallax::compiler
