// Open outcomes of one event that one chance decides.
//
// A tie says that an outcome of the second rule goes as one of the first, or opposite to it,
// when their variables agree; candidates are all ways to identify variables, the more general
// first. A step in which both outcomes are known and do not agree refutes a candidate. The bits
// that need not be told, because the second outcomes follow from the first, are what a tie
// saves; it has to save more than it takes to name one of the candidates, so that a coincidence
// of few runs ties nothing. The best tie is taken, its outcomes count as told, and the search
// goes on (greedy). If the outcomes that do not follow all went one way, the second opening is
// narrowed to where the first applies.
//
// Cost: candidates times steps times pairs of outcomes, for each tie; candidates are limited to
// 4096.

#include "tools/learn/outcome_ties.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

namespace parallax::tools {

namespace {

constexpr std::size_t kMostTied = 4096;  // candidates for one event; of more the first ones

/// One outcome that a rule leaves open, in one step.
struct OpenOutcome {
  std::size_t atom = 0;
  std::vector<std::size_t> binding;  // of the rule's variables
  bool surely = false;               // the rule's condition is known to hold
  Truth after = Truth::kUnknown;
  bool told = false;  // which way it went is told for an earlier rule, or follows from a tie
};

/// Outcomes of the rule `second` follow from those of `first`. The variables of the tie are the
/// event's arguments, then others; `of_first` and `of_second` map each rule's variables to them.
struct Tie {
  std::size_t first = 0, second = 0;
  std::vector<std::size_t> of_first, of_second;
  std::vector<compiler::SortId> variables;
  bool same = true;
};

class TieSearch {
 public:
  TieSearch(const std::vector<LearnedRule>& openings, const std::vector<std::size_t>& steps,
            const Observations& observations)
      : openings_(openings),
        steps_(steps),
        observations_(observations),
        vocabulary_(observations.vocabulary()) {
    std::vector<std::set<std::size_t>> told(steps.size());
    for (const auto& rule : openings) outcomes_.push_back(outcomes_of(rule, told));
    for (std::size_t second = 0; second < openings.size(); ++second) {
      for (std::size_t first = 0; first <= second; ++first) add_candidates(first, second);
    }
  }

  std::vector<OutcomeTie> find(const std::atomic<bool>& stop) {
    std::vector<OutcomeTie> out;
    std::vector<const Tie*> chosen;
    // The bits that it takes to name one of the candidates.
    const double cost = std::log2(static_cast<double>(candidates_.size() + 1)) + 1;
    std::vector<bool> possible(candidates_.size(), true);
    for (;;) {
      std::optional<std::size_t> best;
      double most = cost;
      for (std::size_t i = 0; i < candidates_.size(); ++i) {
        if (stop.load()) return {};
        if (!possible[i]) continue;
        const auto saved = bits_saved(candidates_[i]);
        possible[i] = saved.has_value();
        if (!saved || *saved <= most) continue;
        most = *saved;
        best = i;
      }
      const auto decided = best ? decided_by(candidates_[*best]) : std::nullopt;
      if (!decided) break;
      possible[*best] = false;
      chosen.push_back(&candidates_[*best]);
      out.push_back({rule_of(*chosen.back(), *decided), chosen.back()->second, std::nullopt});
      for (auto* one : *decided) one->told = true;
    }
    for (std::size_t i = 0; i < out.size(); ++i) {
      if (one_way(out[i].second)) out[i].narrower = narrower(*chosen[i]);
    }
    return out;
  }

 private:
  const Transition& step(std::size_t i) const { return observations_.transitions()[steps_[i]]; }
  std::size_t event_arguments() const {
    return vocabulary_.symbols()[openings_.front().event].sorts.size();
  }

