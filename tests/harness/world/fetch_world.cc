#include "tests/harness/world/fetch_world.h"

namespace parallax::harness {
namespace {

BodySpec body(std::string name, std::string material, double mass_kg, Eigen::Vector3d p_WB,
              std::vector<BodyShape> shapes) {
  BodySpec spec;
  spec.name = std::move(name);
  spec.material = std::move(material);
  spec.mass_kg = mass_kg;
  spec.p_WB = p_WB;
  spec.shapes = std::move(shapes);
  return spec;
}

BodyShape box(double x_m, double y_m, double z_m, Eigen::Vector3d p_BS = Eigen::Vector3d::Zero()) {
  return BodyShape{{x_m, y_m, z_m}, p_BS};
}

JointSpec slider(std::string name, std::string parent, std::string child, Eigen::Vector3d axis_W,
                 double low_m, double high_m, double max_force_n) {
  JointSpec spec;
  spec.name = std::move(name);
  spec.parent = std::move(parent);
  spec.child = std::move(child);
  spec.axis_W = axis_W;
  spec.low_m = low_m;
  spec.high_m = high_m;
  spec.max_force_n = max_force_n;
  return spec;
}

void add_robot(WorldSpec& spec) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                        z = Eigen::Vector3d::UnitZ();
  BodySpec base = body("base", "steel", 30.0, {0.5, -0.6, 0.20},
                       {box(0.50, 0.40, 0.30), box(0.10, 0.10, 0.25, {0.0, 0.0, 0.275})});
  base.settable = {"x"};
  spec.bodies.push_back(base);
  spec.bodies.push_back(body("arm", "steel", 3.0, {0.5, -0.3, 0.50}, {box(0.06, 0.60, 0.06)}));
  spec.bodies.push_back(body("palm", "steel", 0.6, {0.5, 0.0, 0.305}, {box(0.06, 0.16, 0.04)}));
  const BodyShape pad = box(0.02, 0.01, 0.05);
  spec.bodies.push_back(body("near_pad", "pad", 0.1, {0.5, -0.05, 0.24}, {pad}));
  spec.bodies.push_back(body("far_pad", "pad", 0.1, {0.5, 0.05, 0.24}, {pad}));

  spec.joints.push_back(slider("drive", "", "base", x, -1.0, 2.5, 400.0));
  spec.joints.push_back(slider("reach", "base", "arm", x, -0.6, 0.6, 200.0));
  spec.joints.push_back(slider("lift", "arm", "palm", z, -0.21, 0.05, 200.0));
  spec.joints.push_back(slider("finger", "palm", "far_pad", y, -0.085, 0.0, 20.0));
  JointSpec weld;
  weld.name = "near_pad_weld";
  weld.type = JointType::kFixed;
  weld.parent = "palm";
  weld.child = "near_pad";
  spec.joints.push_back(weld);

  spec.robot = {"drive", "base", "reach", "lift", "finger", "near_pad", "far_pad", 20.0, 0.09};
}

}  // namespace

WorldSpec fetch_world() {
  WorldSpec spec;
  spec.friction.fallback = 0.5;
  spec.friction.pairs[{"box", "floor"}] = 0.5;
  spec.friction.pairs[{"box", "pad"}] = 0.6;
  add_robot(spec);
  BodySpec item = body("box", "box", 0.3, {1.5, 0.0, 0.035}, {box(0.07, 0.07, 0.07)});
  item.settable = {"x", "y", "yaw"};
  spec.bodies.push_back(item);
  return spec;
}

double number(const State& state, std::string_view name) {
  return std::get<double>(state.find(name)->second);
}
bool flag(const State& state, std::string_view name) {
  return std::get<bool>(state.find(name)->second);
}
std::string text(const State& state, std::string_view name) {
  return std::get<std::string>(state.find(name)->second);
}

}  // namespace parallax::harness
