#include "tools/learn/effect_learner.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "tools/learn/rule_search.h"

namespace parallax::tools {

using compiler::SymbolKind;

namespace {

class EffectLearner {
 public:
  EffectLearner(const Observations& observations, const std::set<std::string>& attempted,
                const std::atomic<bool>& stop)
      : observations_(observations),
        vocabulary_(observations.vocabulary()),
        attempted_(attempted),
        stop_(stop) {
    const auto& steps = observations.transitions();
    for (std::size_t i = 0; i < steps.size(); ++i) {
      alike_[{steps[i].before, {steps[i].event, steps[i].arguments}}].push_back(i);
    }
  }

  LearnedEffects learn() {
    const auto& symbols = vocabulary_.symbols();
    for (std::size_t event = 0; event < symbols.size() && !stop_.load(); ++event) {
      if (symbols[event].kind != SymbolKind::kEvent) continue;
      steps_.clear();
      for (std::size_t i = 0; i < observations_.transitions().size(); ++i) {
        if (observations_.transitions()[i].event == event) steps_.push_back(i);
      }
      if (steps_.empty()) continue;
      learn_refusals(event);
      for (std::size_t fluent = 0; fluent < symbols.size() && !stop_.load(); ++fluent) {
        if (symbols[fluent].kind == SymbolKind::kFluent && symbols[fluent].inertial) {
          learn_fluent(event, fluent);
        }
      }
    }
    return std::move(out_);
  }

 private:
  const Transition& step(std::size_t i) const { return observations_.transitions()[i]; }

  std::string event_text(const Transition& at) const {
    std::string out = vocabulary_.symbols()[at.event].name + "(";
    for (std::size_t i = 0; i < at.arguments.size(); ++i) {
      out += (i == 0 ? "" : ",") + vocabulary_.constant(at.arguments[i]);
    }
    return out + ")";
  }

  void learn_refusals(std::size_t event) {
    if (attempted_.contains(vocabulary_.symbols()[event].name)) return;
    RuleProblem problem{RuleKind::kForbids, event, 0, {}, {}};
    for (const auto i : steps_) {
      (step(i).refused ? problem.shown : problem.against).push_back({i, {}});
    }
    if (problem.shown.empty()) return;
    auto answer = find_rules(problem, observations_, stop_);
    if (!answer.unexplained.empty()) return;  // then it happens and changes nothing
    std::erase_if(steps_, [&](auto i) { return step(i).refused; });
    std::move(answer.rules.begin(), answer.rules.end(), std::back_inserter(out_.rules));
  }

  /// Did a step from the same state with the same event end otherwise?
  bool is_open(std::size_t i, std::size_t atom) const {
    const auto& at = step(i);
    const auto here = observations_.state(at.after)[atom];
    const auto& others = alike_.at({at.before, {at.event, at.arguments}});
    return std::any_of(others.begin(), others.end(), [&](auto other) {
      const auto there = observations_.state(step(other).after)[atom];
      return there != here && there != Truth::kUnknown && here != Truth::kUnknown;
    });
  }

  void learn_fluent(std::size_t event, std::size_t fluent) {
    RuleProblem begins{RuleKind::kInitiates, event, fluent, {}, {}};
    RuleProblem ends{RuleKind::kTerminates, event, fluent, {}, {}};
    std::vector<RuleExample> open, plain;
    for (std::size_t k = 0; k < vocabulary_.atoms().size(); ++k) {
      const auto& atom = vocabulary_.atoms()[k];
      if (atom.symbol != fluent) continue;
      for (const auto i : steps_) {
        const RuleExample example{i, atom.arguments};
        if (is_open(i, k)) {
          open.push_back(example);
          begins.against.push_back(example);
          ends.against.push_back(example);
          continue;
        }
        const auto before = observations_.state(step(i).before)[k];
        const auto after = observations_.state(step(i).after)[k];
        if (after == Truth::kUnknown) continue;
        plain.push_back(example);
        const bool holds = after == Truth::kTrue;
        (holds ? ends : begins).against.push_back(example);
        if (before == (holds ? Truth::kFalse : Truth::kTrue)) {
          (holds ? begins : ends).shown.push_back(example);
        }
      }
    }
    const auto first = out_.rules.size();
    for (const auto* problem : {&begins, &ends}) {
      if (problem->shown.empty()) continue;
      auto answer = find_rules(*problem, observations_, stop_);
      std::move(answer.rules.begin(), answer.rules.end(), std::back_inserter(out_.rules));
      open.insert(open.end(), answer.unexplained.begin(), answer.unexplained.end());
    }
    if (open.empty() || stop_.load()) return;
    leave_open(event, fluent, first, open, plain);
  }

