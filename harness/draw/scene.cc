#include "harness/draw/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "harness/world/shapes.h"

namespace parallax::harness {
namespace {

SceneKind kind_of(const WorldLayout& layout, const WorldSpec& spec, BodyId id) {
  if (!layout.link_of[id.index()]) return SceneKind::kFurniture;
  if (layout.is_free[id.index()]) return SceneKind::kItem;
  const auto base = layout.find_body(base_body(spec));
  if (!base || layout.assembly_of[id.index()] != layout.assembly_of[base->index()]) {
    return SceneKind::kDrawer;
  }
  const std::string& name = layout.bodies[id].name;
  const auto all = grippers(spec);
  const bool pad = std::any_of(all.begin(), all.end(), [&](const GripperSpec& gripper) {
    return gripper.near_pad_body == name || gripper.far_pad_body == name;
  });
  return pad ? SceneKind::kGripper : SceneKind::kRobot;
}

std::vector<SceneArm> arms_of(const PhysicsWorld& world, const MobileRobotSpec& robot) {
  const WorldLayout& layout = world.layout();
  const auto base = layout.find_body(robot.base_body);
  const auto torso = layout.find_slider(robot.torso_joint);
  const double lift_m = torso ? world.slider_position_m(*torso) : 0.0;
  std::vector<SceneArm> arms;
  for (const ArmSpec& arm : robot.arms) {
    const auto palm = layout.find_body(arm.palm_body);
    if (!base || !palm || !arm.chain.empty()) continue;
    const Eigen::Vector3d p_BS = arm.p_BS + lift_m * Eigen::Vector3d::UnitZ();
    arms.push_back(
        {arm.name, world.position(*base) + world.rotation(*base) * p_BS, world.position(*palm)});
  }
  return arms;
}

constexpr int kRound = 32;  // points of a circle

/// A circle about the z axis.
void add_circle_points(double radius_m, double z_m, std::vector<Eigen::Vector3d>& points) {
  for (int i = 0; i < kRound; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kRound;
    points.emplace_back(radius_m * std::cos(angle), radius_m * std::sin(angle), z_m);
  }
}

}  // namespace

std::vector<Eigen::Vector3d> outline_points(const Probe& shape) {
  std::vector<Eigen::Vector3d> points;
  const Eigen::Vector3d half = 0.5 * shape.size_m;
  if (shape.form == ShapeForm::kBox) {
    for (int i = 0; i < 8; ++i) {
      const Eigen::Vector3d sign(i % 2 == 0 ? 0.5 : -0.5, i / 2 % 2 == 0 ? 0.5 : -0.5,
                                 i / 4 == 0 ? 0.5 : -0.5);
      points.emplace_back(sign.cwiseProduct(shape.size_m));
    }
    return points;
  }
  if (shape.form == ShapeForm::kHull) return shape.hull->vertices;
  if (shape.form == ShapeForm::kCylinder) {
    for (const double z : {-half.z(), half.z()}) add_circle_points(half.x(), z, points);
    return points;
  }
  // Circles of latitude, the upper and the lower half as far apart as the straight part is long.
  const double straight_m = half.z() - half.x();
  for (int i = 0; i <= kRound; ++i) {
    const double latitude = std::numbers::pi * (static_cast<double>(i) / kRound - 0.5);
    const double z = half.x() * std::sin(latitude);
    add_circle_points(half.x() * std::cos(latitude), z + (z < 0.0 ? -straight_m : straight_m),
                      points);
  }
  return points;
}

Scene scene_of(const PhysicsWorld& world, const WorldSpec& spec) {
  Scene scene;
  const WorldLayout& layout = world.layout();
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    const BodyId id = layout.bodies.id_at(i);
    for (const BodyShape& shape : layout.bodies[id].shapes) {
      scene.boxes.push_back({layout.bodies[id].name, kind_of(layout, spec, id),
                             world.placed(id, shape), world.position(id)});
    }
  }
  scene.base = base_body(spec);
  if (spec.mobile) scene.arms = arms_of(world, *spec.mobile);
  return scene;
}

