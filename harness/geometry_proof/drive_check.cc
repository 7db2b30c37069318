// The sweep test of a drive, decided for boxes of starts.
//
// For each pair of a part of the robot and an obstacle there are two questions: is the part
// clear on the straight way, and in the turn at the goal? Clear: along one axis the gap between
// the shapes (axis_views.cc) is positive for every start of the box. For a turn, the circle
// round the part is tried first; then the range of headings is halved until each piece is clear,
// or a piece overlaps in the middle of the box. Refused: at a step that the controller tries
// from every start of the box, the shapes overlap along all axes. Else the question is open, and
// the slopes of its gap tell branch_and_bound.cc which variable to halve.
//
// Cost: linear in the open questions; a turn takes at most 2^9 pieces or so.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "harness/geometry_proof/axis_views.h"
#include "harness/geometry_proof/geometric_check.h"
#include "harness/robot/mobile_robot.h"

namespace parallax::harness {
namespace {

constexpr double kTurnInfluence = 0.1;  // [m/rad]

bool apart_in_height(const UprightBox& a, const UprightBox& b) {
  return a.top.upper + kEngineRoom_m < b.bottom.lower ||
         b.top.upper + kEngineRoom_m < a.bottom.lower;
}

bool surely_at_one_height(const UprightBox& a, const UprightBox& b) {
  return a.top.lower - kEngineRoom_m > b.bottom.upper &&
         b.top.lower - kEngineRoom_m > a.bottom.upper;
}

class DriveCheck final : public GeometricCheck {
 public:
  DriveCheck(const ProofScene& scene, const KnownPoint& target, double yaw_rad, double step_m)
      : scene_(scene), yaw_rad_(yaw_rad), step_m_(step_m) {
    const Eigen::Vector3d middle = 0.5 * (target.low + target.high);
    const Eigen::Vector3d reach = (target.high - middle).cwiseAbs() * (1.0 + 1e-12);
    target_x_ = AffineForm::within(middle.x(), reach.x());
    target_y_ = AffineForm::within(middle.y(), reach.y());
    test_ = {"drive", "Drive::is_blocked", "harness/robot/mobile_drive.cc",
             "navigation-pose-unreachable",
             "the robot and what it holds, swept along the straight way and turned at the goal, "
             "meet nothing"};
    const auto& pieces = scene.pieces();
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      if (!pieces[i].moves_with_robot) continue;
      pairs_.push_back({i, i});  // and the floor
      for (std::size_t k = 0; k < pieces.size(); ++k) {
        if (!pieces[k].moves_with_robot) pairs_.push_back({i, k});
      }
    }
  }

  const CheckedTest& test() const override { return test_; }

