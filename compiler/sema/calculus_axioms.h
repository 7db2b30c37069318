#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "compiler/base/source_file.h"
#include "compiler/syntax/ast.h"

namespace parallax::compiler {

/// A small formula as clauses: conjuncts that are disjunctions of atoms, comparisons and
/// existential formulas. Two formulas that differ in the names and order of variables, in the order
/// of conjuncts and disjuncts, or in `A -> (B -> C)` for `A & B -> C`, have equal ones.
class ClauseShape {
 public:
  struct Part;
  /// None: the formula is larger than any that is looked for.
  static std::optional<ClauseShape> of(const Ast& ast, const Statement& formula);

  /// Can the clauses be paired so that each pair is the same up to the names of variables?
  bool same_as(const ClauseShape& pattern) const;
  /// Is each clause the same as some clause of the patterns?
  bool all_among(const std::vector<ClauseShape>& patterns) const;

 private:
  friend class ShapeMaker;
  using Clause = std::vector<Part>;
  const Ast* ast_ = nullptr;
  std::vector<std::vector<Part>> clauses_;
};

/// A part of a clause.
struct ClauseShape::Part {
  enum class Kind : std::uint8_t { kAtom, kCompare, kAnd, kOr, kExists };
  Kind kind = Kind::kAtom;
  bool negated = false;                     // kAtom, kCompare of `=`
  NodeId node;                              // kAtom
  Operator op = Operator::kEqual;           // kCompare: `=`, `<`, `<=`
  NodeId left, right;                       // kCompare
  std::vector<std::string_view> variables;  // kExists
  std::vector<Part> parts;                  // kAnd, kOr; the body of kExists
};

/// The axioms DEC3 to DEC12 of the discrete event calculus (Mueller 2006, section 2.3), which hold
/// without being written, as old models write them.
class CalculusAxioms {
 public:
  CalculusAxioms();
  /// Is the formula one of the axioms, or several of them in one?
  bool recognises(const ClauseShape& shape) const { return shape.all_among(axioms_); }
  /// Does it define Clipped, Declipped, StoppedIn or StartedIn as the axioms mean them?
  bool is_usual_definition(const ClauseShape& shape) const;
  /// The predicate that the formula defines by `[...] P(...) <-> ...`, if it is one of these four.
  static std::optional<std::string_view> defined_interval(const Ast& ast, NodeId formula);

 private:
  base::SourceFiles files_;
  std::vector<Ast> asts_;
  std::vector<ClauseShape> axioms_, definitions_;
};

}  // namespace parallax::compiler
