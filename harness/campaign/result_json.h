#pragma once

#include <string>

#include "harness/campaign/trace_input.h"
#include "harness/confidence/criterion_spec.h"

namespace parallax::harness {

/// The criterion as one JSON object; journal and report say it in the same words.
std::string criterion_json(const CriterionSpec& criterion);

/// The fluents that hold at a timepoint, sorted: ["BoxIn(r2)", "RobotIn(r1)"].
template <typename Json>
Json holds_json(const CampaignTrace& trace, std::size_t t) {
  Json out = Json::array();
  for (const auto name : trace.holds(t)) out.push_back(std::string(name));
  return out;
}

/// An event and its place in the plan: {"event": "Go(r2)", "source": "fetch.lisp:4"}.
template <typename Json>
Json event_json(const CampaignTrace& trace, std::size_t t) {
  return {{"event", trace.event(t)}, {"source", trace.plan[t].source}};
}

}  // namespace parallax::harness
