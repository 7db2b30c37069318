#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/ground/ground_model.h"

namespace parallax::compiler {

/// Values of variables, and of terms under them. Errors that a term makes (division by zero, a
/// function without a value) are reported once and end the work on the axiom.
class TermGrounder {
 public:
  TermGrounder(GroundModel& model, const GroundOptions& options, base::DiagnosticSink& sink);

  void bind(VariableId variable, GroundTermId value) { environment_[variable.index()] = value; }
  void unbind(VariableId variable) { environment_[variable.index()].reset(); }
  std::optional<GroundTermId> value(VariableId variable) const {
    return environment_[variable.index()];
  }
  bool is_bound(VariableId variable) const { return environment_[variable.index()].has_value(); }

  /// None: the term does not denote (or an error was reported, or a variable is unbound).
  std::optional<GroundTermId> term(TermId term);
  /// The value of a comparison; none if a side does not denote.
  std::optional<bool> compare(const TypedFormula& formula);
  /// Do the arguments lie in the sorts that the symbol declares?
  bool arguments_fit(const Symbol& symbol, std::span<const GroundTermId> arguments) const;
  bool in_sort(SortId sort, GroundTermId value) const {
    return model_->universe().contains(sort, value, model_->terms());
  }

  /// Starts a new budget of instances, reported at `blame`.
  void start(base::SourceRange blame);
  void report_overflow(const base::SourceRange& source);
  /// True once an error was reported since `start`.
  bool failed() const { return failed_; }
  /// Counts `more` instances against the budget; false (and reported) when it is spent.
  bool spend(std::int64_t more);
  /// Instances counted since `start`.
  std::int64_t spent() const { return spent_; }
  const GroundOptions& options() const { return options_; }
  GroundModel& model() const { return *model_; }

 private:
  std::optional<std::optional<GroundTermId>> flat_term(const Term& term);
  std::optional<GroundTermId> arithmetic(const Term& term, GroundTermId left, GroundTermId right);
  std::optional<GroundTermId> apply(const Term& term, std::span<const GroundTermId> arguments);
  void read_function_values();

  GroundModel* model_;
  const TypedModel* typed_;
  GroundOptions options_;
  base::DiagnosticSink* sink_;
  std::vector<std::optional<GroundTermId>> environment_;  // by variable
  /// By function application: the value stated for it.
  std::unordered_map<GroundTermId, GroundTermId> function_values_;
  std::int64_t spent_ = 0;
  bool failed_ = false;
  base::SourceRange blame_;
};

}  // namespace parallax::compiler
