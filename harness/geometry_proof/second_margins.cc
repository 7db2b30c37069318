// Reach and gaze once more, by intervals.
//
// The shoulder or the camera is a point of the base's frame; its coordinates in the world are
// intervals, from the ranges of x, y and heading. Distances follow from squares of intervals;
// the pan to a rectangle of places that does not hold the origin is extreme at its corners, the
// tilt follows from the least and the greatest distance and height. If these ranges do not
// decide, the box is halved along the widest variable of the robot. Lengths and angles keep a
// margin for rounding on either side. At most `effort` pieces.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "harness/geometry_proof/flat_shapes.h"
#include "harness/geometry_proof/second_evaluation.h"

namespace parallax::harness {

StartBox box_at(std::span<const double> start) {
  StartBox box;
  for (const double value : start) box.push_back({value, value});
  return box;
}

namespace {

constexpr double kRounding = 1e-9;

/// A point of the base's frame and points of the world, by ranges of their coordinates; a box is
/// cut until lengths and angles that follow from these ranges decide.
class SecondMargins : public SecondEvaluation {
 public:
  SecondMargins(const WorldSpec& spec, const WorldLayout& layout, const StartCuboid& region,
                const KnownState& state, const Eigen::Vector3d& p_B)
      : spec_(spec), layout_(layout), region_(region), state_(state), p_B_(p_B) {}

  bool confirms(std::span<const Bounds1> box, BoxVerdict verdict, int effort) const override {
    if (verdict == BoxVerdict::kOpen) return true;
    return confirms_box(StartBox(box.begin(), box.end()), verdict, effort);
  }
  bool refuses_at(std::span<const double> start) const override {
    const StartBox box = box_at(start);
    return refuses(middle_of(ranges(box)));
  }

 protected:
  struct Ranges {
    Bounds1 x, y, z, yaw;  // of the point in the world, and the base's heading
  };
  /// Does it pass wherever these ranges allow, or refuse everywhere?
  virtual bool passes(const Ranges& ranges) const = 0;
  virtual bool refuses(const Ranges& ranges) const = 0;

  static Bounds1 between(double low, double high) {
    return {std::min(low, high), std::max(low, high)};
  }
  /// From a range to the range of one coordinate of a place.
  static Bounds1 difference(double low, double high, const Bounds1& from) {
    return {low - from.upper, high - from.lower};
  }
  static Bounds1 square(const Bounds1& a) {
    const double one = a.lower * a.lower, other = a.upper * a.upper;
    const bool spans = a.lower <= 0.0 && a.upper >= 0.0;
    return {spans ? 0.0 : std::min(one, other), std::max(one, other)};
  }

 private:
  static Ranges middle_of(const Ranges& all) {
    const auto middle = [](const Bounds1& one) {
      const double value = 0.5 * (one.lower + one.upper);
      return Bounds1{value, value};
    };
    return {middle(all.x), middle(all.y), middle(all.z), middle(all.yaw)};
  }

  bool confirms_box(const StartBox& box, BoxVerdict verdict, int effort) const {
    const Ranges all = ranges(box);
    if (verdict == BoxVerdict::kSafe ? passes(all) : refuses(all)) return true;
    if (effort < 2) return false;
    std::size_t drawn = 0, axis = 0;
    double widest = 0.0;
    for (const auto& [name, interval] : region_.dimensions) {
      if (!(interval.lower < interval.upper)) continue;
      const double width = box[drawn].upper - box[drawn].lower;
      if (name.starts_with("robot.") && width > widest) axis = drawn, widest = width;
      ++drawn;
    }
    if (widest == 0.0) return false;
    StartBox low = box, high = box;
    low[axis].upper = high[axis].lower = 0.5 * (box[axis].lower + box[axis].upper);
    return confirms_box(low, verdict, effort / 2) && confirms_box(high, verdict, effort / 2);
  }

