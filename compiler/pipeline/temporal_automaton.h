#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "compiler/pipeline/temporal_tree.h"

namespace parallax::compiler {

/// What a node of a temporal formula says at each timepoint; none where it names what does not
/// exist.
struct TemporalValues {
  using Value = std::optional<FormulaId>;
  using Values = std::vector<Value>;  // by timepoint
  Values ends;                        // of traces that end here
  Values surely;                      // of those that may end or go on: whatever happens here
  Values goes_on;                     // up to the timepoint before the horizon
};

/// Which beginnings of a trace fulfil a formula, for all ends at once. Forwards: a state is what
/// remains to be fulfilled from the next timepoint on, and all states that the trace so far allows
/// are followed together (an alternating automaton made deterministic, one variable for each state
/// and timepoint). Linear in the horizon; exponential in the operators at worst.
class TemporalAutomaton {
 public:
  using Number = TemporalTree::Number;
  using Values = TemporalValues::Values;

  /// `values` of what only looks back; all outlive the automaton.
  TemporalAutomaton(const TemporalTree& tree, const std::vector<TemporalValues>& values,
                    FormulaStore& formulas, Timepoint horizon);

  /// Of the node or its negation. False: more than `most` steps, or a node that it does not take:
  /// an operator about the past around one about later timepoints, or `next` before what names a
  /// timepoint before 0 there.
  bool build(Number root, bool negated, std::size_t most);
  std::size_t size() const { return size_; }
  /// By n: the trace from 0 to n fulfils what was built. `name` gives an atom for a formula.
  Values values(const std::function<FormulaId(FormulaId)>& name) const;

 private:
  using Kind = TemporalTree::Kind;
  using Goal = std::uint32_t;                  // a node's number twice, and 1 for its negation
  using Goals = std::vector<Goal>;             // all of them; ascending
  using Choices = std::map<Goals, FormulaId>;  // what remains, and under which condition
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
