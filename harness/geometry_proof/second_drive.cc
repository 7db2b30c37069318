// The sweep test of a drive once more, without sharing code with drive_check.cc.
//
// Safe: for every pair some direction parts the obstacle from both ends of the way, hence from
// all between, and, with the range of headings halved as far as needed, from the part in the
// turn. Refused: there is a place on the way or in the turn that the controller tries from
// everywhere in the box, for each number of steps that the way's length may ask for, and a point
// that both shapes contain then throughout. Where that does not show, the box is cut along the
// widest variable that moves the pair, and both halves have to be confirmed; pairs that are
// clear in a box are not asked about in its halves.
//
// Cost: at most `effort` pieces of a box, each linear in the pairs that are left.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "harness/geometry_proof/flat_scene.h"
#include "harness/geometry_proof/second_evaluation.h"
#include "harness/robot/mobile_robot.h"

namespace parallax::harness {
namespace {

double distance_to_way(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                       const Eigen::Vector2d& b) {
  const Eigen::Vector2d way = b - a;
  const double length = way.squaredNorm();
  const double share = length > 0.0 ? std::clamp((p - a).dot(way) / length, 0.0, 1.0) : 0.0;
  return (p - a - share * way).norm();
}

class SecondDrive final : public SecondEvaluation, private FlatScene {
 public:
  SecondDrive(const WorldSpec& spec, const WorldLayout& layout, const StartCuboid& region,
              const KnownState& state, const KnownPoint& target, double yaw_rad, double step_m)
      : FlatScene(spec, layout, region, state), yaw_rad_(yaw_rad), step_m_(step_m) {
    goal_.x = {target.low.x(), target.high.x()};
    goal_.y = {target.low.y(), target.high.y()};
  }

  bool confirms(std::span<const Bounds1> box, BoxVerdict verdict, int effort) const override {
    if (verdict == BoxVerdict::kOpen) return true;
    const StartBox all(box.begin(), box.end());
    if (verdict == BoxVerdict::kRefuted) return surely_refused(all, effort);
    std::vector<FlatPair> pairs;
    for (std::size_t a = 0; a < parts_.size(); ++a) {
      if (parts_[a].bottom.lower <= 0.0) return false;  // the floor
      for (std::size_t b = 0; b < obstacles_.size(); ++b) {
        if (meet_in_height(parts_[a], obstacles_[b])) pairs.emplace_back(a, b);
      }
    }
    return surely_clear(all, std::move(pairs), effort);
  }

