#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/ground/effect_rows.h"
#include "compiler/ground/ground_model.h"

namespace parallax::compiler {

/// Expands typed formulas into propositional ones under an assignment of the free variables.
///
/// The horizon is finite, so an instance can name a timepoint, an event occurrence or an integer
/// that does not exist. Such an instance says nothing: it leaves the innermost quantifier around
/// it; a quantifier none of whose instances exists passes this on. A conjunction with a false part
/// stays false and a disjunction with a true part stays true.
class FormulaGrounder {
 public:
  FormulaGrounder(GroundModel& model, const GroundOptions& options, base::DiagnosticSink& sink);

  /// From now on Initiates, Terminates and Releases in formulas mean these rows; before, they name
  /// nothing. `rows` outlives the grounder.
  void use_effects(const EffectRows& rows) { rows_ = &rows; }

  void bind(VariableId variable, GroundTermId value) { environment_[variable.index()] = value; }
  void unbind(VariableId variable) { environment_[variable.index()].reset(); }
  /// Starts a new budget of instances, reported at `blame`.
  void start(base::SourceRange blame);
  /// True once an error was reported since `start`.
  bool failed() const { return failed_; }
  /// Counts `more` instances against the budget; false (and reported) when it is spent.
  bool spend(std::int64_t more);

  /// None: the formula names something that does not exist (or an error was reported).
  std::optional<FormulaId> ground(TypedFormulaId formula);
  /// None: the term does not denote.
  std::optional<GroundTermId> term(TermId term);

 private:
  struct Frame;
  std::optional<FormulaId> leaf(const TypedFormula& formula);
  std::optional<FormulaId> atom(const TypedFormula& formula);
  std::optional<FormulaId> compare(const TypedFormula& formula);
  std::optional<FormulaId> combine(Frame& frame);
  bool begin_instances(Frame& frame);
  bool next_instance(Frame& frame);
  std::optional<GroundTermId> arithmetic(const Term& term, GroundTermId left, GroundTermId right);
  std::optional<GroundTermId> apply(const Term& term, std::vector<GroundTermId> arguments);
  bool arguments_fit(const Symbol& symbol, const std::vector<GroundTermId>& arguments) const;
  std::optional<FormulaId> effect_atom(EffectKind kind, const std::vector<GroundTermId>& arguments);
  void read_function_values();

  GroundModel* model_;
  const TypedModel* typed_;
  GroundOptions options_;
  base::DiagnosticSink* sink_;
  std::vector<std::optional<GroundTermId>> environment_;  // by variable
  const EffectRows* rows_ = nullptr;
  /// By function application: the value stated for it.
  std::unordered_map<GroundTermId, GroundTermId> function_values_;
  std::int64_t spent_ = 0;
  bool failed_ = false;
  base::SourceRange blame_;
};

}  // namespace parallax::compiler
