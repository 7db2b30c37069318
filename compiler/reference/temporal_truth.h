#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compiler/base/source_file.h"
#include "compiler/reference/model_expander.h"
#include "compiler/reference/reference_evaluator.h"

namespace parallax::compiler {

/// Does no operator about later timepoints stand in the formula?
bool only_looks_back(const TypedModel& model, TypedFormulaId formula);

/// Does the formula promise that something comes about at some time (`eventually`, `until`), so
/// that no beginning of an execution can break it?
bool waits_for_end(const TypedModel& model, TypedFormulaId formula);

/// Part of a formula that makes it false of a trace, at the timepoint where one would look.
struct TemporalBreak {
  base::SourceRange formula;  // a part of it
  std::int64_t at = 0;
  std::string text;  // "does not hold at timepoint 3"
};

/// Evaluates a temporal formula on a trace, timepoint by timepoint from the definitions. Shares
/// nothing with the encoding into clauses; it is its oracle. Nothing happens at the last timepoint
/// of a trace. A formula has no value where a state formula in it names a timepoint that does not
/// exist: `always`, `until` and quantifiers leave such instances out.
class TemporalTruth {
 public:
  /// A value is missing where the formula names what does not exist.
  using Values = std::vector<std::optional<bool>>;  // by timepoint

  /// `model` outlives the object, and so does what `limits` points to; the formulas that are to be
  /// asked are in its stores.
  TemporalTruth(const TypedModel& model, const ReferenceLimits& limits = {});

  /// Why no formula may be evaluated, or why the last one has no value.
  std::optional<std::string> refusal() const;
  /// At every timepoint of the trace. `time`: the formula's free variable, if it has one.
  Values values(TypedFormulaId formula, std::optional<VariableId> time, const Valuation& trace);
  /// Why the formula is not true at t.
  TemporalBreak why_false(TypedFormulaId formula, std::int64_t t, std::optional<VariableId> time,
                          const Valuation& trace);

 private:
  Values of(TypedFormulaId formula);
  Values leaf(TypedFormulaId formula);
  Values quantified(const TypedFormula& formula, std::size_t variable);
  Values temporal(const TypedFormula& formula);
  Values connected(const TypedFormula& formula);
  std::optional<TemporalBreak> step(TypedFormulaId& formula, std::int64_t& t);
  std::optional<TemporalBreak> until_step(const TypedFormula& formula, std::int64_t t);
  void look_at(std::optional<VariableId> time, const Valuation& trace);
  std::int64_t last() const { return static_cast<std::int64_t>(trace_->holds.size()) - 1; }

  const TypedModel& model_;
  ReferenceLimits limits_;
  ReferenceBudget budget_;
  ExpandedModel expanded_;
  ModelExpander expander_;
  const Valuation* trace_ = nullptr;
  std::optional<VariableId> time_;
  std::vector<std::uint8_t> atoms_;  // values of the trace's atoms
};

}  // namespace parallax::compiler
