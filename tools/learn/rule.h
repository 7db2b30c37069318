#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/learn/observations.h"

namespace parallax::tools {

/// A variable of the rule's head, one of the unit's own, or a constant; of a number also its
/// neighbour, `x+1` or `x-1`.
struct RuleTerm {
  enum class Kind : std::uint8_t { kHead, kOwn, kConstant };
  Kind kind = Kind::kHead;
  std::size_t index = 0;
  int step = 0;
  friend bool operator==(const RuleTerm&, const RuleTerm&) = default;
};

/// An atom at the time of the event, or a comparison of two terms.
struct RuleLiteral {
  bool equation = false;
  bool negated = false;  // of an equation
  bool less = false;     // of an equation: `<` instead of `=`
  std::size_t symbol = 0;
  std::vector<RuleTerm> terms;
  friend bool operator==(const RuleLiteral&, const RuleLiteral&) = default;
};

/// Part of a condition: there are values of the unit's own variables for which all its literals
/// hold; negated: there are none.
struct RuleUnit {
  bool negated = false;
  std::vector<RuleLiteral> literals;
  std::vector<compiler::SortId> own;  // sorts of its variables
  int cost = 0;
};

enum class RuleKind : std::uint8_t { kInitiates, kTerminates, kReleases, kForbids, kAdmits, kTies };

/// An outcome that is the same as another one, or the opposite.
struct TiedFluent {
  std::size_t fluent = 0;
  std::vector<RuleTerm> terms;
  bool same = true;
};

/// `[variables] units -> Initiates(event(x1,..,xn),fluent(terms),time)`, or, of kForbids,
/// `units -> !Happens(event(x1,..,xn),time)`. The head's variables are the event's arguments, then
/// further ones of the fluent. Of kAdmits there is no event: where the units hold, the fluent may
/// be otherwise than a formula about states says. Of kTies: where the event happens and the units
/// hold, the fluent holds afterwards if and only if the tied one does, or does not.
struct LearnedRule {
  RuleKind kind = RuleKind::kInitiates;
  std::size_t event = 0, fluent = 0;
  std::vector<compiler::SortId> variables;
  std::vector<RuleTerm> terms;  // of the fluent
  std::vector<RuleUnit> units;
  int cost = 0;
  bool unless_open = false;            // an effect only where no rule leaves the outcome open
  bool certain = false;                // of kAdmits: it went so each time that anyone saw it
  std::optional<TiedFluent> tied;      // of kTies
  std::vector<std::string> taught_by;  // runs that show the effect
  std::vector<std::string> held_by;    // runs that show that it needs its condition

  /// The values of the head's variables where it is about these arguments; false if it is not.
  bool bind(const std::vector<std::size_t>& event_arguments,
            const std::vector<std::size_t>& fluent_arguments,
            std::vector<std::size_t>& binding) const;
};

/// Does the unit hold in a state, for these values of the head's variables?
Truth value_of(const RuleUnit& unit, const LearnVocabulary& vocabulary,
               const std::vector<Truth>& state, const std::vector<std::size_t>& binding);
/// A state, and values of the head's variables.
struct RuleInstance {
  std::size_t state = 0;
  std::vector<std::size_t> binding;
};
/// The same for many.
std::vector<Truth> values_of(const RuleUnit& unit, const LearnVocabulary& vocabulary,
                             const std::vector<std::vector<Truth>>& states,
                             const std::vector<RuleInstance>& instances);
/// Do all of them?
Truth value_of(const std::vector<RuleUnit>& units, const LearnVocabulary& vocabulary,
               const std::vector<Truth>& state, const std::vector<std::size_t>& binding);

/// Its conditions, of kAdmits: "HoldsAt(Near(item),time) & ({base} HoldsAt(RobotAt(base),time))".
/// `head` names the head's variables, `time` the timepoint. Empty if there are none.
std::string print_condition(const LearnedRule& rule, const LearnVocabulary& vocabulary,
                            const std::vector<std::string>& head, const std::string& time);

/// Bits that tell which way each of them went, without further knowledge.
double bits_to_tell(double held, double failed);

/// As the language writes it, with its period.
std::string print(const LearnedRule& rule, const LearnVocabulary& vocabulary);
/// Two sentences: the fluent stays as it is where no event sets it or leaves it open. By itself a
/// fluent that was released is free until an event sets it.
std::string print_settled(std::size_t fluent, const LearnVocabulary& vocabulary);

}  // namespace parallax::tools
