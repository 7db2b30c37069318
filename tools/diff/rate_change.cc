// Has the rate of a trace grown? By pairs of runs where both sides began them alike, else by two
// counts.

#include "tools/diff/rate_change.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "harness/confidence/rounding.h"

namespace parallax::tools {

using harness::RateCounts;

const RevisionRates* rates_for(const RatesRevision& in, const std::string& events) {
  for (const auto& trace : in.traces) {
    if (trace.events == events) return &trace;
  }
  return nullptr;
}

std::int64_t times(const RevisionRates& trace, const std::string& cause) {
  for (const auto& one : trace.causes) {
    if (one.text == cause) return one.count;
  }
  return 0;
}

namespace {

std::string counts_text(const RateCounts& counts) {
  return fmt::format("{} of {}{}", counts.failures, counts.runs - counts.lost,
                     counts.lost == 0 ? "" : fmt::format(" ({} lost)", counts.lost));
}

/// Were the initial states drawn by the same law from as many? One state is one, however it was
/// chosen; the number that "first" was chosen from may not be known.
bool same_initial(const RevisionInitial& before, const RevisionInitial& after) {
  if (before.is_one_state() && after.is_one_state()) {
    return !before.all || !after.all || before.all == after.all;
  }
  return before.law == after.law && before.all == after.all;
}

}  // namespace

std::string change_text(const RateCounts& before, const RateCounts& after) {
  return fmt::format("{} before, {} now", counts_text(before), counts_text(after));
}

namespace {

/// Why counts of the two are of other comparisons, or of runs that begin elsewhere; empty: they are
/// not, as far as the files say.
std::string not_of_the_same(const RatesRevision& before, const RatesRevision& after) {
  if (before.compare != after.compare) {
    return fmt::format("{} compares `{}` and {} `{}`", before.name, before.compare, after.name,
                       after.compare);
  }
  if (before.says_what_it_is_of() != after.says_what_it_is_of()) {
    const auto& silent = before.says_what_it_is_of() ? after : before;
    return fmt::format(
        "{} does not say which fluents it compares and where its runs begin, as files of earlier "
        "versions",
        silent.name);
  }
  if (before.compared != after.compared) {
    return fmt::format("another comparison: {} compares {}; {} compares {}", before.name,
                       before.compared, after.name, after.compared);
  }
  if (before.match != after.match) {
    return fmt::format("another comparison: {} has `match: {}` and {} `match: {}`", before.name,
                       before.match, after.name, after.match);
  }
  if (before.judging_hash != after.judging_hash) {
    return fmt::format(
        "another comparison: regions, mapping or unobserved events of {} are not those of {}",
        after.name, before.name);
  }
  if (before.starts_hash != after.starts_hash) {
    return fmt::format(
        "runs of {} begin elsewhere: regions, mapping, sampling or laws of starts are not those of "
        "{}",
        after.name, before.name);
  }
  return {};
}

}  // namespace

std::string not_comparable(const RatesRevision& before, const RatesRevision& after) {
  if (auto why = not_of_the_same(before, after); !why.empty()) return why;
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
    if (trace.initial.states != same->initial.states) {
      return fmt::format("runs of the trace {} begin in other initial states", trace.events);
    }
  }
  for (const auto& trace : after.traces) {
    if (rates_for(before, trace.events) == nullptr) {
      return fmt::format("{} has no rate of the trace {}", before.name, trace.events);
    }
  }
  return {};
}

namespace {

/// The evidence of an exact test, whose p-value is shown multiplied by the number of tests.
GrowthEvidence exact_evidence(std::string_view test, double chance, const SharedError& shared) {
  const bool grew = chance <= shared.of_one();
  const auto p = harness::p_text(std::min(1.0, chance * static_cast<double>(shared.tests)));
  return {grew, chance,
          fmt::format("{}{}{}", grew ? fmt::format("{}, ", test) : "",
                      shared.tests > 1 ? "adjusted " : "", p)};
}

}  // namespace

GrowthEvidence weigh_growth(const RateCounts& before, const RateCounts& after,
                            const SharedError& shared) {
  if (before.fixed && after.fixed) {
    return exact_evidence("Fisher's exact test", harness::fisher_worse(before, after), shared);
  }
  const bool grew = harness::is_surely_worse(before, after, 1.0 - shared.of_one());
  return {grew, grew ? 0.0 : 1.0,
          fmt::format("bounds that hold whenever one looks {}", grew ? "part" : "overlap")};
}

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

std::string change_text(const RateChange& change) {
  auto out = change_text(change.before, change.after);
  if (!change.pairs) return out;
  using harness::RunResult;
  const auto parted = change.pairs->discordant(RunResult::kFailure, RunResult::kClean);
  out += fmt::format("; of {} pairs, {} with equal starts, {} fail anew and {} no longer",
                     change.pairs->pairs(), change.equal_starts, parted.gained, parted.mended);
  return out;
}

namespace {

/// McNemar's exact test for pairs, or the tests for two independent counts.
GrowthEvidence weigh_growth(const RateChange& change, const SharedError& shared) {
  if (!change.pairs) return weigh_growth(change.before, change.after, shared);
  return exact_evidence("McNemar's exact test", harness::mcnemar_worse(*change.pairs), shared);
}

}  // namespace

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

}  // namespace parallax::tools
