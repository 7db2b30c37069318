#pragma once

#include <cstddef>
#include <vector>

#include "tools/learn/rule.h"

namespace parallax::tools {

/// Kinds of conditions that are tried; each stage includes the earlier ones.
enum class UnitStage : std::uint8_t {
  kPlain,      // a literal over the head's variables and "there is one", and unlike variables
  kJoined,     // two literals that share a variable of their own
  kConstants,  // literals and equations with constants
  kChained,    // three literals that share variables
};

/// The atom that an axiom is about itself: no condition of it.
struct RuleHead {
  RuleKind kind = RuleKind::kInitiates;
  std::size_t fluent = 0;
  std::vector<compiler::SortId> variables;
  std::vector<RuleTerm> terms;
};

/// Every condition of the stage that holds in the state for these values of the head's variables,
/// cheapest first. Costs grow with the distance from what people write first.
std::vector<RuleUnit> units_that_hold(const RuleHead& head, const LearnVocabulary& vocabulary,
                                      const std::vector<Truth>& state,
                                      const std::vector<std::size_t>& binding, UnitStage stage);

}  // namespace parallax::tools
