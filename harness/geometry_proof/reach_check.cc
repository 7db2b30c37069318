#include <algorithm>
#include <cmath>
#include <utility>

#include "harness/geometry_proof/geometric_check.h"

namespace parallax::harness {
namespace {

/// `require_reach`: points of the world against the shoulder. A question for each end of the reach
/// and each point.
class ReachCheck final : public GeometricCheck {
 public:
  ReachCheck(const ProofScene& scene, CheckedTest test, std::size_t arm,
             std::vector<KnownPoint> points)
      : scene_(scene),
        test_(std::move(test)),
        arm_(scene.spec().mobile->arms[arm]),
        points_(std::move(points)) {}

  const CheckedTest& test() const override { return test_; }

  std::vector<std::uint32_t> questions() const override {
    std::vector<std::uint32_t> all;
    for (std::size_t i = 0; i < 2 * points_.size(); ++i) {
      all.push_back(static_cast<std::uint32_t>(i));
    }
    return all;
  }

  Finding examine(std::span<const Bounds1> box,
                  std::span<const std::uint32_t> questions) const override {
    const ProofScene::Base base = scene_.base(box);
    const ProofScene::Point shoulder = scene_.on_torso(arm_.p_BS, base);
    Finding finding;
    finding.influence.assign(box.size(), 0.0);
    for (const std::uint32_t question : questions) {
      const KnownPoint& point = points_[question / 2];
      const AffineForm dx = coordinate(point, 0) - shoulder.x;
      const AffineForm dy = coordinate(point, 1) - shoulder.y;
      const AffineForm dz = coordinate(point, 2) - shoulder.z;
      const AffineForm square = dx * dx + dy * dy + dz * dz;
      const bool is_far_end = question % 2 == 0;
      const double reach = is_far_end ? arm_.max_reach_m : arm_.min_reach_m;
      const AffineForm margin =
          is_far_end ? AffineForm(reach * reach) - square : square - AffineForm(reach * reach);
      // The error of a squared length whose root is off by the room.
      const double room = 2.0 * reach * kEngineRoom_m;
      if (!finding.settle(question, margin, room,
                          is_far_end ? "out of reach" : "too near to the shoulder")) {
        return finding;
      }
    }
    if (finding.open.empty()) finding.verdict = BoxVerdict::kSafe;
    return finding;
  }

 private:
  const ProofScene& scene_;
  CheckedTest test_;
  const ArmSpec& arm_;
  std::vector<KnownPoint> points_;
};

}  // namespace

std::unique_ptr<GeometricCheck> make_reach_check(const ProofScene& scene, CheckedTest test,
                                                 std::size_t arm, std::vector<KnownPoint> points) {
  return std::make_unique<ReachCheck>(scene, std::move(test), arm, std::move(points));
}

}  // namespace parallax::harness
