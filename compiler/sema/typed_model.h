#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "compiler/base/id.h"
#include "compiler/base/source_file.h"

namespace parallax::compiler {

/// Positions in a store by name: open addressing, four bytes a slot. It keeps no names, so that it
/// can be copied with the store that has them; `name_of(position)` gives them.
class NameIndex {
 public:
  std::size_t size() const { return size_; }

  template <typename NameOf>
  std::optional<std::uint32_t> find(std::string_view name, const NameOf& name_of) const {
    if (slots_.empty()) return std::nullopt;
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t i = hash(name) & mask; slots_[i] != 0; i = (i + 1) & mask) {
      if (name_of(slots_[i] - 1) == name) return slots_[i] - 1;
    }
    return std::nullopt;
  }

  /// `position` must not be in the index.
  template <typename NameOf>
  void insert(std::uint32_t position, const NameOf& name_of) {
    if ((size_ + 1) * 2 > slots_.size()) grow(name_of);
    place(position, name_of(position));
    ++size_;
  }

 private:
  static std::size_t hash(std::string_view name) { return std::hash<std::string_view>{}(name); }

  void place(std::uint32_t position, std::string_view name) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t i = hash(name) & mask;
    while (slots_[i] != 0) i = (i + 1) & mask;
    slots_[i] = position + 1;
  }

  template <typename NameOf>
  void grow(const NameOf& name_of) {
    const auto old = std::move(slots_);
    slots_.assign(old.empty() ? 16 : old.size() * 2, 0);
    for (const auto slot : old) {
      if (slot != 0) place(slot - 1, name_of(slot - 1));
    }
  }

  std::vector<std::uint32_t> slots_;  // position + 1; 0 is free
  std::size_t size_ = 0;
};

struct SortTag {
  static constexpr bool kOrdered = true;  // order of declaration
};
struct ObjectTag {
  static constexpr bool kOrdered = true;  // order of declaration
};
struct SymbolTag {
  static constexpr bool kOrdered = true;  // order of declaration
};
struct VariableTag {};
struct TermTag {};
struct TypedFormulaTag {};
using SortId = base::Id<SortTag>;
using ObjectId = base::Id<ObjectTag>;
using SymbolId = base::Id<SymbolTag>;
using VariableId = base::Id<VariableTag>;
using TermId = base::Id<TermTag>;
using TypedFormulaId = base::Id<TypedFormulaTag>;

/// A sort of the many-sorted language. Its domain: the domains of its subsorts in order of
/// declaration, then its own constants, then its ranges; for a reified sort every ground term of
/// its constructors (symbols whose `result` is the sort).
struct Sort {
  std::string name;
  std::vector<SortId> parents;
  bool reified = false;
  bool integer = false;  // `integer` itself or below it
  std::vector<ObjectId> constants;
  struct Range {
    std::int64_t lower = 0;
    std::int64_t upper = 0;
    base::SourceRange declared;
  };
  std::vector<Range> ranges;
  base::SourceRange declared;
};

/// A named constant of a plain sort. Integers are no objects: they are terms of kind kInteger.
struct Object {
  std::string name;
  std::vector<SortId> sorts;
  base::SourceRange declared;
};

enum class SymbolKind : std::uint8_t { kPredicate, kFunction, kFluent, kEvent, kReified };

struct Symbol {
  std::string name;
  SymbolKind kind = SymbolKind::kPredicate;
  std::vector<SortId> arguments;
  std::optional<SortId> result;  // the sort of the term it makes; none for a predicate
  base::SourceRange declared;
  bool noninertial = false;     // fluents: no inertia at any time
  bool manual_release = false;  // fluents: nothing is said of ReleasedAt at 0
};

/// A variable of one axiom. Its sort is its name without the trailing digits.
struct Variable {
  std::string name;
  SortId sort;
};

enum class TermKind : std::uint8_t { kVariable, kObject, kInteger, kApply, kArithmetic };
enum class ArithmeticOp : std::uint8_t { kAdd, kSubtract, kMultiply, kDivide, kModulo };

struct Term {
  TermKind kind = TermKind::kInteger;
  VariableId variable;       // kVariable
  ObjectId object;           // kObject
  std::int64_t integer = 0;  // kInteger
  SymbolId symbol;           // kApply: fluent, event, reified or function symbol
  ArithmeticOp op = ArithmeticOp::kAdd;
  std::vector<TermId> arguments;  // kApply; two for kArithmetic (unary minus is 0 - x)
  base::SourceRange source;
};

