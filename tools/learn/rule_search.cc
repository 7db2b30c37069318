// Rules for effects that were seen, by covering and branch and bound.
//
// The first example without a rule is a seed. The rule's condition is a conjunction of facts
// that held there, the cheapest that excludes all examples against the rule. The search branches
// on the first example that is not excluded yet: some fact has to exclude it, so only facts that
// do are tried, cheapest first, and a branch ends when its cost reaches the best found. A fact
// that excludes and explains no more than a cheaper one is never tried. One rule that explains
// all is preferred to several, by a price for another rule. Heads and facts come in stages, from
// plain facts to joins, constants and chains; later stages are asked only if the condition is
// still dear. A condition that is not known to hold explains nothing and excludes nothing.
//
// Cost: up to 3 facts, 200,000 steps of a search; sets of examples are bit sets.

#include "tools/learn/rule_search.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "tools/learn/example_set.h"
#include "tools/learn/rule_heads.h"
#include "tools/learn/rule_units.h"

namespace parallax::tools {

namespace {

constexpr int kCheapCondition = 30;                // cheaper than this, no further stage is asked
constexpr std::size_t kMostUnits = 3;              // of one rule
constexpr std::size_t kMostSearchSteps = 200'000;  // of one search
constexpr int kNone = std::numeric_limits<int>::max();

/// Examples in the words of a head.
struct CoveredExamples {
  std::vector<std::size_t> examples;  // places among `shown` or `against`
  std::vector<RuleInstance> values;
};

struct RatedUnit {
  const RuleUnit* unit = nullptr;
  ExampleSet shows, excludes;
};

/// The cheapest conjunction for one head.
class ConditionSearch {
 public:
  ConditionSearch(const std::vector<RatedUnit>& units, std::size_t shown, std::size_t against,
                  std::size_t wanted, int head_cost, int bound)
      : units_(units), wanted_(wanted), best_(bound) {
    descend(ExampleSet(shown, true), ExampleSet(against, true), head_cost);
  }

  int best() const { return best_; }
  const std::optional<std::vector<std::size_t>>& chosen() const { return found_; }

 private:
  void descend(const ExampleSet& shown, const ExampleSet& against, int cost) {
    if (++steps_ > kMostSearchSteps || cost >= best_) return;
    const auto open = against.first();
    if (!open) {
      const int score = cost + (shown.size() < wanted_ ? kAnotherRule : 0);
      if (score >= best_) return;
      best_ = score;
      found_ = chosen_;
      return;
    }
    if (chosen_.size() == kMostUnits) return;
    for (std::size_t i = 0; i < units_.size(); ++i) {
      const auto& unit = units_[i];
      if (cost + unit.unit->cost >= best_) break;  // the others cost no less
      if (!unit.excludes.contains(*open)) continue;
      chosen_.push_back(i);
      descend(shown.both(unit.shows), against.without(unit.excludes), cost + unit.unit->cost);
      chosen_.pop_back();
    }
  }

  const std::vector<RatedUnit>& units_;
  std::size_t wanted_;
  int best_;
  std::size_t steps_ = 0;
  std::vector<std::size_t> chosen_;
  std::optional<std::vector<std::size_t>> found_;
};

class RuleFinder {
 public:
  RuleFinder(const RuleProblem& problem, const Observations& observations,
             const std::atomic<bool>& stop)
      : problem_(problem),
        observations_(observations),
        vocabulary_(observations.vocabulary()),
        stop_(stop),
        open_(problem.shown.size(), true) {}

  RuleAnswer find() {
    RuleAnswer out;
    while (const auto seed = open_.first()) {
      if (stop_.load()) break;
      auto rule = best_rule(*seed);
      ExampleSet explained(problem_.shown.size());
      if (rule) {
        for (std::size_t i = 0; i < problem_.shown.size(); ++i) {
          if (fires(*rule, problem_.shown[i])) explained.insert(i);
        }
      }
      if (!rule || !explained.contains(*seed)) {
        out.unexplained.push_back(problem_.shown[*seed]);
        explained.insert(*seed);
      } else {
        name_runs(*rule);
        out.rules.push_back(*std::move(rule));
      }
      open_ = open_.without(explained);
    }
    return out;
  }

 private:
  const Transition& step(const RuleExample& example) const {
    return observations_.transitions()[example.transition];
  }

  bool fires(const LearnedRule& rule, const RuleExample& example) const {
    std::vector<std::size_t> binding;
    const auto& at = step(example);
    return rule.bind(at.arguments, example.arguments, binding) &&
           value_of(rule.units, vocabulary_, observations_.state(at.before), binding) ==
               Truth::kTrue;
  }

