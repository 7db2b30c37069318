#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "harness/confidence/paired_runs.h"
#include "harness/confidence/rate_evidence.h"
#include "harness/confidence/rounding.h"
#include "tools/diff/gate.h"
#include "tools/diff/rates_revision.h"

namespace parallax::tools {
namespace {

using harness::RateCounts;

const RevisionRates* rates_for(const RatesRevision& in, const std::string& events) {
  for (const auto& trace : in.traces) {
    if (trace.events == events) return &trace;
  }
  return nullptr;
}

std::string counts_text(const RateCounts& counts) {
  return fmt::format("{} of {}{}", counts.failures, counts.runs - counts.lost,
                     counts.lost == 0 ? "" : fmt::format(" ({} lost)", counts.lost));
}

std::string change_text(const RateCounts& before, const RateCounts& after) {
  return fmt::format("{} before, {} now", counts_text(before), counts_text(after));
}

/// Were the initial states drawn by the same law from as many? One state is one, however it was
/// chosen; the number that "first" was chosen from may not be known.
bool same_initial(const RevisionInitial& before, const RevisionInitial& after) {
  if (before.is_one_state() && after.is_one_state()) {
    return !before.all || !after.all || before.all == after.all;
  }
  return before.law == after.law && before.all == after.all;
}

/// Why the two cannot be compared; empty: they can.
std::string not_comparable(const RatesRevision& before, const RatesRevision& after) {
  if (before.compare != after.compare) {
    return fmt::format("{} compares `{}` and {} `{}`", before.name, before.compare, after.name,
                       after.compare);
  }
  for (const auto* side : {&before, &after}) {
    // Anytime-valid bounds hold wherever the runs ended.
    if (!side->complete && side->fixed) {
      return fmt::format("{} was stopped before all runs were made", side->name);
    }
    if (side->traces.empty()) return fmt::format("{} has no trace", side->name);
  }
  for (const auto& trace : before.traces) {
    const auto* same = rates_for(after, trace.events);
    if (same == nullptr) {
      return fmt::format("{} has no rate of the trace {}", after.name, trace.events);
    }
    if (same->law != trace.law) {
      const auto law_of = [](const std::string& law) { return law.empty() ? "uniformly" : law; };
      return fmt::format("starts of the trace {} were drawn by other laws ({}, now {})",
                         trace.events, law_of(trace.law), law_of(same->law));
    }
    if (!same_initial(trace.initial, same->initial)) {
      return fmt::format("initial states of the trace {} were drawn otherwise ({}, now {})",
                         trace.events, initial_text(trace.initial), initial_text(same->initial));
    }
  }
  for (const auto& trace : after.traces) {
    if (rates_for(before, trace.events) == nullptr) {
      return fmt::format("{} has no rate of the trace {}", before.name, trace.events);
    }
  }
  return {};
}

/// Has a probability grown?
struct GrowthEvidence {
  bool grew = false;   // with the confidence that was asked for
  double order = 0.0;  // the lower, the surer
  std::string words;
};

/// The error that a rule may spend, and the number of tests that share it.
struct SharedError {
  double error = 0.05;
  std::size_t tests = 1;

