#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "compiler/repair/axiom_form.h"
#include "compiler/repair/condition_literal.h"
#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// One possible mistake in a model, and its correction.
struct Edit {
  enum class Kind : std::uint8_t {
    kNarrow,         // `literal`, or else `text`, is added to the condition of the axiom
    kNarrowEvent,    // ... of every axiom about what the event does, or about what differed of it
    kRequire,        // a new precondition: the event happens only where `literal` holds
    kDropCondition,  // the conjunct `node` of the axiom's condition goes
    kDropAxiom,      // an axiom about effects, or a precondition
    kReplace,        // `node` of the axiom, a conjunct or an effect, becomes `text` (`literal`)
    kAddEffect,      // a new axiom: the effect `text`
    kAddTrigger,     // a new axiom: an event that no axiom demands happens where `given` holds
    kAddCondition,   // `literal` is the condition of the new axiom `of`
    kDelay,          // the effect comes later, or at once: `sentences` instead of the axiom
    kOpenEvent,      // the effects `nodes`, one of each axiom, become Releases
    kRewrite,        // a formula about states becomes `text`; of its file `change` is made
    kAddFact,        // `text`, a fact of the start or a definition, is added: `change`
  };
  /// `[variables] condition -> effect.`
  struct Sentence {
    std::vector<std::string> variables;
    std::string condition, effect;
  };
  Kind kind = Kind::kNarrow;
  std::vector<std::size_t> axioms;  // places among the forms
  NodeId node;
  std::vector<std::pair<std::size_t, NodeId>> nodes;  // kOpenEvent: axiom and effect
  std::optional<ConditionLiteral> literal;
  std::optional<ConditionLiteral> or_else;  // kNarrowEvent: it is enough that this holds
  std::string text;
  TextChange change;                   // kRewrite, kAddFact
  std::string event;                   // symbol
  std::vector<std::string> variables;  // of a new axiom: the event's arguments, then others
  std::size_t event_arity = 0;         // of a new axiom
  std::size_t of = 0;                  // kAddCondition: the edit with the effect
  /// kAddEffect, kAddTrigger: conditions that it has in any case
  std::vector<ConditionLiteral> given;
  /// kAddEffect of several effects: "ends `F` and begins `G`"; kRewrite: "without `F`";
  /// kDelay: empty where the effect comes later; kAddFact: empty for a fact
  std::string words;
  std::vector<Sentence> sentences;  // kDelay
  bool names_constants = false;     // kAddEffect: in the place of variables
  bool moves_effect = false;        // kReplace: of another event, or of one with other arguments
  bool moves_trigger = false;       // kReplace: the trigger demands `event`, which none demands yet
  bool frees = false;               // leaves open what a definition said
  /// Distance from what people usually write and forget: constants where a variable would do, a
  /// condition that no other axiom of the event has. Smaller is tried first among equals.
  int oddity = 0;
};

/// Scope of the edits: the steps at which runs and model parted.
struct EditScope {
  struct Step {
    std::string event;                      // "Go(bTable)"
    bool refused = false;                   // the world did not do it
    bool not_possible = false;              // and the world says that it cannot happen
    std::map<std::string, bool> before;     // fluents observed before it
    std::map<std::string, bool> differing;  // fluents observed after it, unlike the model
    /// Fluents of `differing` that took the model's value `by` steps later, after that event.
    struct Late {
      std::string event;
      std::size_t by = 1;
      std::set<std::string> fluents;
    };
    std::vector<Late> late = {};
    std::map<std::string, bool> after = {};  // all fluents observed after it
  };
  std::vector<Step> steps;
  /// Events of the same symbols that did what the model says, with what was seen before each.
  struct Success {
    std::string event;
    std::map<std::string, bool> before;
    friend bool operator==(const Success&, const Success&) = default;
  };
  std::vector<Success> successes = {};
  /// By event symbol: fluents, by symbol, and the value that they took with it in some run,
  /// wherever it happened.
  std::map<std::string, std::set<std::pair<std::string, bool>>> changed;
  /// Other events, and fluents, whose axioms may be to blame as well.
  std::set<std::string> more_events, more_fluents;
  /// Events that axioms of the model demand: some of `more_events`.
  std::set<std::string> demanded;
  /// Events that have effects in the model, and that neither a recorded run nor an axiom brings
  /// about: they may lack a trigger.
  std::set<std::string> idle;
  /// The effects of an event may be left open: `Releases`.
  bool open_outcomes = false;
  /// The same for an event that the world refused, though it can happen.
  bool open_refused = false;
  /// Far from the steps: few edits of formulas about states.
  bool wide = false;
  /// Only conditions that are disjunctions of two: `!Outside(spot) | DoorOpen()`.
  bool alternatives = false;
  /// States that were seen, for definitions that are missing.
  std::vector<std::map<std::string, bool>> states = {};
};

/// The arguments of a ground atom: {"milk1", "pTable"} for "ItemAt(milk1,pTable)".
std::vector<std::string> arguments_of(const std::string& ground);

/// Every single edit of the grammar in the scope, in a fixed order. Edits of one kind on one axiom
/// are at most some hundred: where a model has more symbols and constants than that, those with
/// constants are left out (condition_literals).
std::vector<Edit> edits_in_scope(const ModelAst& model, const TypedModel& typed,
                                 const std::vector<AxiomForm>& forms, const EditScope& scope);

/// Every single edit of what a model says of timepoint 0, and of its formulas about states, that
/// concerns a fluent which differed there: `scope` has one step without an event, with the state of
/// timepoint 0 after it. In a fixed order.
std::vector<Edit> start_edits(const ModelAst& model, const TypedModel& typed,
                              const std::vector<AxiomForm>& forms, const EditScope& scope);

/// Fluents without inertia, by symbol, that no equivalence of the model defines: it may leave them
/// open.
std::set<std::string> undefined_fluents(const ModelAst& model, const TypedModel& typed,
                                        const std::vector<AxiomForm>& forms);

}  // namespace parallax::compiler
