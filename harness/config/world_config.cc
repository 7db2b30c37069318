#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "compiler/base/diagnostic_codes.h"
#include "harness/config/sections.h"
#include "harness/world/world_check.h"

namespace parallax::harness {
namespace {

using base::DiagnosticCode;

void read_vector(const YamlFields& fields, std::string_view key, Eigen::Vector3d& out) {
  if (const auto values = fields.numbers(key, 3)) {
    out = Eigen::Vector3d((*values)[0], (*values)[1], (*values)[2]);
  }
}

SolverSpec read_solver(const YamlNode& node, base::DiagnosticSink& sink) {
  SolverSpec solver;
  YamlFields fields(node, "`solver`", sink);
  fields.only({"timestep_s", "gravity_m_s2", "erp", "cfm", "surface_layer_m",
               "max_correcting_velocity_m_s", "start_penetration_m", "max_contacts_per_pair",
               "sleep_linear_m_s", "sleep_angular_rad_s", "sleep_after_s"});
  fields.number("timestep_s", kPositive, solver.timestep_s);
  fields.number("gravity_m_s2", kAnyNumber, solver.gravity_m_s2);
  fields.number("erp", kNotNegative, solver.erp);
  fields.number("cfm", kNotNegative, solver.cfm);
  fields.number("surface_layer_m", kNotNegative, solver.surface_layer_m);
  fields.number("max_correcting_velocity_m_s", kPositive, solver.max_correcting_velocity_m_s);
  fields.number("start_penetration_m", kNotNegative, solver.start_penetration_m);
  fields.integer("max_contacts_per_pair", 1, 64, solver.max_contacts_per_pair);
  fields.number("sleep_linear_m_s", kNotNegative, solver.sleep_linear_m_s);
  fields.number("sleep_angular_rad_s", kNotNegative, solver.sleep_angular_rad_s);
  fields.number("sleep_after_s", kNotNegative, solver.sleep_after_s);
  return solver;
}

/// One word for all boxes of a body, or a list of them under `shapes`.
BoxShape read_shape(const YamlNode& node, std::string what, base::DiagnosticSink& sink) {
  BoxShape shape;
  YamlFields fields(node, std::move(what), sink);
  fields.only({"size_m", "at_m"});
  fields.require("size_m");
  read_vector(fields, "size_m", shape.size_m);
  read_vector(fields, "at_m", shape.p_BS);
  return shape;
}

void read_shapes(const YamlFields& fields, BodySpec& body) {
  const auto* list = fields.find("shapes");
  if (list == nullptr) {
    if (fields.require("size_m") == nullptr) return;
    BoxShape shape;
    read_vector(fields, "size_m", shape.size_m);
    body.shapes.push_back(shape);
    return;
  }
  if (const auto* size = fields.find("size_m")) {
    fields.sink().error(DiagnosticCode::kUnknownKey, size->range, "size_m",
                        fields.what() + ", which has `shapes`");
  }
  if (!list->is_list()) {
    fields.sink().error(DiagnosticCode::kWrongYamlKind, list->range, "`shapes`", describe(*list),
                        "a list of boxes");
    return;
  }
  for (const auto& item : list->items) {
    body.shapes.push_back(read_shape(item, "a shape of " + fields.what(), fields.sink()));
  }
}

BodySpec read_body(const YamlEntry& entry, base::DiagnosticSink& sink) {
  BodySpec body;
  body.name = entry.key;
  YamlFields fields(entry.value, fmt::format("the body `{}`", entry.key), sink);
  fields.only({"size_m", "shapes", "mass_kg", "material", "position_m", "yaw_rad", "gravity",
               "collides", "settable"});
  read_shapes(fields, body);
  fields.number("mass_kg", kNotNegative, body.mass_kg);
  fields.text("material", body.material);
  read_vector(fields, "position_m", body.p_WB);
  fields.number("yaw_rad", kAnyNumber, body.yaw_rad);
  fields.boolean("gravity", body.gravity);
  fields.boolean("collides", body.collides);
  fields.texts("settable", body.settable);
  return body;
}

void read_axis(const YamlFields& fields, JointSpec& joint) {
  static constexpr std::array<std::string_view, 3> kWords = {"x", "y", "z"};
  const auto* axis = fields.find("axis");
  if (axis == nullptr) return;
  if (axis->is_list()) {
    read_vector(fields, "axis", joint.axis_W);
  } else if (const auto word = fields.choice("axis", "axis", kWords)) {
    joint.axis_W = Eigen::Vector3d::Unit(static_cast<Eigen::Index>(*word));
  }
}

JointSpec read_joint(const YamlEntry& entry, base::DiagnosticSink& sink) {
  static constexpr std::array<std::string_view, 2> kTypes = {"slider", "fixed"};
  JointSpec joint;
  joint.name = entry.key;
  YamlFields fields(entry.value, fmt::format("the joint `{}`", entry.key), sink);
  fields.only({"type", "parent", "child", "axis", "range_m", "max_force_n"});
  if (fields.choice("type", "type of joint", kTypes) == std::size_t{1}) {
    joint.type = JointType::kFixed;
  }
  fields.text("parent", joint.parent);
  if (joint.parent == "world") joint.parent.clear();
  fields.require("child");
  fields.text("child", joint.child);
  read_axis(fields, joint);
  if (const auto range = fields.numbers("range_m", 2)) {
    joint.low_m = (*range)[0];
    joint.high_m = (*range)[1];
  }
  fields.number("max_force_n", kNotNegative, joint.max_force_n);
  return joint;
}

RobotSpec read_robot(const YamlNode& node, base::DiagnosticSink& sink) {
  RobotSpec robot;
  YamlFields fields(node, "`robot`", sink);
  fields.only({"base_joint", "base_body", "reach_joint", "lift_joint", "finger_joint",
               "near_pad_body", "far_pad_body", "grip_force_n", "opening_m"});
  fields.text("base_joint", robot.base_joint);
  fields.text("base_body", robot.base_body);
  fields.text("reach_joint", robot.reach_joint);
  fields.text("lift_joint", robot.lift_joint);
  fields.text("finger_joint", robot.finger_joint);
  fields.text("near_pad_body", robot.near_pad_body);
  fields.text("far_pad_body", robot.far_pad_body);
  fields.number("grip_force_n", kNotNegative, robot.grip_force_n);
  fields.number("opening_m", kPositive, robot.opening_m);
  return robot;
}

/// Keys are `default` or two materials joined by a hyphen, in either order.
FrictionSpec read_friction(const YamlNode& node, const std::vector<std::string>& materials,
                           base::DiagnosticSink& sink) {
  FrictionSpec friction;
  YamlFields fields(node, "`friction`", sink);
  fields.number("default", kNotNegative, friction.fallback);
  for (const auto& entry : node.entries) {
    if (entry.key == "default") continue;
    const auto hyphen = entry.key.find('-');
    std::array<std::string, 2> pair = {
        entry.key.substr(0, hyphen),
        hyphen == std::string::npos ? std::string() : entry.key.substr(hyphen + 1)};
    bool known = true;
    for (const auto& material : pair) {
      if (std::find(materials.begin(), materials.end(), material) != materials.end()) continue;
      known = false;
      auto error = sink.error(DiagnosticCode::kYamlUnknownChoice, entry.key_range, material,
                              "material (a key is `default` or two of them, as `pad-box`)");
      add_suggestion(error, material, materials, "materials");
    }
    const auto value = read_number(entry.value, fmt::format("`{}`", entry.key), kNotNegative, sink);
    std::sort(pair.begin(), pair.end());
    if (known && value) friction.pairs[{pair[0], pair[1]}] = *value;
  }
  return friction;
}

std::vector<std::string> materials_of(const WorldSpec& world) {
  std::vector<std::string> names = {world.floor_material};
  for (const auto& body : world.bodies) {
    if (!body.material.empty()) names.push_back(body.material);
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

/// The place of a path such as "bodies/box/mass_kg": as deep as the text goes along.
base::SourceRange range_of(const YamlNode& world, std::string_view path) {
  const YamlNode* node = &world;
  auto range = world.range;
  while (!path.empty()) {
    const auto slash = path.find('/');
    const auto* entry = node->find(path.substr(0, slash));
    if (entry == nullptr) break;
    range = entry->value.is_scalar() ? entry->value.range : entry->key_range;
    node = &entry->value;
    path = slash == std::string_view::npos ? std::string_view() : path.substr(slash + 1);
  }
  return range;
}

}  // namespace

WorldSpec read_world(const YamlNode& node, base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  WorldSpec world;
  YamlFields fields(node, "`world`", sink);
  fields.only({"include", "solver", "friction", "floor_material", "bodies", "joints", "robot"});
  fields.text("floor_material", world.floor_material);
  if (const auto* solver = fields.find("solver")) world.solver = read_solver(*solver, sink);
  if (const auto* bodies = fields.require("bodies")) {
    const YamlFields all(*bodies, "`bodies`", sink);
    for (const auto& entry : bodies->entries) world.bodies.push_back(read_body(entry, sink));
  }
  if (const auto* joints = fields.find("joints")) {
    const YamlFields all(*joints, "`joints`", sink);
    for (const auto& entry : joints->entries) world.joints.push_back(read_joint(entry, sink));
  }
  if (const auto* robot = fields.find("robot")) world.robot = read_robot(*robot, sink);
  if (const auto* friction = fields.find("friction")) {
    world.friction = read_friction(*friction, materials_of(world), sink);
  }
  // Laid over an included world, bodies may come in any order; the result must not depend on it.
  const auto by_name = [](const auto& a, const auto& b) { return a.name < b.name; };
  std::sort(world.bodies.begin(), world.bodies.end(), by_name);
  std::sort(world.joints.begin(), world.joints.end(), by_name);
  if (sink.error_count() != errors_before) return world;
  for (const auto& problem : check_world(world)) {
    auto error = sink.error(DiagnosticCode::kBadWorld, range_of(node, problem.path), problem.path,
                            problem.message);
    if (!problem.suggestion.empty()) error.fix(fmt::format("write `{}`", problem.suggestion));
  }
  return world;
}

}  // namespace parallax::harness
