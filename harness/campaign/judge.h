#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "harness/campaign/campaign_result.h"
#include "harness/campaign/trace_input.h"
#include "harness/confidence/comparison.h"
#include "harness/region/state_mapping.h"

namespace parallax::harness {

/// The compared fluents at one timepoint, as they were observed.
struct ObservedState {
  std::map<compiler::FluentId, bool> holds;
  bool in_no_state = false;  // one that no state of a model stands for
};

/// When something is observed: fluents may be compared at the start only, or at start and end.
enum class Moment : std::uint8_t { kStart, kOnTheWay, kEnd };
inline Moment moment_at(std::size_t timepoint, std::size_t last) {
  if (timepoint == 0) return Moment::kStart;
  return timepoint == last ? Moment::kEnd : Moment::kOnTheWay;
}

/// One observation as the fluents read it that are compared then.
struct LoopState {
  ObservedState state;
  std::vector<compiler::FluentId> neither;  // what is neither so nor so; not in `state.holds`
  std::vector<std::string> outside;         // bodies in none of their regions: "RobotAt(outside)"
};
LoopState loop_state(const StateMapping& mapping, const ModelFluents& fluents,
                     const State& observation, Moment moment, std::set<std::string>* missing);

/// The comparison of one simulation's observations with the trace, on every fluent with a mapping:
/// at every timepoint, or at the start and the last one where the mapping says so.
struct Judgement {
  std::optional<std::int64_t> first_divergence;  // timepoint
  std::vector<DivergingFluent> first;            // what differs there
  /// The timepoint from which on the first of the fluents that differ at the end differed for good.
  /// None if the last state agrees.
  std::optional<std::int64_t> parted;
  std::vector<DivergingFluent> at_parting;  // those that began to differ there
  std::vector<DivergingFluent> last;        // what differs at the last timepoint
  std::vector<ObservedState> states;        // by timepoint
  std::set<std::string> missing;  // variables that the mapping needs and the observations lack
  /// Where a simulation that does not match left its trace: at once, or for good where only the end
  /// is compared.
  std::int64_t left_at(Comparison comparison) const {
    return comparison == Comparison::kFinal ? *parted : *first_divergence;
  }
  bool matches(Comparison comparison) const {
    return comparison == Comparison::kFinal ? last.empty() : !first_divergence;
  }
};

/// `fluents` of the trace's symbols; `observations` has one state per timepoint of the trace.
Judgement judge(const StateMapping& mapping, const ModelFluents& fluents,
                const CampaignTrace& trace, const std::vector<State>& observations);

/// Why a judged simulation differs from the trace; it has to. What it first differed in where every
/// step is compared, and else where it left the trace for good.
Cause cause_of(const CampaignTrace& trace, const Judgement& judgement, Comparison comparison,
               const std::vector<ActionOutcome>& outcomes);

/// Number of the event behind which a judged simulation, which differs, left its trace; from 0.
std::int64_t event_of(const Judgement& judgement, Comparison comparison);

/// The comparison of each fluent symbol of the model, sorted by symbol.
std::vector<ComparedFluents> compared_fluents(const StateMapping& mapping,
                                              const std::vector<GroundFluent>& fluents,
                                              Comparison comparison);

/// The part of an observation that the compared fluents are read from.
State mapped_part(const StateMapping& mapping, const std::vector<GroundFluent>& fluents,
                  const State& observation);

}  // namespace parallax::harness
