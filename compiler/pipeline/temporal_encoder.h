#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "compiler/pipeline/state_constraint.h"
#include "compiler/pipeline/temporal_automaton.h"
#include "compiler/pipeline/temporal_tree.h"

namespace parallax::compiler {

/// A formula of linear temporal logic over finite traces (De Giacomo and Vardi, 2013), operators
/// about the past included, in terms of the atoms of a model. A trace has states 0 to n and events
/// 0 to n - 1: nothing happens at its last timepoint. Each operator gets a variable for each
/// timepoint, which is defined by the one for the next timepoint (until, ...) or for the one before
/// (since, ...).
///
/// Every node has two values at t: one for traces that end there, one for those that go on.
class TemporalEncoder {
 public:
  /// All outlive the encoder, which is for one formula; `origin` is that of its clauses.
  TemporalEncoder(const StateConstraint& formula, std::uint32_t origin, GroundModel& model,
                  FormulaGrounder& grounder, base::DiagnosticSink& sink);

  using Value = TemporalValues::Value;
  using Values = TemporalValues::Values;

  /// By n: the trace from 0 to n fulfils the formula, at its last timepoint if the formula only
  /// looks back, else at its first; none where it names what does not exist. None: reported.
  std::optional<Values> fulfilled();

  /// Where `hit` of n is true, and of no earlier timepoint, the trace from 0 to n violates the
  /// property: either n is `complete` and the formula false of it, or it is false however the trace
  /// goes on. A property that only looks back is to hold at all timepoints. There is no hit where
  /// an end is not `known`. Hits are forced only where every trace violates it.
  base::Status require_violation(const std::vector<FormulaId>& hit,
                                 const std::vector<FormulaId>& complete,
                                 const std::vector<FormulaId>& known);

 private:
  using Kind = TemporalTree::Kind;
  using Number = TemporalTree::Number;
  using Node = TemporalValues;
  /// Which traces are spoken of.
  struct View {
    Timepoint last = 0;
    /// All end where the first hit is, or at `last` if there are no hits.
    const std::vector<FormulaId>* hit = nullptr;
    const std::vector<FormulaId>* complete = nullptr;  // beside `hit`
  };

  std::optional<Values> fulfilled(Number part);
  std::optional<Values> by_automaton(Number part);
  bool settle(Number root);
  bool says_something();
  bool settle_leaf(Number number);
  bool looks_ahead(FormulaId formula, Timepoint t) const;
  FormulaId at_last(FormulaId formula, Timepoint t, bool nothing_happens) const;
  void settle_past(Number number);
  Value past(Number number, Timepoint t, const Values Node::*column);
  void settle_future(const View& view);
  Value end_value(Number number, Timepoint t, const View& view) const;
  Value ending(Number number, Timepoint t, const View& view);
  Value going_on(Number number, Timepoint t, const View& view);
  FormulaId complete(Timepoint t, const View& view) const;
  Value any(Number number, Timepoint t, const View& view);
  Value junction(Number number, const std::function<Value(std::size_t)>& child) const;
  Value named(Value value);

  const StateConstraint& formula_;
  std::uint32_t origin_;
  GroundModel& model_;
  FormulaGrounder& grounder_;
  base::DiagnosticSink& sink_;
  FormulaStore& formulas_;
  TemporalTree tree_;
  std::vector<Node> nodes_;     // by number
  std::vector<Number> wanted_;  // parts of the root, ascending
  std::map<FormulaId, FormulaId> names_;
  std::map<std::pair<Number, Timepoint>, Value> any_;  // of the view at hand
};

}  // namespace parallax::compiler
