// What a perform hands to the controller.
#include <fmt/core.h>

#include "compiler/plan/perform_resolver.h"

namespace parallax::compiler {

void PerformResolver::flatten(const std::string& name, ValueId id, PlanArguments& out) const {
  const auto& value = values_[id];
  const auto pose = target(id).pose;
  if (pose) {
    out.emplace(name + ".x", pose->x_m);
    out.emplace(name + ".y", pose->y_m);
    out.emplace(name + ".z", pose->z_m);
    out.emplace(name + ".yaw", yaw_rad(*pose));
    if (const auto sample = values_.key(id, kSolutionKey))
      flatten(name + ".solution", *sample, out);
    return;
  }
  switch (value.kind) {
    case ValueKind::kSymbol:
      out.emplace(name, constants_.find(value.text).value_or(value.text));
      return;
    case ValueKind::kString:
      out.emplace(name, value.text);
      return;
    case ValueKind::kNumber:
      if (value.number.is_integer()) {
        out.emplace(name, value.number.numerator());
      } else {
        out.emplace(name, value.number.value());
      }
      return;
    case ValueKind::kModel:
      out.emplace(name, value.model);
      return;
    case ValueKind::kDesignator:
      for (const auto& [key, item] : value.keys) {
        flatten(key == "name" ? name : fmt::format("{}.{}", name, key), item, out);
      }
      return;
    case ValueKind::kVector:
      out.emplace(name + ".x", value.pose.x_m);
      out.emplace(name + ".y", value.pose.y_m);
      out.emplace(name + ".z", value.pose.z_m);
      return;
    case ValueKind::kCons: {
      std::size_t index = 0;
      for (const auto item : values_.elements(id).value_or(std::vector<ValueId>())) {
        flatten(fmt::format("{}.{}", name, index++), item, out);
      }
      return;
    }
    case ValueKind::kNil:
    case ValueKind::kQuaternion:
    case ValueKind::kPose:
    case ValueKind::kFailure:
    case ValueKind::kCounter:
      return;
  }
}

/// Every key but the type. Of two keys with one role the second keeps its own name.
PlanArguments PerformResolver::arguments(ValueId designator) const {
  PlanArguments out;
  std::vector<std::string> roles;
  for (const auto& [key, value] : values_[designator].keys) {
    if (key == "type") continue;
    auto role = normalise_key(key);
    for (const auto& taken : roles) {
      if (taken == role) role = key;
    }
    roles.push_back(role);
    flatten(role, value, out);
  }
  return out;
}

}  // namespace parallax::compiler