  bool refuses_at(std::span<const double> start) const override {
    const StartBox box = box_at(start);
    const PlanarRange base = base_range(box);
    const Eigen::Vector2d goal = goal_.middle();
    const double yaw = base.middle_yaw();
    const double turn = std::remainder(yaw_rad_ - yaw, kFullTurn_rad);
    for (const FlatShape& part : parts_) {
      if (part.bottom.lower <= 0.0) return true;
      for (const FlatShape& obstacle : obstacles_) {
        if (!meet_in_height(part, obstacle)) continue;
        const Polygon there = at_middle(obstacle, box);
        if (!far_from_way(part, obstacle, base, box) && overlap(swept(part, base, box), there)) {
          return true;
        }
        if (part.frame != FlatShape::Frame::kBase || far_from_turn(part, obstacle, box)) continue;
        const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(turn) / kTurnStep_rad)));
        for (int i = 0; i <= steps; ++i) {
          if (overlap(moved(part.corners, goal, yaw + turn * i / steps), there)) return true;
        }
      }
    }
    return false;
  }

 private:
  /// The part on its whole way, seen from the middle of the box.
  Polygon swept(const FlatShape& part, const PlanarRange& from, const StartBox& box) const {
    PlanarRange to = goal_;
    to.yaw = from.yaw;
    const PlanarRange first = carried(part, from, box), last = carried(part, to, box);
    Polygon both = moved(part.corners, first.middle(), first.middle_yaw());
    const Polygon end = moved(part.corners, last.middle(), last.middle_yaw());
    both.insert(both.end(), end.begin(), end.end());
    return hull_of(both);
  }

  /// So far apart that circles tell.
  bool far_from_way(const FlatShape& part, const FlatShape& obstacle, const PlanarRange& from,
                    const StartBox& box) const {
    PlanarRange to = goal_;
    to.yaw = from.yaw;
    const Circle first = circle_of(part, carried(part, from, box));
    const Circle last = circle_of(part, carried(part, to, box));
    const Circle there = circle_of(obstacle, range_of(obstacle, box));
    return distance_to_way(there.middle, first.middle, last.middle) >
           there.radius_m + std::max(first.radius_m, last.radius_m);
  }
  bool far_from_turn(const FlatShape& part, const FlatShape& obstacle, const StartBox& box) const {
    const Circle there = circle_of(obstacle, range_of(obstacle, box));
    const double wide =
        0.5 * std::hypot(goal_.x.upper - goal_.x.lower, goal_.y.upper - goal_.y.lower);
    const double reach = part.hand.norm() + reach_of(part.corners) + part.slack_m + wide;
    return (there.middle - goal_.middle()).norm() > there.radius_m + reach + kFlatRounding_m;
  }

  bool clear_on_way(const FlatShape& part, const FlatShape& obstacle, const StartBox& box) const {
    const PlanarRange from = base_range(box);
    if (far_from_way(part, obstacle, from, box)) return true;
    PlanarRange to = goal_;
    to.yaw = from.yaw;
    return apart(part, part.corners, {carried(part, from, box), carried(part, to, box)},
                 swept(part, from, box), obstacle, box);
  }

  /// The headings that a turn may go through from anywhere in `yaw`.
  Bounds1 turned(const Bounds1& yaw) const {
    const double one = std::remainder(yaw_rad_ - yaw.lower, kFullTurn_rad);
    const double other = std::remainder(yaw_rad_ - yaw.upper, kFullTurn_rad);
    // Where the way round changes, both are possible.
    const bool jumps = std::abs((one - other) - (yaw.upper - yaw.lower)) > 1e-9;
    const bool is_near = std::numbers::pi - std::max(std::abs(one), std::abs(other)) < 1e-9;
    if (jumps || is_near) return {yaw_rad_ - std::numbers::pi, yaw_rad_ + std::numbers::pi};
    return {yaw.lower + std::min(other, 0.0), yaw.upper + std::max(one, 0.0)};
  }

  bool clear_in_turn(const FlatShape& part, const Polygon& corners, const FlatShape& obstacle,
                     const StartBox& box, const Bounds1& yaw, int depth) const {
    PlanarRange at = goal_;
    at.yaw = yaw;
    if (yaw.upper - yaw.lower < 0.5) {
      const Polygon middle_of_turn = moved(corners, at.middle(), at.middle_yaw());
      if (apart(part, corners, {at}, middle_of_turn, obstacle, box)) {
        return true;
      }
      if (depth >= 14) return false;
    }
    const double middle = at.middle_yaw();
    return clear_in_turn(part, corners, obstacle, box, {yaw.lower, middle}, depth + 1) &&
           clear_in_turn(part, corners, obstacle, box, {middle, yaw.upper}, depth + 1);
  }

  bool surely_clear(const StartBox& box, std::vector<FlatPair> pairs, int effort) const {
    const Bounds1 yaw = turned(base_range(box).yaw);
    std::erase_if(pairs, [&](const auto& pair) {
      const FlatShape& part = parts_[pair.first];
      const FlatShape& obstacle = obstacles_[pair.second];
      return clear_on_way(part, obstacle, box) &&
             (far_from_turn(part, obstacle, box) ||
              clear_in_turn(part, turning_corners(part), obstacle, box, yaw, 0));
    });
    if (pairs.empty()) return true;
    if (effort < 2 || box.empty()) return false;
    const auto [low, high] = cut(box, cut_axis(box, pairs.front()));
    return surely_clear(low, pairs, effort / 2) && surely_clear(high, pairs, effort / 2);
  }

  /// The variable, of those that move the pair, that is widest.
  std::size_t cut_axis(const StartBox& box, const FlatPair& pair) const {
    const FlatShape& part = parts_[pair.first];
    const FlatShape& obstacle = obstacles_[pair.second];
    const auto name_of = [&](std::size_t body) {
      return layout_.bodies[layout_.bodies.id_at(body)].name;
    };
    std::string own, held;
    if (obstacle.frame == FlatShape::Frame::kBody) own = name_of(obstacle.body) + ".";
    if (part.frame == FlatShape::Frame::kHand) held = name_of(part.body) + ".yaw";
    std::optional<std::size_t> best;
    std::size_t drawn = 0;
    for (const auto& [name, interval] : region_.dimensions) {
      if (!(interval.lower < interval.upper)) continue;
      const bool matters =
          name.starts_with("robot.") || name == held || (!own.empty() && name.starts_with(own));
      const double width = box[drawn].upper - box[drawn].lower;
      if (matters && (!best || width > box[*best].upper - box[*best].lower)) best = drawn;
      ++drawn;
    }
    return best.value_or(widest_of(box));
  }

  /// A place that the controller tries: the share of the way, or of the turn behind it.
  struct Try {
    double way = 0.0, turn = 0.0;
  };

  PlanarRange at(const Try& one, const PlanarRange& from, double turn_low, double turn_high) const {
    const auto blend = [](const Bounds1& a, const Bounds1& b, double share) {
      return Bounds1{(1.0 - share) * a.lower + share * b.lower,
                     (1.0 - share) * a.upper + share * b.upper};
    };
    return {blend(from.x, goal_.x, one.way),
            blend(from.y, goal_.y, one.way),
            {from.yaw.lower + one.turn * turn_low, from.yaw.upper + one.turn * turn_high}};
  }

  bool surely_refused(const StartBox& box, int effort) const {
    std::optional<FlatPair> nearest;
    if (refused_throughout(box, nearest)) return true;
    if (effort < 2 || box.empty()) return false;
    const auto [low, high] = cut(box, nearest ? cut_axis(box, *nearest) : widest_of(box));
    return surely_refused(low, effort / 2) && surely_refused(high, effort / 2);
  }

  /// `nearest`: a pair that meets in the middle of the box.
  bool refused_throughout(const StartBox& box, std::optional<FlatPair>& nearest) const {
    const PlanarRange from = base_range(box);
    // All numbers of steps that the length of the way may ask for.
    double shortest = 0.0, longest = 0.0;
    for (int i = 0; i < 2; ++i) {
      const Bounds1 a = i == 0 ? from.x : from.y, b = i == 0 ? goal_.x : goal_.y;
      const double least = std::max({0.0, b.lower - a.upper, a.lower - b.upper});
      const double most = std::max(std::abs(b.upper - a.lower), std::abs(a.upper - b.lower));
      shortest = std::hypot(shortest, least);
      longest = std::hypot(longest, most);
    }
    const int fewest = std::max(1, static_cast<int>(std::ceil(shortest / step_m_ - 1e-9)));
    const int most = std::max(1, static_cast<int>(std::ceil(longest / step_m_ + 1e-9)));
    if (most - fewest > 8) return false;
    for (int steps = fewest; steps <= most; ++steps) {
      if (!refused_in(box, from, steps, nearest)) return false;
    }
    return true;
  }

  bool refused_in(const StartBox& box, const PlanarRange& from, int steps,
                  std::optional<FlatPair>& nearest) const {
    const double low = std::remainder(yaw_rad_ - from.yaw.lower, kFullTurn_rad);
    const double high = std::remainder(yaw_rad_ - from.yaw.upper, kFullTurn_rad);
    const bool one_way = std::abs((low - high) - (from.yaw.upper - from.yaw.lower)) < 1e-9;
    for (std::size_t a = 0; a < parts_.size(); ++a) {
      const FlatShape& part = parts_[a];
      if (part.is_exact && part.bottom.upper < 0.0) return true;
      for (std::size_t b = 0; b < obstacles_.size(); ++b) {
        const FlatShape& obstacle = obstacles_[b];
        if (!part.is_exact || !obstacle.is_exact || !surely_meet_in_height(part, obstacle))
          continue;
        const auto refused = pair_refused(part, obstacle, box, from, steps, one_way, low, high);
        if (refused) nearest = FlatPair{a, b};
        if (refused.value_or(false)) return true;
      }
    }
    return false;
  }

  /// Is there one place that the controller tries from everywhere in the box, and a point that both
  /// shapes contain then? None: they do not even meet in its middle.
  std::optional<bool> pair_refused(const FlatShape& part, const FlatShape& obstacle,
                                   const StartBox& box, const PlanarRange& from, int steps,
                                   bool one_way, double low, double high) const {
    const Polygon there = at_middle(obstacle, box);
    std::vector<Try> tries;
    if (far_from_way(part, obstacle, from, box) && far_from_turn(part, obstacle, box)) {
      return std::nullopt;
    }
    if (overlap(swept(part, from, box), there)) {
      for (int i = 0; i <= steps; ++i) tries.push_back({static_cast<double>(i) / steps, 0.0});
    }
    if (tries.empty()) {
      tries.push_back({1.0, 1.0});
      const double turn = 0.5 * (low + high);
      const int turns = std::max(1, static_cast<int>(std::ceil(std::abs(turn) / kTurnStep_rad)));
      const bool same =
          std::ceil(std::abs(low) / kTurnStep_rad) == std::ceil(std::abs(high) / kTurnStep_rad);
      for (int i = 0; one_way && same && i < turns; ++i) {
        tries.push_back({1.0, static_cast<double>(i) / turns});
      }
    }
    Try best;
    double most = 0.0;
    Eigen::Vector2d point = Eigen::Vector2d::Zero();
    for (const Try& one : tries) {
      const PlanarRange frame = at(one, from, one_way ? low : 0.0, one_way ? high : 0.0);
      const double yaw = one.turn == 1.0 ? yaw_rad_ : frame.middle_yaw();
      const Polygon both = common_part(moved(part.corners, frame.middle(), yaw), there);
      if (both.size() < 3 || area_of(both) <= most) continue;
      most = area_of(both);
      best = one;
      point = centroid_of(both);
    }
    if (most <= 0.0) return std::nullopt;
    PlanarRange frame = at(best, from, one_way ? low : 0.0, one_way ? high : 0.0);
    if (best.turn == 1.0) frame.yaw = {yaw_rad_, yaw_rad_};
    return surely_inside(point, frame, part.middle, part.heading_rad, part.half,
                         part.shrink_m + kFlatRounding_m) &&
           surely_inside(point, range_of(obstacle, box), obstacle.middle, obstacle.heading_rad,
                         obstacle.half, obstacle.shrink_m + kFlatRounding_m);
  }

  PlanarRange goal_;
  double yaw_rad_, step_m_;
};

}  // namespace

std::unique_ptr<SecondEvaluation> make_second_drive(
    const WorldSpec& spec, const WorldLayout& layout, const StartCuboid& region,
    const KnownState& state, const KnownPoint& target, double yaw_rad, double sweep_step_m) {
  return std::make_unique<SecondDrive>(spec, layout, region, state, target, yaw_rad, sweep_step_m);
}

}  // namespace parallax::harness