  Ranges ranges(const StartBox& box) const {
    const BodySpec& base = layout_.bodies[*layout_.find_body(spec_.mobile->base_body)];
    Ranges out{{base.p_WB.x(), base.p_WB.x()},
               {base.p_WB.y(), base.p_WB.y()},
               {},
               {base.yaw_rad, base.yaw_rad}};
    std::size_t drawn = 0;
    for (const auto& [name, interval] : region_.dimensions) {
      const bool is_drawn = interval.lower < interval.upper;
      const Bounds1 range = is_drawn ? box[drawn++] : Bounds1{interval.lower, interval.lower};
      if (name == "robot.x") out.x = range;
      if (name == "robot.y") out.y = range;
      if (name == "robot.yaw") out.yaw = range;
    }
    if (state_.base_at) {
      const auto& goal = *state_.base_at;
      out.x = {goal.p.x() - goal.within_m, goal.p.x() + goal.within_m};
      out.y = {goal.p.y() - goal.within_m, goal.p.y() + goal.within_m};
      out.yaw = {goal.yaw_rad - goal.within_rad, goal.yaw_rad + goal.within_rad};
    }
    out.yaw.lower -= state_.slack.drift_rad, out.yaw.upper += state_.slack.drift_rad;
    const double far = p_B_.head<2>().norm(), at = std::atan2(p_B_.y(), p_B_.x());
    const Bounds1 c = cosine_range(out.yaw.lower + at, out.yaw.upper + at);
    const double quarter = 0.5 * std::numbers::pi;
    const Bounds1 s = cosine_range(out.yaw.lower + at - quarter, out.yaw.upper + at - quarter);
    const double drift = state_.slack.drift_m;
    out.x = {out.x.lower - drift + far * c.lower, out.x.upper + drift + far * c.upper};
    out.y = {out.y.lower - drift + far * s.lower, out.y.upper + drift + far * s.upper};
    const double loose = drift + state_.relief_m;
    const double z = base.p_WB.z() + p_B_.z();
    out.z = {z + state_.lift_m.lower - loose, z + state_.lift_m.upper + loose};
    return out;
  }

  const WorldSpec& spec_;
  const WorldLayout& layout_;
  const StartCuboid& region_;
  const KnownState& state_;
  Eigen::Vector3d p_B_;
};

class SecondReach final : public SecondMargins {
 public:
  SecondReach(const WorldSpec& spec, const WorldLayout& layout, const StartCuboid& region,
              const KnownState& state, std::size_t arm, std::vector<KnownPoint> points)
      : SecondMargins(spec, layout, region, state, spec.mobile->arms[arm].p_BS),
        arm_(spec.mobile->arms[arm]),
        points_(std::move(points)) {}

 protected:
  bool passes(const Ranges& from) const override {
    return std::all_of(points_.begin(), points_.end(), [&](const KnownPoint& point) {
      const Bounds1 length = length_to(point, from);
      return length.upper < arm_.max_reach_m - kRounding &&
             length.lower > arm_.min_reach_m + kRounding;
    });
  }
  bool refuses(const Ranges& from) const override {
    return std::any_of(points_.begin(), points_.end(), [&](const KnownPoint& point) {
      const Bounds1 length = length_to(point, from);
      return length.lower > arm_.max_reach_m + kRounding ||
             length.upper < arm_.min_reach_m - kRounding;
    });
  }

 private:
  static Bounds1 length_to(const KnownPoint& point, const Ranges& from) {
    const Bounds1 x = square(difference(point.low.x(), point.high.x(), from.x));
    const Bounds1 y = square(difference(point.low.y(), point.high.y(), from.y));
    const Bounds1 z = square(difference(point.low.z(), point.high.z(), from.z));
    return {std::sqrt(x.lower + y.lower + z.lower), std::sqrt(x.upper + y.upper + z.upper)};
  }

