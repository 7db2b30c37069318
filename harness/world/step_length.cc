// Steps of the engine that are so long that something thin may be passed through.
//
// In one step a body covers speed times timestep. If that is more than the thickness of the
// thinnest thing involved, two bodies may change sides without a contact in between. For the
// speeds of a controller the thinnest is looked for among what the controller moves and all that
// this may collide with; a rate of turn counts as the speed of the part that is farthest from
// the axis of the base. A free body may fall from its default place to the highest top below it,
// or to the floor, and arrives at sqrt(2 g h). Places are compared as boxes round the bodies.
// The thickness is the least size of a shape, of a hull also the least extent along the normals
// of its faces.
//
// Cost: quadratic in the bodies.

#include "harness/world/step_length.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "harness/world/shapes.h"

namespace parallax::harness {
namespace {

constexpr double kFar_m = std::numeric_limits<double>::infinity();

/// The body and all that it carries by joints, whatever their type.
std::set<std::string> carried_by(const std::string& body, const WorldSpec& world) {
  std::set<std::string> out = {body};
  for (std::size_t before = 0; before != out.size();) {
    before = out.size();
    for (const JointSpec& joint : world.joints) {
      if (out.contains(joint.parent)) out.insert(joint.child);
    }
  }
  return out;
}

void add_child_of(const std::string& name, const WorldSpec& world, std::set<std::string>& moved) {
  for (const JointSpec& joint : world.joints) {
    if (joint.name == name) moved.merge(carried_by(joint.child, world));
  }
}

std::set<std::string> moved_by(const ControllerSpec& controller, const State& given,
                               const WorldSpec& world) {
  std::set<std::string> moved;
  const bool moves_base = controller.name == "going" || controller.name == "drive";
  if (!world.mobile) {
    const LineRobotSpec& robot = world.robot;
    add_child_of(moves_base ? robot.base_joint : robot.reach_joint, world, moved);
    return moved;
  }
  const MobileRobotSpec& robot = *world.mobile;
  if (moves_base) return carried_by(robot.base_body, world);
  if (controller.name == "move-torso") {
    add_child_of(robot.torso_joint, world, moved);
    return moved;
  }
  const auto named = given.find("arm");
  const auto* only = named == given.end() ? nullptr : std::get_if<std::string>(&named->second);
  for (const ArmSpec& arm : robot.arms) {
    const bool is_other =
        only != nullptr && *only != arm.name && only->find('{') == std::string::npos;
    if (!is_other) moved.merge(carried_by(arm.palm_body, world));
  }
  return moved;
}

struct Thinnest {
  std::string body;
  double thickness_m = kFar_m;
  void note(const BodySpec& one) {
    for (const BodyShape& shape : one.shapes) {
      const double here_m = parallax::harness::thickness_m(shape);
      if (here_m >= thickness_m) continue;
      thickness_m = here_m;
      body = one.name;
    }
  }
};

/// The thinnest shape among the moved bodies and all bodies that they may meet.
Thinnest thinnest_at(const std::set<std::string>& moved, const WorldLayout& layout) {
  Thinnest thinnest;
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    const BodyId id = layout.bodies.id_at(i);
    if (!layout.bodies[id].collides) continue;
    const bool is_met =
        moved.contains(layout.bodies[id].name) ||
        std::any_of(moved.begin(), moved.end(), [&](const std::string& name) {
          const auto mover = layout.find_body(name);
          return mover && layout.bodies[*mover].collides && !layout.never_collide(*mover, id);
        });
    if (is_met) thinnest.note(layout.bodies[id]);
  }
  return thinnest;
}

/// The box round a body as it stands by default.
struct Box {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(kFar_m);
  Eigen::Vector3d high = Eigen::Vector3d::Constant(-kFar_m);
  bool is_over(const Box& other) const {
    return (low.head<2>().array() < other.high.head<2>().array()).all() &&
           (other.low.head<2>().array() < high.head<2>().array()).all();
  }
};

Box box_round(const BodySpec& body) {
  const Eigen::Matrix3d R_WB =
      Eigen::AngleAxisd(body.yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  Box box;
  for (const BodyShape& shape : body.shapes) {
    const Eigen::Vector3d p_WS = body.p_WB + R_WB * shape.p_BS;
    const auto [low, high] =
        span(shape.form, shape.size_m, shape.hull.get(), R_WB * shape_rotation(shape));
    box.low = box.low.cwiseMin(p_WS + low);
    box.high = box.high.cwiseMax(p_WS + high);
  }
  return box;
}

/// How far the robot's parts are from the axis that its base turns about.
double radius_m(const std::set<std::string>& moved, const WorldSpec& world,
                const WorldLayout& layout) {
  const Eigen::Vector3d axis = layout.bodies[*layout.find_body(world.mobile->base_body)].p_WB;
  double out_m = 0.0;
  for (const std::string& name : moved) {
    const Box box = box_round(layout.bodies[*layout.find_body(name)]);
    const Eigen::Vector2d far =
        (box.low - axis).cwiseAbs().cwiseMax((box.high - axis).cwiseAbs()).head<2>();
    if (std::isfinite(far.norm())) out_m = std::max(out_m, far.norm());
  }
  return out_m;
}

}  // namespace

double thickness_m(const BodyShape& shape) {
  double least_m = shape.size_m.minCoeff();
  if (shape.form != ShapeForm::kHull || shape.hull == nullptr) return least_m;
  const ConvexHull& hull = *shape.hull;
  for (std::size_t i = 0; i < hull.normals.size(); ++i) {
    double behind = kFar_m;
    for (const Eigen::Vector3d& p : hull.vertices)
      behind = std::min(behind, hull.normals[i].dot(p));
    least_m = std::min(least_m, hull.offsets[i] - behind);
  }
  return least_m;
}

bool is_speed(const ArgumentSpec& argument) {
  return argument.unit == "m/s" || argument.unit == "rad/s";
}

std::vector<LongStep> long_steps(const ControllerSpec& controller, const State& given,
                                 const WorldSpec& world, const WorldLayout& layout) {
  std::vector<LongStep> out;
  std::set<std::string> moved;
  Thinnest thinnest;
  for (const ArgumentSpec& argument : controller.arguments) {
    if (!is_speed(argument)) continue;
    if (moved.empty()) {
      moved = moved_by(controller, given, world);
      thinnest = thinnest_at(moved, layout);
    }
    const auto found = given.find(std::string(argument.name));
    const auto number =
        found == given.end() ? std::optional<double>(argument.fallback) : as_number(found->second);
    if (!number) continue;
    const double speed_m_s =
        argument.unit == "rad/s" ? *number * radius_m(moved, world, layout) : *number;
    const double step_m = speed_m_s * world.solver.timestep_s;
    if (!(step_m > thinnest.thickness_m)) continue;
    out.push_back(
        {std::string(argument.name), {}, speed_m_s, step_m, thinnest.body, thinnest.thickness_m});
  }
  return out;
}

std::vector<LongStep> long_falls(const WorldSpec& world, const WorldLayout& layout) {
  std::vector<LongStep> out;
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    const BodyId id = layout.bodies.id_at(i);
    const BodySpec& body = layout.bodies[id];
    if (!layout.is_free[i] || !body.gravity || !body.collides) continue;
    const Box box = box_round(body);
    double top_m = 0.0;  // of the floor
    const BodySpec* below = nullptr;
    for (std::size_t k = 0; k < layout.bodies.size(); ++k) {
      const BodyId other = layout.bodies.id_at(k);
      const BodySpec& one = layout.bodies[other];
      if (k == i || !one.collides || layout.never_collide(id, other)) continue;
      const Box under = box_round(one);
      if (!box.is_over(under) || under.high.z() > box.low.z() || under.high.z() <= top_m) continue;
      top_m = under.high.z();
      below = &one;
    }
    if (below == nullptr) continue;
    const double height_m = box.low.z() - top_m;
    const double speed_m_s = std::sqrt(-2.0 * world.solver.gravity_m_s2 * height_m);
    Thinnest thinnest;
    thinnest.note(body);
    thinnest.note(*below);
    const double step_m = speed_m_s * world.solver.timestep_s;
    if (!(step_m > thinnest.thickness_m)) continue;
    out.push_back({{}, body.name, speed_m_s, step_m, thinnest.body, thinnest.thickness_m});
  }
  return out;
}

}  // namespace parallax::harness
