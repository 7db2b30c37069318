// The test of a grasp from above, decided for boxes of starts: the hand goes straight down to a
// body and up again.
//
// Everything is seen from the body as it is believed to lie, with bounds on the error of sight.
// The hand may be turned either of two ways round, which depends on the base's heading. A pair
// of a part and an obstacle is clear if their heights never meet or some axis shows a gap for
// the whole box (axis_views.cc). Refused: each way round that is possible meets something, at a
// height that is tried, along all axes. Linear in the open pairs.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "harness/geometry_proof/axis_views.h"
#include "harness/geometry_proof/hand_shapes.h"

namespace parallax::harness {
namespace {

constexpr double kWayInfluence = 0.02;  // [m/rad]
constexpr double kSeenInfluence = 0.5;

/// `PickUp::check_last_stretch` of a grasp from above: the hand, which hangs over where the body is
/// believed to be, straight down to it and up again. All in the frame of the believed body; only
/// which of two ways round the hand is turned depends on the base.
class HandCheck final : public GeometricCheck {
 public:
  HandCheck(const ProofScene& scene, const HandDescent& descent)
      : scene_(scene), descent_(descent) {
    test_ = {"pick-up", "PickUp::check_last_stretch", "harness/robot/mobile_pick_place.cc",
             "manipulation-pose-unreachable: at `",
             "the hand meets nothing on its way straight down to the body and up again"};
    test_.is_at_once = false;
    const auto& pieces = scene.pieces();
    for (std::size_t part = 0; part < descent_.shapes.size(); ++part) {
      for (std::size_t k = 0; k < pieces.size(); ++k) {
        if (!pieces[k].moves_with_robot && pieces[k].body != descent.object) {
          pairs_.push_back({part, k});
        }
      }
    }
  }

  const CheckedTest& test() const override { return test_; }

  std::vector<std::uint32_t> questions() const override {
    std::vector<std::uint32_t> all(pairs_.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint32_t>(i);
    return all;
  }

  Finding examine(std::span<const Bounds1> box,
                  std::span<const std::uint32_t> questions) const override {
    const ProofScene::Base base = scene_.base(box);
    ProofScene::Base believed = scene_.free_body(descent_.object, box);
    const SightError seen = descent_.seen(box);
    believed.x += AffineForm::within(0.0, descent_.error_m + seen.level_m);
    believed.y += AffineForm::within(0.0, descent_.error_m + seen.level_m);
    believed.yaw += AffineForm::within(0.0, descent_.error_rad);
    believed.cosine = cosine(believed.yaw);
    believed.sine = sine(believed.yaw);
    const AffineForm wrist = believed.yaw + AffineForm(descent_.wrist_rad) - base.yaw;
    const auto ways = descent_.ways_round(wrist.bounds());
    Finding finding;
    finding.influence.assign(box.size(), 0.0);
    std::array<bool, 2> hit = {!ways[0], !ways[1]};
    OpenRooms rooms(finding);
    for (const std::uint32_t question : questions) {
      const Pair& pair = pairs_[question];
      const UprightBox obstacle = scene_.place(scene_.pieces()[pair.obstacle], box, base);
      bool is_open = false;
      for (std::size_t way = 0; way < 2; ++way) {
        if (!ways[way]) continue;
        HandShape shape = descent_.shapes[pair.part];
        shape.bottom = {shape.bottom.lower - seen.height_m, shape.bottom.upper + seen.height_m};
        shape.top = {shape.top.lower - seen.height_m, shape.top.upper + seen.height_m};
        const UprightBox part = scene_.place(shape.turned[way], box, believed);
        const auto room = room_for(shape, part, obstacle);
        if (!room) continue;
        is_open = true;
        hit[way] = hit[way] || surely_meets(shape, part, obstacle);
        if (rooms.add(*room, true)) finding.culprit = words(pair);
      }
      if (is_open) finding.open.push_back(question);
    }
    if (hit[0] && hit[1]) {
      finding.verdict = BoxVerdict::kRefuted;
      return finding;
    }
    rooms.close();
    // From where the camera sees it decides how high it is taken to lie.
    for (std::size_t i = 0; i < box.size() && seen.height_m > kEngineRoom_m; ++i) {
      if (finding.open.empty()) break;
      finding.influence[i] +=
          kSeenInfluence * (std::abs(base.x.slope(i)) + std::abs(base.y.slope(i)));
    }
    // Which way round it is matters as well.
    for (std::size_t i = 0; i < box.size() && ways[0] && ways[1] && !finding.open.empty(); ++i) {
      finding.influence[i] += kWayInfluence * std::abs(wrist.slope(i));
    }
    return finding;
  }

 private:
  struct Pair {
    std::size_t part, obstacle;
  };

  std::string words(const Pair& pair) const {
    return fmt::format("`{}` would meet `{}`",
                       scene_.layout().bodies[descent_.shapes[pair.part].body].name,
                       scene_.layout().bodies[scene_.pieces()[pair.obstacle].body].name);
  }

  /// None where they are apart on the whole way.
  std::optional<AffineForm> room_for(const HandShape& shape, const UprightBox& part,
                                     const UprightBox& obstacle) const {
    if (shape.bottom.lower > obstacle.top.upper + kEngineRoom_m ||
        shape.top.upper + descent_.rise_m + kEngineRoom_m < obstacle.bottom.lower) {
      return std::nullopt;
    }
    const auto seen = views_of(part, obstacle);
    std::optional<AffineForm> best;
    for (const AxisView& view : seen) {
      for (const double side : {1.0, -1.0}) {
        const AffineForm gap = view.gap(side);
        if (gap.lower() > kEngineRoom_m) return std::nullopt;
        if (!best || gap.center() > best->center()) best = gap;
      }
    }
    return best;
  }

  /// At one of the heights that are tried.
  bool surely_meets(const HandShape& shape, const UprightBox& part,
                    const UprightBox& obstacle) const {
    const bool is_level =
        std::any_of(descent_.heights_m.begin(), descent_.heights_m.end(), [&](double height) {
          return shape.bottom.upper + height < obstacle.top.lower - kEngineRoom_m &&
                 obstacle.bottom.upper < shape.top.lower + height - kEngineRoom_m;
        });
    if (!is_level) return false;
    const auto seen = views_of(part, obstacle);
    return std::all_of(seen.begin(), seen.end(), [](const AxisView& view) {
      return view.overlap(0.0).lower() > kEngineRoom_m;
    });
  }

  const ProofScene& scene_;
  HandDescent descent_;
  CheckedTest test_;
  std::vector<Pair> pairs_;
};

}  // namespace

std::unique_ptr<GeometricCheck> make_hand_check(const ProofScene& scene,
                                                const HandDescent& descent) {
  return std::make_unique<HandCheck>(scene, descent);
}

}  // namespace parallax::harness
