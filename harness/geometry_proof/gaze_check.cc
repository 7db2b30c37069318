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
    const ProofScene::Point camera = scene_.on_torso(camera_.p_BC, base);
    const AffineForm x = coordinate(place_, 0) - camera.x;
    const AffineForm y = coordinate(place_, 1) - camera.y;
    const AffineForm down = camera.z - coordinate(place_, 2);
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
      static constexpr std::array kWords = {"beyond the neck's turn", "below its tilt",
                                            "above its tilt"};
      if (!finding.settle(question, margin, kEngineRoom_m, kWords[question])) return finding;
    }
    if (finding.open.empty()) finding.verdict = BoxVerdict::kSafe;
    return finding;
  }

 private:
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
