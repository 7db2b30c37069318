#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>

#include "tests/support/random_model.h"

namespace parallax::test {

struct DifferentialOptions {
  bool brute_force = true;
  bool clingo = false;
  bool compat = false;            // against the encoder of 2005, and against nothing else
  std::size_t max_traces = 1500;  // beyond, only a part is compared
  std::size_t max_atoms = 18;     // of brute force
};

/// Result of comparing the oracles on one model.
struct Comparison {
  enum class Kind : std::uint8_t {
    kAgree,    // all oracles have the same traces
    kPart,     // too many traces: those found were checked, not all compared
    kRefused,  // parallax rejects the model with `code`, and the oracles confirm the reason
    kLeftOut,  // the rules of the encoder of 2005 give no answer, `code` says why
    kDiffer    // `detail` describes the difference
  };
  Kind kind = Kind::kAgree;
  std::string code;    // kRefused: the errors; kDiffer: which two sides, for shrinking
  std::string detail;  // kDiffer: the first trace that one side lacks
  std::size_t traces = 0;
  std::set<std::size_t> lines;  // kRefused: where the errors stand
  bool brute_force = false;     // had its part in the comparison
  bool clingo = false;
};

/// Compiles the text and compares its traces with those of brute force over all assignments and
/// of clingo; the ways of grounding (`ground_variants`) with each other. With `compat` the old
/// meaning is compared, over all atoms, with what `old_encoder_traces` finds.
Comparison compare_oracles(const std::string& text, const DifferentialOptions& options);

/// The smallest model found, by dropping statements and parts of formulas, on which the same two
/// sides still differ.
RandomModel shrink(RandomModel model, const Comparison& difference,
                   const DifferentialOptions& options);

}  // namespace parallax::test
