#include "tools/bench/engines/grips.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "compiler/base/contract.h"

namespace parallax::tools {
namespace {

using Eigen::Vector3d;
using harness::BodySpec;
using harness::EngineKind;
using harness::JointSpec;
using harness::WorldSpec;

constexpr double kEarth_m_s2 = 9.81;
constexpr double kPadFriction = 0.215, kMass_kg = 0.9;
constexpr double kLoad_m = 0.07;     // of the load
constexpr double kOverlap_m = 1e-4;  // of pads and load at the start, so that they touch at once
constexpr double kClosing_m_s = 0.05;

BodySpec box(std::string name, const Vector3d& size_m, const Vector3d& p_WB, double mass_kg) {
  BodySpec body;
  body.name = std::move(name);
  body.shapes = {harness::BodyShape{size_m}};
  body.p_WB = p_WB;
  body.mass_kg = mass_kg;
  return body;
}

/// The same box as corners and faces.
void make_hull(harness::BodyShape& shape) {
  std::vector<Vector3d> corners;
  for (int i = 0; i < 8; ++i) {
    const Vector3d side((i & 1) != 0 ? 0.5 : -0.5, (i & 2) != 0 ? 0.5 : -0.5,
                        (i & 4) != 0 ? 0.5 : -0.5);
    corners.push_back(side.cwiseProduct(shape.size_m));
  }
  std::string why;
  auto hull = harness::hull_with(corners,
                                 {{{0, 4, 6}},
                                  {{0, 6, 2}},
                                  {{1, 3, 7}},
                                  {{1, 7, 5}},
                                  {{0, 1, 5}},
                                  {{0, 5, 4}},
                                  {{2, 6, 7}},
                                  {{2, 7, 3}},
                                  {{0, 2, 3}},
                                  {{0, 3, 1}},
                                  {{4, 5, 7}},
                                  {{4, 7, 6}}},
                                 shape.p_BS, why);
  PARALLAX_REQUIRE(hull.has_value(), "a box that is convex");
  shape.form = harness::ShapeForm::kHull;
  shape.hull = std::make_shared<const harness::ConvexHull>(std::move(*hull));
}

JointSpec slider(std::string name, std::string parent, std::string child, const Vector3d& axis,
                 double max_force_n) {
  JointSpec joint;
  joint.name = std::move(name);
  joint.parent = std::move(parent);
  joint.child = std::move(child);
  joint.axis_W = axis;
  joint.max_force_n = max_force_n;
  return joint;
}

std::unique_ptr<harness::PhysicsWorld> started(WorldSpec spec, EngineKind engine,
                                               double timestep_s) {
  spec.engine = engine;
  spec.solver.timestep_s = timestep_s;
  spec.solver.surface_layer_m = 0.0002;
  auto world = harness::make_world(spec);
  std::vector<harness::Placement> start;
  for (const auto& body : world->layout().bodies) start.push_back({body.p_WB, body.yaw_rad, 0});
  PARALLAX_REQUIRE(!world->reset(start, 1), "bodies that do not overlap");
  return world;
}

/// A carriage with a pad, a second pad on it, and a load between them.
class Gripper {
 public:
  Gripper(EngineKind engine, double timestep_s, const Vector3d& axis, double force_n,
          LoadForm form = LoadForm::kBox)
      : force_n_(force_n) {
    constexpr double kAnyForce_n = 1e5;
    const Vector3d pad(0.02, 0.01, 0.026);
    const Vector3d apart(0.0, 0.5 * (kLoad_m + pad.y()) - kOverlap_m, 0.0);
    const Vector3d middle(0.0, 0.0, 2.0);
    WorldSpec spec;
    spec.friction.fallback = kPadFriction;
    spec.bodies = {box("carriage", pad, middle - apart, 5.0), box("pad", pad, middle + apart, 0.12),
                   box("load", {kLoad_m, kLoad_m, 0.21}, middle, kMass_kg)};
    if (form == LoadForm::kHull) make_hull(spec.bodies.back().shapes.front());
    spec.joints = {slider("rail", "", "carriage", axis, kAnyForce_n),
                   slider("finger", "carriage", "pad", -Vector3d::UnitY(), force_n)};
    world_ = started(std::move(spec), engine, timestep_s);
    rail_ = *world_->layout().find_slider("rail");
    finger_ = *world_->layout().find_slider("finger");
  }

  /// Moves the rail along `way_m`, a function of the time from now.
  void go_on(double time_s, const std::function<double(double)>& way_m) {
    const double step_s = world_->timestep_s();
    const auto steps = std::lround(time_s / step_s);
    const double from_m = world_->slider_position_m(rail_);
    for (long i = 1; i <= steps; ++i) {
      const double to_m = from_m + way_m(static_cast<double>(i) * step_s);
      world_->set_motor(rail_, (to_m - world_->slider_position_m(rail_)) / step_s, kRailForce_n);
      world_->set_motor(finger_, kClosing_m_s, force_n_);
      PARALLAX_REQUIRE(world_->step(), "a world that stays sane");
    }
  }

