#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "compiler/artifact/literal.h"
#include "compiler/base/id.h"
#include "compiler/base/word_table.h"

namespace parallax::compiler {

enum class AtomKind : std::uint8_t {
  kHoldsAt,
  kHappens,
  kReleasedAt,
  kPredicate,  // a user's predicate; its time, if any, is one of the printed arguments
  kLocation,   // the plan's control is at a step, a cut or an end, or takes a choice
  kHit,        // the state constraints hold at this timepoint
  kRunning,    // the plan has not ended at this timepoint
  kSucceeded,  // the perform of a step at the timepoint before succeeded
  kResult,     // the object that this perform returned
  kRegister,   // a returned object that the plan still knows
  kAuxiliary,  // stands for a subformula; no name
  kUnused,     // no clause mentions it
};

/// How an artifact writes a kind: the enumerator without its `k`.
inline constexpr auto kAtomKindWords =
    base::word_table<AtomKind>("HoldsAt", "Happens", "ReleasedAt", "Predicate", "Location", "Hit",
                               "Running", "Succeeded", "Result", "Register", "Auxiliary", "Unused");
constexpr std::string_view to_string(AtomKind kind) { return kAtomKindWords.of(kind); }

/// True for the kinds that have no meaning outside the clauses and need no name.
inline bool is_nameless(AtomKind kind) {
  return kind == AtomKind::kAuxiliary || kind == AtomKind::kUnused;
}
/// True for the kinds whose atoms say something of the plan's control, see PlanAtom.
bool is_of_plan(AtomKind kind);

struct FluentTag {
  static constexpr bool kOrdered = true;  // order of declaration
};
struct EventTag {
  static constexpr bool kOrdered = true;  // order of declaration
};
struct PlanStepTag {
  static constexpr bool kOrdered = true;  // order of the plan's text, as it was unrolled
};
struct PlanCutTag {
  static constexpr bool kOrdered = true;
};
struct PlanChoiceTag {
  static constexpr bool kOrdered = true;
};
using FluentId = base::Id<FluentTag>;          // a place in CompiledModel::fluents
using EventId = base::Id<EventTag>;            // a place in CompiledModel::events
using PlanStepId = base::Id<PlanStepTag>;      // a place in CompiledModel::plan; printed `L3`
using PlanCutId = base::Id<PlanCutTag>;        // in CompiledModel::plan_cuts; printed `BOUND(0)`
using PlanChoiceId = base::Id<PlanChoiceTag>;  // a branch that nothing decides; `CHOICE(0)`

/// Where the plan has ended, and how: `DONE`, `FAILED(navigation-pose-unreachable)`.
struct PlanEnd {
  std::string text;
  friend auto operator<=>(const PlanEnd&, const PlanEnd&) = default;
};
/// The object that a perform returned: `cup1`.
struct ReturnedObject {
  std::string object;
  friend auto operator<=>(const ReturnedObject&, const ReturnedObject&) = default;
};
/// A returned object that the plan knows by this name: `?item1=cup1`.
struct RegisterValue {
  std::string name;
  std::string object;
  friend auto operator<=>(const RegisterValue&, const RegisterValue&) = default;
};

/// The part of the plan's control that an atom is about, beside its kind and its timepoint. Empty
/// for kHit and kRunning, whose kind says everything, and for atoms of the model.
using PlanAtom = std::variant<std::monostate, PlanStepId, PlanCutId, PlanChoiceId, PlanEnd,
                              ReturnedObject, RegisterValue>;

/// As artifacts and messages print it: `L3`, `BOUND(0)`, `CHOICE(0)`, `DONE`, `cup1`,
/// `?item1=cup1`, `hit`, `running`.
std::string to_string(AtomKind kind, const PlanAtom& plan);
/// The atom printed as `text`; a text of no other form is an end of the plan.
PlanAtom plan_atom(AtomKind kind, std::string_view text);

/// Meaning of a SAT variable. Atoms of the model have a `name`, printed without blanks:
/// `RobotIn(r1)`, `Go(r2)`. Those of the plan have none.
struct Atom {
  AtomKind kind = AtomKind::kUnused;
  std::string name;
  std::optional<Timepoint> time;
  PlanAtom plan = {};
  friend bool operator==(const Atom&, const Atom&) = default;
};

/// The name of an atom of the model, or the printed form of an atom of the plan.
std::string printed(const Atom& atom);

/// The horizon from which on an atom exists: an event at t needs the step to t + 1.
inline Timepoint needed_horizon(const Atom& atom) {
  return atom.time.value_or(0) + (atom.kind == AtomKind::kHappens ? 1 : 0);
}

}  // namespace parallax::compiler
