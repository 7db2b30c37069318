#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "compiler/plan/pose_locator.h"

namespace parallax::test {

/// The regions of the kitchen that its plans name by poses [m]: where the robot stands for
/// `region`, cells of counter and table for `place` and `gaze`.
class KitchenLocator final : public compiler::PoseLocator {
 public:
  std::optional<std::string> region_of(std::string_view function,
                                       const compiler::PlanPose& pose) const override {
    const auto within = [](double value, double low, double high) {
      return value >= low && value <= high;
    };
    if (function == "region") {
      if (within(pose.x_m, 0.64, 0.80) && within(pose.y_m, -0.02, 0.14)) return "bWork";
      if (within(pose.x_m, -0.25, 0.05) && within(pose.y_m, 0.43, 0.73)) return "bTable";
      if (within(pose.x_m, -0.30, 0.20) && within(pose.y_m, -1.20, -0.50)) return "bHome";
      return std::nullopt;
    }
    const auto cell = static_cast<int>((pose.y_m - (pose.x_m > 0 ? 0.0 : 0.40)) / 0.15) + 1;
    if (within(pose.x_m, 1.34, 1.58) && within(pose.y_m, 0.0, 0.449)) {
      return "pw" + std::to_string(cell);
    }
    if (within(pose.x_m, -0.95, -0.72) && within(pose.y_m, 0.40, 0.999)) {
      return "pt" + std::to_string(cell);
    }
    return std::nullopt;
  }
  std::optional<Nearest> nearest(std::string_view, const compiler::PlanPose&) const override {
    return std::nullopt;
  }
};

}  // namespace parallax::test