  /// By step.
  std::vector<std::vector<OpenOutcome>> outcomes_of(
      const LearnedRule& rule, std::vector<std::set<std::size_t>>& told) const {
    std::vector<std::vector<OpenOutcome>> out(steps_.size());
    for (std::size_t atom = 0; atom < vocabulary_.atoms().size(); ++atom) {
      if (vocabulary_.atoms()[atom].symbol != rule.fluent) continue;
      for (std::size_t i = 0; i < steps_.size(); ++i) {
        OpenOutcome one;
        const auto& at = step(i);
        if (!rule.bind(at.arguments, vocabulary_.atoms()[atom].arguments, one.binding)) continue;
        const auto fires =
            value_of(rule.units, vocabulary_, observations_.state(at.before), one.binding);
        if (fires == Truth::kFalse) continue;
        one.atom = atom;
        one.surely = fires == Truth::kTrue;
        one.after = observations_.state(at.after)[atom];
        one.told = !told[i].insert(atom).second || one.after == Truth::kUnknown;
        out[i].push_back(std::move(one));
      }
    }
    return out;
  }

  /// The more general ones come first.
  void add_candidates(std::size_t first, std::size_t second) {
    Tie bare;
    bare.first = first;
    bare.second = second;
    bare.variables = vocabulary_.symbols()[openings_.front().event].sorts;
    std::vector<Tie> begun = {std::move(bare)};
    for (const auto side : {&Tie::of_first, &Tie::of_second}) {
      const auto& rule = openings_[side == &Tie::of_first ? first : second];
      for (std::size_t v = 0; v < rule.variables.size(); ++v) {
        std::vector<Tie> next;
        for (const auto& tie : begun) {
          if (v < event_arguments()) {
            next.push_back(tie);
            (next.back().*side).push_back(v);
            continue;
          }
          next.push_back(tie);
          (next.back().*side).push_back(tie.variables.size());
          next.back().variables.push_back(rule.variables[v]);
          for (std::size_t w = 0; w < tie.variables.size(); ++w) {
            if (tie.variables[w] != rule.variables[v]) continue;
            next.push_back(tie);
            (next.back().*side).push_back(w);
          }
        }
        begun = std::move(next);
        if (begun.size() > kMostTied) return;
      }
    }
    for (auto& tie : begun) {
      if (candidates_.size() + 2 > kMostTied) return;
      if (first == second && tie.of_first == tie.of_second) continue;  // each with itself
      candidates_.push_back(tie);
      if (first == second) continue;
      tie.same = false;
      candidates_.push_back(std::move(tie));
    }
  }

  /// The outcomes that follow from the tie and are not told otherwise; none: a step contradicts it.
  std::optional<std::vector<OpenOutcome*>> decided_by(const Tie& tie) {
    std::vector<OpenOutcome*> out;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      const auto& firsts = outcomes_[tie.first][i];
      auto& seconds = outcomes_[tie.second][i];
      for (std::size_t b = 0; b < seconds.size(); ++b) {
        auto& second = seconds[b];
        bool decided = false;
        for (std::size_t a = 0; a < firsts.size(); ++a) {
          const auto& first = firsts[a];
          if (!about(tie, first, second)) continue;
          if (first.atom == second.atom) {
            if (!tie.same) return std::nullopt;
            continue;
          }
          if (first.after == Truth::kUnknown || second.after == Truth::kUnknown) continue;
          if ((first.after == second.after) != tie.same) return std::nullopt;
          const bool sure = first.surely && second.surely;
          decided = decided || (sure && (tie.first != tie.second || a < b));
        }
        if (decided && !second.told) out.push_back(&second);
      }
    }
    return out;
  }

  static bool about(const Tie& tie, const OpenOutcome& first, const OpenOutcome& second) {
    constexpr auto kOpen = static_cast<std::size_t>(-1);
    std::vector<std::size_t> values(tie.variables.size(), kOpen);
    const auto agree = [&](const auto& places, const auto& binding) {
      for (std::size_t v = 0; v < places.size(); ++v) {
        auto& value = values[places[v]];
        if (value != kOpen && value != binding[v]) return false;
        value = binding[v];
      }
      return true;
    };
    return agree(tie.of_first, first.binding) && agree(tie.of_second, second.binding);
  }

  /// The bits saved because outcomes of the second rule that follow need not be described.
  std::optional<double> bits_saved(const Tie& tie) {
    const auto decided = decided_by(tie);
    if (!decided) return std::nullopt;
    const std::set<const OpenOutcome*> follow(decided->begin(), decided->end());
    double held = 0, failed = 0, held_left = 0, failed_left = 0;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      const auto runs = static_cast<double>(step(i).runs.size());
      for (const auto& one : outcomes_[tie.second][i]) {
        if (one.told) continue;
        const bool holds = one.after == Truth::kTrue;
        (holds ? held : failed) += runs;
        if (!follow.contains(&one)) (holds ? held_left : failed_left) += runs;
      }
    }
    return bits_to_tell(held, failed) - bits_to_tell(held_left, failed_left);
  }