  void leave_open(std::size_t event, std::size_t fluent, std::size_t first,
                  const std::vector<RuleExample>& open, const std::vector<RuleExample>& plain) {
    tell_open(fluent, open);
    RuleProblem problem{RuleKind::kReleases, event, fluent, open, {}};
    // At best only what was seen to go both ways; in any case not what other axioms decide.
    for (const auto& example : plain) {
      if (std::find(open.begin(), open.end(), example) == open.end()) {
        problem.against.push_back(example);
      }
    }
    auto answer = find_rules(problem, observations_, stop_);
    std::vector<LearnedRule> found = std::move(answer.rules);
    if (!answer.unexplained.empty()) {
      std::erase_if(problem.against, [&](const auto& example) {
        return std::none_of(out_.rules.begin() + static_cast<std::ptrdiff_t>(first),
                            out_.rules.end(),
                            [&](const auto& rule) { return may_fire(rule, example); });
      });
      problem.shown = std::move(answer.unexplained);
      answer = find_rules(problem, observations_, stop_);
      std::move(answer.rules.begin(), answer.rules.end(), std::back_inserter(found));
    }
    std::move(found.begin(), found.end(), std::back_inserter(out_.rules));
    for (const auto& example : answer.unexplained) {
      const auto& at = step(example.transition);
      out_.unexplained.push_back(fmt::format("what {} does to {} in run {}", event_text(at),
                                             fluent_text(fluent, example), at.runs.front()));
    }
  }

  bool may_fire(const LearnedRule& rule, const RuleExample& example) const {
    std::vector<std::size_t> binding;
    const auto& at = step(example.transition);
    return rule.bind(at.arguments, example.arguments, binding) &&
           value_of(rule.units, vocabulary_, observations_.state(at.before), binding) !=
               Truth::kFalse;
  }

  std::string fluent_text(std::size_t fluent, const RuleExample& example) const {
    return vocabulary_.atoms()[*vocabulary_.atom(fluent, example.arguments)].name;
  }

  /// Once for each event and fluent, with a run of either kind.
  void tell_open(std::size_t fluent, const std::vector<RuleExample>& open) {
    std::map<std::pair<std::string, std::string>, std::map<Truth, std::string>> seen;
    for (const auto& example : open) {
      const auto& at = step(example.transition);
      const auto atom = *vocabulary_.atom(fluent, example.arguments);
      if (!is_open(example.transition, atom)) continue;
      seen[{event_text(at), fluent_text(fluent, example)}].emplace(
          observations_.state(at.after)[atom], at.runs.front());
    }
    for (const auto& [what, runs] : seen) {
      if (runs.size() < 2) continue;
      out_.contradictions.push_back(
          fmt::format("after {} {} holds in run {} and not in run {}, from the same state",
                      what.first, what.second, runs.at(Truth::kTrue), runs.at(Truth::kFalse)));
    }
  }

  const Observations& observations_;
  const LearnVocabulary& vocabulary_;
  const std::set<std::string>& attempted_;
  const std::atomic<bool>& stop_;
  std::vector<std::size_t> steps_;  // of the event at hand
  std::map<std::pair<std::size_t, std::pair<std::size_t, std::vector<std::size_t>>>,
           std::vector<std::size_t>>
      alike_;  // steps by state and event
  LearnedEffects out_;
};

}  // namespace

LearnedEffects learn_effects(const Observations& observations,
                             const std::set<std::string>& attempted,
                             const std::atomic<bool>& stop) {
  return EffectLearner(observations, attempted, stop).learn();
}

}  // namespace parallax::tools
