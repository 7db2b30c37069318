#pragma once

// Only .cc files include this header.

#include "harness/campaign/start_law.h"
#include "harness/campaign/start_result.h"

namespace parallax::harness {

/// {"words": [...], "drawn": 90, "refused": 30, "refused_share": 0.25,
///  "conditions": [{"condition": "a < b", "refused": 20}]}
template <typename Json>
Json law_json(const LawResult& law) {
  Json conditions = Json::array();
  for (const auto& [text, refused] : law.conditions) {
    conditions.push_back({{"condition", text}, {"refused", refused}});
  }
  return {{"words", law.words},
          {"drawn", law.drawn},
          {"refused", law.refused},
          {"refused_share", law.refused_share()},
          {"conditions", std::move(conditions)}};
}

/// {"all": 6, "tried": 6, "law": "uniform", "states": [{"state": 1, "holds": "At(a)", "clean": 15,
/// "lost": 0, "discrepancies": 0}]}, states where there are several.
template <typename Json>
Json starts_json(const StartResult& starts) {
  Json out = {{"all", nullptr}, {"tried", starts.tried}, {"law", law_word(starts.law)}};
  if (starts.all) out["all"] = *starts.all;
  if (starts.visits > 0) out["visits"] = starts.visits;
  if (starts.candidates > 0) {
    out["candidates"] = starts.candidates;
    out["refused"] = starts.refused;
    if (starts.ran_out) out["ran_out"] = true;
  }
  if (!starts.unrealisable.empty()) out["unrealisable"] = starts.unrealisable;
  for (const auto& [number, counts] : starts.states) {
    out["states"].push_back({{"state", number},
                             {"holds", counts.text},
                             {"clean", counts.clean},
                             {"lost", counts.lost},
                             {"discrepancies", counts.discrepancies}});
  }
  return out;
}

}  // namespace parallax::harness
