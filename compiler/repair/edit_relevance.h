#pragma once

#include <string>
#include <vector>

#include "compiler/repair/edit_grammar.h"

namespace parallax::compiler {

/// Rates literals and effects: which ones can explain the observations at the steps of a scope, and
/// how usual they are. Its arguments outlive it.
class EditRelevance {
 public:
  EditRelevance(const ModelAst& model, const std::vector<AxiomForm>& forms, const EditScope& scope)
      : model_(model), forms_(forms), scope_(scope) {}

  /// Could the literal have been `value` in front of one of the steps? `arguments` are those of the
  /// event in the axiom, in whose `variables` the literal is. Of events that are not at a step
  /// nothing is known.
  bool in_some_step(const ConditionLiteral& literal, bool value,
                    const std::vector<std::string>& arguments, const std::string& symbol,
                    const std::vector<std::string>& variables) const;
  /// Could the literal have been `value` in front of one of the steps, or `after` it, for some
  /// values of its variables?
  bool around_some_step(const ConditionLiteral& literal, bool value, bool after) const;
  /// Could the literal have held in front of an event of this symbol that did what the model says?
  bool in_some_success(const ConditionLiteral& literal, const std::vector<std::string>& arguments,
                       const std::string& symbol, const std::vector<std::string>& variables) const;
  /// Would the effect explain what was observed of the fluent at one of the steps? `choice` are the
  /// fluent's arguments.
  bool covers(const std::string& kind, const std::string& event, const std::string& fluent,
              const std::vector<std::string>& of_event, const std::vector<std::string>& choice,
              const std::vector<std::string>& variables) const;
  /// Edit::oddity of a condition of the event.
  int oddity(const ConditionLiteral& literal, const std::string& event) const;

  /// Adds to `edits` the conditions that the new effect `of`, one of them, may have: at most `most`
  /// of a symbol, without constants and without those that are `given`. Of its `variables` the
  /// first `arity` are those of the event.
  void add_conditions(const TypedModel& typed, std::size_t of,
                      const std::vector<SortedVariable>& variables, std::size_t arity,
                      std::size_t most, const std::vector<ConditionLiteral>& given,
                      std::vector<Edit>& edits) const;

 private:
  const ModelAst& model_;
  const std::vector<AxiomForm>& forms_;
  const EditScope& scope_;
};

}  // namespace parallax::compiler
