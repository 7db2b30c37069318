// Which initial states make simulations of one trace fail.
//
// Every fluent that holds at the start of some runs and not of others is a candidate, with either
// value; where none tells all runs apart, so is every pair of them. The best is told only if
// Fisher's exact test, one-sided, with its probability multiplied by the number of candidates
// (Bonferroni), is at most kMostChance. Linear in the runs for each candidate.

#include "harness/cause/state_rule.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/base/shown_text.h"
#include "compiler/base/words.h"

namespace parallax::harness {
namespace {

constexpr double kMostChance = 0.01;
constexpr std::size_t kMostPaired = 60;  // candidates, beyond which no pairs are tried

using FluentValue = std::pair<std::string, bool>;

/// The fluents that tell initial states apart: first those that hold, then those that do not.
std::vector<FluentValue> candidate_values(const std::vector<StateRun>& runs) {
  std::set<std::string> all;
  for (const auto& run : runs) all.insert(run.holds.begin(), run.holds.end());
  std::vector<FluentValue> out;
  for (const bool value : {true, false}) {
    for (const auto& fluent : all) {
      const bool varies = std::any_of(runs.begin(), runs.end(), [&](const StateRun& run) {
        return !run.holds.contains(fluent);
      });
      if (varies) out.emplace_back(fluent, value);
    }
  }
  return out;
}

StateRule counted_rule(std::vector<FluentValue> literals, const std::vector<StateRun>& runs) {
  StateRule out;
  out.literals = std::move(literals);
  for (const auto& run : runs) {
    const bool inside =
        std::all_of(out.literals.begin(), out.literals.end(), [&](const FluentValue& literal) {
          return run.holds.contains(literal.first) == literal.second;
        });
    ++(run.failed ? out.failures : out.clean);
    if (inside) ++(run.failed ? out.failures_inside : out.clean_inside);
  }
  return out;
}

/// Share of failures inside less share of clean runs inside. Needs runs of both kinds.
double separation(const StateRule& rule) {
  return static_cast<double>(rule.failures_inside) / static_cast<double>(rule.failures) -
         static_cast<double>(rule.clean_inside) / static_cast<double>(rule.clean);
}

double log_choose(std::int64_t n, std::int64_t k) {
  const auto log_factorial = [](std::int64_t m) {
    return std::lgamma(static_cast<double>(m) + 1.0);
  };
  return log_factorial(n) - log_factorial(k) - log_factorial(n - k);
}

/// Probability that as many of the failures lie inside by chance (hypergeometric).
double chance_of(const StateRule& rule) {
  const auto inside = rule.failures_inside + rule.clean_inside;
  const auto all = rule.failures + rule.clean;
  double sum = 0.0;
  for (auto k = rule.failures_inside; k <= std::min(inside, rule.failures); ++k) {
    if (inside - k > rule.clean) continue;
    sum += std::exp(log_choose(rule.failures, k) + log_choose(rule.clean, inside - k) -
                    log_choose(all, inside));
  }
  return std::min(sum, 1.0);
}

}  // namespace

std::optional<StateRule> state_rule(const std::vector<StateRun>& runs) {
  const auto failed =
      std::count_if(runs.begin(), runs.end(), [](const StateRun& run) { return run.failed; });
  if (failed == 0 || failed == std::ssize(runs)) return std::nullopt;
  std::optional<StateRule> best;
  double tried = 0.0;
  const auto take = [&](std::vector<FluentValue> literals) {
    tried += 1.0;
    auto rule = counted_rule(std::move(literals), runs);
    if (!best || separation(rule) > separation(*best)) best = std::move(rule);
  };
  const auto candidates = candidate_values(runs);
  for (const auto& each : candidates) take({each});
  if (best && !best->is_exact() && candidates.size() <= kMostPaired) {
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      for (std::size_t j = i + 1; j < candidates.size(); ++j) {
        if (candidates[i].first != candidates[j].first) take({candidates[i], candidates[j]});
      }
    }
  }
  if (!best || tried * chance_of(*best) > kMostChance) return std::nullopt;
  return best;
}

std::string state_words(const StateRule& rule) {
  std::vector<std::string> where;
  for (const auto& [fluent, value] : rule.literals) {
    where.push_back(fmt::format("{}`{}`", value ? "" : "not ", base::printable(fluent)));
  }
  const auto inside = rule.failures_inside + rule.clean_inside;
  return fmt::format("It fails where {} at the start: {} of {}, elsewhere {} of {}.",
                     base::listed(where), rule.failures_inside, base::counted(inside, "run"),
                     rule.failures - rule.failures_inside, rule.failures + rule.clean - inside);
}

}  // namespace parallax::harness
