#include "harness/campaign/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "compiler/base/contract.h"
#include "harness/region/measured.h"

namespace parallax::harness {
namespace {

/// Does the trace put the body of `outside` somewhere? Then that fluent differs already.
bool predicts_inside(const runtime::TracePoint& point, const ModelFluents& fluents,
                     const StateMapping& mapping, const std::string& outside) {
  for (std::size_t i = 0; i < fluents.ground().size(); ++i) {
    if (!runtime::contains(point.holds, fluents.id(i))) continue;
    if (mapping.outside_text(fluents.ground()[i]) == outside) return true;
  }
  return false;
}

/// Does the mapping say that the fluent is compared at rest only: at the start and the end?
bool compared_at_rest(const StateMapping& mapping, const GroundFluent& fluent) {
  const auto* binding = mapping.find(fluent.symbol);
  return binding != nullptr && binding->at_rest_only;
}

bool is_compared(const StateMapping& mapping, const GroundFluent& fluent, Moment moment) {
  const auto* binding = mapping.find(fluent.symbol);
  if (binding == nullptr || moment == Moment::kStart) return true;
  if (binding->at_start_only()) return false;
  return moment == Moment::kEnd || !binding->at_rest_only;
}

bool only_at_rest(const StateMapping& mapping, const ModelFluents& fluents,
                  const std::string& outside) {
  return std::all_of(fluents.ground().begin(), fluents.ground().end(), [&](const auto& fluent) {
    return mapping.outside_text(fluent) != outside || compared_at_rest(mapping, fluent);
  });
}

}  // namespace

LoopState loop_state(const StateMapping& mapping, const ModelFluents& fluents,
                     const State& observation, Moment moment, std::set<std::string>* missing) {
  LoopState seen;
  const bool at_rest = moment != Moment::kOnTheWay;
  for (std::size_t i = 0; i < fluents.ground().size(); ++i) {
    const auto& fluent = fluents.ground()[i];
    if (!is_compared(mapping, fluent, moment)) continue;
    const auto reading = mapping.read(fluent, observation, missing);
    if (!reading) continue;  // ignored on purpose
    if (*reading == Reading::kNeither) {
      seen.neither.push_back(fluents.id(i));
    } else {
      seen.state.holds[fluents.id(i)] = *reading == Reading::kHolds;
    }
  }
  for (auto& text : mapping.outside(fluents.ground(), observation)) {
    if (at_rest || !only_at_rest(mapping, fluents, text)) seen.outside.push_back(std::move(text));
  }
  seen.state.in_no_state = !seen.neither.empty() || !seen.outside.empty();
  return seen;
}

Judgement judge(const StateMapping& mapping, const ModelFluents& fluents,
                const CampaignTrace& trace, const std::vector<State>& observations) {
  PARALLAX_REQUIRE(observations.size() == trace.points.size(), "one observation per timepoint");
  Judgement out;
  std::vector<DivergingFluent> lasting;
  for (std::size_t t = 0; t < observations.size(); ++t) {
    const auto moment = moment_at(t, observations.size() - 1);
    const bool at_rest = moment != Moment::kOnTheWay;
    std::vector<DivergingFluent> differing;
    auto& state = out.states.emplace_back();
    for (std::size_t i = 0; i < fluents.ground().size(); ++i) {
      const auto& fluent = fluents.ground()[i];
      if (!is_compared(mapping, fluent, moment)) continue;
      const auto reading = mapping.read(fluent, observations[t], &out.missing);
      if (!reading) continue;  // ignored on purpose
      const bool predicted = runtime::contains(trace.points[t].holds, fluents.id(i));
      // A reading that is neither true nor false differs from both.
      const bool neither = *reading == Reading::kNeither;
      const bool observed = neither ? !predicted : *reading == Reading::kHolds;
      state.holds[fluents.id(i)] = observed;
      state.in_no_state = state.in_no_state || neither;
      if (observed != predicted) {
        differing.push_back({fluent.text, static_cast<std::int64_t>(t), predicted, observed,
                             measured_text(mapping, fluent, observations[t])});
      }
    }
    for (const auto& text : mapping.outside(fluents.ground(), observations[t])) {
      if (predicts_inside(trace.points[t], fluents, mapping, text)) continue;  // differs above
      if (!at_rest && only_at_rest(mapping, fluents, text)) continue;
      differing.push_back({text, static_cast<std::int64_t>(t), false, true});
      state.in_no_state = true;
    }
    if (!differing.empty() && !out.first_divergence) {
      out.first_divergence = static_cast<std::int64_t>(t);
      out.first = differing;
    }
    // Since when each of them does, without a break.
    std::vector<DivergingFluent> since;
    for (const auto& fluent : differing) {
      const auto before = std::find_if(lasting.begin(), lasting.end(), [&](const auto& known) {
        return known.fluent == fluent.fluent;
      });
      since.push_back(before == lasting.end() ? fluent : *before);
    }
    lasting = std::move(since);
    if (t + 1 == observations.size()) out.last = std::move(differing);
  }
  for (const auto& fluent : lasting) {
    if (!out.parted || fluent.timepoint < *out.parted) out.parted = fluent.timepoint;
  }
  std::copy_if(lasting.begin(), lasting.end(), std::back_inserter(out.at_parting),
               [&](const auto& fluent) { return fluent.timepoint == *out.parted; });
  return out;
}

std::int64_t event_of(const Judgement& judgement, Comparison comparison) {
  return std::max<std::int64_t>(1, judgement.left_at(comparison)) - 1;
}

Cause cause_of(const CampaignTrace& trace, const Judgement& judgement, Comparison comparison,
               const std::vector<ActionOutcome>& outcomes) {
  PARALLAX_REQUIRE(!judgement.matches(comparison), "a simulation that left its trace");
  const bool final = comparison == Comparison::kFinal;
  const auto& differing = final ? judgement.at_parting : judgement.first;
  const auto& fluent = differing.front();
  const std::string changed = fmt::format("{}{}", fluent.observed ? "" : "not ", fluent.fluent);
  Cause cause;
  for (const auto& each : differing) cause.fluents.push_back(each.fluent);
  if (trace.event_count() == 0) {
    cause.text = fmt::format("start: {}", changed);
    return cause;
  }
  const auto step = static_cast<std::size_t>(event_of(judgement, comparison));
  cause.event = trace.event(step);
  if (outcomes[step].status == SimStatus::kOk) {
    cause.text = fmt::format("{}: {}", cause.event, changed);
    return cause;
  }
  const std::string& reason = outcomes[step].reason;
  const std::string condition = reason.empty() ? std::string(to_string(outcomes[step].status))
                                               : reason.substr(0, reason.find(':'));
  cause.text = fmt::format("{}: {}", cause.event, condition);
  cause.reason = reason;
  return cause;
}

std::vector<ComparedFluents> compared_fluents(const StateMapping& mapping,
                                              const std::vector<GroundFluent>& fluents,
                                              Comparison comparison) {
  std::map<std::string, ComparedFluents> out;
  for (const auto& fluent : fluents) {
    const auto* binding = mapping.find(fluent.symbol);
    if (binding == nullptr) continue;
    auto& entry = out[fluent.symbol];
    entry.fluent = fluent.symbol + (fluent.arguments.empty() ? "()" : "(..)");
    if (binding->is_ignored()) {
      entry.how = ComparedFluents::How::kIgnored;
      entry.why = std::get<IgnoredBinding>(binding->condition).why;
    } else if (binding->at_start_only()) {
      entry.how = ComparedFluents::How::kAtTheStart;
    } else if (comparison == Comparison::kFinal || binding->at_rest_only) {
      entry.how = ComparedFluents::How::kAtTheEnd;
    }
  }
  std::vector<ComparedFluents> list;
  for (auto& [symbol, entry] : out) list.push_back(std::move(entry));
  return list;
}

State mapped_part(const StateMapping& mapping, const std::vector<GroundFluent>& fluents,
                  const State& observation) {
  State out;
  for (const auto& fluent : fluents) {
    const auto* binding = mapping.find(fluent.symbol);
    PARALLAX_REQUIRE(binding != nullptr, "the mapping was checked against the model's fluents");
    for (const auto& variable : binding->variables(fluent, mapping.regions())) {
      const auto found = observation.find(variable);
      if (found != observation.end()) out.insert(*found);
    }
  }
  return out;
}

}  // namespace parallax::harness
