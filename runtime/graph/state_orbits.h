#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "runtime/graph/layered_model.h"
#include "runtime/graph/trace_graph.h"
#include "runtime/symmetry/interchangeable.h"

namespace parallax::runtime {

/// States of a layered model up to exchanging constants that the model does not tell apart. The
/// same number of traces go on from a state and from its image under a symmetry, so that a graph
/// that counts them needs only one of the two.
class StateOrbits {
 public:
  /// `layered` is the model's own. Symmetries are left out if their effect on its states cannot be
  /// told. Linear in the slots and in what the generators move.
  StateOrbits(const CompiledModel& model, const LayeredModel& layered,
              std::span<const NodeMap> symmetries);
  /// True if every state is its own orbit.
  bool empty() const { return generators_.empty(); }

  /// A state of the same orbit from which no generator leads to an earlier one (false before true,
  /// in the order of the slots). Where generators exchange neighbours of a set and no atom mentions
  /// two of the set, it is the first of the orbit; else an orbit may keep several.
  void represent(GraphNode& node) const;

 private:
  /// Moves of a vector of bits: each place that changes, and the place that its new value comes
  /// from. Sorted by place.
  using Moves = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
  struct Generator {
    Moves observed, hidden;
  };
  static std::optional<Generator> generator(const CompiledModel& model, const LayeredModel& layered,
                                            const NodeMap& symmetry);
  static bool apply_if_earlier(const Generator& generator, GraphNode& node);

  std::vector<Generator> generators_;
};

/// Orbits by which a counting graph merges states.
struct GraphOrbits {
  StateOrbits at_start;  // symmetries of the whole model
  StateOrbits later;     // symmetries of the model after timepoint 0 (model_after_start)

  /// Searches for symmetries, some tenths of a second each.
  static GraphOrbits of(const CompiledModel& model, const LayeredModel& layered);
  bool empty() const { return at_start.empty() && later.empty(); }
};

/// The model without what it says of the state at timepoint 0 alone, for a search for symmetries.
/// What it proved of all states counts as said.
CompiledModel model_after_start(const CompiledModel& model);

}  // namespace parallax::runtime
