#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/lisp/lisp_data.h"
#include "compiler/lisp/lisp_reader.h"

namespace parallax::compiler {

/// The forms of a plan as they are written, for edits of its text: which of them are statements,
/// which names are visible there, and which other forms of the plan would make sense there.
class PlanText {
 public:
  /// None where the text cannot be read.
  static std::optional<PlanText> read(const base::SourceFiles& files,
                                      std::span<const base::FileId> plan);

  const LispData& data() const { return text_.data; }
  const base::SourceRange& source(DatumId form) const { return text_.data.source(form); }
  std::string_view written(DatumId form) const { return files_->text(source(form)); }
  /// "plan2.lisp:41"
  std::string place(DatumId form) const { return files_->place(source(form)); }
  const base::SourceFiles& files() const { return *files_; }

  /// Calls `visit` with each of the forms and with all that is in them, outer ones first.
  template <typename Visit>
  void for_each_datum(std::vector<DatumId> todo, Visit visit) const {
    while (!todo.empty()) {
      const auto datum = todo.back();
      todo.pop_back();
      visit(datum);
      for (const auto child : data().children(datum)) todo.push_back(child);
    }
  }

  /// The form that stands exactly there.
  std::optional<DatumId> form_at(const base::SourceRange& source) const;
  /// The form, or the innermost one around it, that is an element of a body (of a function, `let`,
  /// `when`, ...) or of the top level: another form may stand in front of it. None in a definition
  /// of data.
  std::optional<DatumId> statement_around(DatumId form) const;
  /// The statement behind which the other of the two stands in the same body comes first.
  bool same_body(DatumId a, DatumId b) const { return parent(a) == parent(b); }
  bool is_last_of_body(DatumId statement) const;
  /// The lexical variables that can be read in front of a statement.
  std::set<std::string> scope(DatumId statement) const;
  /// The variables and globals that occur in a form and are bound outside of it.
  std::set<std::string> free_variables(DatumId form) const;
  /// The function around a form; empty at top level.
  std::string function_of(DatumId form) const;
  /// Is the form inside one that leaves a block or tries again? Text put around it could change the
  /// meaning of that.
  bool jumps(DatumId form) const;

  /// A form that acts: a perform, or the call of a function of the plan that does.
  struct Action {
    std::string text;             // on one line
    std::set<std::string> types;  // of the designators that it performs
    std::optional<DatumId> copied;
    bool substituted = false;  // a variable of the copied form became a value of the plan
    friend bool operator==(const Action&, const Action&) = default;
  };
  /// Actions of the plan, in the order of the text, for a place in front of `statement`. A variable
  /// that cannot be read there becomes one of the values that the plan itself gives it: elements of
  /// the list that `dolist` walks through, arguments of calls. No function that comes to the
  /// statement itself is called.
  std::vector<Action> actions_for(DatumId statement) const;
  /// The types of the designators that are performed in a form, in functions that it calls as well.
  std::set<std::string> performed_types(DatumId form) const;
  bool is_perform(DatumId form) const { return text_.data.head(form) == "perform"; }
  /// Is the form a call of a function that the plan defines?
  bool is_call(DatumId form) const {
    const auto head = text_.data.head(form);
    return head && functions_.contains(*head);
  }
  std::optional<DatumId> parent(DatumId form) const;
  /// Is the form part of the text?
  bool is_written(DatumId form) const;
  /// Does it stand in a quoted list, or is it the name and parameters of a definition?
  bool is_quoted(DatumId form) const;
  bool is_global(const std::string& name) const { return globals_.contains(name); }
  /// How the plan writes `perform`, `an` and so on: with the prefix that it uses.
  std::string prefixed(std::string_view symbol) const;

 private:
  PlanText(const base::SourceFiles& files, LispText text);
  bool is_constant(DatumId form) const;
  std::size_t place_in_parent(DatumId form) const;
  bool is_definition(DatumId form) const;
  void collect_symbols(DatumId form, std::set<std::string>& out) const;
  std::vector<std::string> bound_by(DatumId form) const;
  std::vector<std::string> values_of(const std::string& variable, DatumId where) const;
  void add_types(DatumId form, std::set<std::string>& out, std::set<std::string>& seen) const;
  void add_called(DatumId form, std::set<std::string>& seen) const;
  std::string one_line(DatumId form, const std::map<std::string, std::string>& values) const;

  const base::SourceFiles* files_;
  LispText text_;
  std::vector<std::optional<DatumId>> parents_;  // by datum
  std::map<std::string, DatumId, std::less<>> functions_;
  std::set<std::string> globals_;
};

}  // namespace parallax::compiler
