#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "runtime/enumerate/trace_source.h"

namespace parallax::runtime {

using compiler::CompiledModel;
using compiler::Literal;
using compiler::Timepoint;

/// Clauses over one window, with variables of their own:
///   1 .. S             the slots of the state before, S = state_slots
///   S+1 .. 2S          the slots of the state after
///   2S+1 .. S+stride   the slots of the step between them
///   the rest           variables that occur in this window only
/// The window at the start has the state before only.
struct WindowClauses {
  std::vector<std::vector<std::int32_t>> clauses;  // DIMACS literals
  std::int32_t variables = 0;
  friend bool operator==(const WindowClauses&, const WindowClauses&) = default;
};

/// A model whose clauses each look at two neighbouring timepoints at most.
struct LayeredModel {
  Timepoint horizon = 0;
  std::uint32_t state_slots = 0;
  std::uint32_t stride = 0;
  /// State slots that tell traces apart: HoldsAt in declaration order, then perhaps ReleasedAt.
  std::vector<std::uint32_t> observed;
  std::vector<std::uint32_t> events;  // step slots of Happens, in declaration order
  /// Other state slots that one window can hand on to the next.
  std::vector<std::uint32_t> hidden;
  /// Fixed variables that are carried in the state slots behind those of the model, by slot.
  std::vector<std::int32_t> carried;
  /// State slots of ReleasedAt that are neither, though some clause mentions them.
  std::vector<std::uint32_t> loose_releases;
  WindowClauses start;
  std::vector<WindowClauses> steps;      // each one once
  std::vector<std::uint32_t> step_at;    // by timepoint: index into `steps`
  std::vector<std::int32_t> true_fixed;  // fixed variables that are true in every trace
  std::vector<std::int32_t> open_fixed;  // fixed variables whose value differs between traces
  /// There are clauses that no window has, over fixed variables alone. They distinguish no traces,
  /// but if they cannot hold, there is no trace.
  bool has_unplaced = false;

  /// Literals of a window: for a slot of the state before it; for one of the state after it, or of
  /// the step.
  Literal before(std::uint32_t slot) const {
    return Literal::positive(static_cast<std::int32_t>(slot) + 1);
  }
  Literal after(std::uint32_t slot) const { return before(state_slots + slot); }
  /// Those for `observed`, then `hidden`.
  std::vector<Literal> state_before() const;
  std::vector<Literal> state_after() const;
};

/// Treatment of variables without a timepoint that tie far windows together.
enum class FixedTies : std::uint8_t {
  kRefused,
  /// Each becomes a hidden slot of every state, behind those of the model, that no step changes;
  /// the step slots move up. So do atoms that clauses look back at from beyond the next timepoint.
  /// At most kMostCarried.
  kCarried,
};
inline constexpr std::size_t kMostCarried = 12;

/// Splits the model into windows, or says why it cannot be split: "a clause of FILE:LINE spans
/// timepoints 0 to 3". Fixed variables with a value of their own are replaced by it. Linear in the
/// clauses, for each time that further variables have to be carried. `values` are the values of
/// fixed variables, as from unit_values; by default those that unit propagation over the whole
/// horizon finds.
std::variant<LayeredModel, std::string> split_into_windows(const CompiledModel& model,
                                                           Distinct distinct,
                                                           FixedTies ties = FixedTies::kRefused);
std::variant<LayeredModel, std::string> split_into_windows(const CompiledModel& model,
                                                           Distinct distinct,
                                                           std::vector<std::int8_t> values);

}  // namespace parallax::runtime
