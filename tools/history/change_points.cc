// Changes in the history of a suite, with one bound on false alarms over all time.
//
// Outcomes and cases are compared line by line. A rate is compared with the first measurement
// since its last change, by Fisher's exact test of two sides; comparing with the reference and
// not with the line before finds slow changes, too. Each line is a look: look k may spend
// 6/(pi^2 k^2) of the error, whose sum is the whole, shared by the comparisons that the line
// makes (Bonferroni). The share depends on this line and earlier ones alone, so a change that
// was named stays named. Cost: one test for each rate and line.

#include "tools/history/change_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <tuple>

#include "harness/confidence/clean_runs.h"
#include "harness/confidence/rate_evidence.h"
#include "harness/confidence/rounding.h"
#include "harness/confidence/spending.h"

namespace parallax::tools {
namespace {

std::string standing_of(const HistoryCase& one) {
  return one.verdict.empty() ? one.outcome : fmt::format("{} ({})", one.outcome, one.verdict);
}

bool says_something(const HistoryCase& one) {
  return one.outcome != "not finished" && one.outcome != "skipped";
}

/// "world.bodies.box.mass_kg 0.3 -> 3; criterion.runs 90 -> 40; and 3 more"
std::string value_words(const std::vector<std::string>& changes) {
  constexpr std::size_t kShown = 5;
  std::string out;
  for (std::size_t i = 0; i < std::min(changes.size(), kShown); ++i) {
    out += (i > 0 ? "; " : "") + changes[i];
  }
  return changes.size() <= kShown ? out
                                  : out + fmt::format("; and {} more", changes.size() - kShown);
}

/// Names other changes between the two results. `changes`: of the files, by value, where known.
std::string reason_words(const HistoryLine& old_line, const HistoryCase& before,
                         const HistoryLine& new_line, const HistoryCase& after,
                         const std::vector<std::string>& changes) {
  if (before.files.empty() || after.files.empty()) return {};
  if (before.files != after.files) {
    return changes.empty() ? "; files that it reads changed"
                           : "; files that it reads changed: " + value_words(changes);
  }
  const bool program = old_line.program != new_line.program;
  const bool seed = old_line.seed != new_line.seed;
  return fmt::format("; its files are the same{}{}", program ? ", the program is another one" : "",
                     seed ? ", the seed is another one" : "");
}

std::string rate_words(const MeasuredRate& rate) {
  return fmt::format("{} of {} ({})", rate.count, rate.runs,
                     harness::percent_interval(rate.lower, rate.upper));
}

harness::RateCounts counts_of(const MeasuredRate& rate) {
  return {rate.runs + rate.lost, rate.count, rate.lost};
}

double two_sided(const MeasuredRate& before, const MeasuredRate& after) {
  const auto old_counts = counts_of(before), new_counts = counts_of(after);
  return std::min(1.0, 2.0 * std::min(harness::fisher_worse(old_counts, new_counts),
                                      harness::fisher_worse(new_counts, old_counts)));
}

const MeasuredRate* find_rate(const HistoryCase& one, const std::string& of) {
  const auto at = std::find_if(one.rates.begin(), one.rates.end(),
                               [&](const MeasuredRate& rate) { return rate.of == of; });
  return at == one.rates.end() ? nullptr : &*at;
}

/// One case through the lines of its suite.
class CaseHistory {
 public:
  CaseHistory(const History& history, const std::vector<std::size_t>& suite, std::string name)
      : history_(history), suite_(suite), name_(std::move(name)) {}

  void outcomes(std::vector<ChangePoint>& out) const {
    std::optional<std::size_t> last;
    for (std::size_t i = 0; i < suite_.size(); ++i) {
      const auto* now = at(i);
      const bool was_there = i > 0 && at(i - 1) != nullptr;
      if (i > 0 && (now != nullptr) != was_there) {
        out.push_back(
            {ChangePoint::Kind::kCases, i, name_,
             now == nullptr ? "is no case any more" : fmt::format("is new: {}", standing_of(*now)),
             0.0});
      }
      if (now == nullptr || !says_something(*now)) continue;
      if (last && standing_of(*at(*last)) != standing_of(*now)) {
        out.push_back(
            {ChangePoint::Kind::kOutcome, i, name_,
             fmt::format("{}, then {}{}", standing_of(*at(*last)), standing_of(*now),
                         reason_words(line(*last), *at(*last), line(i), *now, between(*last, i))),
             0.0});
      } else if (last && !now->changes.empty()) {
        out.push_back(
            {ChangePoint::Kind::kValues, i, name_,
             fmt::format("{} as before; {}", standing_of(*now), value_words(now->changes)), 0.0});
      }
      last = i;
    }
  }

  /// Everything that was measured of the case, with the first line that has it.
  std::map<std::string, std::size_t> rate_names() const {
    std::map<std::string, std::size_t> out;
    for (std::size_t i = 0; i < suite_.size(); ++i) {
      if (at(i) == nullptr) continue;
      for (const auto& rate : at(i)->rates) out.emplace(rate.of, i);
    }
    return out;
  }

  /// Lines in which it was measured, with a number of runs that an exact test may take.
  std::vector<std::size_t> measured(const std::string& of) const {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < suite_.size(); ++i) {
      const auto rate = at(i) == nullptr ? std::nullopt : measured_rate(*at(i), of);
      if (rate && rate->fixed) out.push_back(i);
    }
    return out;
  }

