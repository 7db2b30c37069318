#include "harness/campaign/start_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "compiler/base/words.h"
#include "harness/confidence/rounding.h"

namespace parallax::harness {

void count_start(std::int64_t state, StartOutcome outcome,
                 const std::function<std::string(std::int64_t)>& text, StartResult& result) {
  if (state == 0) {
    result.tried = 1;
    return;
  }
  const auto [at, is_new] = result.states.try_emplace(state);
  auto& counts = at->second;
  if (is_new) counts.text = text(state);
  const bool was_seen = counts.seen() > 0;
  switch (outcome) {
    case StartOutcome::kLost:
      ++counts.lost;
      break;
    case StartOutcome::kDiscrepancy:
      ++counts.discrepancies;
      break;
    case StartOutcome::kClean:
      ++counts.clean;
      break;
  }
  if (!was_seen && counts.seen() > 0) ++result.tried;
}

void count_start(const StartStates& states, const TrialSample& sample, StartResult& result) {
  auto outcome = StartOutcome::kClean;
  switch (sample.verdict) {
    case SampleVerdict::kLost:
    case SampleVerdict::kLostTooOften:
      outcome = StartOutcome::kLost;
      break;
    case SampleVerdict::kDiscrepancy:
      outcome = StartOutcome::kDiscrepancy;
      break;
    case SampleVerdict::kAsPredicted:
    case SampleVerdict::kAdmitted:
      break;
  }
  const auto text = [&](std::int64_t state) { return states.text(state); };
  const auto state = sample.record.start_state;
  count_start(state, outcome, text, result);
  if (state == 0) return;
  auto& trace = result.states.at(state).trace;
  if (!trace) trace = states.known(state).plan->trace;
}

DrawnStarts drawn_starts(const TraceResult& result, DrawnStarts drawn) {
  const auto& starts = result.starts;
  const auto beyond = std::ssize(starts.unrealisable);
  drawn.initial = {starts.only_first ? Initial::kFirst : starts.law, starts.all, starts.tried,
                   beyond};
  if (drawn.initial.all) *drawn.initial.all -= beyond;
  return drawn;
}

std::string states_text(const StartResult& starts) {
  return starts.all ? std::to_string(*starts.all) : fmt::format("more than {}", kMostInitialStates);
}

std::string in_states_text(const CampaignResult& result) {
  std::int64_t tried = 0;
  std::optional<std::int64_t> all = 0;
  for (const auto& trace : result.traces) {
    if (trace.starts.is_single()) continue;
    tried += trace.starts.tried;
    all = all && trace.starts.all ? std::optional(*all + *trace.starts.all) : std::nullopt;
  }
  if (all && tried >= *all) return {};
  return all ? fmt::format("in {} of {} initial states", tried, *all)
             : fmt::format("in {} initial states of many more", tried);
}

std::string ran_out_text(const StartResult& starts) {
  if (!starts.ran_out) return {};
  const auto found = starts.candidates - starts.refused;
  return fmt::format(
      "drawing initial states ended: {} of {} candidates ({}) led to these events", found,
      starts.candidates,
      percent_about(static_cast<double>(found) / static_cast<double>(starts.candidates)));
}

std::string ran_out_text(const CampaignResult& result) {
  for (const auto& trace : result.traces) {
    if (trace.starts.ran_out) return ran_out_text(trace.starts);
  }
  return {};
}

std::string tried_text(const StartResult& starts) {
  if (starts.is_single()) return {};
  auto text = fmt::format("{} of {} initial states tried", starts.tried, states_text(starts));
  if (starts.law == Initial::kFirst) text += ", by `initial: first`";
  if (starts.visits > 0) {
    text += fmt::format(", {} in {} that {} for no claim", starts.visits,
                        base::agreed(starts.visits, "a run", "runs"),
                        base::agreed(starts.visits, "counts", "count"));
  }
  if (starts.candidates > 0) {
    text += fmt::format("; {} of {} drawn candidates were none", starts.refused, starts.candidates);
  }
  return text;
}

std::vector<std::string> failing_states(const StartResult& starts) {
  constexpr std::size_t kMostShown = 6;
  std::vector<std::string> out;
  std::size_t more = 0;
  for (const auto& [number, counts] : starts.states) {
    if (counts.discrepancies == 0) continue;
    if (out.size() == kMostShown) {
      ++more;
      continue;
    }
    out.push_back(fmt::format("{} of {} from {}", counts.discrepancies,
                              base::counted(counts.seen(), "run", "runs"), counts.text));
  }
  if (more > 0) out.push_back(fmt::format("and in {} more initial states", more));
  return out;
}

void add_start_caveats(const StartResult& starts, std::int64_t counted, std::int64_t most,
                       std::vector<std::string>& caveats) {
  if (starts.is_single()) return;
  if (starts.law == Initial::kFirst) {
    caveats.push_back(fmt::format(
        "only 1 of {} initial states that lead to these events was sampled, as `initial: first` "
        "says",
        states_text(starts)));
    return;
  }
  constexpr std::size_t kMostShown = 3;
  for (std::size_t i = 0; i < starts.unrealisable.size() && i < kMostShown; ++i) {
    caveats.push_back(
        fmt::format("no start realises the initial state with {}", starts.unrealisable[i]));
  }
  if (starts.unrealisable.size() > kMostShown) {
    caveats.push_back(fmt::format("no start realises {} more initial states",
                                  starts.unrealisable.size() - kMostShown));
  }
  if (starts.all) {
    const auto left = *starts.all - starts.tried - std::ssize(starts.unrealisable);
    if (left > 0 && left > most - counted) {
      caveats.push_back(
          fmt::format("{} of {} initial states were not tried; --max-runs {} tries "
                      "each",
                      left, *starts.all, counted + left));
    } else if (left > 0) {
      caveats.push_back(fmt::format("{} of {} initial states were not tried", left, *starts.all));
    }
    return;
  }
  if (starts.only_first) {
    caveats.push_back(fmt::format(
        "there are {} initial states, and none could be drawn: only the first was sampled",
        states_text(starts)));
  } else if (starts.ran_out) {
    caveats.push_back(ran_out_text(starts));
  } else {
    caveats.push_back(
        fmt::format("there are {} initial states, too many to try each: {} were drawn",
                    states_text(starts), starts.tried));
  }
}

}  // namespace parallax::harness