  CoveredExamples instances(const LearnedRule& head, const std::vector<RuleExample>& examples,
                            const ExampleSet* only) const {
    CoveredExamples out;
    RuleInstance instance;
    for (std::size_t i = 0; i < examples.size(); ++i) {
      if (only != nullptr && !only->contains(i)) continue;
      const auto& at = step(examples[i]);
      if (!head.bind(at.arguments, examples[i].arguments, instance.binding)) continue;
      instance.state = at.before;
      out.examples.push_back(i);
      out.values.push_back(instance);
    }
    return out;
  }

  std::optional<LearnedRule> best_rule(std::size_t seed) const {
    std::optional<LearnedRule> best;
    int score = kNone;
    const auto& example = problem_.shown[seed];
    const auto all_heads = rule_heads(problem_.kind, problem_.event, step(example).arguments,
                                      problem_.fluent, example.arguments, vocabulary_);
    for (const auto stage :
         {UnitStage::kPlain, UnitStage::kJoined, UnitStage::kConstants, UnitStage::kChained}) {
      for (const auto& head : all_heads) {
        if (stop_.load()) return best;
        if (head.cost >= score) continue;
        const bool constants = std::any_of(head.terms.begin(), head.terms.end(), [](auto& term) {
          return term.kind == RuleTerm::Kind::kConstant;
        });
        if (constants && stage < UnitStage::kConstants) continue;
        try_head(head, seed, stage, best, score);
      }
      if (best && score <= kRuleCost + kCheapCondition) break;
    }
    return best;
  }

  void try_head(const LearnedRule& head, std::size_t seed, UnitStage stage,
                std::optional<LearnedRule>& best, int& score) const {
    const auto shown = instances(head, problem_.shown, &open_);
    const auto against = instances(head, problem_.against, nullptr);
    const auto at = static_cast<std::size_t>(
        std::find(shown.examples.begin(), shown.examples.end(), seed) - shown.examples.begin());
    const RuleHead about{head.kind, head.fluent, head.variables, head.terms};
    std::vector<RuleUnit> units;
    if (!against.values.empty()) {
      units = units_that_hold(about, vocabulary_, observations_.state(shown.values[at].state),
                              shown.values[at].binding, stage);
    }
    std::vector<RatedUnit> rated;
    for (const auto& unit : units) {
      if (head.cost + unit.cost >= score || stop_.load()) break;
      RatedUnit one{&unit, ExampleSet(shown.values.size()), ExampleSet(against.values.size())};
      const auto denied = values_of(unit, vocabulary_, observations_.states(), against.values);
      for (std::size_t i = 0; i < denied.size(); ++i) {
        if (denied[i] == Truth::kFalse) one.excludes.insert(i);
      }
      if (!one.excludes.first()) continue;
      const auto met = values_of(unit, vocabulary_, observations_.states(), shown.values);
      for (std::size_t i = 0; i < met.size(); ++i) {
        if (met[i] == Truth::kTrue) one.shows.insert(i);
      }
      // Skips a condition that excludes and explains no more examples than a cheaper one.
      const bool needless = std::any_of(rated.begin(), rated.end(), [&](const auto& other) {
        return one.excludes.without(other.excludes).first() == std::nullopt &&
               one.shows.without(other.shows).first() == std::nullopt;
      });
      if (!needless) rated.push_back(std::move(one));
    }
    const ConditionSearch search(rated, shown.values.size(), against.values.size(), open_.size(),
                                 head.cost, score);
    if (!search.chosen()) return;
    score = search.best();
    best = head;
    for (const auto i : *search.chosen()) {
      best->units.push_back(*rated[i].unit);
      best->cost += rated[i].unit->cost;
    }
  }

  /// Names the runs that show the effect, and those that the bare rule would contradict.
  void name_runs(LearnedRule& rule) const {
    const auto collect = [&](const Transition& from, std::vector<std::string>& to) {
      for (const auto& id : from.runs) {
        if (std::find(to.begin(), to.end(), id) == to.end()) to.push_back(id);
      }
    };
    for (const auto& example : problem_.shown) {
      if (fires(rule, example)) collect(step(example), rule.taught_by);
    }
    if (rule.units.empty()) return;
    std::vector<std::size_t> binding;
    for (const auto& example : problem_.against) {
      if (rule.bind(step(example).arguments, example.arguments, binding)) {
        collect(step(example), rule.held_by);
      }
    }
  }

  const RuleProblem& problem_;
  const Observations& observations_;
  const LearnVocabulary& vocabulary_;
  const std::atomic<bool>& stop_;
  ExampleSet open_;  // of `shown`, those that no rule explains yet
};

}  // namespace

RuleAnswer find_rules(const RuleProblem& problem, const Observations& observations,
                      const std::atomic<bool>& stop) {
  return RuleFinder(problem, observations, stop).find();
}

}  // namespace parallax::tools
