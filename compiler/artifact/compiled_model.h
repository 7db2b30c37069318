#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "compiler/artifact/atom.h"
#include "compiler/artifact/literal.h"
#include "compiler/artifact/objective.h"
#include "compiler/base/source_file.h"
#include "compiler/base/word_table.h"

namespace parallax::compiler {

/// Kind of text that a clause comes from.
enum class OriginKind : std::uint8_t {
  kAxiom,
  kEffectAxiom,
  kTrajectoryAxiom,
  kFrameAxiom,  // the declaration of a fluent, for DEC5 to DEC8
  kCompletion,
  kInvariant,    // follows from the others and only shortens the search: no reason of anything
  kUnmentioned,  // denies, in the meaning of the 2005 reasoner, what no formula mentions
  kPlanStep,
  kStateConstraint,
  kObjective,  // an objective's counted formulas; true of every trace, no reason of anything
  kTrace,      // held against the model: part of a trace from elsewhere
};

/// `axiom`, `effect axiom`, ... as artifacts and messages write it.
inline constexpr auto kOriginKindWords = base::word_table<OriginKind>(
    "axiom", "effect axiom", "trajectory axiom", "frame axiom", "completion", "state invariant",
    "atom without a mention", "plan step", "state constraint", "objective", "trace");
constexpr std::string_view to_string(OriginKind kind) { return kOriginKindWords.of(kind); }

/// A range of a source text as messages print it; it outlives the text.
struct TextPlace {
  std::string file;  // as the user named it
  base::LineColumn begin;
  base::LineColumn end;  // one column beyond the last
  friend bool operator==(const TextPlace&, const TextPlace&) = default;
};

/// Where a clause comes from. Clauses that no text asks for (frame axioms DEC5 to DEC8) carry the
/// declaration of their fluent.
struct Origin {
  base::SourceRange source;  // in a model read from an artifact: a line of that file
  OriginKind kind = OriginKind::kAxiom;
  std::string id = {};    // unique in the model; depends on the kind and the text alone
  TextPlace place = {};   // where `source` was when the model was compiled
  std::string text = {};  // of the source, on one line, without comments
};

/// A symbol of every timepoint.
struct Slot {
  AtomKind kind = AtomKind::kUnused;
  std::string name;
  friend bool operator==(const Slot&, const Slot&) = default;
};

/// A ground fluent or event of the model. Without a slot it is false at every timepoint, and no
/// clause mentions it.
struct GroundName {
  std::string name;
  std::optional<std::uint32_t> slot;
  friend bool operator==(const GroundName&, const GroundName&) = default;
};

/// All clauses in one array; views stay valid until the next `add`.
class ClauseList {
 public:
  void add(std::span<const Literal> clause) {
    literals_.insert(literals_.end(), clause.begin(), clause.end());
    ends_.push_back(literals_.size());
  }
  friend bool operator==(const ClauseList&, const ClauseList&) = default;
  std::size_t size() const { return ends_.size(); }
  std::span<const Literal> operator[](std::size_t index) const {
    const std::size_t begin = index == 0 ? 0 : ends_[index - 1];
    return std::span(literals_).subspan(begin, ends_[index] - begin);
  }

 private:
  std::vector<Literal> literals_;
  std::vector<std::size_t> ends_;
};

/// An argument of a plan step for the controllers, as the designator gave it.
using PlanValue = std::variant<double, std::int64_t, std::string>;

/// One `perform` of the plan: what its location executes.
struct PlanPerform {
  std::string event;  // printed ground event
  base::SourceRange source;
  std::string failure_class;
  std::map<std::string, PlanValue, std::less<>> arguments;
  TextPlace place = {};  // as in Origin
};

/// A form whose unrolling was cut: executions that get there are known up to there only.
struct PlanCut {
  std::string form;  // "loop", or the function that calls itself
  base::SourceRange source;
  TextPlace place = {};  // as in Origin
};
/// A text that took part in the compilation.
struct SourceText {
  std::string name;
  std::uint64_t hash = 0;  // FNV-1a over its bytes
  friend bool operator==(const SourceText&, const SourceText&) = default;
};

std::vector<std::string> names_of(const std::vector<GroundName>& ground);

/// Clauses that follow one another. A repeated section is `copies` blocks of `clauses` clauses: the
/// block for timepoint k is the first one with every slot variable moved by k strides.
struct Section {
  std::size_t begin = 0;    // of its first clause
  std::size_t clauses = 0;  // of one copy
  std::int64_t copies = 1;  // 1 for a section that is not repeated
  bool repeated = false;
  Timepoint width = 0;  // repeated: copies for timepoints 0 .. horizon - width
  friend bool operator==(const Section&, const Section&) = default;
};

/// An atom of the model as `for_each_atom` shows it; the texts belong to the model.
struct AtomRef {
  std::int32_t variable = 0;
  AtomKind kind = AtomKind::kUnused;
  std::optional<Timepoint> time;
  const std::string& name;   // as in Atom
  const PlanAtom& plan;      // as in Atom
  std::uint32_t number = 0;  // of the fluent or event, else of the place in `fixed`

