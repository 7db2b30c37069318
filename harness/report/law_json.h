#pragma once

// Only .cc files include this header.

#include "harness/campaign/start_law.h"

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

}  // namespace parallax::harness
