#pragma once

#include <set>
#include <string>
#include <vector>

#include "compiler/repair/edit_grammar.h"
#include "compiler/repair/edit_relevance.h"

namespace parallax::compiler {

/// So many literals of a symbol are tried on one axiom.
inline constexpr std::size_t kMostLiterals = 160;

/// What edits are looked for in, and the events and fluents, by symbol, that they are about. What
/// it is made of outlives it.
struct EditSubject {
  const ModelAst& model;
  const TypedModel& typed;
  const std::vector<AxiomForm>& forms;
  const EditScope& scope;
  EditRelevance relevance;
  std::set<std::string> events, fluents;
};

/// Appends the edits of the axioms of these events: one is dropped, gets a condition or loses one,
/// has another effect.
void add_axiom_edits(const EditSubject& subject, std::vector<Edit>& edits);
/// Appends those of the events by themselves: conditions of all that one does, preconditions,
/// effects that are missing or left open.
void add_event_edits(const EditSubject& subject, std::vector<Edit>& edits);
/// Appends conditions of which one of two is enough, for all that an event does and for each of the
/// effects that differed: likelier ones first, and not all.
void add_alternatives(const EditSubject& subject, std::vector<Edit>& edits);

}  // namespace parallax::compiler
