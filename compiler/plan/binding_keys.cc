#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/plan/plan_binding.h"

namespace parallax::compiler {

std::string normalise_key(std::string_view key) {
  if (key == "target" || key == "pose" || key == "location") return "target";
  if (key == "object" || key == "for") return "object";
  if (key == "arm" || key == "gripper" || key.starts_with("left-") || key.starts_with("right-")) {
    return "arm";
  }
  return std::string(key);
}

std::vector<std::string> PlanBinding::types(PerformKind kind) const {
  std::vector<std::string> out;
  for (const auto& entry : entries) {
    if (entry.kind != kind) continue;
    if (std::find(out.begin(), out.end(), entry.type) == out.end()) out.push_back(entry.type);
  }
  return out;
}

}  // namespace parallax::compiler
