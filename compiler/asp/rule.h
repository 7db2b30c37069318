#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// A body literal as text. Where it is an atom of the model, also which one: completion has to
/// tell the occurrences of a predicate.
struct AspLiteral {
  std::string text;
  std::optional<SymbolId> predicate;
  std::vector<std::string> arguments;
  bool positive = true;
};

/// A conjunction. The empty one is true.
using AspBody = std::vector<AspLiteral>;
/// A disjunction of conjunctions. The empty one is false.
using AspAlternatives = std::vector<AspBody>;

/// The true or the false disjunction.
AspAlternatives constant(bool value);

AspLiteral plain_literal(std::string text);

void append(AspBody& body, const AspBody& more);

/// `name(a,b)`, or `name` without arguments.
std::string applied(const std::string& name, const std::vector<std::string>& arguments);

/// `head :- body.` with repeated literals left out, wrapped; a head alone is a fact, and a rule
/// without head forbids its body.
std::string rule_text(const std::string& head, const AspBody& body);

}  // namespace parallax::compiler