  /// Adds to each line the comparisons that it makes: of the rates known so far that are measured
  /// both in it and before it. Later lines have no influence, so a change that was named stays
  /// named.
  void count_comparisons(std::vector<std::size_t>& by_line) const {
    for (const auto& [of, known_at] : rate_names()) {
      const auto lines = measured(of);
      for (std::size_t k = 1; k < lines.size(); ++k) {
        if (lines[k] >= known_at) ++by_line[lines[k]];
      }
    }
  }

  /// `factors`: by line, what its p-values are multiplied by.
  void rates(const std::string& of, std::span<const double> factors, double confidence,
             std::vector<ChangePoint>& out) const {
    std::optional<std::size_t> reference;
    for (const auto i : measured(of)) {
      if (!reference) {
        reference = i;
        continue;
      }
      const auto before = *measured_rate(*at(*reference), of), now = *measured_rate(*at(i), of);
      const double p = std::min(1.0, factors[i] * two_sided(before, now));
      if (p > 1.0 - confidence) continue;
      out.push_back({ChangePoint::Kind::kRate, i, name_,
                     fmt::format("{}: {}, then {}{}", of, rate_words(before), rate_words(now),
                                 reason_words(line(*reference), *at(*reference), line(i), *at(i),
                                              between(*reference, i))),
                     p});
      reference = i;
    }
  }

 private:
  const HistoryLine& line(std::size_t i) const { return history_.lines[suite_[i]]; }
  /// The changes by value of the lines behind `first`, up to `last`.
  std::vector<std::string> between(std::size_t first, std::size_t last) const {
    std::vector<std::string> out;
    for (auto i = first + 1; i <= last; ++i) {
      if (at(i) == nullptr) continue;
      for (const auto& change : at(i)->changes) {
        if (std::find(out.begin(), out.end(), change) == out.end()) out.push_back(change);
      }
    }
    return out;
  }
  const HistoryCase* at(std::size_t i) const {
    const auto found = line(i).cases.find(name_);
    return found == line(i).cases.end() ? nullptr : &found->second;
  }

  const History& history_;
  const std::vector<std::size_t>& suite_;
  std::string name_;
};

std::vector<std::string> case_names(const History& history, const std::vector<std::size_t>& suite) {
  std::map<std::string, bool> names;
  for (const auto i : suite) {
    for (const auto& [name, one] : history.lines[i].cases) names.emplace(name, true);
  }
  std::vector<std::string> out;
  for (const auto& [name, is_there] : names) out.push_back(name);
  return out;
}

}  // namespace

std::optional<MeasuredRate> measured_rate(const HistoryCase& one, const std::string& of) {
  if (const auto* rate = find_rate(one, of)) return *rate;
  const auto any = of.substr(0, of.find(": ")) + ": any discrepancy";
  const auto* runs = find_rate(one, any);
  if (runs == nullptr) return std::nullopt;
  auto out = *runs;
  out.of = of;
  out.count = 0;
  out.lower = 0.0;
  out.upper = harness::clopper_pearson_upper(0, runs->runs, 0.5 * (1.0 + runs->confidence));
  return out;
}

Changes find_changes(const History& history, const std::vector<std::size_t>& suite,
                     double confidence) {
  Changes out;
  out.confidence = confidence;
  const auto names = case_names(history, suite);
  std::vector<std::size_t> comparisons(suite.size(), 0);
  for (const auto& name : names) {
    CaseHistory(history, suite, name).count_comparisons(comparisons);
  }
  // The first line compares nothing, so the k-th look is at line k.
  const harness::SpendingRule spending(std::nullopt);
  std::vector<double> factors(suite.size(), 1.0);
  for (std::size_t i = 1; i < suite.size(); ++i) {
    out.comparisons += comparisons[i];
    const auto tests = static_cast<double>(std::max<std::size_t>(1, comparisons[i]));
    factors[i] = tests / spending.share(static_cast<std::int64_t>(i));
  }
  for (const auto& name : names) {
    const CaseHistory one(history, suite, name);
    one.outcomes(out.points);
    for (const auto& [of, known_at] : one.rate_names()) {
      one.rates(of, factors, confidence, out.points);
    }
  }
  std::stable_sort(out.points.begin(), out.points.end(), [](const auto& a, const auto& b) {
    return std::tie(a.line, a.name) < std::tie(b.line, b.name);
  });
  return out;
}

std::vector<std::string> slower_cases(const History& history,
                                      const std::vector<std::size_t>& suite) {
  constexpr double kTimes = 3.0, kLongerS = 1.0;
  std::vector<std::string> out;
  if (suite.size() < 2) return out;
  const auto& before = history.lines[suite[suite.size() - 2]].cases;
  for (const auto& [name, now] : history.lines[suite.back()].cases) {
    const auto at = before.find(name);
    if (at == before.end() || !says_something(now) || !says_something(at->second)) continue;
    const double old_s = at->second.wall_s;
    if (old_s > 0.0 && now.wall_s > kTimes * old_s && now.wall_s > old_s + kLongerS) {
      out.push_back(fmt::format("{} took {:.1f} s, and {:.1f} s before", name, now.wall_s, old_s));
    }
  }
  return out;
}

std::string change_text(const ChangePoint& point, const History& history,
                        const std::vector<std::size_t>& suite) {
  const auto index = suite[point.line];
  const auto& revision = history.lines[index].revision;
  const auto where = revision.empty() ? fmt::format("line {}", history.numbers[index]) : revision;
  auto out = fmt::format("{}: {}: {}", where, point.name, point.words);
  if (point.kind == ChangePoint::Kind::kRate)
    out += fmt::format("; adjusted {}", harness::p_text(point.p_value));
  return out;
}

}  // namespace parallax::tools