  double of_one() const { return error / static_cast<double>(tests); }
};

/// The evidence of an exact test, whose p-value is shown multiplied by the number of tests.
GrowthEvidence exact_evidence(std::string_view test, double chance, const SharedError& shared) {
  const bool grew = chance <= shared.of_one();
  const auto p = harness::p_text(std::min(1.0, chance * static_cast<double>(shared.tests)));
  return {grew, chance,
          fmt::format("{}{}{}", grew ? fmt::format("{}, ", test) : "",
                      shared.tests > 1 ? "adjusted " : "", p)};
}

/// Fisher's exact test; anytime-valid bounds where a number of runs depends on its results.
GrowthEvidence weigh_growth(const RateCounts& before, const RateCounts& after,
                            const SharedError& shared) {
  if (before.fixed && after.fixed) {
    return exact_evidence("Fisher's exact test", harness::fisher_worse(before, after), shared);
  }
  const bool grew = harness::is_surely_worse(before, after, 1.0 - shared.of_one());
  return {grew, grew ? 0.0 : 1.0,
          fmt::format("bounds that hold whenever one looks {}", grew ? "part" : "overlap")};
}

/// One trace before and after.
struct RateChange {
  RateCounts before, after;
  /// Run by run, where both sides list as many runs of one seed and not all starts differ. That
  /// does not depend on how the runs ended.
  std::optional<harness::PairedRuns> pairs;
  std::int64_t equal_starts = 0;
};

RateChange change_of(const RatesRevision& before, const RatesRevision& after,
                     const RevisionRates& old, const RevisionRates& now) {
  RateChange out{old.any, now.any, {}, 0};
  const bool fixed = old.any.fixed && now.any.fixed;
  if (!fixed || before.seed != after.seed || old.runs.size() != now.runs.size()) return out;
  harness::PairedRuns pairs;
  for (std::size_t i = 0; i < old.runs.size(); ++i) {
    pairs.add(old.runs[i].result, now.runs[i].result);
    out.equal_starts += old.runs[i].start == now.runs[i].start ? 1 : 0;
  }
  if (out.equal_starts > 0) out.pairs = pairs;
  return out;
}

/// "20 of 100 before, 25 now; of 100 pairs, 98 with equal starts, 6 fail anew and 1 no longer"
std::string change_text(const RateChange& change) {
  auto out = change_text(change.before, change.after);
  if (!change.pairs) return out;
  using harness::RunResult;
  const auto parted = change.pairs->discordant(RunResult::kFailure, RunResult::kClean);
  out += fmt::format("; of {} pairs, {} with equal starts, {} fail anew and {} no longer",
                     change.pairs->pairs(), change.equal_starts, parted.gained, parted.mended);
  return out;
}

/// McNemar's exact test for pairs, or the tests for two independent counts.
GrowthEvidence weigh_growth(const RateChange& change, const SharedError& shared) {
  if (!change.pairs) return weigh_growth(change.before, change.after, shared);
  return exact_evidence("McNemar's exact test", harness::mcnemar_worse(*change.pairs), shared);
}

/// Judges the change of one trace.
RuleOutcome weigh_change(const RateChange& change, const harness::GateRules::Worse& worse,
                         const SharedError& shared, std::string& words) {
  const double bound = change.pairs ? harness::paired_excess_bound(*change.pairs, worse.confidence)
                                    : excess_bound(change.before, change.after, worse.confidence);
  if (bound < worse.margin) {
    words = fmt::format("{}: worse by less than {}", change_text(change),
                        harness::percent_up(worse.margin));
    return RuleOutcome::kKept;
  }
  const auto evidence = weigh_growth(change, shared);
  words = change_text(change);
  words += evidence.grew ? fmt::format(": worse ({})", evidence.words)
                         : fmt::format(": may be worse by up to {} ({}); more runs would tell",
                                       harness::percent_up(bound), evidence.words);
  return evidence.grew ? RuleOutcome::kBroken : RuleOutcome::kUndecided;
}

RuleResult rate_rule(const RatesRevision& before, const RatesRevision& after,
                     const harness::GateRules::Worse& worse, double error) {
  RuleResult out{"rates.worse", RuleOutcome::kKept, {}};
  // Any of the traces may look worse by chance.
  const SharedError shared{error, before.traces.size()};
  std::size_t broken = 0, open = 0;
  for (const auto& trace : before.traces) {
    std::string words;
    const auto change = change_of(before, after, trace, *rates_for(after, trace.events));
    const auto outcome = weigh_change(change, worse, shared, words);
    broken += outcome == RuleOutcome::kBroken ? 1 : 0;
    open += outcome == RuleOutcome::kUndecided ? 1 : 0;
    if (outcome != RuleOutcome::kKept) {
      out.witness += fmt::format("{}: {}\n", trace.events, words);
    } else if (before.traces.size() == 1) {
      out.words = words;
    }
  }
  if (broken > 0) {
    out.outcome = RuleOutcome::kBroken;
    out.words = fmt::format("{} of {} rates worse with {} confidence", broken, before.traces.size(),
                            harness::level_text(1.0 - error));
  } else if (open > 0) {
    out.outcome = RuleOutcome::kUndecided;
    out.words = fmt::format("{} of {} rates not known to be worse by less than {}", open,
                            before.traces.size(), harness::percent_up(worse.margin));
  } else if (out.words.empty()) {
    out.words = fmt::format("{} rates, none worse by {} or more", before.traces.size(),
                            harness::percent_up(worse.margin));
  }
  return out;
}

std::int64_t times(const RevisionRates& trace, const std::string& cause) {
  for (const auto& one : trace.causes) {
    if (one.text == cause) return one.count;
  }
  return 0;
}

/// Number of causes on either side, over all traces. Given the total counts of both sides, any of
/// them may have come on the newer side alone by chance, also those that did not. So all of these
/// tests share the error, not only the ones of interest afterwards.
std::size_t causes_of_either(const RatesRevision& before, const RatesRevision& after) {
  std::size_t out = 0;
  for (const auto& trace : after.traces) {
    std::set<std::string> seen;
    for (const auto* side : {&trace, rates_for(before, trace.events)}) {
      for (const auto& cause : side->causes) {
        if (cause.count > 0) seen.insert(cause.text);
      }
    }
    out += seen.size();
  }
  return out;
}

/// Causes that only the newer rates have: broken where chance hardly explains that.
RuleResult cause_rule(const RatesRevision& before, const RatesRevision& after, double error) {
  RuleResult out{"rates.gained_causes", RuleOutcome::kKept, "none gained"};
  const SharedError shared{error, causes_of_either(before, after)};
  std::vector<std::pair<double, std::string>> shown;
  bool broken = false;
  for (const auto& trace : after.traces) {
    const auto* old = rates_for(before, trace.events);
    for (const auto& cause : trace.causes) {
      if (cause.count == 0 || times(*old, cause.text) > 0) continue;
      auto none = old->any, some = trace.any;
      none.failures = 0;
      some.failures = cause.count;
      const auto evidence = weigh_growth(none, some, shared);
      broken = broken || evidence.grew;
      shown.emplace_back(evidence.order, fmt::format("{}: {}, {} ({})\n", trace.events, cause.text,
                                                     change_text(none, some), evidence.words));
    }
  }
  if (shown.empty()) return out;
  std::stable_sort(shown.begin(), shown.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [order, text] : shown) out.witness += text;
  out.outcome = broken ? RuleOutcome::kBroken : RuleOutcome::kUndecided;
  out.words = broken ? fmt::format("{} gained, with {} confidence not all by chance", shown.size(),
                                   harness::level_text(1.0 - error))
                     : fmt::format("{} seen that the older runs did not show, which may be chance",
                                   shown.size());
  return out;
}

}  // namespace

base::Result<std::vector<RuleResult>> gate_rates(const GateInput& input,
                                                 const harness::GateRules::Rates& rules,
                                                 Context& context) {
  const auto before = load_rates(input.old_path, context);
  const auto after = load_rates(input.new_path, context);
  if (!before || !after) return context.sink().already_reported();
  return hold_rates(*before, *after, rules);
}

std::vector<RuleResult> hold_rates(const RatesRevision& before, const RatesRevision& after,
                                   const harness::GateRules::Rates& rules) {
  const auto why_not = not_comparable(before, after);
  std::vector<RuleResult> out;
  const auto add = [&](const char* name, const auto& rule) {
    out.push_back(why_not.empty() ? rule() : RuleResult{name, RuleOutcome::kUndecided, why_not});
  };
  const auto worse = rules.worse.value_or(harness::GateRules::Worse{});
  // The probability that a gate breaks without a change is that of any of its rules.
  const double asked = (rules.worse ? 1.0 : 0.0) + (rules.gained_causes ? 1.0 : 0.0);
  const double error = (1.0 - worse.confidence) / std::max(1.0, asked);
  if (rules.worse) add("rates.worse", [&] { return rate_rule(before, after, worse, error); });
  if (rules.gained_causes) {
    add("rates.gained_causes", [&] { return cause_rule(before, after, error); });
  }
  return out;
}

}  // namespace parallax::tools
