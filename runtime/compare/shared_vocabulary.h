#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compiler/artifact/compiled_model.h"

namespace parallax::runtime {

using compiler::AtomKind;
using compiler::CompiledModel;
using compiler::Literal;
using compiler::Timepoint;

/// An observable atom of a name that both models have. Without a literal it is false in every trace
/// of that model; one of the two has one.
struct SharedAtom {
  AtomKind kind = AtomKind::kHoldsAt;  // or kHappens
  std::uint32_t name = 0;              // index into SharedVocabulary::names
  Timepoint time = 0;
  std::optional<Literal> first, second;
  /// The horizon from which on it exists.
  Timepoint needed_horizon() const { return time + (kind == AtomKind::kHappens ? 1 : 0); }
};

/// What two models of one horizon can be compared on: the ground fluents and events that both have.
struct SharedVocabulary {
  std::vector<std::string> names;
  std::vector<SharedAtom> shared;  // by timepoint, fluents before events, in the first's order
  std::vector<std::string> only_first, only_second;  // names, sorted
  std::size_t fluents = 0, events = 0;               // that both have
  bool is_same() const { return only_first.empty() && only_second.empty(); }
};

/// Both models have the horizon `n` or a later one. Log-linear in names, linear in atoms.
SharedVocabulary shared_vocabulary(const CompiledModel& first, const CompiledModel& second,
                                   Timepoint n);

/// Names, by side, exchanged.
SharedVocabulary exchanged(const SharedVocabulary& vocabulary);

/// The model with the horizon `n`, at most its own: later clauses and timepoints are left out.
/// Sections, which describe how a file is written, are not kept.
CompiledModel truncated(const CompiledModel& model, Timepoint n);

}  // namespace parallax::runtime
