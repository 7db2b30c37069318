#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/asp/names.h"
#include "compiler/base/diagnostic.h"
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

/// A term as text, and the positive literals that hold exactly if it denotes.
struct AspTerm {
  std::string text;
  AspBody needs;    // memberships and look-ups
  AspBody lookups;  // those of `needs` that bind a variable of the text
};

/// Terms of one axiom: variables get their names with a capital letter, the values of functions
/// variables of their own.
class TermWriter {
 public:
  TermWriter(const TypedModel& model, const AspNames& names, base::DiagnosticSink& sink)
      : model_(model), names_(names), sink_(sink) {}

  /// Forgets the variables: a new axiom begins.
  void start();
  const std::string& variable(VariableId id);
  /// A variable for the exporter's own use.
  std::string fresh_variable(const std::string& wanted);
  /// `sort(Variable)` for each.
  AspBody domains(const std::vector<VariableId>& variables);

  AspTerm term(TermId id);
  /// The term and what makes it an element of the sort.
  AspTerm member(TermId id, SortId sort);

  /// True if the sort has no element; constructors over empty sorts have none.
  bool is_empty(SortId sort) const;
  /// True for an integer sort without a range: every integer may stand where it is declared.
  bool is_unbounded(SortId sort) const;

 private:
  AspTerm leaf(const Term& node);
  AspTerm combined(TermId id, std::vector<AspTerm> arguments);
  AspTerm arithmetic(const Term& node, AspTerm left, AspTerm right) const;
  void require_member(const Term& node, SortId sort, AspTerm& value) const;
  bool surely_member(const Term& node, SortId sort) const;
  bool never_negative(TermId id) const;
  std::string number(std::int64_t value, base::SourceRange source) const;

  const TypedModel& model_;
  const AspNames& names_;
  base::DiagnosticSink& sink_;
  std::map<std::uint32_t, std::string> variables_;
  std::set<std::string> used_;
  std::map<std::string, std::string> values_;  // variable by function application
  mutable std::map<std::uint32_t, bool> empty_;
};

}  // namespace parallax::compiler