Rectangle around(const std::vector<Eigen::Vector2d>& points) {
  Rectangle out;
  if (!points.empty()) out = {points.front(), points.front()};
  for (const Eigen::Vector2d& p : points) out = {out.low.cwiseMin(p), out.high.cwiseMax(p)};
  return out;
}

std::vector<Eigen::Vector2d> hull(std::vector<Eigen::Vector2d> points) {
  std::sort(points.begin(), points.end(), [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  const auto left_turn = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                            const Eigen::Vector2d& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x()) > 0.0;
  };
  std::vector<Eigen::Vector2d> out;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t base = out.size();
    for (const Eigen::Vector2d& p : points) {
      while (out.size() >= base + 2 && !left_turn(out[out.size() - 2], out.back(), p)) {
        out.pop_back();
      }
      out.push_back(p);
    }
    out.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return out;
}

std::vector<Eigen::Vector2d> clipped(std::vector<Eigen::Vector2d> polygon, const Rectangle& area) {
  // One side of the rectangle after the other: `sign` * coordinate is at most `limit` inside.
  const auto cut = [&polygon](Eigen::Index axis, double sign, double limit) {
    std::vector<Eigen::Vector2d> out;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Eigen::Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      const double from = limit - sign * a[axis], to = limit - sign * b[axis];
      if (from >= 0.0) out.push_back(a);
      if ((from > 0.0 && to < 0.0) || (from < 0.0 && to > 0.0)) {
        out.push_back(a + from / (from - to) * (b - a));
      }
    }
    polygon = std::move(out);
  };
  for (const Eigen::Index axis : {0, 1}) {
    cut(axis, 1.0, area.high[axis]);
    cut(axis, -1.0, -area.low[axis]);
  }
  return polygon.size() < 3 ? std::vector<Eigen::Vector2d>() : polygon;
}

std::vector<Eigen::Vector2d> closed(std::vector<Eigen::Vector2d> points) {
  if (!points.empty()) points.push_back(points.front());
  return points;
}

std::string point_list(const std::vector<Eigen::Vector2d>& points) {
  std::string out;
  for (const Eigen::Vector2d& p : points) {
    out += fmt::format("{}{:.1f},{:.1f}", out.empty() ? "" : " ", p.x(), p.y());
  }
  return out;
}

Eigen::Vector2d Projection::anywhere(const Eigen::Vector3d& p_W) const {
  const double right = kind_ == ViewKind::kFront ? p_W.y() : p_W.x();
  const double up = kind_ == ViewKind::kAbove ? p_W.y() : p_W.z();
  return {left_px_ + px_per_m_ * (right - left_m()), top_px_ + px_per_m_ * (top_m() - up)};
}

Eigen::Vector2d Projection::pixel(const Eigen::Vector3d& p_W) const {
  const Rectangle within = area();
  return anywhere(p_W).cwiseMax(within.low).cwiseMin(within.high);
}

std::vector<Eigen::Vector2d> Projection::pixels(
    const std::vector<Eigen::Vector3d>& points_W) const {
  std::vector<Eigen::Vector2d> out;
  out.reserve(points_W.size());
  for (const Eigen::Vector3d& p : points_W) out.push_back(pixel(p));
  return out;
}

std::vector<Eigen::Vector2d> Projection::outline(const Probe& shape) const {
  std::vector<Eigen::Vector2d> corners;
  for (const Eigen::Vector3d& p : outline_points(shape)) {
    corners.push_back(anywhere(shape.p_WS + shape.R_WS * p));
  }
  return clipped(hull(corners), area());
}

double Projection::nearness(const Probe& box) const {
  const Eigen::Vector3d half = half_extents(box.form, box.size_m, box.R_WS);
  if (kind_ == ViewKind::kFront) return box.p_WS.x() + half.x();
  return kind_ == ViewKind::kAbove ? box.p_WS.z() + half.z() : half.y() - box.p_WS.y();
}

}  // namespace parallax::harness