  const ArmSpec& arm_;
  std::vector<KnownPoint> points_;
};

class SecondGaze final : public SecondMargins {
 public:
  SecondGaze(const WorldSpec& spec, const WorldLayout& layout, const StartCuboid& region,
             const KnownState& state, const KnownPoint& place)
      : SecondMargins(spec, layout, region, state, spec.mobile->camera.p_BC),
        camera_(spec.mobile->camera),
        place_(place) {}

 protected:
  struct Angles {
    Bounds1 pan, tilt;
    bool is_known = false;  // the place is not straight below or above anywhere
  };
  bool passes(const Ranges& from) const override {
    const Angles angles = angles_of(from);
    return angles.is_known && angles.pan.lower > -camera_.max_pan_rad + kRounding &&
           angles.pan.upper < camera_.max_pan_rad - kRounding &&
           angles.tilt.lower > camera_.min_tilt_rad + kRounding &&
           angles.tilt.upper < camera_.max_tilt_rad - kRounding;
  }
  bool refuses(const Ranges& from) const override {
    const Angles angles = angles_of(from);
    return angles.is_known && (angles.pan.lower > camera_.max_pan_rad + kRounding ||
                               angles.pan.upper < -camera_.max_pan_rad - kRounding ||
                               angles.tilt.lower > camera_.max_tilt_rad + kRounding ||
                               angles.tilt.upper < camera_.min_tilt_rad - kRounding);
  }

 private:
  Angles angles_of(const Ranges& from) const {
    Angles out;
    const Bounds1 x = difference(place_.low.x(), place_.high.x(), from.x);
    const Bounds1 y = difference(place_.low.y(), place_.high.y(), from.y);
    const Bounds1 z = difference(place_.low.z(), place_.high.z(), from.z);
    const Bounds1 xx = square(x), yy = square(y);
    if (xx.lower + yy.lower <= 0.0) return out;
    // Seen from the origin, the corners of a rectangle that does not hold it are its ends.
    const double middle_x = 0.5 * (x.lower + x.upper), middle_y = 0.5 * (y.lower + y.upper);
    const double middle = std::atan2(middle_y, middle_x);
    Bounds1 off{};
    for (const double cx : {x.lower, x.upper}) {
      for (const double cy : {y.lower, y.upper}) {
        const double angle =
            std::atan2(middle_x * cy - middle_y * cx, middle_x * cx + middle_y * cy);
        off = {std::min(off.lower, angle), std::max(off.upper, angle)};
      }
    }
    const double turn = 0.5 * (from.yaw.lower + from.yaw.upper);
    const double pan = std::remainder(middle - turn, 2.0 * std::numbers::pi);
    const double wide = 0.5 * (from.yaw.upper - from.yaw.lower);
    out.pan = {pan + off.lower - wide, pan + off.upper + wide};
    const double near = std::sqrt(xx.lower + yy.lower), far = std::sqrt(xx.upper + yy.upper);
    const auto tilt = [&](double height, bool most) {
      const bool below = height < 0.0;
      return std::atan2(-height, below == most ? near : far);
    };
    out.tilt = {tilt(z.upper, false), tilt(z.lower, true)};
    out.is_known = out.pan.lower > -std::numbers::pi && out.pan.upper < std::numbers::pi;
    return out;
  }

  const CameraSpec& camera_;
  KnownPoint place_;
};

}  // namespace

std::unique_ptr<SecondEvaluation> make_second_reach(const WorldSpec& spec,
                                                    const WorldLayout& layout,
                                                    const StartCuboid& region,
                                                    const KnownState& state, std::size_t arm,
                                                    std::vector<KnownPoint> points) {
  return std::make_unique<SecondReach>(spec, layout, region, state, arm, std::move(points));
}

std::unique_ptr<SecondEvaluation> make_second_gaze(const WorldSpec& spec, const WorldLayout& layout,
                                                   const StartCuboid& region,
                                                   const KnownState& state,
                                                   const KnownPoint& place) {
  return std::make_unique<SecondGaze>(spec, layout, region, state, place);
}

}  // namespace parallax::harness
