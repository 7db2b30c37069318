#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// Identifiers of a logic program for the names of a model: the first letter small, and `_` behind
/// a name that is taken. One pool for sorts, constants, symbols and the exporter's own predicates,
/// so that no two things share a name.
class AspNames {
 public:
  explicit AspNames(const TypedModel& model);

  const std::string& sort(SortId id) const { return sorts_[id.index()]; }
  const std::string& object(ObjectId id) const { return objects_[id.index()]; }
  /// The predicates of the event calculus are `holds_at`, `happens`, ...
  const std::string& symbol(SymbolId id) const { return symbols_[id.index()]; }

  /// `wanted`, changed where it is no identifier or is taken; never given again.
  std::string fresh(std::string_view wanted);

  /// A ground term or user's atom as clingo prints it, in the model's spelling without blanks:
  /// `on(red,3)` is `On(Red,3)`, `f` is `F()`.
  std::string original(std::string_view printed) const;
  /// The way back: `On(Red,3)` is `on(red,3)`, `F()` is `f`.
  std::string printed(std::string_view original) const;

 private:
  std::vector<std::string> sorts_, objects_, symbols_;
  std::set<std::string, std::less<>> taken_;
  std::map<std::string, std::string, std::less<>> originals_;  // symbols with `()` appended
  std::map<std::string, std::string, std::less<>> by_original_;
};

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

  /// The number as it stands; reported (E3050) at `source` where it does not fit 32 bits.
  std::string number(std::int64_t value, base::SourceRange source) const;

 private:
  AspTerm leaf(const Term& node);
  AspTerm combined(TermId id, std::vector<AspTerm> arguments);
  AspTerm arithmetic(const Term& node, AspTerm left, AspTerm right) const;
  void require_member(const Term& node, SortId sort, AspTerm& value) const;
  bool surely_member(const Term& node, SortId sort) const;
  bool never_negative(TermId id) const;

  const TypedModel& model_;
  const AspNames& names_;
  base::DiagnosticSink& sink_;
  std::map<std::uint32_t, std::string> variables_;
  std::set<std::string> used_;
  std::map<std::string, std::string> values_;  // variable by function application
  mutable std::map<std::uint32_t, bool> empty_;
};

}  // namespace parallax::compiler
