#include "harness/world/world_spec.h"

#include <algorithm>

namespace parallax::harness {

bool BodySpec::can_set(std::string_view item) const {
  return std::find(settable.begin(), settable.end(), item) != settable.end();
}

std::vector<GripperSpec> grippers(const WorldSpec& spec) {
  std::vector<GripperSpec> all;
  if (spec.mobile) {
    for (const ArmSpec& arm : spec.mobile->arms) {
      all.push_back({arm.near_pad_body, arm.far_pad_body});
    }
  } else if (!spec.robot.near_pad_body.empty()) {
    all.push_back({spec.robot.near_pad_body, spec.robot.far_pad_body});
  }
  return all;
}

std::string base_body(const WorldSpec& spec) {
  return spec.mobile ? spec.mobile->base_body : spec.robot.base_body;
}

}  // namespace parallax::harness
