// Where outcomes are left to chance, by the shortest description of all observations.
//
// An example is a state and an event with how often the fluent was true and false afterwards;
// open ones went both ways. A rule that covers examples costs its length and the bits that tell
// which way they went each time; examples that it leaves out cost what other axioms need for
// them, at most `most_outside`. So a rule is as general as the runs allow, and is replaced by a
// longer condition once enough runs have shown that it covers too much. From an open example
// that no rule covers, facts that held there are joined by a beam search. How much other axioms
// may cost is not known before, so some values are tried, and the whole description decides.
//
// Cost: for each seed, head and length the beam times the facts, each linear in the examples.

#include "tools/learn/opening_search.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "tools/learn/example_set.h"
#include "tools/learn/rule_heads.h"
#include "tools/learn/rule_units.h"

namespace parallax::tools {

namespace {

constexpr double kGoodCondition = 30.0;         // shorter than this, no further stage is asked
constexpr std::size_t kBeam = 24;               // conditions that are made longer
constexpr std::size_t kMostRuleConditions = 3;  // of one rule
constexpr std::size_t kMostNarrower = 8;        // rules that are proposed instead of one

struct Counts {
  double held = 0, failed = 0;

  double all() const { return held + failed; }
  void add(const OpeningExample& example) {
    held += static_cast<double>(example.held);
    failed += static_cast<double>(example.failed);
  }
  /// Bits that tell which way each example went, without further knowledge.
  double bits() const { return bits_to_tell(held, failed); }
};

Truth fires_at(const LearnedRule& rule, const OpeningExample& example,
               const LearnVocabulary& vocabulary, const std::vector<std::vector<Truth>>& states) {
  std::vector<std::size_t> binding;
  if (!rule.bind(example.event_arguments, example.fluent_arguments, binding)) return Truth::kFalse;
  return value_of(rule.units, vocabulary, states[example.state], binding);
}

/// Names the runs that teach the rule, and those that hold it back.
void tell_runs(const OpeningProblem& problem, const LearnVocabulary& vocabulary,
               const std::vector<std::vector<Truth>>& states, LearnedRule& rule) {
  std::vector<std::size_t> binding;
  rule.taught_by.clear();
  rule.held_by.clear();
  for (const auto& example : problem.examples) {
    if (!rule.bind(example.event_arguments, example.fluent_arguments, binding)) continue;
    const bool here = fires_at(rule, example, vocabulary, states) == Truth::kTrue;
    if (!(here ? example.open : !example.open && !rule.units.empty())) continue;
    auto& runs = here ? rule.taught_by : rule.held_by;
    for (const auto& run : example.runs) {
      if (std::find(runs.begin(), runs.end(), run) == runs.end()) runs.push_back(run);
    }
  }
}

class OpeningFinder {
 public:
  OpeningFinder(const OpeningProblem& problem, const LearnVocabulary& vocabulary,
                const std::vector<std::vector<Truth>>& states, const std::atomic<bool>& stop)
      : problem_(problem), vocabulary_(vocabulary), states_(states), stop_(stop) {}

  std::vector<LearnedRule> find() {
    std::vector<LearnedRule> out;
    std::vector<bool> covered(problem_.examples.size(), false);
    for (std::size_t seed = 0; seed < covered.size(); ++seed) {
      if (!problem_.examples[seed].open || covered[seed]) continue;
      if (stop_.load()) break;
      auto rule = best_rule(seed, covered);
      if (!rule) break;  // stopped
      for (std::size_t i = 0; i < covered.size(); ++i) {
        const auto fires = fires_at(*rule, problem_.examples[i], vocabulary_, states_);
        if (fires == Truth::kTrue) covered[i] = true;
      }
      tell_runs(problem_, vocabulary_, states_, *rule);
      out.push_back(*std::move(rule));
    }
    return out;
  }

 private:
  struct Candidate {
    std::vector<const RuleUnit*> units;
    int cost = 0;
    double score = 0;
    ExampleSet sure, perhaps;  // instances where it holds; where it is not known not to
  };
  struct RatedUnit {
    const RuleUnit* unit = nullptr;
    ExampleSet sure, perhaps;
  };
  struct Best {
    std::optional<LearnedRule> rule;
    double score = std::numeric_limits<double>::infinity();
  };

  std::optional<LearnedRule> best_rule(std::size_t seed, const std::vector<bool>& covered) const {
    Best best;
    const auto& example = problem_.examples[seed];
    const auto heads = rule_heads(problem_.kind, problem_.event, example.event_arguments,
                                  problem_.fluent, example.fluent_arguments, vocabulary_);
    for (const auto stage : {UnitStage::kPlain, UnitStage::kJoined, UnitStage::kConstants}) {
      for (const auto& head : heads) {
        if (stop_.load()) return best.rule;
        if (head.cost < best.score) try_head(head, seed, covered, stage, best);
      }
      if (best.rule && best.score <= kRuleCost + kGoodCondition) break;
    }
    return best.rule;
  }

