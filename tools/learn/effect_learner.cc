// Learns from all observed steps at once which fluents events begin, end and leave open.
//
// For each event and inertial fluent there are three kinds of rules that compete for the same
// outcomes: openings (chance decides, opening_search.cc), and what the event initiates and
// terminates (rule_search.cc). An account is a set of openings with the effects that explain the
// rest, and its length the bits of the rules and of the outcomes left open; an outcome that
// nothing explains costs much. The shortest account over several prices of openings is taken and
// its openings are narrowed as long as it gets shorter. Outcomes that no rule explains become
// open themselves, and it begins again. Refusals come first; outcomes of one chance are tied at
// the end (outcome_ties.cc).
//
// It ends, since each round opens at least one more example. Cost: that of the searches, some
// for each round.

#include "tools/learn/effect_learner.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "tools/learn/opening_search.h"
#include "tools/learn/outcome_ties.h"
#include "tools/learn/rule_search.h"

namespace parallax::tools {

using compiler::SymbolKind;

namespace {

constexpr double kUnexplained = 60.0;  // bits: what no rule says

/// The condition that keeps an effect from applying where an outcome is open, in the variables of
/// the effect; none if that takes more than one condition.
std::optional<RuleUnit> guard_against(const LearnedRule& opening, const LearnedRule& effect,
                                      std::size_t event_arguments) {
  if (opening.units.size() != 1) return std::nullopt;
  std::map<std::size_t, RuleTerm> terms;  // of the effect, by variable of the opening
  for (std::size_t i = 0; i < opening.terms.size(); ++i) {
    const auto& here = opening.terms[i];
    const auto& there = effect.terms[i];
    const bool own = here.kind == RuleTerm::Kind::kHead && here.index >= event_arguments;
    if (!own && here != there) return std::nullopt;
    if (own && !terms.emplace(here.index, there).second) return std::nullopt;
  }
  auto out = opening.units.front();
  out.negated = !out.negated;
  for (auto& literal : out.literals) {
    for (auto& term : literal.terms) {
      const auto other = terms.find(term.index);
      if (term.kind != RuleTerm::Kind::kHead || other == terms.end()) continue;
      if (term.step != 0 && other->second.kind == RuleTerm::Kind::kConstant) return std::nullopt;
      const auto step = term.step;
      term = other->second;
      term.step = step;
    }
  }
  return out;
}

/// Effects apply where no outcome is left open.
void keep_apart(const std::vector<LearnedRule>& openings, std::size_t event_arguments,
                LearnedRule& effect) {
  for (const auto& opening : openings) {
    const auto guard = guard_against(opening, effect, event_arguments);
    if (!guard) {
      effect.unless_open = true;
      continue;
    }
    const bool there = std::any_of(effect.units.begin(), effect.units.end(), [&](const auto& unit) {
      return unit.negated == guard->negated && unit.literals == guard->literals &&
             unit.own == guard->own;
    });
    if (!there) effect.units.insert(effect.units.begin(), *guard);
  }
}

class EffectLearner {
 public:
  EffectLearner(const Observations& observations, const std::set<std::string>& attempted,
                const std::set<std::string>& from_outcomes, const std::atomic<bool>& stop)
      : observations_(observations),
        vocabulary_(observations.vocabulary()),
        attempted_(attempted),
        from_outcomes_(from_outcomes),
        stop_(stop) {}

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
      std::vector<FluentAccount> fluents;
      for (std::size_t fluent = 0; fluent < symbols.size() && !stop_.load(); ++fluent) {
        if (symbols[fluent].kind == SymbolKind::kFluent && symbols[fluent].inertial) {
          fluents.push_back(learn_fluent(event, fluent));
        }
      }
      learn_ties(fluents);
    }
    for (const auto& rule : out_.rules) {
      const bool told = from_outcomes_.contains(symbols[rule.fluent].name);
      if (rule.kind == RuleKind::kReleases && !told) out_.settled.insert(rule.fluent);
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

  /// The observed result of one event in one state, for one fluent.
  struct Outcome {
    RuleExample example;
    Truth before = Truth::kUnknown;
    Truth after = Truth::kUnknown;
    std::size_t opening = 0;  // place in the problem of openings
  };

  /// Every observed outcome, and the same by state for find_openings.
  std::vector<Outcome> outcomes(std::size_t fluent, OpeningProblem& problem) const {
    std::vector<Outcome> out;
    for (std::size_t k = 0; k < vocabulary_.atoms().size(); ++k) {
      const auto& atom = vocabulary_.atoms()[k];
      if (atom.symbol != fluent) continue;
      std::map<std::pair<std::size_t, std::vector<std::size_t>>, std::size_t> places;
      for (const auto i : steps_) {
        const auto& at = step(i);
        const auto after = observations_.state(at.after)[k];
        if (after == Truth::kUnknown) continue;
        const auto [place, is_new] =
            places.emplace(std::pair(at.before, at.arguments), problem.examples.size());
        if (is_new) {
          problem.examples.push_back({at.before, at.arguments, atom.arguments, 0, 0, false, {}});
        }
        auto& example = problem.examples[place->second];
        (after == Truth::kTrue ? example.held : example.failed) += at.runs.size();
        example.open = example.held > 0 && example.failed > 0;
        example.runs.insert(example.runs.end(), at.runs.begin(), at.runs.end());
        out.push_back(
            {{i, atom.arguments}, observations_.state(at.before)[k], after, place->second});
      }
    }
    return out;
  }

  /// The rules that were found for one event and fluent.
  struct Account {
    std::vector<LearnedRule> openings, effects;
    std::vector<RuleExample> unexplained;
    /// Description length of the rules, and of the outcomes that they leave open.
    double length = 0.0;
  };

  struct FluentAccount {
    OpeningProblem problem;
    std::vector<Outcome> seen;
    Account account;
  };

  Account account(const OpeningProblem& problem, const std::vector<Outcome>& seen,
                  std::vector<LearnedRule> openings) const {
    Account out;
    out.openings = std::move(openings);
    RuleProblem begins{RuleKind::kInitiates, problem.event, problem.fluent, {}, {}};
    RuleProblem ends{RuleKind::kTerminates, problem.event, problem.fluent, {}, {}};
    const bool told = from_outcomes_.contains(vocabulary_.symbols()[problem.fluent].name);
    std::vector<std::optional<std::size_t>> open(problem.examples.size());
    for (const auto& one : seen) {
      const auto rule = std::find_if(out.openings.begin(), out.openings.end(),
                                     [&](auto& each) { return may_fire(each, one.example); });
      if (rule != out.openings.end()) {  // nothing else is said there
        open[one.opening] = static_cast<std::size_t>(rule - out.openings.begin());
        continue;
      }
      const bool holds = one.after == Truth::kTrue;
      (holds ? ends : begins).against.push_back(one.example);
      // A fluent known only from outcomes counts as changed if its value before is unknown.
      const bool changed = one.before == (holds ? Truth::kFalse : Truth::kTrue) ||
                           (told && one.before == Truth::kUnknown);
      if (changed) (holds ? begins : ends).shown.push_back(one.example);
    }
    for (const auto& rule : out.openings) out.length += rule.cost;
    out.length += bits_of(problem, open);
    for (const auto* effect : {&begins, &ends}) {
      if (effect->shown.empty()) continue;
      auto answer = find_rules(*effect, observations_, stop_);
      for (const auto& rule : answer.rules) out.length += rule.cost;
      out.length += kUnexplained * static_cast<double>(answer.unexplained.size());
      std::move(answer.rules.begin(), answer.rules.end(), std::back_inserter(out.effects));
      std::move(answer.unexplained.begin(), answer.unexplained.end(),
                std::back_inserter(out.unexplained));
    }
    const auto arguments = vocabulary_.symbols()[problem.event].sorts.size();
    for (auto& rule : out.effects) keep_apart(out.openings, arguments, rule);
    return out;
  }

  /// The account with the shortest description. It decides how many of the outcomes that went one
  /// way each time are chance as well, and how many other rules explain.
  Account best_account(OpeningProblem& problem, const std::vector<Outcome>& seen) const {
    std::optional<Account> best;
    std::set<std::string> known;
    for (const auto most : kMostOutside) {
      problem.most_outside = most;
      auto openings = find_openings(problem, vocabulary_, observations_.states(), stop_);
      std::string text;
      for (const auto& rule : openings) text += print(rule, vocabulary_);
      if (!known.insert(text).second) continue;
      auto next = account(problem, seen, std::move(openings));
      if (!best || next.length < best->length) best = std::move(next);
      if (text.empty() || stop_.load()) break;  // nothing is open
    }
    return narrowed(problem, seen, *std::move(best));
  }

  /// Tries narrower openings. They were found one after the other, and before the effects: with
  /// both known, a longer condition may shorten the whole description.
  Account narrowed(const OpeningProblem& problem, const std::vector<Outcome>& seen,
                   Account best) const {
    for (bool shorter = true; shorter && !stop_.load();) {
      shorter = false;
      for (std::size_t k = 0; k < best.openings.size() && !shorter; ++k) {
        const auto narrower =
            narrower_openings(problem, best.openings[k], vocabulary_, observations_.states());
        for (const auto& rule : narrower) {
          if (stop_.load()) break;
          auto openings = best.openings;
          openings[k] = rule;
          auto next = account(problem, seen, std::move(openings));
          const bool says_all = next.unexplained.size() <= best.unexplained.size();
          if (!says_all || next.length >= best.length) continue;
          best = std::move(next);
          shorter = true;
          break;
        }
      }
    }
    return best;
  }

  FluentAccount learn_fluent(std::size_t event, std::size_t fluent) {
    OpeningProblem problem{RuleKind::kReleases, event, fluent, {}, 0.0};
    const auto seen = outcomes(fluent, problem);
    tell_open(fluent, seen, problem);
    while (!stop_.load()) {
      auto found = best_account(problem, seen);
      // Outcomes that no rule explains are left open, too.
      bool all = true;
      for (const auto& example : found.unexplained) {
        const auto one = std::find_if(seen.begin(), seen.end(),
                                      [&](const auto& each) { return each.example == example; });
        auto& opening = problem.examples[one->opening];
        if (opening.open) continue;
        opening.open = true;
        all = false;
        out_.contradictions.push_back(fmt::format(
            "what {} does to {} in run {} is said by none of the rules that are looked for",
            event_text(step(example.transition)), fluent_text(fluent, example),
            step(example.transition).runs.front()));
      }
      if (!all) continue;
      return {std::move(problem), seen, std::move(found)};
    }
    return {};
  }

  /// Ties outcomes that one chance decides. Where one outcome follows another, and nothing shows
  /// that more of it is open, it is left open only where the other one is.
  void learn_ties(std::vector<FluentAccount>& fluents) {
    for (bool narrowed = true; narrowed && !stop_.load();) {
      narrowed = false;
      std::vector<LearnedRule> openings;
      std::vector<std::pair<std::size_t, std::size_t>> places;
      for (std::size_t i = 0; i < fluents.size(); ++i) {
        const auto& of_fluent = fluents[i].account.openings;
        for (std::size_t k = 0; k < of_fluent.size(); ++k) places.emplace_back(i, k);
        openings.insert(openings.end(), of_fluent.begin(), of_fluent.end());
      }
      auto ties = find_ties(openings, steps_, observations_, stop_);
      for (auto& tie : ties) {
        if (!tie.narrower || narrowed) continue;
        const auto& [fluent, rule] = places[tie.second];
        auto& [problem, seen, account] = fluents[fluent];
        auto less = account.openings;
        less[rule] = *std::move(tie.narrower);
        auto next = this->account(problem, seen, std::move(less));
        narrowed = next.unexplained.size() <= account.unexplained.size();
        if (narrowed) account = std::move(next);
      }
      if (narrowed) continue;
      for (auto& each : fluents) {
        auto& [openings_of, effects, unexplained, length] = each.account;
        std::move(openings_of.begin(), openings_of.end(), std::back_inserter(out_.rules));
        std::move(effects.begin(), effects.end(), std::back_inserter(out_.rules));
      }
      for (auto& tie : ties) out_.rules.push_back(std::move(tie.rule));
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

  /// Named once for each event and fluent, with a run of either kind.
  void tell_open(std::size_t fluent, const std::vector<Outcome>& seen,
                 const OpeningProblem& problem) {
    std::map<std::pair<std::string, std::string>, std::map<Truth, std::string>> told;
    for (const auto& one : seen) {
      if (!problem.examples[one.opening].open) continue;
      const auto& at = step(one.example.transition);
      told[{event_text(at), fluent_text(fluent, one.example)}].emplace(one.after, at.runs.front());
    }
    for (const auto& [what, runs] : told) {
      out_.contradictions.push_back(
          fmt::format("after {} {} holds in run {} and not in run {}, from the same state",
                      what.first, what.second, runs.at(Truth::kTrue), runs.at(Truth::kFalse)));
    }
  }

  const Observations& observations_;
  const LearnVocabulary& vocabulary_;
  const std::set<std::string>& attempted_;
  const std::set<std::string>& from_outcomes_;
  const std::atomic<bool>& stop_;
  std::vector<std::size_t> steps_;  // of the event at hand
  LearnedEffects out_;
};

}  // namespace

LearnedEffects learn_effects(const Observations& observations,
                             const std::set<std::string>& attempted,
                             const std::set<std::string>& from_outcomes,
                             const std::atomic<bool>& stop) {
  return EffectLearner(observations, attempted, from_outcomes, stop).learn();
}

}  // namespace parallax::tools
