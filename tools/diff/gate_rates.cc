#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "harness/confidence/rounding.h"
#include "tools/diff/gate.h"
#include "tools/diff/rate_change.h"

namespace parallax::tools {
namespace {

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
  return hold_rates(*before, *after, rules, input.results);
}

std::vector<RuleResult> hold_rates(const RatesRevision& before, const RatesRevision& after,
                                   const harness::GateRules::Rates& rules, std::size_t results) {
  const auto why_not = not_comparable(before, after);
  std::vector<RuleResult> out;
  const auto add = [&](const char* name, const auto& rule) {
    out.push_back(why_not.empty() ? rule() : RuleResult{name, RuleOutcome::kUndecided, why_not});
  };
  const auto worse = rules.worse.value_or(harness::GateRules::Worse{});
  // The probability that a gate breaks without a change is that of any of its rules.
  const double asked = (rules.worse ? 1.0 : 0.0) + (rules.gained_causes ? 1.0 : 0.0);
  const double tests =
      std::max(1.0, asked) * static_cast<double>(std::max<std::size_t>(1, results));
  const double error = (1.0 - worse.confidence) / tests;
  if (rules.worse) add("rates.worse", [&] { return rate_rule(before, after, worse, error); });
  if (rules.gained_causes) {
    add("rates.gained_causes", [&] { return cause_rule(before, after, error); });
  }
  return out;
}

}  // namespace parallax::tools
