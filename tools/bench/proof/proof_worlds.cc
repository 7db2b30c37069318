#include "tools/bench/proof/proof_worlds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "harness/sampling/sampler.h"

namespace parallax::bench {
namespace {

using harness::BodyShape;
using harness::BodySpec;
using harness::JointSpec;
using harness::JointType;

/// Numbers one after the other.
class Dice {
 public:
  explicit Dice(std::uint64_t number) : rng_({number, 0x70726f6f66, {}, 0, 0}) {}
  double between(double low, double high) { return low + rng_.uniform(next_++) * (high - low); }
  int whole(int low, int high) {
    return std::min(high, static_cast<int>(std::floor(between(low, high + 1.0))));
  }

 private:
  harness::CounterRng rng_;
  std::uint64_t next_ = 0;
};

BodyShape box_of(double x_m, double y_m, double z_m) {
  return {{x_m, y_m, z_m}, Eigen::Vector3d::Zero(), 0.0};
}

BodySpec body(std::string name, double mass_kg, Eigen::Vector3d p_WB,
              std::vector<BodyShape> shapes) {
  BodySpec spec;
  spec.name = std::move(name);
  spec.material = "wood";
  spec.mass_kg = mass_kg;
  spec.p_WB = p_WB;
  spec.shapes = std::move(shapes);
  return spec;
}

JointSpec joint(std::string name, JointType type, std::string parent, std::string child) {
  JointSpec spec;
  spec.name = std::move(name);
  spec.type = type;
  spec.parent = std::move(parent);
  spec.child = std::move(child);
  spec.max_force_n = 400.0;
  return spec;
}

/// With its frame on the floor under its middle, at the origin.
void add_robot(Dice& dice, harness::WorldSpec& spec) {
  const double length = dice.between(0.4, 0.8), width = dice.between(0.3, 0.7);
  const double height = dice.between(0.3, 0.7), ahead = dice.between(0.2, 0.7);
  BodySpec base =
      body("base", 80.0, Eigen::Vector3d::Zero(),
           {{{length, width, height}, {0.0, 0.0, 0.03 + 0.5 * height}, 0.0},
            {{0.2, 0.3, 1.2 - height}, {-0.05, 0.0, 0.03 + 0.5 * (1.2 + height)}, 0.0}});
  base.settable = {"x", "y", "yaw"};
  spec.bodies.push_back(base);
  spec.bodies.push_back(body("palm", 0.6, {ahead, 0.1, 0.91}, {box_of(0.06, 0.14, 0.05)}));
  spec.bodies.push_back(body("near", 0.1, {ahead, 0.05, 0.83}, {box_of(0.02, 0.01, 0.10)}));
  spec.bodies.push_back(body("far", 0.1, {ahead, 0.15, 0.83}, {box_of(0.02, 0.01, 0.10)}));
  spec.joints.push_back(joint("wheels", JointType::kGantry, "", "base"));
  spec.joints.push_back(joint("arm", JointType::kGantry, "base", "palm"));
  spec.joints.push_back(joint("weld", JointType::kFixed, "palm", "near"));
  JointSpec finger = joint("finger", JointType::kSlider, "palm", "far");
  finger.axis_W = Eigen::Vector3d::UnitY();
  finger.low_m = -0.089;
  finger.high_m = 0.01;
  spec.joints.push_back(finger);
  harness::MobileRobotSpec robot;
  robot.base_joint = "wheels";
  robot.base_body = "base";
  robot.camera.p_BC = {0.0, 0.0, 1.2};
  harness::ArmSpec arm;
  arm.name = "arm";
  arm.joint = "arm";
  arm.finger_joint = "finger";
  arm.palm_body = "palm";
  arm.near_pad_body = "near";
  arm.far_pad_body = "far";
  arm.p_BS = {0.0, 0.1, 0.5};
  arm.carry_B = {ahead, 0.1, 0.83};
  arm.min_reach_m = 0.1;
  arm.max_reach_m = 1.2;
  robot.arms.push_back(arm);
  spec.mobile = robot;
}

void draw(ProofWorld& world, const std::string& name, double middle, double half) {
  world.region.dimensions.push_back({name, {middle - half, middle + half, false}});
}

}  // namespace

ProofWorld random_drive(std::uint64_t number) {
  Dice dice(number);
  ProofWorld world;
  add_robot(dice, world.spec);
  const double way = dice.between(0.3, 3.0), towards = dice.between(-3.0, 3.0);
  const Eigen::Vector2d along(std::cos(towards), std::sin(towards));
  const Eigen::Vector2d across(-along.y(), along.x());
  const int boxes = dice.whole(2, 7);
  const bool one_is_drawn = number % 2 == 1;
  for (int i = 0; i < boxes; ++i) {
    const Eigen::Vector3d size(dice.between(0.05, 0.8), dice.between(0.05, 0.8),
                               dice.between(0.1, 1.5));
    const bool is_free = one_is_drawn && i == 0;
    const double side = dice.between(0.0, 1.0) < 0.5 ? -1.0 : 1.0;
    const Eigen::Vector2d p =
        dice.between(-0.2, way + 0.4) * along + side * dice.between(0.25, 1.3) * across;
    const double bottom = is_free ? 0.001 : dice.between(0.0, 0.6);
    BodySpec box =
        body(fmt::format("box{}", i), is_free ? 1.0 : 0.0, {p.x(), p.y(), bottom + 0.5 * size.z()},
             {box_of(size.x(), size.y(), size.z())});
    box.yaw_rad = dice.between(-1.6, 1.6);
    if (is_free) {
      box.settable = {"x", "y", "yaw"};
      draw(world, box.name + ".x", p.x(), dice.between(0.02, 0.15));
      draw(world, box.name + ".y", p.y(), dice.between(0.02, 0.15));
      draw(world, box.name + ".yaw", box.yaw_rad, dice.between(0.02, 0.3));
    }
    world.spec.bodies.push_back(std::move(box));
  }
  draw(world, "robot.x", 0.0, dice.between(0.02, 0.3));
  draw(world, "robot.y", 0.0, dice.between(0.02, 0.3));
  draw(world, "robot.yaw", dice.between(-3.0, 3.0), dice.between(0.01, 0.3));
  std::sort(world.region.dimensions.begin(), world.region.dimensions.end(),
            [](const auto& a, const auto& b) { return a.variable < b.variable; });
  const Eigen::Vector2d target = way * along;
  world.action = {"Go()",
                  "drive",
                  {{"target.x", target.x()},
                   {"target.y", target.y()},
                   {"target.yaw", dice.between(-3.0, 3.0)}}};
  return world;
}

}  // namespace parallax::bench
