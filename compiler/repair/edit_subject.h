#pragma once

#include <set>
#include <string>
#include <vector>

#include "compiler/repair/edit_grammar.h"
#include "compiler/repair/edit_relevance.h"

namespace parallax::compiler {

/// The most literals of a symbol that are tried on one axiom.
inline constexpr std::size_t kMostLiterals = 160;

/// Model in which edits are sought, and the events and fluents, by symbol, that they are about.
/// Everything referred to outlives it.
struct EditSubject {
  const ModelAst& model;
  const TypedModel& typed;
  const std::vector<AxiomForm>& forms;
  const EditScope& scope;
  EditRelevance relevance;
  std::set<std::string> events, fluents;
};

/// Appends edits of these events' axioms: one is dropped, gains or loses a condition, or has
/// another effect.
void add_axiom_edits(const EditSubject& subject, std::vector<Edit>& edits);
/// Appends edits of the events themselves: conditions of everything that one does, preconditions,
/// effects that are missing or left open.
void add_event_edits(const EditSubject& subject, std::vector<Edit>& edits);
/// Appends triggers of idle events (EditScope) with an effect on a fluent that differed.
void add_triggers(const EditSubject& subject, std::vector<Edit>& edits);
/// Appends edits of a trigger that demands another event: one that an axiom demands, or one that
/// has effects and that nothing brings about.
void add_other_demands(const EditSubject& subject, std::size_t trigger, std::vector<Edit>& edits);
/// Does the trigger's event end the condition? Such a condition keeps the event from happening
/// again and again.
bool is_undone(const EditSubject& subject, const AxiomForm& trigger,
               const ConditionLiteral& condition);
/// Appends edits of formulas about states, constraints and definitions: one is dropped or weakened,
/// gains or loses a condition, or has another argument.
void add_state_edits(const EditSubject& subject, std::vector<Edit>& edits);
/// Appends the same edits of formulas about timepoint 0.
void add_start_edits(const EditSubject& subject, std::vector<Edit>& edits);
/// Appends facts of timepoint 0 that are missing, for fluents that differed there.
void add_start_facts(const EditSubject& subject, std::vector<Edit>& edits);
/// Appends definitions of fluents that lack one (undefined_fluents), true of all states seen.
void add_missing_definitions(const EditSubject& subject, std::vector<Edit>& edits);
/// Appends effects on fluents with a number, `HoldsAt(F(count1),time) & count2=count1+1 ->
/// Initiates(E,F(count2),time)`, where a step changed the number.
void add_counter_effects(const EditSubject& subject, std::vector<Edit>& edits);
/// Appends conditions of which one of two is enough, for everything that an event does and for each
/// of the effects that differed: likelier ones first, and not all.
void add_alternatives(const EditSubject& subject, std::vector<Edit>& edits);

}  // namespace parallax::compiler
