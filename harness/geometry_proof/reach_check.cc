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
    const KnownState& state = scene_.state();
    const AffineForm px(arm_.p_BS.x()), py(arm_.p_BS.y());
    const AffineForm x = base.x + base.cosine * px - base.sine * py;
    const AffineForm y = base.y + base.sine * px + base.cosine * py;
    const double rise = 0.5 * (state.lift_m.lower + state.lift_m.upper);
    const double slack =
        0.5 * (state.lift_m.upper - state.lift_m.lower) + state.relief_m + state.slack.drift_m;
    const AffineForm z =
        AffineForm(scene_.base_z() + arm_.p_BS.z() + rise) + AffineForm::within(0.0, slack);
    Finding finding;
    finding.influence.assign(box.size(), 0.0);
    for (const std::uint32_t question : questions) {
      const KnownPoint& point = points_[question / 2];
      const AffineForm dx = part(point, 0) - x, dy = part(point, 1) - y, dz = part(point, 2) - z;
      const AffineForm square = dx * dx + dy * dy + dz * dz;
      const bool is_far_end = question % 2 == 0;
      const double reach = is_far_end ? arm_.max_reach_m : arm_.min_reach_m;
      const AffineForm margin =
          is_far_end ? AffineForm(reach * reach) - square : square - AffineForm(reach * reach);
      // A length that is off by the room makes so much of its square.
      const double room = 2.0 * reach * kEngineRoom_m;
      if (margin.lower() > room) continue;
      finding.culprit = is_far_end ? "out of reach" : "too near to the shoulder";
      if (margin.upper() < -room) {
        finding.verdict = BoxVerdict::kRefuted;
        return finding;
      }
      finding.open.push_back(question);
      for (std::size_t i = 0; i < box.size(); ++i) {
        finding.influence[i] += std::abs(margin.slope(i));
      }
    }
    if (finding.open.empty()) finding.verdict = BoxVerdict::kSafe;
    return finding;
  }

 private:
  static AffineForm part(const KnownPoint& point, Eigen::Index axis) {
    const double middle = 0.5 * (point.low(axis) + point.high(axis));
    const double radius = std::max(point.high(axis) - middle, middle - point.low(axis));
    return AffineForm::within(middle, radius * (1.0 + 1e-12));
  }

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
