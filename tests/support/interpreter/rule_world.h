#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/interpreter/world.h"

namespace parallax::test {

/// A fluent that must be true or false.
struct RuleLiteral {
  std::string fluent;  // "Lit(t1)"; in a binding "Lit(?o)"
  bool value = true;
};

/// Meaning of a designator, both for the text of a binding table and for the world below.
struct RuleBinding {
  std::string type;   // of an action with (object (an object (name ?o))), if `event` has ?o;
  std::string event;  // "Poke(?o)", "Look(?k)", "Wait()"
  std::vector<RuleLiteral> success;
  int offset = 1;        // 0: judged before the event
  bool returns = false;  // a thing of the kind ?k that fulfils `success` for ?o
  std::string failure_class = "simple-plan-failure";
};

/// When the event happens and the condition holds, the fluent gets the value.
struct Rule {
  std::string event;
  std::vector<RuleLiteral> condition;
  RuleLiteral effect;
};

/// A small world of things, made of rules. Prints itself as model and binding table, and executes
/// itself, so that the two can be compared.
struct RuleModel {
  std::vector<std::pair<std::string, std::string>> things;  // and their kinds
  std::vector<std::string> thing_fluents, plain_fluents;    // symbols
  std::vector<std::string> thing_events, kind_events, plain_events;
  std::vector<Rule> rules;  // no two disagree on a fluent
  std::vector<RuleLiteral> start;
  std::vector<RuleBinding> bindings;
  /// The constraint: these hold, and the event has just happened if one is named.
  std::vector<RuleLiteral> goal;
  std::string goal_event;

  std::vector<std::string> fluents() const;  // ground
  std::string model_text() const;
  std::string binding_text() const;
  std::string constraint_text() const;
};

class RuleWorld final : public World {
 public:
  /// `model` outlives the world.
  explicit RuleWorld(const RuleModel& model);
  std::size_t initial_states() const override { return std::size_t{1} << free_.size(); }
  void reset(std::size_t initial_state) override;
  Outcome perform(const PlanItem& designator) override;
  bool holds(const std::vector<PlanItem>& fluent) const override;
  bool hit() const override;

 private:
  bool all(const std::vector<RuleLiteral>& literals, const std::string& variable,
           const std::string& value) const;

  const RuleModel& model_;
  std::vector<std::string> free_;  // fluents that the start leaves open
  std::map<std::string, bool> state_;
  std::string last_event_;
};

/// "Lit(?o)" with the variable replaced.
std::string substituted(std::string text, const std::string& variable, const std::string& value);

}  // namespace parallax::test
