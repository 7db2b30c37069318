#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/geometry_proof/known_state.h"

namespace parallax::harness {

/// An assumption that is one number, in metres or radians, by its name in options and certificates.
struct AssumptionField {
  const char* name;  // "drift-rad"
  double ProofAssumptions::*value;
};
std::span<const AssumptionField> assumption_fields();

/// No assumption allows more [m, rad].
inline constexpr double kMostAssumed = 10.0;

/// The one rule for values of assumptions, whether an option or a certificate gives them: a number
/// from 0 to kMostAssumed. Returns what is wrong; empty: nothing.
std::string wrong_assumption(double value);

/// The first fault of the assumptions: a number beyond its range, a range of no slider of the
/// world, of one that is named twice, or one that the slider's stops do not admit at all. Empty:
/// nothing.
std::string wrong_assumptions(const ProofAssumptions& assumptions, const WorldLayout& layout);

/// The assumptions by name, for people: "drift=0.001 (default 0.002)". One text for each value that
/// is not the default, then one for all others.
std::vector<std::string> assumption_lines(const ProofAssumptions& assumptions);

}  // namespace parallax::harness