  FluentId fluent() const {
    PARALLAX_REQUIRE(kind == AtomKind::kHoldsAt || kind == AtomKind::kReleasedAt, "of a fluent");
    return FluentId(number);
  }
  EventId event() const {
    PARALLAX_REQUIRE(kind == AtomKind::kHappens, "of an event");
    return EventId(number);
  }
  Literal literal() const { return Literal::positive(variable); }
  /// The horizon from which on it exists in a model of the horizon `last`: an event needs the step
  /// that follows it, but for one at the last timepoint (--compat decreasoner).
  Timepoint needed_horizon(Timepoint last) const {
    return std::min(time.value_or(0) + (kind == AtomKind::kHappens ? 1 : 0), last);
  }
};

/// The compiled model as data: symbols, clauses, provenance. It says nothing of how it was made
/// and nothing of how it is solved.
///
/// Variables: `fixed` first (user predicates, the plan's control, auxiliaries of single clauses),
/// then one block of slots for every timepoint: variable = base + t * stride + slot + 1. The first
/// `state_slots` slots exist at every timepoint, the others (events, auxiliaries of steps) at every
/// timepoint before the last.
///
/// Every clause has a timepoint, the horizon that its atoms need: the clauses with a timepoint of
/// at most n are the model with horizon n.
struct CompiledModel {
  std::string producer;                        // "parallax 0.3.0"; empty: not said
  std::vector<SourceText> sources;             // in the order of loading
  std::map<std::string, std::string> options;  // options that the meaning depends on

  Timepoint horizon = 0;
  std::vector<Atom> fixed;  // fixed[v - 1] is variable v
  std::vector<Slot> slots;
  std::uint32_t state_slots = 0;
  std::vector<GroundName> fluents;                          // in declaration order
  std::vector<std::optional<std::uint32_t>> release_slots;  // by fluent; none: never released
  std::vector<GroundName> events;                           // in declaration order

  ClauseList clauses;
  std::vector<Timepoint> clause_timepoints;
  std::vector<std::uint32_t> clause_origins;  // index into `origins`
  std::vector<bool> clause_is_definition;     // defines an auxiliary: true in itself, says nothing
  std::vector<Section> sections;              // cover the clauses, in order
  /// True if `clauses` holds only the first copy of each section. That is enough to write the model
  /// at any horizon, and such a model can only be written.
  bool folded = false;
  std::vector<Origin> origins;
  std::vector<PlanPerform> plan;      // by location number; empty without a plan
  std::vector<PlanCut> plan_cuts;     // empty if the whole plan was unrolled
  bool has_constraints = false;       // kHit atoms exist
  std::vector<Objective> objectives;  // quantities that best traces minimize, the first one first

  std::int32_t base() const { return static_cast<std::int32_t>(fixed.size()); }
  std::int32_t stride() const { return static_cast<std::int32_t>(slots.size()); }
  std::int32_t variable_count() const {
    return base() + horizon * stride() + static_cast<std::int32_t>(state_slots);
  }
  std::int32_t variable(std::uint32_t slot, Timepoint t) const {
    return base() + t * stride() + static_cast<std::int32_t>(slot) + 1;
  }
  /// The literal `steps` timepoints later; one of a fixed variable stays.
  Literal moved(Literal literal, std::int64_t steps) const {
    if (literal.var() <= base()) return literal;
    const auto by = static_cast<std::int32_t>(steps) * stride();
    return Literal::from_dimacs(literal.dimacs() + (literal.is_positive() ? by : -by));
  }
  /// Copies of the section that are among the clauses.
  std::int64_t stored_copies(const Section& section) const {
    return folded ? std::min<std::int64_t>(section.copies, 1) : section.copies;
  }
  /// With all copies of all sections.
  std::size_t clause_count() const;
  /// The atom of a variable, 1 <= v <= variable_count().
  Atom atom(std::int32_t v) const;
  /// None: false in every trace, or there is no such timepoint.
  std::optional<Literal> holds_at(FluentId fluent, Timepoint t) const {
    return of_slot(fluents[fluent.index()].slot, t);
  }
  std::optional<Literal> released_at(FluentId fluent, Timepoint t) const {
    return fluent.index() < release_slots.size() ? of_slot(release_slots[fluent.index()], t)
                                                 : std::nullopt;
  }
  /// Calls `visit` for every variable that stands for an atom of the model, in canonical order:
  /// timepoint by timepoint fluents, releases, events in declaration order, then the fixed ones.
  /// Linear in what it visits.
  void for_each_atom(const std::function<void(const AtomRef&)>& visit) const;

 private:
  std::optional<Literal> of_slot(std::optional<std::uint32_t> slot, Timepoint t) const;
};

/// Variable look-up. None: the atom is false in every trace, or there is no such atom.
class AtomIndex {
 public:
  /// `model` outlives the index.
  explicit AtomIndex(const CompiledModel& model);
  /// An atom of the model, by its name.
  std::optional<Literal> find(AtomKind kind, std::string_view name,
                              std::optional<Timepoint> time) const;
  /// The fluent that the atom of a variable, HoldsAt or ReleasedAt, is about; none of any other.
  std::optional<FluentId> fluent(std::int32_t variable) const;
  /// An atom of the plan.
  std::optional<Literal> plan(AtomKind kind, const PlanAtom& plan, Timepoint t) const;
  std::optional<Literal> hit(Timepoint t) const { return plan(AtomKind::kHit, {}, t); }
  std::optional<Literal> running(Timepoint t) const { return plan(AtomKind::kRunning, {}, t); }
  /// Is the plan's control at a step or a cut?
  std::optional<Literal> at(const PlanAtom& place, Timepoint t) const {
    return plan(AtomKind::kLocation, place, t);
  }
  /// Has the perform at t - 1 succeeded?
  std::optional<Literal> succeeded(PlanStepId step, Timepoint t) const {
    return plan(AtomKind::kSucceeded, step, t);
  }

 private:
  const CompiledModel* model_;
  std::map<std::pair<AtomKind, std::string>, std::uint32_t, std::less<>> slots_;
  std::vector<std::optional<FluentId>> fluents_;  // by slot
  std::map<std::tuple<AtomKind, Timepoint, std::string>, std::int32_t, std::less<>> fixed_;
  std::map<std::tuple<AtomKind, Timepoint, PlanAtom>, std::int32_t> plan_;
};

}  // namespace parallax::compiler