  void try_head(const LearnedRule& head, std::size_t seed, const std::vector<bool>& covered,
                UnitStage stage, Best& best) const {
    std::vector<const OpeningExample*> examples;
    std::vector<RuleInstance> instances;
    ExampleSet wanted_here(problem_.examples.size());  // open, and no rule covers it yet
    Counts elsewhere;                                  // what is wanted and not in the head's words
    std::size_t own = 0;
    RuleInstance instance;
    for (std::size_t i = 0; i < problem_.examples.size(); ++i) {
      const auto& example = problem_.examples[i];
      const bool open = example.open && !covered[i];
      if (!head.bind(example.event_arguments, example.fluent_arguments, instance.binding)) {
        if (open) elsewhere.add(example);
        continue;
      }
      if (i == seed) own = instances.size();
      if (open) wanted_here.insert(instances.size());
      instance.state = example.state;
      instances.push_back(instance);
      examples.push_back(&example);
    }
    const auto score = [&](int cost, const ExampleSet& sure, const ExampleSet& perhaps) {
      // Open outcomes that are not covered need another rule, whose cost is not known yet.
      Counts inside, outside, left = elsewhere;
      for (std::size_t i = 0; i < instances.size(); ++i) {
        const bool needed = wanted_here.contains(i) && !sure.contains(i);
        if (perhaps.contains(i)) inside.add(*examples[i]);
        if (needed) left.add(*examples[i]);
        if (!needed && !perhaps.contains(i)) outside.add(*examples[i]);
      }
      outside.held += left.held;
      outside.failed += left.failed;
      return cost + inside.bits() +
             std::max(left.bits(), std::min(outside.bits(), problem_.most_outside)) +
             (left.all() > 0 ? kAnotherRule : 0);
    };
    const auto take = [&](const Candidate& candidate) {
      if (candidate.score >= best.score) return;
      best.score = candidate.score;
      best.rule = head;
      best.rule->cost = candidate.cost;
      for (const auto* unit : candidate.units) best.rule->units.push_back(*unit);
    };
    const ExampleSet all(instances.size(), true);
    Candidate bare{{}, head.cost, score(head.cost, all, all), all, all};
    take(bare);
    const RuleHead about{head.kind, head.fluent, head.variables, head.terms};
    const auto units = units_that_hold(about, vocabulary_, states_[instances[own].state],
                                       instances[own].binding, stage);
    std::vector<RatedUnit> rated;
    for (const auto& unit : units) {
      if (head.cost + unit.cost >= best.score || stop_.load()) break;
      RatedUnit one{&unit, ExampleSet(instances.size()), ExampleSet(instances.size())};
      const auto truths = values_of(unit, vocabulary_, states_, instances);
      for (std::size_t i = 0; i < truths.size(); ++i) {
        if (truths[i] == Truth::kTrue) one.sure.insert(i);
        if (truths[i] != Truth::kFalse) one.perhaps.insert(i);
      }
      // Only the first of several units with the same values is kept: it is the shortest.
      const bool known =
          one.perhaps == all || std::any_of(rated.begin(), rated.end(), [&](const auto& other) {
            return other.perhaps == one.perhaps && other.sure == one.sure;
          });
      if (!known) rated.push_back(std::move(one));
    }
    std::vector<Candidate> beam = {std::move(bare)};
    for (std::size_t length = 1; length <= kMostRuleConditions && !beam.empty(); ++length) {
      std::vector<Candidate> longer;
      for (const auto& from : beam) {
        for (const auto& unit : rated) {
          const auto cost = from.cost + unit.unit->cost;
          if (cost >= best.score || stop_.load()) break;
          auto perhaps = from.perhaps.both(unit.perhaps);
          if (perhaps == from.perhaps) continue;
          auto sure = from.sure.both(unit.sure);
          Candidate next{from.units, cost, score(cost, sure, perhaps), std::move(sure),
                         std::move(perhaps)};
          next.units.push_back(unit.unit);
          longer.push_back(std::move(next));
        }
      }
      std::stable_sort(longer.begin(), longer.end(),
                       [](const auto& a, const auto& b) { return a.score < b.score; });
      if (longer.size() > kBeam) longer.erase(longer.begin() + kBeam, longer.end());
      for (const auto& candidate : longer) take(candidate);
      beam = std::move(longer);
    }
  }