  /// Two questions for each pair: whether the way is clear of it, and whether the turn is.
  std::vector<std::uint32_t> questions() const override {
    std::vector<std::uint32_t> all(2 * pairs_.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint32_t>(i);
    return all;
  }

  Finding examine(std::span<const Bounds1> box,
                  std::span<const std::uint32_t> questions) const override {
    const Motion motion = motion_of(box);
    Finding finding;
    finding.influence.assign(box.size(), 0.0);
    OpenRooms rooms(finding);
    for (const std::uint32_t question : questions) {
      const Pair& pair = pairs_[question / 2];
      const bool is_turn = question % 2 == 1;
      std::optional<AffineForm> room = pair.part == pair.obstacle ? above_floor(box, motion, pair)
                                       : is_turn                  ? room_in_turn(box, motion, pair)
                                                                  : room_on_way(box, motion, pair);
      if (!room) continue;  // clear
      finding.open.push_back(question);
      if (is_turn ? surely_hit_in_turn(box, motion, pair) : surely_hit_on_way(box, motion, pair)) {
        finding.verdict = BoxVerdict::kRefuted;
        finding.culprit = words(pair);
        return finding;
      }
      // Which headings a turn goes through follows from the one that it begins with.
      if (is_turn) *room += AffineForm(kTurnInfluence) * motion.base.yaw;
      if (rooms.add(*room, is_exact(pair))) finding.culprit = words(pair);
    }
    rooms.close();
    return finding;
  }

 private:
  struct Pair {
    std::size_t part, obstacle;  // the same: the floor
  };
  struct Motion {
    ProofScene::Base base;
    AffineForm way_x, way_y;
    int fewest_steps = 1, most_steps = 1;
    bool has_direction = false;  // the way is long enough for its normal to be about a unit vector
    /// The headings between which it turns, and whether the way round is certain.
    Bounds1 start_yaw, turned_yaw;
    bool is_certain_turn = true;
  };

  bool is_exact(const Pair& pair) const {
    return scene_.pieces()[pair.part].is_exact && scene_.pieces()[pair.obstacle].is_exact;
  }

  std::string words(const Pair& pair) const {
    const auto name = [&](std::size_t piece) {
      return scene_.layout().bodies[scene_.pieces()[piece].body].name;
    };
    return fmt::format("`{}` would meet `{}`", name(pair.part),
                       pair.part == pair.obstacle ? "floor" : name(pair.obstacle));
  }

  Motion motion_of(std::span<const Bounds1> box) const {
    Motion motion;
    motion.base = scene_.base(box);
    motion.way_x = target_x_ - motion.base.x;
    motion.way_y = target_y_ - motion.base.y;
    const AffineForm square = motion.way_x * motion.way_x + motion.way_y * motion.way_y;
    const Bounds1 length = root(square).bounds();
    const double middle = std::hypot(motion.way_x.center(), motion.way_y.center());
    motion.has_direction = length.lower > 0.5 * middle && length.upper < 2.0 * middle;
    const double step = step_m_;
    motion.fewest_steps = std::max(1, static_cast<int>(std::ceil(length.lower / step - 1e-9)));
    motion.most_steps = std::max(1, static_cast<int>(std::ceil(length.upper / step + 1e-9)));
    motion.start_yaw = motion.base.yaw.bounds();
    // The turn is the shorter way round; where that is not certain, it may be either.
    constexpr double kTurn = 2.0 * std::numbers::pi;
    double low = yaw_rad_ - motion.start_yaw.upper, high = yaw_rad_ - motion.start_yaw.lower;
    const double shift = std::round(0.5 * (low + high) / kTurn) * kTurn;
    low -= shift, high -= shift;
    constexpr double kClear = std::numbers::pi - 1e-9;
    motion.is_certain_turn = low > -kClear && high < kClear;
    if (motion.is_certain_turn) {
      motion.turned_yaw = {motion.start_yaw.lower + std::min(low, 0.0),
                           motion.start_yaw.upper + std::max(high, 0.0)};
    } else {
      motion.turned_yaw = {yaw_rad_ - kTurn, yaw_rad_ + kTurn};
    }
    return motion;
  }

  /// None where the floor is certainly not met.
  std::optional<AffineForm> above_floor(std::span<const Bounds1> box, const Motion& motion,
                                        const Pair& pair) const {
    const UprightBox part = scene_.place(scene_.pieces()[pair.part], box, motion.base);
    if (part.bottom.lower > kEngineRoom_m) return std::nullopt;
    return AffineForm(part.bottom.lower);
  }

  /// None where the pair is certainly clear along the way; else the form that comes nearest to it.
  std::optional<AffineForm> room_on_way(std::span<const Bounds1> box, const Motion& motion,
                                        const Pair& pair) const {
    const UprightBox part = scene_.place(scene_.pieces()[pair.part], box, motion.base);
    const UprightBox obstacle = scene_.place(scene_.pieces()[pair.obstacle], box, motion.base);
    if (apart_in_height(part, obstacle)) return std::nullopt;
    const auto along = views_on_way(part, obstacle, motion.way_x, motion.way_y);
    std::optional<AffineForm> best;
    for (std::size_t axis = 0; axis < along.size(); ++axis) {
      if (axis == 4 && !motion.has_direction) continue;
      for (const double side : {1.0, -1.0}) {
        AffineForm gap = along[axis].gap(side);
        if (gap.lower() > kEngineRoom_m) return std::nullopt;
        if (!best || gap.center() > best->center()) best = gap;
      }
    }
    return best;
  }

  bool surely_hit_on_way(std::span<const Bounds1> box, const Motion& motion,
                         const Pair& pair) const {
    if (motion.most_steps - motion.fewest_steps > 3) return false;
    const bool is_floor = pair.part == pair.obstacle;
    const ScenePiece& piece = scene_.pieces()[pair.part];
    if (!piece.is_exact || !scene_.pieces()[pair.obstacle].is_exact) return false;
    const UprightBox part = scene_.place(piece, box, motion.base);
    if (is_floor) return part.bottom.upper < -kEngineRoom_m;
    const UprightBox obstacle = scene_.place(scene_.pieces()[pair.obstacle], box, motion.base);
    if (!surely_at_one_height(part, obstacle)) return false;
    const auto along = views_on_way(part, obstacle, motion.way_x, motion.way_y);
    for (int steps = motion.fewest_steps; steps <= motion.most_steps; ++steps) {
      // The step at which they overlap most in the middle of the box.
      int best = 0;
      double most = -1e300;
      for (int i = 0; i <= steps; ++i) {
        double least = 1e300;
        for (std::size_t axis = 0; axis < 4; ++axis) {
          const double there = along[axis].ahead.center() - along[axis].way.center() * i / steps;
          least = std::min(least, along[axis].width.center() - std::abs(there));
        }
        if (least > most) most = least, best = i;
      }
      if (most <= 0.0) return false;
      const double share = static_cast<double>(best) / steps;
      for (std::size_t axis = 0; axis < 4; ++axis) {
        if (!(along[axis].overlap(share).lower() > kEngineRoom_m)) return false;
      }
    }
    return true;
  }

  /// The part as it stands when the base is at the goal with this heading.
  UprightBox at_goal(const ScenePiece& piece, std::span<const Bounds1> box,
                     const AffineForm& yaw) const {
    ProofScene::Base goal{target_x_, target_y_, yaw, cosine(yaw), sine(yaw)};
    return scene_.place(piece, box, goal);
  }

  static std::optional<AffineForm> gap_at_rest(const UprightBox& part, const UprightBox& obstacle,
                                               bool& is_clear) {
    const auto seen = views_of(part, obstacle);
    std::optional<AffineForm> best;
    for (std::size_t axis = 0; axis < 4; ++axis) {
      for (const double side : {1.0, -1.0}) {
        const AffineForm gap = seen[axis].gap(side);
        is_clear = is_clear || gap.lower() > kEngineRoom_m;
        if (!best || gap.center() > best->center()) best = gap;
      }
    }
    return best;
  }

  std::optional<AffineForm> room_in_turn(std::span<const Bounds1> box, const Motion& motion,
                                         const Pair& pair) const {
    ScenePiece piece = scene_.pieces()[pair.part];
    if (piece.carrier == ScenePiece::Carrier::kHand) {  // turns along: a square round its circle
      piece.carrier = ScenePiece::Carrier::kBase;
      piece.middle.setZero();
      piece.half_x = piece.half_y = piece.hand_radius_m;
    }
    const UprightBox obstacle = scene_.place(scene_.pieces()[pair.obstacle], box, motion.base);
    const UprightBox part = at_goal(piece, box, AffineForm(yaw_rad_));
    if (apart_in_height(part, obstacle)) return std::nullopt;
    // No corner of the part comes farther from the goal than this.
    const double radius = std::hypot(std::abs(piece.middle.x()) + piece.half_x + piece.slack_m.x(),
                                     std::abs(piece.middle.y()) + piece.half_y + piece.slack_m.y());
    UprightBox round = part;
    round.x = target_x_, round.y = target_y_;
    round.half_x = round.half_y = radius * (1.0 + 1e-12);
    round.cosine = obstacle.cosine, round.sine = obstacle.sine;
    bool is_clear = false;
    (void)gap_at_rest(round, obstacle, is_clear);
    if (is_clear) return std::nullopt;
    return turn_between(box, motion.turned_yaw, piece, obstacle, 0);
  }

  std::optional<AffineForm> turn_between(std::span<const Bounds1> box, const Bounds1& yaw,
                                         const ScenePiece& piece, const UprightBox& obstacle,
                                         int depth) const {
    constexpr int kDeepest = 9;
    constexpr double kWidest_rad = 0.4;
    std::optional<AffineForm> gap;
    if (yaw.upper - yaw.lower < kWidest_rad) {
      const AffineForm heading =
          AffineForm::variable(AffineForm::kMostVariables - 1, yaw.lower, yaw.upper);
      bool is_clear = false;
      gap = gap_at_rest(at_goal(piece, box, heading), obstacle, is_clear);
      if (is_clear) return std::nullopt;
      // Nothing is gained by looking closer where they overlap in the middle.
      if (depth >= kDeepest || gap->center() <= 0.0) return gap;
    }
    const double middle = 0.5 * (yaw.lower + yaw.upper);
    auto left = turn_between(box, {yaw.lower, middle}, piece, obstacle, depth + 1);
    if (left) return left;
    return turn_between(box, {middle, yaw.upper}, piece, obstacle, depth + 1);
  }

  /// Tries the heading at the end, which every turn comes to, and, of turns whose way round is
  /// certain, the steps before.
  bool surely_hit_in_turn(std::span<const Bounds1> box, const Motion& motion,
                          const Pair& pair) const {
    const ScenePiece& piece = scene_.pieces()[pair.part];
    if (pair.part == pair.obstacle || !piece.is_exact || !scene_.pieces()[pair.obstacle].is_exact) {
      return false;
    }
    const UprightBox obstacle = scene_.place(scene_.pieces()[pair.obstacle], box, motion.base);
    const auto hits = [&](const AffineForm& yaw) {
      const UprightBox part = at_goal(piece, box, yaw);
      if (!surely_at_one_height(part, obstacle)) return false;
      const auto seen = views_of(part, obstacle);
      for (std::size_t axis = 0; axis < 4; ++axis) {
        if (!(seen[axis].overlap(0.0).lower() > kEngineRoom_m)) return false;
      }
      return true;
    };
    if (hits(AffineForm(yaw_rad_))) return true;
    if (!motion.is_certain_turn) return false;
    constexpr double kTurn = 2.0 * std::numbers::pi;
    const double middle = motion.base.yaw.center();
    const double shift = std::round((yaw_rad_ - middle) / kTurn) * kTurn;
    const AffineForm turn = AffineForm(yaw_rad_ - shift) - motion.base.yaw;
    const Bounds1 angle = absolute(turn).bounds();
    const int fewest = std::max(1, static_cast<int>(std::ceil(angle.lower / kTurnStep_rad - 1e-9)));
    const int most = std::max(1, static_cast<int>(std::ceil(angle.upper / kTurnStep_rad + 1e-9)));
    if (most - fewest > 2) return false;
    for (int steps = fewest; steps <= most; ++steps) {
      bool any = false;
      for (int i = 0; i < steps && !any; ++i) {
        any = hits(motion.base.yaw + AffineForm(static_cast<double>(i) / steps) * turn);
      }
      if (!any) return false;
    }
    return true;
  }

  const ProofScene& scene_;
  CheckedTest test_;
  AffineForm target_x_, target_y_;
  double yaw_rad_, step_m_;
  std::vector<Pair> pairs_;
};

}  // namespace

std::unique_ptr<GeometricCheck> make_drive_check(const ProofScene& scene, const KnownPoint& target,
                                                 double yaw_rad, double sweep_step_m) {
  return std::make_unique<DriveCheck>(scene, target, yaw_rad, sweep_step_m);
}

}  // namespace parallax::harness