  /// Maps a variable of a rule to its place.
  static RuleTerm moved(RuleTerm term, const std::vector<std::size_t>& places) {
    if (term.kind == RuleTerm::Kind::kHead) term.index = places[term.index];
    return term;
  }

  static void add_units(const LearnedRule& from, const std::vector<std::size_t>& places,
                        LearnedRule& to) {
    for (auto unit : from.units) {
      for (auto& literal : unit.literals) {
        for (auto& term : literal.terms) term = moved(term, places);
      }
      const bool there = std::any_of(to.units.begin(), to.units.end(), [&](const auto& other) {
        return other.negated == unit.negated && other.literals == unit.literals &&
               other.own == unit.own;
      });
      if (there) continue;
      to.cost += unit.cost;
      to.units.push_back(std::move(unit));
    }
  }

  /// Did the remaining outcomes of the rule go the same way each time?
  bool one_way(std::size_t rule) const {
    std::set<Truth> ways;
    for (const auto& step : outcomes_[rule]) {
      for (const auto& one : step) {
        if (!one.told) ways.insert(one.after);
      }
    }
    return ways.size() == 1;
  }

  /// None: the first rule's conditions use variables that the second one lacks, or add nothing new.
  std::optional<LearnedRule> narrower(const Tie& tie) const {
    const auto& first = openings_[tie.first];
    auto out = openings_[tie.second];
    std::vector<std::size_t> places;
    for (const auto place : tie.of_first) {
      const auto same = std::find(tie.of_second.begin(), tie.of_second.end(), place);
      places.push_back(static_cast<std::size_t>(same - tie.of_second.begin()));
    }
    for (const auto& unit : first.units) {
      for (const auto& literal : unit.literals) {
        for (const auto& term : literal.terms) {
          if (moved(term, places).kind != RuleTerm::Kind::kHead) continue;
          if (places[term.index] >= tie.of_second.size()) return std::nullopt;
        }
      }
    }
    add_units(first, places, out);
    if (out.units.size() == openings_[tie.second].units.size()) return std::nullopt;
    return out;
  }

  LearnedRule rule_of(const Tie& tie, const std::vector<OpenOutcome*>& decided) const {
    const auto& first = openings_[tie.first];
    const auto& second = openings_[tie.second];
    LearnedRule out;
    out.kind = RuleKind::kTies;
    out.event = first.event;
    out.fluent = first.fluent;
    out.variables = tie.variables;
    for (const auto& term : first.terms) out.terms.push_back(moved(term, tie.of_first));
    out.tied = TiedFluent{second.fluent, {}, tie.same};
    for (const auto& term : second.terms) out.tied->terms.push_back(moved(term, tie.of_second));
    add_units(first, tie.of_first, out);
    add_units(second, tie.of_second, out);
    const std::set<const OpenOutcome*> follow(decided.begin(), decided.end());
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      const auto& here = outcomes_[tie.second][i];
      const bool shows =
          std::any_of(here.begin(), here.end(), [&](auto& one) { return follow.contains(&one); });
      if (!shows) continue;
      for (const auto& run : step(i).runs) {
        auto& runs = out.taught_by;
        if (std::find(runs.begin(), runs.end(), run) == runs.end()) runs.push_back(run);
      }
    }
    return out;
  }

  const std::vector<LearnedRule>& openings_;
  const std::vector<std::size_t>& steps_;
  const Observations& observations_;
  const LearnVocabulary& vocabulary_;
  std::vector<std::vector<std::vector<OpenOutcome>>> outcomes_;  // by rule, then by step
  std::vector<Tie> candidates_;
};

}  // namespace

std::vector<OutcomeTie> find_ties(const std::vector<LearnedRule>& openings,
                                  const std::vector<std::size_t>& steps,
                                  const Observations& observations, const std::atomic<bool>& stop) {
  if (openings.empty()) return {};
  return TieSearch(openings, steps, observations).find(stop);
}

}  // namespace parallax::tools