enum class FormulaKind : std::uint8_t {
  kTrue,
  kFalse,
  kAtom,
  kCompare,
  kNot,
  kAnd,
  kOr,
  kImplies,
  kIff,
  kForall,
  kExists,
  kAggregate,  // a number of instances, or the sum of their weights, compared with a number
  kTemporal    // in properties and state constraints only
};
enum class CompareOp : std::uint8_t {
  kEqual,
  kNotEqual,
  kLess,
  kLessEqual,
  kGreater,
  kGreaterEqual
};

/// The comparison that says the same with its sides exchanged: `<` for `>`.
CompareOp mirrored(CompareOp op);
bool compares(std::int64_t left, CompareOp op, std::int64_t right);

/// In the order of their Operators.
enum class TemporalOp : std::uint8_t {
  kAlways,
  kEventually,
  kNext,
  kWeakNext,
  kHistorically,
  kOnce,
  kPreviously,
  kUntil,  // two children, as kSince has
  kSince
};

struct TypedFormula {
  FormulaKind kind = FormulaKind::kTrue;
  TemporalOp temporal = TemporalOp::kAlways;  // kTemporal
  SymbolId predicate;                         // kAtom
  CompareOp compare = CompareOp::kEqual;      // kCompare, kAggregate (the number is on its right)
  /// kAtom: arguments; kCompare: two; kAggregate: the number, and for a sum the weight
  std::vector<TermId> terms;
  std::vector<TypedFormulaId> children;  // connectives, quantifiers, aggregates
  std::vector<VariableId> variables;     // quantifiers, aggregates
  base::SourceRange source;

  /// May the whole become true, and false, where a part becomes true?
  bool mixes_polarity() const {
    return kind == FormulaKind::kIff || kind == FormulaKind::kAggregate;
  }
};

/// A formula that is asserted as it stands (observations, constraints, preconditions, triggers).
struct Axiom {
  std::string label;  // empty without one
  TypedFormulaId formula;
  base::SourceRange source;
  /// Mentions Initiates, Terminates or Releases in a condition or a definition (as the definitions
  /// of ECCausal.e do): they stand there for their completed meaning.
  bool mentions_effects = false;
  /// A definition of the foundations. It may say nothing of a model that never asks for it.
  bool is_foundation = false;
};

enum class EffectKind : std::uint8_t { kInitiates, kTerminates, kReleases };

/// `[variables] condition -> Initiates(event, fluent, time)` (Mueller 2006, section 2.7).
/// `event` and `fluent` are terms; `time` is a term, usually a variable. Where the condition
/// mentions effects itself, the effects of the model are the least ones that its axioms admit.
struct EffectAxiom {
  EffectKind kind = EffectKind::kInitiates;
  std::vector<VariableId> variables;  // universally quantified
  TypedFormulaId condition;           // kTrue where there is none
  TermId event, fluent, time;
  std::string label;
  base::SourceRange source;
  /// The condition also says that other conjuncts of the formula exist (SharedInstance).
  bool shares_instances = false;
};

enum class TrajectoryKind : std::uint8_t { kTrajectory, kAntiTrajectory };

/// `[variables] condition -> Trajectory(fluent, time, target, offset)` (Mueller 2006, DEC3, DEC4).
struct TrajectoryAxiom {
  TrajectoryKind kind = TrajectoryKind::kTrajectory;
  std::vector<VariableId> variables;
  TypedFormulaId condition;  // kTrue where there is none
  TermId fluent, time, target, offset;
  std::string label;
  base::SourceRange source;
};

/// A conjunct of a formula that was taken apart into axioms, and the conjuncts beside it that may
/// lack instances: `[variables] condition -> conjunct & part & ...`. An instance in which one of
/// them is missing says nothing. The axiom of the conjunct has that in its condition.
struct SharedInstance {
  struct Part {
    TypedFormulaId existence;  // true, with the instances of the part
    base::SourceRange source;
  };
  std::vector<VariableId> variables;
  TypedFormulaId condition;  // without the existence of the parts
  TypedFormulaId existence;  // of the conjunct
  std::vector<Part> parts;
  base::SourceRange source;  // of the conjunct
};

