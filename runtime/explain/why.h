#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "runtime/explain/derivation.h"

namespace parallax::runtime {

enum class WhyKind : std::uint8_t {
  kStated,      // an axiom says so outright
  kEffect,      // an event brought it about (effect or trajectory axiom)
  kInertia,     // it was so before, and nothing changed it
  kAxiom,       // it follows from an axiom and other facts
  kCompletion,  // a completed predicate: nothing else could be a reason for it
  kForced,      // open at its time, but what comes later admits no other value
  kChosen,      // the model leaves it open; this trace has it so
  kUndecided    // forced or chosen: the solver was stopped
};

/// One fact of a chain, and what it follows from.
struct WhyStep {
  compiler::Literal fact;
  WhyKind kind;
  std::optional<std::uint32_t> origin;      // the axiom; none for choices
  std::vector<compiler::Literal> premises;  // facts that are told before this one
  /// Inertia: the timepoint since which the fact has been so without a break; it is told for that
  /// timepoint as a premise.
  compiler::Timepoint since = 0;
  /// Inertia: what would have changed it and did not happen.
  std::vector<compiler::Literal> absent;
  /// Clauses of effects that would have brought it about as well.
  std::vector<std::size_t> also;
};

struct WhyOptions {
  bool alternatives = false;  // tell the premises of `also` as well
  const std::atomic<bool>* stop = nullptr;
};

/// The chain of facts behind one that is true in a trace: earliest first, the fact itself last,
/// each once, premises before what follows from them. `values` as for Derivation, `fact` is true in
/// it.
std::vector<WhyStep> explain_fact(const compiler::CompiledModel& model, compiler::Timepoint n,
                                  const std::vector<bool>& values, compiler::Literal fact,
                                  const WhyOptions& options = {});

}  // namespace parallax::runtime
