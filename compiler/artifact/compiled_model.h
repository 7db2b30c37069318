#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "compiler/artifact/literal.h"
#include "compiler/base/source_file.h"

namespace parallax::compiler {

enum class AtomKind : std::uint8_t {
  kHoldsAt,
  kHappens,
  kReleasedAt,
  kPredicate,  // a user's predicate; its time, if any, is one of the printed arguments
  kLocation,   // the plan's control is at a location: name "L3"
  kHit,        // the state constraints hold at this timepoint
  kRunning,    // the plan has not ended at this timepoint
};

/// What a SAT variable stands for. `name` is printed without blanks: `RobotIn(r1)`, `Go(r2)`.
struct Atom {
  AtomKind kind = AtomKind::kPredicate;
  std::string name;
  std::optional<Timepoint> time;
  friend bool operator==(const Atom&, const Atom&) = default;
};

/// The horizon from which on an atom exists: an event at t needs the step to t + 1.
inline Timepoint needed_horizon(const Atom& atom) {
  return atom.time.value_or(0) + (atom.kind == AtomKind::kHappens ? 1 : 0);
}

/// All clauses in one array; views stay valid until the next `add`.
class ClauseList {
 public:
  void add(std::span<const Literal> clause) {
    literals_.insert(literals_.end(), clause.begin(), clause.end());
    ends_.push_back(literals_.size());
  }
  std::size_t size() const { return ends_.size(); }
  std::span<const Literal> operator[](std::size_t index) const {
    const std::size_t begin = index == 0 ? 0 : ends_[index - 1];
    return std::span(literals_).subspan(begin, ends_[index] - begin);
  }

 private:
  std::vector<Literal> literals_;
  std::vector<std::size_t> ends_;
};

/// Where a clause comes from: an axiom, an effect axiom, a perform, a state constraint. Clauses
/// that no text asks for (frame axioms DEC5 to DEC8) carry the declaration of their fluent.
struct Origin {
  base::SourceRange source;
  std::string what;  // "axiom", "effect axiom", "frame axiom", "plan step", "state constraint"
};

/// An argument of a plan step for the controllers, as the designator gave it.
using PlanValue = std::variant<double, std::int64_t, std::string>;

/// One `perform` of the plan: what its location executes.
struct PlanStep {
  std::string event;  // printed ground event
  base::SourceRange source;
  std::string failure_class;
  std::map<std::string, PlanValue, std::less<>> arguments;
};

/// The compiled model as data: symbols, clauses, provenance. It says nothing of how it was made
/// and nothing of how it is solved.
///
/// Every clause has a timepoint, the horizon that its atoms need: the clauses with a timepoint of
/// at most n are the model with horizon n.
struct CompiledModel {
  Timepoint horizon = 0;
  std::vector<Atom> atoms;  // atoms[v - 1] names variable v; auxiliaries come after them
  std::int32_t variable_count = 0;
  ClauseList clauses;
  std::vector<Timepoint> clause_timepoints;
  std::vector<std::uint32_t> clause_origins;  // index into `origins`
  std::vector<bool> clause_is_definition;     // defines an auxiliary: true in itself, says nothing
  std::vector<Origin> origins;
  std::vector<std::string> fluents;  // ground fluents in declaration order
  std::vector<std::string> events;   // ground events in declaration order
  std::vector<PlanStep> plan;    // by location number; empty without a plan
  bool has_constraints = false;      // kHit atoms exist
};

/// Variable look-up by (kind, name, time).
class AtomIndex {
 public:
  explicit AtomIndex(const CompiledModel& model);
  std::optional<Literal> find(AtomKind kind, std::string_view name,
                              std::optional<Timepoint> time) const;

 private:
  std::map<std::tuple<AtomKind, Timepoint, std::string>, std::int32_t, std::less<>> variables_;
};

}  // namespace parallax::compiler
