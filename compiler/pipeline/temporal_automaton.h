#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "compiler/pipeline/temporal_tree.h"

namespace parallax::compiler {

/// Values of a node of a temporal formula at each timepoint; none where the node names something
/// that does not exist.
struct TemporalValues {
  using Value = std::optional<FormulaId>;
  using Values = std::vector<Value>;  // by timepoint
  Values ends;                        // for traces that end here
  Values surely;                      // for traces that end here or go on: true in either case
  Values goes_on;                     // for traces that go on; up to the horizon - 1
};

/// Decides which prefixes of a trace fulfil a formula, for all ends at once. It runs forwards: a
/// state is the set of goals that remain from the next timepoint on, and all states that the trace
/// so far allows are followed together (an alternating automaton made deterministic, one variable
/// for each state and timepoint). Linear in the horizon; exponential in the operators at worst.
class TemporalAutomaton {
 public:
  using Number = TemporalTree::Number;
  using Values = TemporalValues::Values;

  /// `values` are those of the nodes that only look back. All arguments outlive the automaton.
  TemporalAutomaton(const TemporalTree& tree, const std::vector<TemporalValues>& values,
                    FormulaStore& formulas, Timepoint horizon);

  /// Builds the automaton of a node or its negation. Returns false if it takes more than `most`
  /// steps, or for a node that it does not support: an operator about the past around one about
  /// later timepoints, or `next` before a part that names a timepoint before 0 there.
  bool build(Number root, bool negated, std::size_t most);
  std::size_t size() const { return size_; }
  /// By n: the trace from 0 to n fulfils the formula that was built. `name` gives an atom for a
  /// formula.
  Values values(const std::function<FormulaId(FormulaId)>& name) const;

 private:
  using Kind = TemporalTree::Kind;
  using Goal = std::uint32_t;                  // twice the node's number, plus 1 for its negation
  using Goals = std::vector<Goal>;             // a conjunction; ascending
  using Choices = std::map<Goals, FormulaId>;  // remaining goals, and under which condition
  struct Step {
    Goals from, to;
    FormulaId guard;
  };

  bool is_taken(Number number) const;
  Timepoint speaks_from(Number number) const;
  bool speaks(Number number, Timepoint t) const;
  Choices expand(Goal goal, Timepoint t);
  Choices both(const Choices& a, const Choices& b);
  Choices either(Choices a, const Choices& b);
  void prune(Choices& choices) const;
  FormulaId at_end(Goal goal, Timepoint t) const;

  const TemporalTree& tree_;
  const std::vector<TemporalValues>& values_;
  FormulaStore& formulas_;
  Timepoint horizon_;
  Goal root_ = 0;
  std::size_t size_ = 0, most_ = 0;
  bool too_large_ = false;
  std::vector<std::vector<Step>> steps_;  // by timepoint
  std::map<Goal, Choices> expanded_;      // at the timepoint at hand
};

}  // namespace parallax::compiler
