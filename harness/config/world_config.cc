#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "compiler/base/codes/scenarios.h"
#include "harness/config/sections.h"
#include "harness/engine/world_check.h"
#include "harness/world/chain_arm.h"
#include "harness/world/density.h"
#include "harness/world/step_length.h"
#include "harness/world/world_layout.h"

namespace parallax::harness {
namespace {

SolverSpec read_solver(const YamlNode& node, base::DiagnosticSink& sink) {
  SolverSpec solver;
  YamlFields fields(node, key_text(Key::kSolver), sink);
  fields.may_be_absent();
  fields.only({Key::kTimestepS, "gravity_m_s2", Key::kErp, Key::kCfm, Key::kSurfaceLayerM,
               Key::kMaxCorrectingVelocityMS, Key::kStartPenetrationM, Key::kMaxContactsPerPair,
               Key::kSleepLinearMS, Key::kSleepAngularRadS, Key::kSleepAfterS, Key::kContactErp,
               Key::kContactCfm, Key::kHeldAfterS, Key::kHeldClearanceM, Key::kRestingJoints,
               Key::kMaxContactsPerSide});
  fields.number(Key::kContactErp, kPositive, solver.contact_erp);
  fields.number(Key::kContactCfm, kNotNegative, solver.contact_cfm);
  fields.number(Key::kHeldAfterS, kNotNegative, solver.held_after_s);
  fields.number(Key::kHeldClearanceM, kAnyNumber, solver.held_clearance_m);
  fields.integer(Key::kMaxContactsPerSide, 3, 64, solver.max_contacts_per_side);
  fields.boolean(Key::kRestingJoints, solver.resting_joints);
  fields.number(Key::kTimestepS, kPositive, solver.timestep_s);
  fields.number("gravity_m_s2", kAnyNumber, solver.gravity_m_s2);
  fields.number(Key::kErp, kNotNegative, solver.erp);
  fields.number(Key::kCfm, kNotNegative, solver.cfm);
  fields.number(Key::kSurfaceLayerM, kNotNegative, solver.surface_layer_m);
  fields.number(Key::kMaxCorrectingVelocityMS, kPositive, solver.max_correcting_velocity_m_s);
  fields.number(Key::kStartPenetrationM, kNotNegative, solver.start_penetration_m);
  fields.integer(Key::kMaxContactsPerPair, 1, 64, solver.max_contacts_per_pair);
  fields.number(Key::kSleepLinearMS, kNotNegative, solver.sleep_linear_m_s);
  fields.number(Key::kSleepAngularRadS, kNotNegative, solver.sleep_angular_rad_s);
  fields.number(Key::kSleepAfterS, kNotNegative, solver.sleep_after_s);
  return solver;
}

void read_axis(const YamlFields& fields, JointSpec& joint) {
  static constexpr std::array<std::string_view, 3> kWords = {"x", "y", "z"};
  const auto* axis = fields.find(Key::kAxis);
  if (axis == nullptr) return;
  if (axis->is_list()) {
    read_vector(fields, Key::kAxis, joint.axis_W);
  } else if (const auto word = fields.choice(Key::kAxis, Key::kAxis, kWords, 0)) {
    joint.axis_W = Eigen::Vector3d::Unit(static_cast<Eigen::Index>(*word));
  }
}

/// Keys that say nothing of a joint of this type would be read past without a word.
void refuse_other_types(const YamlFields& fields, JointType type) {
  const auto refuse = [&](std::string_view key, std::string_view others) {
    const auto* node = fields.find(key);
    if (node == nullptr) return;
    fields.sink()
        .error(codes::kUnknownKey, node->range, key,
               fmt::format("{}: it belongs to {}", fields.what(), others))
        .help("Remove it, or change the type of the joint.");
  };
  if (type == JointType::kHinge) {
    refuse(Key::kRangeM, "sliders (a hinge has `range_rad`)");
    refuse(Key::kMaxForceN, "sliders (a hinge has `max_torque_nm`)");
    refuse(Key::kDampingNSM, "sliders (a hinge has `damping_nm_s`)");
  } else {
    for (const auto key : {Key::kAtM, Key::kRangeRad, Key::kDampingNmS}) refuse(key, "hinges");
    if (type != JointType::kSlider) refuse(Key::kDampingNSM, "sliders");
  }
  if (type != JointType::kGantry) refuse(Key::kSuspension, "gantries");
  if (type != JointType::kSlider && type != JointType::kHinge) {
    refuse(Key::kFollows, "sliders and hinges");
  }
}

FollowSpec read_follows(const YamlNode& node, base::DiagnosticSink& sink) {
  FollowSpec follows;
  YamlFields fields(node, key_text(Key::kFollows), sink);
  fields.only({Key::kJoint, Key::kRatio});
  fields.require(Key::kJoint);
  fields.text(Key::kJoint, follows.leader);
  fields.number(Key::kRatio, kAnyNumber, follows.ratio);
  return follows;
}

SuspensionSpec read_suspension(const YamlNode& node, base::DiagnosticSink& sink) {
  SuspensionSpec springs;
  YamlFields fields(node, key_text(Key::kSuspension), sink);
  fields.only({Key::kStiffnessNM, Key::kDampingNSM, Key::kStiffnessNmRad, Key::kDampingNmS});
  fields.require(Key::kStiffnessNM);
  fields.require(Key::kStiffnessNmRad);
  fields.number(Key::kStiffnessNM, kPositive, springs.stiffness_n_m);
  fields.number(Key::kDampingNSM, kNotNegative, springs.damping_n_s_m);
  fields.number(Key::kStiffnessNmRad, kPositive, springs.stiffness_nm_rad);
  fields.number(Key::kDampingNmS, kNotNegative, springs.damping_nm_s);
  return springs;
}

/// Two numbers, or nothing in the place of one of them: no stop on that side.
void read_stops(const YamlFields& fields, std::string_view key, std::optional<double>& low,
                std::optional<double>& high) {
  const YamlNode* range = fields.find(key);
  const auto is_none = [](const YamlNode& node) { return node.kind == YamlNode::Kind::kNull; };
  if (range != nullptr && range->is_list() && range->items.size() == 2 &&
      is_none(range->items[0]) != is_none(range->items[1])) {
    const bool has_low = is_none(range->items[1]);
    (has_low ? low : high) =
        read_number(range->items[has_low ? 0 : 1], key_text(key), kAnyNumber, fields.sink());
  } else if (const auto both = fields.numbers(key, 2)) {
    low = (*both)[0];
    high = (*both)[1];
  }
}

JointSpec read_joint(const YamlEntry& entry, base::DiagnosticSink& sink) {
  static constexpr std::array<std::string_view, 4> kTypes = {"slider", "fixed", "gantry", "hinge"};
  JointSpec joint;
  joint.name = entry.key;
  YamlFields fields(entry.value, fmt::format("the joint `{}`", entry.key), sink);
  fields.only({Key::kType, Key::kParent, Key::kChild, Key::kAxis, Key::kRangeM, Key::kMaxForceN,
               Key::kMaxTorqueNm, Key::kHandle, Key::kAtM, Key::kRangeRad, Key::kDampingNSM,
               Key::kDampingNmS, Key::kSuspension, Key::kFollows});
  const auto type = fields.choice(Key::kType, "type of joint", kTypes, 0);
  if (type == std::size_t{1}) joint.type = JointType::kFixed;
  if (type == std::size_t{2}) joint.type = JointType::kGantry;
  if (type == std::size_t{3}) {
    joint.type = JointType::kHinge;
    joint.max_torque_nm = 0.0;  // free, as a slider is
    fields.require(Key::kAtM);
  }
  refuse_other_types(fields, joint.type);
  joint.parent = "world";
  fields.text(Key::kParent, joint.parent);
  if (joint.parent == "world") joint.parent.clear();
  fields.require(Key::kChild);
  fields.text(Key::kChild, joint.child);
  read_axis(fields, joint);
  read_stops(fields, Key::kRangeM, joint.low_m, joint.high_m);
  read_vector(fields, Key::kAtM, joint.p_WA);
  read_stops(fields, Key::kRangeRad, joint.low_rad, joint.high_rad);
  fields.number(Key::kDampingNSM, kNotNegative, joint.damping_n_s_m);
  fields.number(Key::kDampingNmS, kNotNegative, joint.damping_nm_s);
  fields.number(Key::kMaxForceN, kNotNegative, joint.max_force_n);
  fields.number(Key::kMaxTorqueNm, kNotNegative, joint.max_torque_nm);
  if (const auto* handle = fields.find(Key::kHandle)) joint.handle = read_handle(*handle, sink);
  if (const auto* springs = fields.find(Key::kSuspension)) {
    joint.suspension = read_suspension(*springs, sink);
  }
  if (const auto* follows = fields.find(Key::kFollows))
    joint.follows = read_follows(*follows, sink);
  return joint;
}

/// Keys are `default` or two materials joined by a hyphen, in either order.
FrictionSpec read_friction(const YamlNode& node, const std::vector<std::string>& materials,
                           base::DiagnosticSink& sink) {
  FrictionSpec friction;
  YamlFields fields(node, key_text(Key::kFriction), sink);
  fields.may_be_absent();
  fields.number(Key::kDefault, kNotNegative, friction.fallback);
  for (const auto& entry : node.entries) {
    if (entry.key == Key::kDefault) continue;
    const auto hyphen = entry.key.find('-');
    std::array<std::string, 2> pair = {
        entry.key.substr(0, hyphen),
        hyphen == std::string::npos ? std::string() : entry.key.substr(hyphen + 1)};
    bool known = true;
    for (const auto& material : pair) {
      if (std::find(materials.begin(), materials.end(), material) != materials.end()) continue;
      known = false;
      auto error = sink.error(codes::kYamlUnknownChoice, entry.key_range, material,
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

/// Warns of odd densities of the bodies that the robot is to move. The engine makes the robot's own
/// parts and furniture.
void warn_of_densities(const YamlNode& node, const WorldSpec& world, base::DiagnosticSink& sink) {
  const WorldLayout layout = lay_out(world);
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    const BodySpec& body = layout.bodies[layout.bodies.id_at(i)];
    if (!layout.is_free[i]) continue;
    if (const auto odd = odd_density(body, body.mass_kg)) {
      const auto path = "bodies/" + body.name + "/mass_kg";
      sink.warning(codes::kOddDensity, range_of(node, path), path,
                   fmt::format("`{}` a thing", body.name), density_kg_m3(body, body.mass_kg), *odd);
    }
  }
}

void warn_of_falls(const YamlNode& node, const WorldSpec& world, base::DiagnosticSink& sink) {
  for (const LongStep& one : long_falls(world, lay_out(world))) {
    const auto path = "bodies/" + one.body;
    sink.warning(codes::kLongStep, range_of(node, path + "/position_m"), path + " falls",
                 one.speed_m_s, 1e3 * one.step_m, 1e3 * world.solver.timestep_s, one.thin_body,
                 1e3 * one.thickness_m);
  }
}

}  // namespace

WorldSpec read_world(const YamlNode& node, EngineKind engine, base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  WorldSpec world;
  world.engine = engine;
  YamlFields fields(node, key_text(Key::kWorld), sink);
  fields.only({Key::kInclude, Key::kSolver, Key::kFriction, Key::kFloorMaterial, Key::kBodies,
               Key::kJoints, Key::kPlaces, Key::kRobot, Key::kSdf, Key::kUrdf, Key::kMjcf,
               Key::kModels, Key::kPackages});  // the last five were taken over before
  fields.text(Key::kFloorMaterial, world.floor_material);
  if (const auto* solver = fields.find(Key::kSolver)) world.solver = read_solver(*solver, sink);
  if (const auto* bodies = fields.require(Key::kBodies)) {
    const YamlFields all(*bodies, key_text(Key::kBodies), sink);
    for (const auto& entry : bodies->entries) world.bodies.push_back(read_body(entry, sink));
  }
  if (const auto* joints = fields.find(Key::kJoints)) {
    const YamlFields all(*joints, key_text(Key::kJoints), sink);
    all.may_be_absent();
    for (const auto& entry : joints->entries) world.joints.push_back(read_joint(entry, sink));
  }
  if (const auto* places = fields.find(Key::kPlaces)) {
    const YamlFields all(*places, key_text(Key::kPlaces), sink);
    all.may_be_absent();
    for (const auto& entry : places->entries) world.places.push_back(read_place(entry, sink));
  }
  if (const auto* robot = fields.find(Key::kRobot)) read_robot(*robot, world, sink);
  if (const auto* friction = fields.find(Key::kFriction)) {
    world.friction = read_friction(*friction, materials_of(world), sink);
  }
  // Laid over an included world, bodies may come in any order; the result must not depend on it.
  const auto by_name = [](const auto& a, const auto& b) { return a.name < b.name; };
  std::sort(world.bodies.begin(), world.bodies.end(), by_name);
  std::sort(world.joints.begin(), world.joints.end(), by_name);
  std::sort(world.places.begin(), world.places.end(), by_name);
  if (sink.error_count() != errors_before) return world;
  complete_chains(world);
  for (const auto& problem : check_world(world)) {
    auto error =
        sink.error(codes::kBadWorld, range_of(node, problem.path), problem.path, problem.message);
    if (!problem.suggestion.empty()) error.fix(fmt::format("write `{}`", problem.suggestion));
  }
  if (sink.error_count() == errors_before) {
    warn_of_densities(node, world, sink);
    warn_of_falls(node, world, sink);
  }
  return world;
}

}  // namespace parallax::harness
