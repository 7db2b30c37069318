#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/source_file.h"
#include "compiler/syntax/ast.h"
#include "compiler/syntax/loader.h"

namespace parallax::compiler {

/// A part of a text gives way to another one; nothing is replaced where `begin == end`.
struct TextChange {
  base::FileId file;
  std::uint32_t begin = 0, end = 0;
  std::string text;
  friend bool operator==(const TextChange&, const TextChange&) = default;
};

/// A formula of a model whose parts an edit can name: effects of one event, `[variables] condition
/// -> Initiates(E,F,time) & ...`, a precondition of an event, `[variables] Happens(E,time) & ... ->
/// ...`, or a trigger, `[variables] condition -> Happens(E,time)`; or a formula about the states of
/// one timepoint, a constraint or a definition, which names no event; or effects that come late,
/// `Happens(E,time-1) & ... -> Initiates(E2,F,time) & ...`, where `event` is E; or effects of
/// whatever event has another effect, `Terminates(event,F,time) & ... -> Initiates(event,G,time)`,
/// where `event` is a variable; or what holds at timepoint 0. Of other formulas only the condition
/// is read.
struct AxiomForm {
  enum class Kind : std::uint8_t {
    kEffects,
    kPrecondition,
    kTrigger,
    kLateEffects,
    kRamification,
    kState,
    kStart,
    kOther
  };
  Kind kind = Kind::kEffects;
  ModelAst::Place place;
  std::uint32_t begin = 0, end = 0;    // of its text, with label and period
  std::vector<std::string> variables;  // universally quantified
  std::optional<NodeId> condition;     // the formula in front of `->`
  std::vector<NodeId> conjuncts;       // of the condition
  NodeId head;
  NodeId body;                  // without the quantifiers around it
  std::vector<NodeId> effects;  // of kinds with effects: the conjuncts of the head
  NodeId event;                 // the term
  std::string event_symbol;     // kRamification, kState, kStart: empty
  std::string time;             // the variable; kStart: "0"
};

/// The formulas of the model's own files (not of the foundations), in order.
std::vector<AxiomForm> all_forms(const ModelAst& model, const base::SourceFiles& files);
/// Those about events: effects, preconditions, triggers.
std::vector<AxiomForm> axiom_forms(const ModelAst& model, const base::SourceFiles& files);
/// All that repair edits: those about events and those about states.
std::vector<AxiomForm> repairable_forms(const ModelAst& model, const base::SourceFiles& files);

/// The event, fluent and time of `Initiates(E,F,time)` and its like.
struct EffectParts {
  NodeId event, fluent, time;
};
std::optional<EffectParts> effect_parts(const Ast& ast, NodeId atom);

/// A part of a text.
struct TextExtent {
  std::uint32_t begin = 0, end = 0;
};
/// The node with the parentheses around it, inside [from, to).
TextExtent with_parentheses(std::string_view text, const Node& node, std::uint32_t from,
                            std::uint32_t to);

/// The end of a formula with the parentheses that close it and its period.
std::uint32_t end_of_formula(std::string_view text, std::uint32_t end);

/// The text of a model: every file's statements in the order in which they act, those of the
/// foundations as `load`. What `changes` do within a statement, or right behind it, is done.
std::string flat_text(const ModelAst& model, const base::SourceFiles& files,
                      const std::vector<TextChange>& changes);

/// The text with the changes, which do not overlap.
std::string changed_text(std::string_view text, base::FileId file, std::vector<TextChange> changes);

}  // namespace parallax::compiler