  /// Position of the load relative to the carriage.
  Vector3d offset() const { return place("load") - place("carriage"); }

 private:
  static constexpr double kRailForce_n = 1e5;
  Vector3d place(const char* body) const {
    return world_->position(*world_->layout().find_body(body));
  }
  double force_n_;
  std::unique_ptr<harness::PhysicsWorld> world_;
  harness::SliderId rail_, finger_;
};

constexpr double kSettling_s = 0.1, kWatched_s = 0.4, kSlip_m = 0.002;

/// The least value that holds, by bisection to a thousandth.
double least_that_holds(const std::function<bool(double)>& holds) {
  double slips = 0.3, held = 1.7;
  while (held - slips > 1e-3) {
    const double middle = 0.5 * (slips + held);
    (holds(middle) ? held : slips) = middle;
  }
  return held;
}

double force_n(double share, double pull_m_s2) {
  return share * kMass_kg * pull_m_s2 / (2.0 * kPadFriction);
}

/// Distance that a load has slipped after `time_s` by Coulomb's law, while its pads move up and
/// down with the acceleration `rise_m_s2`.
double slipped_m(double time_s, double force_n, const std::function<double(double)>& rise_m_s2) {
  constexpr int kSteps = 200000;
  const double h = time_s / kSteps, most_m_s2 = 2.0 * kPadFriction * force_n / kMass_kg;
  double speed_m_s = 0.0, way_m = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double pull_m_s2 = kEarth_m_s2 + rise_m_s2((i + 0.5) * h);
    const double free_m_s = speed_m_s + h * pull_m_s2, lost_m_s = h * most_m_s2;
    speed_m_s = std::abs(free_m_s) <= lost_m_s ? 0.0 : free_m_s - std::copysign(lost_m_s, free_m_s);
    way_m += h * speed_m_s;
  }
  return way_m;
}

}  // namespace

double least_grip(EngineKind engine, double timestep_s, double angle_rad, LoadForm form) {
  const double side_m_s2 = kEarth_m_s2 * std::tan(angle_rad);
  return least_that_holds([&](double share) {
    Gripper gripper(engine, timestep_s, Vector3d::UnitX(),
                    force_n(share, kEarth_m_s2 / std::cos(angle_rad)), form);
    const auto faster = [&](double time_s) { return 0.5 * side_m_s2 * time_s * time_s; };
    gripper.go_on(kSettling_s + kWatched_s, faster);
    return (gripper.offset() - Vector3d(0.0, gripper.offset().y(), 0.0)).norm() < kSlip_m;
  });
}

double least_slope_friction(EngineKind engine, double timestep_s, double turn_rad) {
  constexpr double kSlope_rad = 0.3;
  const auto turned = [&](BodySpec body) {
    body.shapes.front().pitch_rad = kSlope_rad;
    body.shapes.front().yaw_rad = turn_rad;
    return body;
  };
  const Vector3d up(std::sin(kSlope_rad) * std::cos(turn_rad),
                    std::sin(kSlope_rad) * std::sin(turn_rad), std::cos(kSlope_rad));
  const Vector3d start = Vector3d(0.0, 0.0, 3.0) + 0.2 * up;
  return least_that_holds([&](double share) {
    WorldSpec spec;
    spec.bodies = {turned(box("ramp", {4.0, 4.0, 0.2}, {0.0, 0.0, 3.0}, 0.0)),
                   turned(box("block", Vector3d::Constant(0.2), start, 1.0))};
    spec.friction.fallback = share * std::tan(kSlope_rad);
    const auto world = started(std::move(spec), engine, timestep_s);
    const auto steps = std::lround((kSettling_s + kWatched_s) / timestep_s);
    for (long i = 0; i < steps; ++i) PARALLAX_REQUIRE(world->step(), "a world that stays sane");
    return (world->position(*world->layout().find_body("block")) - start).norm() < kSlip_m;
  });
}

double creep_m_s(EngineKind engine, double timestep_s, LoadForm form) {
  Gripper gripper(engine, timestep_s, Vector3d::UnitZ(), force_n(2.0, kEarth_m_s2), form);
  const auto still = [](double) { return 0.0; };
  gripper.go_on(1.0, still);
  const Vector3d before = gripper.offset();
  gripper.go_on(2.0, still);
  return (gripper.offset() - before).norm() / 2.0;
}

double shaken_load(EngineKind engine, double timestep_s) {
  constexpr double kReach_m = 0.0015, kForce_n = 25.0, kRate_rad_s = 16.0 * std::numbers::pi;
  Gripper gripper(engine, timestep_s, Vector3d::UnitZ(), kForce_n);
  gripper.go_on(0.3, [](double) { return 0.0; });
  const double before_m = gripper.offset().z();
  gripper.go_on(1.0, [](double t) { return kReach_m * (1.0 - std::cos(kRate_rad_s * t)); });
  const double expected_m = slipped_m(1.0, kForce_n, [](double t) {
    return kReach_m * kRate_rad_s * kRate_rad_s * std::cos(kRate_rad_s * t);
  });
  return std::abs(before_m - gripper.offset().z() - expected_m);
}

}  // namespace parallax::tools