/// `F(C1,...,Cn)=V.`: one entry of a function's table. Arguments and value are kObject, kInteger
/// or ground kApply terms. No two entries of a model share function and arguments.
struct FunctionValue {
  SymbolId function;
  std::vector<TermId> arguments;
  TermId value;
  base::SourceRange source;
};

/// The `option` statements; those that only chose files or solvers of the 2005 reasoner are not
/// kept.
struct DeclaredOptions {
  int encoding = 2;
  bool trajectory = false;
  bool manual_release = false;  // already applied to every fluent symbol
  bool renaming = true;
  /// `option founded on`, where it stands: completed atoms need reasons that do not go in circles.
  std::optional<base::SourceRange> founded;
  // Only the printed form of traces:
  bool time_diff = true;
  bool model_diff = false;
  bool show_predicates = true;
};

/// `completion LABEL Predicate`; without a label the predicate is completed over all axioms.
struct Completion {
  std::optional<std::string> label;
  SymbolId predicate;
  base::SourceRange source;
};

/// `minimize OBJECTIVE`; the objective is read only where best traces are asked for.
struct ObjectiveStatement {
  std::string text;
  base::SourceRange source;
};

/// The predicates of the event calculus, declared by the built-in foundations.
struct CoreSymbols {
  std::optional<SymbolId> happens, holds_at, released_at, initiates, terminates, releases,
      trajectory, anti_trajectory;
  std::optional<SortId> time, fluent, event, integer;
};

/// The checked model: every name resolved, every sort checked. Owned by value; ids index into it.
struct TypedModel {
  base::Store<SortId, Sort> sorts;
  base::Store<ObjectId, Object> objects;
  base::Store<SymbolId, Symbol> symbols;
  base::Store<VariableId, Variable> variables;
  base::Store<TermId, Term> terms;
  base::Store<TypedFormulaId, TypedFormula> formulas;
  std::vector<Axiom> axioms;         // in source order
  std::vector<EffectAxiom> effects;  // in source order
  std::vector<Completion> completions;
  std::vector<ObjectiveStatement> objectives;  // in source order
  CoreSymbols core;
  std::vector<TrajectoryAxiom> trajectories;     // in source order
  std::vector<FunctionValue> function_values;    // in source order
  std::vector<SharedInstance> shared_instances;  // in source order
  DeclaredOptions options;

  std::optional<SortId> find_sort(std::string_view name) const;
  std::optional<ObjectId> find_object(std::string_view name) const;
  std::optional<SymbolId> find_symbol(std::string_view name) const;
  /// True if `sort` is `ancestor` or below it.
  bool is_subsort(SortId sort, SortId ancestor) const;
  /// True if the two sorts can have an element in common. A variable or function value of a wider
  /// or overlapping sort may stand at an argument position; instances outside the declared sort
  /// are left out when grounding.
  bool sorts_overlap(SortId a, SortId b) const;

  /// Names whose declaration was refused, which was reported; errors that follow are not.
  std::set<std::string, std::less<>> misdeclared;
  void refuse(std::string_view name) {
    constexpr std::size_t kMostNames = 10'000;  // far more than errors are shown
    if (misdeclared.size() < kMostNames) misdeclared.emplace(name);
  }

  /// Filled by check_model. The look-ups above scan the stores where it is not.
  NameIndex sort_index, object_index, symbol_index;
};

/// Answers questions about the sorts of a model whose declarations are complete, with memory of
/// the answers. The model must outlive it.
class SortDomains {
 public:
  explicit SortDomains(const TypedModel& model);

  /// As TypedModel::sorts_overlap.
  bool overlap(SortId a, SortId b);
  /// The ranges of an integer sort and of all sorts below it.
  const std::vector<Sort::Range>& ranges(SortId sort);
  bool contains(SortId sort, std::int64_t value);
  /// False if the sort is known to have no element. (A reified sort with a constructor counts as
  /// having one.)
  bool has_elements(SortId sort);

 private:
  std::vector<SortId> below(SortId sort) const;  // `sort` first

  const TypedModel& model_;
  std::vector<std::vector<SortId>> children_;  // by sort
  std::vector<bool> has_constructor_;          // by sort
  std::unordered_map<std::uint64_t, bool> overlaps_;
  std::unordered_map<std::uint32_t, std::vector<Sort::Range>> ranges_;
  std::unordered_map<std::uint32_t, bool> has_elements_;
};

}  // namespace parallax::compiler