  const OpeningProblem& problem_;
  const LearnVocabulary& vocabulary_;
  const std::vector<std::vector<Truth>>& states_;
  const std::atomic<bool>& stop_;
};

}  // namespace

double bits_of(const OpeningProblem& problem,
               const std::vector<std::optional<std::size_t>>& rules) {
  std::map<std::size_t, Counts> counts;
  for (std::size_t i = 0; i < rules.size(); ++i) {
    if (rules[i]) counts[*rules[i]].add(problem.examples[i]);
  }
  double out = 0.0;
  for (const auto& [rule, counted] : counts) out += counted.bits();
  return out;
}

std::vector<LearnedRule> find_openings(const OpeningProblem& problem,
                                       const LearnVocabulary& vocabulary,
                                       const std::vector<std::vector<Truth>>& states,
                                       const std::atomic<bool>& stop) {
  return OpeningFinder(problem, vocabulary, states, stop).find();
}

std::vector<LearnedRule> narrower_openings(const OpeningProblem& problem, const LearnedRule& rule,
                                           const LearnVocabulary& vocabulary,
                                           const std::vector<std::vector<Truth>>& states) {
  const OpeningExample* pattern = nullptr;
  std::vector<const OpeningExample*> open, other;  // that the rule covers
  for (const auto& example : problem.examples) {
    const auto fires = fires_at(rule, example, vocabulary, states);
    if (example.open && fires == Truth::kTrue) open.push_back(&example);
    if (!example.open && fires != Truth::kFalse) other.push_back(&example);
  }
  if (open.empty() || other.empty()) return {};
  pattern = open.front();
  std::vector<std::size_t> binding;
  (void)rule.bind(pattern->event_arguments, pattern->fluent_arguments, binding);
  std::vector<std::pair<std::size_t, LearnedRule>> found;  // runs that are left out
  const auto consider = [&](LearnedRule next) {
    for (const auto* each : open) {
      if (fires_at(next, *each, vocabulary, states) != Truth::kTrue) return;
    }
    std::size_t left_out = 0;
    for (const auto* each : other) {
      if (fires_at(next, *each, vocabulary, states) == Truth::kFalse) {
        left_out += each->held + each->failed;
      }
    }
    if (left_out > 0) found.emplace_back(left_out, std::move(next));
  };
  const RuleHead about{rule.kind, rule.fluent, rule.variables, rule.terms};
  for (const auto& unit :
       units_that_hold(about, vocabulary, states[pattern->state], binding, UnitStage::kConstants)) {
    auto next = rule;
    if (next.units.size() < kMostRuleConditions) {
      next.units.push_back(unit);
      next.cost += unit.cost;
      consider(next);
    }
    if (rule.units.size() != 1) continue;
    next = rule;
    next.cost += unit.cost - next.units.front().cost;
    next.units = {unit};
    consider(std::move(next));
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first > b.first : a.second.cost < b.second.cost;
  });
  if (found.size() > kMostNarrower) {
    found.erase(found.begin() + static_cast<std::ptrdiff_t>(kMostNarrower), found.end());
  }
  std::vector<LearnedRule> out;
  for (auto& [left_out, next] : found) {
    tell_runs(problem, vocabulary, states, next);
    out.push_back(std::move(next));
  }
  return out;
}

std::vector<LearnedRule> shortest_exceptions(OpeningProblem problem,
                                             const LearnVocabulary& vocabulary,
                                             const std::vector<std::vector<Truth>>& states,
                                             const std::atomic<bool>& stop) {
  std::vector<LearnedRule> best;
  std::optional<double> length;
  for (const auto most : kMostOutside) {
    if (stop.load()) break;
    problem.most_outside = most;
    auto rules = find_openings(problem, vocabulary, states, stop);
    std::vector<std::optional<std::size_t>> of_rule(problem.examples.size());
    double here = 0.0;
    for (std::size_t k = 0; k < rules.size(); ++k) {
      here += rules[k].cost;
      for (std::size_t i = 0; i < of_rule.size(); ++i) {
        const auto& example = problem.examples[i];
        std::vector<std::size_t> binding;
        const bool covers =
            !of_rule[i] &&
            rules[k].bind(example.event_arguments, example.fluent_arguments, binding) &&
            value_of(rules[k].units, vocabulary, states[example.state], binding) != Truth::kFalse;
        if (covers) of_rule[i] = k;
      }
    }
    here += bits_of(problem, of_rule);
    if (length && here >= *length) continue;
    length = here;
    best = std::move(rules);
  }
  for (auto& rule : best) {
    rule.certain =
        std::all_of(problem.examples.begin(), problem.examples.end(), [&](const auto& example) {
          return example.open || fires_at(rule, example, vocabulary, states) == Truth::kFalse;
        });
  }
  return best;
}

}  // namespace parallax::tools
