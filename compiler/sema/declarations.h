#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/sema/check.h"
#include "compiler/sema/typed_model.h"
#include "compiler/syntax/ast.h"
#include "compiler/syntax/loader.h"

namespace parallax::compiler {

/// Reports repeated declarations and axioms. Those that the foundations make first are reported
/// once for each file, since old models repeat them, whole or in part; not at all where the file is
/// a copy of a foundation.
class Repetitions {
 public:
  Repetitions(const ModelAst& ast, base::DiagnosticSink& sink);
  /// `name` at `again` is declared as it was at `first`, in whatever order the two stand.
  void note(std::string_view name, base::SourceRange again, base::SourceRange first);
  /// An axiom of the event calculus, which holds by itself.
  void note_axiom(base::SourceRange source) { note_foundation(source, "this axiom"); }
  bool built_in(base::SourceRange range) const { return is(kBuiltIn, range); }
  bool is_copy(base::SourceRange range) const { return is(kCopy, range); }

 private:
  void note_foundation(base::SourceRange again, std::string_view what);

  enum Kind : std::uint8_t { kOwn, kCopy, kBuiltIn };
  bool is(Kind kind, base::SourceRange range) const {
    return range.file.index() < kinds_.size() && kinds_[range.file.index()] == kind;
  }

  base::DiagnosticSink& sink_;
  std::vector<Kind> kinds_;  // by file
  std::vector<bool> told_;   // by file: was its repetition of the foundations reported?
};

/// All `sort` and `reified sort` statements: names, then parents, then what parents imply. A sort
/// below itself (E2003) loses the parent that closes the circle.
void declare_sorts(const ModelAst& ast, Repetitions& repetitions, TypedModel& model,
                   base::DiagnosticSink& sink);

/// E2010 for reified sorts whose terms could be nested without end. Needs all symbols.
void check_finite_sorts(const TypedModel& model, base::DiagnosticSink& sink);

/// The sort `word` names, or nothing after an E2001 with a suggestion.
std::optional<SortId> resolve_sort(const Ast& ast, Word word, TypedModel& model,
                                   base::DiagnosticSink& sink);

/// One `option NAME VALUE`. E2011 for unknown names, E2012 for values the option cannot have.
void apply_option(const Ast& ast, const Statement& statement, DeclaredOptions& options,
                  base::DiagnosticSink& sink);

/// The names that `ignore` statements put out of force. A declaration or list entry is left out if
/// it comes after the statement; a formula wherever it stands.
class IgnoredNames {
 public:
  explicit IgnoredNames(const ModelAst& ast);
  bool contains(std::string_view name) const { return since_.contains(name); }
  /// Is `name` ignored by a statement before position `at` of ModelAst::order?
  bool contains(std::string_view name, std::size_t at) const;
  /// Does the formula mention an ignored name anywhere?
  bool concern(const Ast& ast, const Statement& formula) const;

 private:
  std::unordered_map<std::string_view, std::size_t> since_;
};

/// Fills the sorts, objects and symbols of `model` from all declarations, wherever in the model
/// they stand, and its options and completions. Reports wrong declarations and leaves them out.
void declare(const ModelAst& ast, const IgnoredNames& ignored, const CheckOptions& options,
             Repetitions& repetitions, TypedModel& model, base::DiagnosticSink& sink);

}  // namespace parallax::compiler
