#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "harness/geometry_proof/geometric_check.h"

namespace parallax::harness {
namespace {

/// `look_at`: may the neck turn to the place? Three questions: pan, and both ends of the tilt.
/// Angles are compared by their sines and cosines.
class GazeCheck final : public GeometricCheck {
 public:
  GazeCheck(const ProofScene& scene, const KnownPoint& place)
      : scene_(scene), camera_(scene.spec().mobile->camera), place_(place) {
    test_ = {"look", "Perception::look_at", "harness/robot/perception.cc", "looking-failed",
             "the neck turns and tilts as far as the place asks for"};
  }

  const CheckedTest& test() const override { return test_; }
  std::vector<std::uint32_t> questions() const override { return {0, 1, 2}; }

  Finding examine(std::span<const Bounds1> box,
                  std::span<const std::uint32_t> questions) const override {
    const ProofScene::Base base = scene_.base(box);
    const KnownState& state = scene_.state();
    const AffineForm px(camera_.p_BC.x()), py(camera_.p_BC.y());
    const AffineForm x = part(0) - (base.x + base.cosine * px - base.sine * py);
    const AffineForm y = part(1) - (base.y + base.sine * px + base.cosine * py);
    const double rise = 0.5 * (state.lift_m.lower + state.lift_m.upper);
    const double slack =
        0.5 * (state.lift_m.upper - state.lift_m.lower) + state.relief_m + state.slack.drift_m;
    const AffineForm down = AffineForm(scene_.base_z() + camera_.p_BC.z() + rise) +
                            AffineForm::within(0.0, slack) - part(2);
    const AffineForm level = root(x * x + y * y);
    const AffineForm ahead = base.cosine * x + base.sine * y;
    Finding finding;
    finding.influence.assign(box.size(), 0.0);
    for (const std::uint32_t question : questions) {
      AffineForm margin;
      if (question == 0) {
        // |pan| <= most: the cosine of the pan is at least that of the most.
        const double most = std::min(camera_.max_pan_rad, std::numbers::pi);
        if (camera_.max_pan_rad >= std::numbers::pi) continue;
        margin = ahead - AffineForm(std::cos(most)) * level;
      } else {
        const double limit = question == 1 ? camera_.max_tilt_rad : camera_.min_tilt_rad;
        // The tilt lies within a right angle; limits beyond do not matter.
        const bool is_beyond = std::abs(limit) >= 0.5 * std::numbers::pi;
        if (is_beyond && (question == 1) == (limit > 0.0)) continue;
        const AffineForm ends =
            AffineForm(std::sin(limit)) * level - AffineForm(std::cos(limit)) * down;
        margin = question == 1 ? ends : -ends;
      }
      if (margin.lower() > kEngineRoom_m) continue;
      static constexpr std::array kWords = {"beyond the neck's turn", "below its tilt",
                                            "above its tilt"};
      finding.culprit = kWords[question];
      if (margin.upper() < -kEngineRoom_m) {
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
  AffineForm part(Eigen::Index axis) const {
    const double middle = 0.5 * (place_.low(axis) + place_.high(axis));
    const double radius = std::max(place_.high(axis) - middle, middle - place_.low(axis));
    return AffineForm::within(middle, radius * (1.0 + 1e-12));
  }

  const ProofScene& scene_;
  const CameraSpec& camera_;
  CheckedTest test_;
  KnownPoint place_;
};

}  // namespace

std::unique_ptr<GeometricCheck> make_gaze_check(const ProofScene& scene, const KnownPoint& place) {
  return std::make_unique<GazeCheck>(scene, place);
}

}  // namespace parallax::harness
