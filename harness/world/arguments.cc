#include "harness/world/arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace parallax::harness {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

constexpr std::string_view kUnusedPose = "accepted and unused: this robot works along one line";
constexpr std::string_view kSettle = "rest at the end";
constexpr double kMaxCount = 1000.0;

constexpr ArgumentSpec number(std::string_view name, std::string_view unit, double fallback,
                              std::string_view help) {
  return {name, unit, false, fallback, true, help};
}
constexpr ArgumentSpec within(std::string_view name, double fallback, double low, double high,
                              std::string_view unit, std::string_view help) {
  return {name, unit, false, fallback, true, help, low, high};
}
/// How many of something; at most as many as `at_most` says.
constexpr ArgumentSpec count(std::string_view name, double fallback, std::string_view help,
                             std::string_view at_most = {}) {
  return {name, "1", false, fallback, true, help, 1.0, kMaxCount, true, at_most};
}
constexpr ArgumentSpec any_number(std::string_view name, std::string_view unit,
                                  std::string_view help) {
  return {name, unit, false, kNone, false, help};
}
constexpr ArgumentSpec named(std::string_view name, std::string_view what, std::string_view help,
                             bool required = true) {
  return {name, what, required, 0.0, false, help};
}
constexpr ArgumentSpec settle(double fallback_s) {
  return {"settle_s", "s", false, fallback_s, false, kSettle, 0.0};
}

constexpr std::array kGoing = {
    ArgumentSpec{"target.x", "m", true, 0.0, false, "where robot.x is to be"},
    any_number("target.y", "m", kUnusedPose),
    any_number("target.z", "m", kUnusedPose),
    any_number("target.yaw", "rad", kUnusedPose),
    number("max_speed_m_s", "m/s", 0.6, "cruising speed of the base"),
    number("acceleration_m_s2", "m/s^2", 0.8, "of the base"),
    number("goal_tolerance_m", "m", 0.005,
           "the base brakes when so near, and fails when it ends farther away"),
    ArgumentSpec{"settle_s", "s", false, 0.2, true, "rest at the goal"},
};

constexpr std::array kPickingUp = {
    named("object", "body", "the free body to pick up"),
    ArgumentSpec{"grip_force_n", "n", false, kNone, true,
                 "squeezing force; unless given, the robot's"},
    number("tool_tolerance_m", "m", 0.012, "the reach axis brakes when so near to the object"),
    ArgumentSpec{"grasp_height_m", "m", false, 0.0, false,
                 "middle of the pads above the object's origin"},
    number("max_speed_m_s", "m/s", 0.25, "of reach and lift"),
    number("lift_speed_m_s", "m/s", 0.15, "of the lift when loaded"),
    number("close_speed_m_s", "m/s", 0.05, "of the driven pad"),
    number("hold_s", "s", 0.2, "squeezing before the lift"),
    number("settle_s", "s", 0.25, "rest after the lift"),
};

constexpr std::array kPlacing = {
    ArgumentSpec{"target.x", "m", true, 0.0, false, "where the tool is to let go"},
    any_number("target.y", "m", kUnusedPose),
    any_number("target.z", "m", kUnusedPose),
    any_number("target.yaw", "rad", kUnusedPose),
    named("object", "body", "the body that must be held; unless given, whichever is", false),
    number("tool_tolerance_m", "m", 0.012, "the reach axis brakes when so near to the target"),
    number("max_speed_m_s", "m/s", 0.25, "of reach and of the empty lift"),
    number("lower_speed_m_s", "m/s", 0.15, "of the loaded lift"),
    number("open_speed_m_s", "m/s", 0.10, "of the driven pad"),
    number("settle_s", "s", 0.25, "rest after the gripper has left"),
};

constexpr std::array kDrive = {
    named("place", "place", "where to drive, unless the target says", false),
    any_number("target.x", "m", "laid over the place"),
    any_number("target.y", "m", "laid over the place"),
    any_number("target.z", "m", "accepted and unused"),
    any_number("target.yaw", "rad", "laid over the place; the heading at the end"),
    number("max_speed_m_s", "m/s", 0.6, "cruising speed"),
    number("acceleration_m_s2", "m/s^2", 1.0, "of start and braking"),
    number("max_yaw_rate_rad_s", "rad/s", 0.8, "of the turn at the goal"),
    number("yaw_acceleration_rad_s2", "rad/s^2", 1.5, "of the same"),
    number("stop_within_m", "m", 0.002, "[rad] the base brakes when so near to the goal"),
    number("goal_tolerance_m", "m", 0.05, "farther away it has failed"),
    number("yaw_tolerance_rad", "rad", 0.05, "turned farther away it has failed"),
    within("sweep_step_m", 0.01, 0.001, 1.0, "m", "between the places that are tried on the way"),
    settle(0.5),
};

constexpr std::array kLook = {
    named("place", "place", "what to look at", false),
    any_number("target.x", "m", "accepted and unused where a place is named"),
    any_number("target.y", "m", "as target.x"),
    any_number("target.z", "m", "as target.x"),
    any_number("target.yaw", "rad", "as target.x"),
    settle(0.1),
};

constexpr std::array kDetect = {
    named("kind", "kind", "what to look for: `kind` of a body, or its name"),
    count("points", 9, "points along the body that rays are cast at"),
    count("points_needed", 5, "of them, to be in the cone and not hidden", "points"),
    settle(0.1),
};

constexpr std::array kPickUp = {
    named("arm", "arm", "which arm"),
    named("object", "graspable", "the body to pick up"),
    ArgumentSpec{"effort_n", "n", false, kNone, true,
                 "squeezing force; unless given, that of the grasp"},
    number("clearance_m", "m", 0.015, "of each pad before it closes; less where it opens less"),
    number("standoff_m", "m", 0.10, "of the last, straight stretch"),
    number("max_speed_m_s", "m/s", 0.25, "of the tool"),
    number("approach_speed_m_s", "m/s", 0.15, "on the last stretch"),
    number("hold_s", "s", 0.4, "squeezing before the lift"),
    number("lift_m", "m", 0.12, "height of the lift"),
    number("lift_speed_m_s", "m/s", 0.10, "of the lift"),
    number("lift_acceleration_m_s2", "m/s^2", 0.3, "of the lift"),
    settle(0.3),
};

constexpr std::array kPlace = {
    named("arm", "arm", "which arm"),
    named("object", "body", "what must be held; unless given, whatever is", false),
    named("place", "place", "where the lowest point is to be", false),
    any_number("target.x", "m", "laid over the place"),
    any_number("target.y", "m", "laid over the place"),
    any_number("target.z", "m", "laid over the place"),
    any_number("target.yaw", "rad", "accepted and unused"),
    number("hover_m", "m", 0.12, "above the place before and after"),
    number("max_speed_m_s", "m/s", 0.25, "of the tool"),
    number("lower_speed_m_s", "m/s", 0.10, "of the loaded tool going down"),
    number("goal_tolerance_m", "m", 0.05, "farther beside the place it has failed"),
    settle(0.5),
};

constexpr std::array kOpenDrawer = {
    named("arm", "arm", "which arm"),
    named("joint", "drawer", "the slider to move"),
    number("effort_n", "n", 60.0, "squeezing force"),
    number("clearance_m", "m", 0.005, "of each pad before it closes"),
    number("standoff_m", "m", 0.20, "of the last, straight stretch"),
    number("max_speed_m_s", "m/s", 0.25, "of the tool"),
    number("approach_speed_m_s", "m/s", 0.15, "on the last stretch"),
    number("pull_speed_m_s", "m/s", 0.15, "of the drawer"),
    number("hold_s", "s", 0.1, "squeezing before the pull"),
    number("stop_tolerance_m", "m", 0.02, "farther from its stop it has failed"),
    settle(0.3),
};

constexpr std::array kCloseDrawer = {
    named("arm", "arm", "which arm"),
    named("joint", "drawer", "the slider to move"),
    number("standoff_m", "m", 0.20, "of the stretch before the palm meets the handle"),
    number("max_speed_m_s", "m/s", 0.25, "of the tool"),
    number("pull_speed_m_s", "m/s", 0.15, "of the drawer"),
    number("stop_tolerance_m", "m", 0.02, "farther from its stop it has failed"),
    settle(0.3),
};

constexpr std::array kMoveDoor = {
    named("arm", "arm", "which arm"),
    named("joint", "door", "the hinge to turn"),
    number("effort_n", "n", 60.0, "squeezing force"),
    number("clearance_m", "m", 0.005, "of each pad before it closes"),
    number("standoff_m", "m", 0.20, "of the straight stretches to and from the handle"),
    number("max_speed_m_s", "m/s", 0.25, "of the tool"),
    number("approach_speed_m_s", "m/s", 0.15, "on the last stretch"),
    number("pull_speed_m_s", "m/s", 0.20, "of the hand on its arc"),
    number("hold_s", "s", 0.1, "squeezing before the door is moved"),
    number("stop_tolerance_rad", "rad", 0.05, "farther from its stop it has failed"),
    settle(0.3),
};

constexpr std::array kPark = {
    named("arm", "arm", "which arm"),
    number("max_speed_m_s", "m/s", 0.25, "of the tool"),
    settle(0.2),
};

constexpr std::array kMoveTorso = {
    named("place", "place", "its z is the height above the lowest", false),
    any_number("height_m", "m", "laid over the place"),
    number("max_speed_m_s", "m/s", 0.05, "of the torso"),
};

constexpr std::array kOpenGripper = {
    named("arm", "arm", "which arm"),
    settle(0.5),
};

constexpr std::array kRegrip = {
    named("arm", "arm", "which arm"),
    number("effort_n", "n", 40.0, "squeezing force from now on"),
    number("hold_s", "s", 0.3, "squeezing before the end"),
};

constexpr RobotKind kMobile = RobotKind::kMobile;

constexpr std::array kControllers = {
    ControllerSpec{"close-door", kMoveDoor, "leads a door shut by its handle", kMobile},
    ControllerSpec{"close-drawer", kCloseDrawer, "pushes a drawer shut by its handle", kMobile},
    ControllerSpec{"detect", kDetect, "looks for bodies of a kind where the camera points",
                   kMobile},
    ControllerSpec{"drive", kDrive, "drives straight to a pose and turns there", kMobile},
    ControllerSpec{"going", kGoing, "drives the base along x"},
    ControllerSpec{"look", kLook, "points the camera at a place", kMobile},
    ControllerSpec{"move-torso", kMoveTorso, "lifts or lowers the torso", kMobile},
    ControllerSpec{"open-door", kMoveDoor, "leads a door open by its handle", kMobile},
    ControllerSpec{"open-drawer", kOpenDrawer, "pulls a drawer open by its handle", kMobile},
    ControllerSpec{"open-gripper", kOpenGripper, "opens a gripper wide", kMobile},
    ControllerSpec{"park", kPark, "brings the tool to where it is carried", kMobile},
    ControllerSpec{"pick-up", kPickUp, "grasps a body by friction and lifts it", kMobile},
    ControllerSpec{"picking-up", kPickingUp, "grasps a body between the pads and lifts it"},
    ControllerSpec{"place", kPlace, "sets down what is held", kMobile},
    ControllerSpec{"placing", kPlacing, "sets down what is held"},
    ControllerSpec{"regrip", kRegrip, "squeezes what is held with another force", kMobile},
};

std::string quoted(std::string_view name) { return "`" + std::string(name) + "`"; }

const PlaceSpec* find_place(const WorldSpec& world, std::string_view name) {
  const auto found = std::find_if(world.places.begin(), world.places.end(),
                                  [&](const PlaceSpec& place) { return place.name == name; });
  return found == world.places.end() ? nullptr : &*found;
}

bool is_kind(const WorldLayout& layout, std::string_view name) {
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    const BodySpec& body = layout.bodies[layout.bodies.id_at(i)];
    if (layout.is_free[i] && body.kind_name() == name) return true;
  }
  return false;
}

}  // namespace

bool is_name(const ArgumentSpec& argument) {
  static constexpr std::array<std::string_view, 7> kNames = {"arm",  "body",      "door", "drawer",
                                                             "kind", "graspable", "place"};
  return std::find(kNames.begin(), kNames.end(), argument.unit) != kNames.end();
}

ArgumentBounds bounds_of(const ArgumentSpec& argument) {
  // Generous: what is beyond them is a slip of the pen, and would overflow or never end.
  struct Limit {
    std::string_view unit;
    double largest;
  };
  static constexpr std::array<Limit, 8> kLimits = {{{"1", 1e6},
                                                    {"m", 1000.0},
                                                    {"m/s", 100.0},
                                                    {"m/s^2", 1000.0},
                                                    {"n", 1e6},
                                                    {"rad", 1000.0},
                                                    {"rad/s", 100.0},
                                                    {"s", 86400.0}}};
  const auto found = std::find_if(kLimits.begin(), kLimits.end(),
                                  [&](const Limit& limit) { return limit.unit == argument.unit; });
  const double largest = found == kLimits.end() ? 1000.0 : found->largest;
  const double low = argument.positive ? 0.0 : -largest;
  return {std::isnan(argument.low) ? low : argument.low,
          std::isnan(argument.high) ? largest : argument.high,
          argument.positive && std::isnan(argument.low)};
}

std::span<const ControllerSpec> controllers() { return kControllers; }

const ControllerSpec* find_controller(std::string_view name) {
  const auto found = std::find_if(kControllers.begin(), kControllers.end(),
                                  [&](const ControllerSpec& spec) { return spec.name == name; });
  return found == kControllers.end() ? nullptr : &*found;
}

std::optional<double> as_number(const Value& value) {
  if (const double* number = std::get_if<double>(&value)) return *number;
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return static_cast<double>(*integer);
  return std::nullopt;
}

const ArgumentSpec* find_argument(const ControllerSpec& spec, std::string_view name) {
  const auto found = std::find_if(spec.arguments.begin(), spec.arguments.end(),
                                  [&](const ArgumentSpec& one) { return one.name == name; });
  return found == spec.arguments.end() ? nullptr : &*found;
}

std::string wrong_name(const ArgumentSpec& argument, std::string_view name, const WorldSpec& world,
                       const WorldLayout& layout) {
  const auto fault = [&](const char* what) { return "is " + quoted(name) + ", which " + what; };
  if (argument.unit == "body" || argument.unit == "graspable") {
    const auto body = layout.find_body(name);
    if (!body || !layout.is_free[body->index()]) return fault("does not name a free body");
    if (argument.unit == "graspable" && !layout.bodies[*body].grasp) return fault("has no `grasp`");
  } else if (argument.unit == "arm") {
    const auto is_it = [&](const ArmSpec& arm) { return arm.name == name; };
    if (!world.mobile ||
        std::none_of(world.mobile->arms.begin(), world.mobile->arms.end(), is_it)) {
      return fault("does not name an arm");
    }
  } else if (argument.unit == "place") {
    if (find_place(world, name) == nullptr) return fault("does not name a place");
  } else if (argument.unit == "drawer") {
    const auto slider = layout.find_slider(name);
    if (!slider) return fault("does not name a slider");
    const JointSpec& joint = layout.sliders[*slider];
    if (!joint.handle) return fault("has no `handle`");
    if (!joint.low_m || !joint.high_m) return fault("has no stops");
  } else if (argument.unit == "door") {
    const auto hinge = layout.find_hinge(name);
    if (!hinge) return fault("does not name a hinge");
    if (!layout.hinges[*hinge].handle) return fault("has no `handle`");
  } else if (argument.unit == "kind" && !is_kind(layout, name)) {
    return fault("is no kind of a free body");
  }
  return {};
}

std::string wrong_number(const ArgumentSpec& argument, double value) {
  const ArgumentBounds bounds = bounds_of(argument);
  const bool inside = (bounds.low_open ? value > bounds.low : value >= bounds.low) &&
                      value <= bounds.high && (!argument.whole || std::floor(value) == value);
  if (inside) return {};
  return fmt::format("is {:g}, but must be {}{} {:g} {} {:g}", value,
                     argument.whole ? "a whole number " : "", bounds.low_open ? "above" : "from",
                     bounds.low, bounds.low_open ? "and at most" : "to", bounds.high);
}

std::optional<ArgumentFault> wrong_together(const ControllerSpec& spec, const State& given) {
  const auto value_of = [&](const ArgumentSpec& argument) {
    const auto found = given.find(argument.name);
    return found == given.end() ? argument.fallback
                                : as_number(found->second).value_or(argument.fallback);
  };
  for (const ArgumentSpec& one : spec.arguments) {
    if (one.at_most.empty()) continue;
    const ArgumentSpec& other = *find_argument(spec, one.at_most);
    const double value = value_of(one), most = value_of(other);
    if (!(value > most)) continue;
    if (given.contains(one.name)) {
      return ArgumentFault{std::string(one.name),
                           fmt::format("is {:g}, above the {:g} of `{}`", value, most, other.name)};
    }
    return ArgumentFault{std::string(other.name),
                         fmt::format("is {:g}, below the {:g} of `{}`", most, value, one.name)};
  }
  return std::nullopt;
}

namespace {

/// The same of a robot on a line, whose squeeze has another name and no fallback but the robot's.
std::optional<ArgumentFault> wrong_grip_force(const ControllerSpec& spec, const State& given,
                                              const WorldSpec& world, const WorldLayout& layout) {
  constexpr const char* kForce = "grip_force_n";
  const auto said = given.find(kForce);
  const auto finger = layout.find_slider(world.robot.finger_joint);
  if (find_argument(spec, kForce) == nullptr || said == given.end() || !finger) return std::nullopt;
  const double force = as_number(said->second).value_or(0.0);
  const double most = layout.sliders[*finger].max_force_n;
  if (!(force > most)) return std::nullopt;
  return ArgumentFault{kForce, fmt::format("is {:g} N, more than the {:g} N (max_force_n) of {}",
                                           force, most, quoted(world.robot.finger_joint))};
}

}  // namespace

std::optional<ArgumentFault> wrong_effort(const ControllerSpec& spec, const State& given,
                                          const WorldSpec& world, const WorldLayout& layout) {
  if (spec.robot == RobotKind::kLine) return wrong_grip_force(spec, given, world, layout);
  const ArgumentSpec* effort = find_argument(spec, "effort_n");
  if (effort == nullptr || !world.mobile) return std::nullopt;
  const auto name_of = [&](const char* argument) {
    const auto found = given.find(argument);
    const auto* text = found == given.end() ? nullptr : std::get_if<std::string>(&found->second);
    return text == nullptr ? std::string() : *text;
  };
  const auto& arms = world.mobile->arms;
  const auto arm = std::find_if(arms.begin(), arms.end(),
                                [&](const ArmSpec& one) { return one.name == name_of("arm"); });
  const auto finger = arm == arms.end() ? std::nullopt : layout.find_slider(arm->finger_joint);
  if (!finger) return std::nullopt;
  const double most = layout.sliders[*finger].max_force_n;

  const auto said = given.find("effort_n");
  if (said != given.end()) {
    const double force = as_number(said->second).value_or(0.0);
    if (!(force > most)) return std::nullopt;
    return ArgumentFault{
        "effort_n", fmt::format("is {:g} N, more than the {:g} N (max_force_n) of {}", force, most,
                                quoted(arm->finger_joint))};
  }
  if (effort->fallback > most) {
    return ArgumentFault{
        "arm", fmt::format("is {}: the {:g} N of `effort_n` are more than the "
                           "{:g} N (max_force_n) of {}",
                           quoted(arm->name), effort->fallback, most, quoted(arm->finger_joint))};
  }
  const auto body = layout.find_body(name_of("object"));
  if (!body || !layout.bodies[*body].grasp) return std::nullopt;
  const double force = layout.bodies[*body].grasp->effort_n;
  if (!(force > most)) return std::nullopt;
  return ArgumentFault{
      "object", fmt::format("is {}, whose grasp asks for {:g} N (effort_n), more than the {:g} N "
                            "(max_force_n) of {}",
                            quoted(name_of("object")), force, most, quoted(arm->finger_joint))};
}

std::vector<std::string> names_for(const ArgumentSpec& argument, const WorldSpec& world,
                                   const WorldLayout& layout) {
  std::vector<std::string> names;
  for (const BodySpec& body : layout.bodies) {
    names.push_back(argument.unit == "kind" ? body.kind_name() : body.name);
  }
  for (const JointSpec& joint : layout.sliders) names.push_back(joint.name);
  for (const JointSpec& joint : layout.hinges) names.push_back(joint.name);
  for (const PlaceSpec& place : world.places) names.push_back(place.name);
  if (world.mobile) {
    for (const ArmSpec& arm : world.mobile->arms) names.push_back(arm.name);
  }
  std::erase_if(names, [&](const std::string& name) {
    return !wrong_name(argument, name, world, layout).empty();
  });
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

std::variant<Arguments, std::string> Arguments::check(const ControllerSpec& spec,
                                                      const State& given, const WorldSpec& world,
                                                      const WorldLayout& layout) {
  Arguments arguments(spec, world, layout);
  for (const auto& [name, value] : given) {
    const ArgumentSpec* known = find_argument(spec, name);
    if (known == nullptr) return quoted(spec.name) + " takes no argument " + quoted(name);
    if (is_name(*known)) {
      const auto* text = std::get_if<std::string>(&value);
      if (text == nullptr) return "argument " + quoted(name) + " is not a name";
      const std::string fault = wrong_name(*known, *text, world, layout);
      if (!fault.empty()) return "argument " + quoted(name) + " " + fault;
      arguments.names_.emplace(name, *text);
      continue;
    }
    const std::optional<double> number = as_number(value);
    if (!number || !std::isfinite(*number)) {
      return "argument " + quoted(name) + " is not a finite number";
    }
    const std::string fault = wrong_number(*known, *number);
    if (!fault.empty()) return "argument " + quoted(name) + " " + fault;
    arguments.numbers_.emplace(name, *number);
  }
  if (const auto fault = wrong_together(spec, given)) {
    return "argument " + quoted(fault->name) + " " + fault->text;
  }
  if (const auto fault = wrong_effort(spec, given, world, layout)) {
    return "argument " + quoted(fault->name) + " " + fault->text;
  }
  for (const ArgumentSpec& one : spec.arguments) {
    if (!one.required || given.find(one.name) != given.end()) continue;
    return quoted(spec.name) + " needs the argument " + quoted(one.name);
  }
  return arguments;
}

double Arguments::number(std::string_view name) const {
  if (const auto found = numbers_.find(name); found != numbers_.end()) return found->second;
  const ArgumentSpec* known = find_argument(*spec_, name);
  return known == nullptr ? std::numeric_limits<double>::quiet_NaN() : known->fallback;
}

std::optional<std::string> Arguments::text(std::string_view name) const {
  const auto found = names_.find(name);
  if (found == names_.end()) return std::nullopt;
  return found->second;
}

std::optional<BodyId> Arguments::body(std::string_view name) const {
  const auto found = text(name);
  return found ? layout_->find_body(*found) : std::nullopt;
}

std::optional<SliderId> Arguments::slider(std::string_view name) const {
  const auto found = text(name);
  return found ? layout_->find_slider(*found) : std::nullopt;
}

std::optional<HingeId> Arguments::hinge(std::string_view name) const {
  const auto found = text(name);
  return found ? layout_->find_hinge(*found) : std::nullopt;
}

const PlaceSpec* Arguments::place(std::string_view name) const {
  const auto found = text(name);
  return found ? find_place(*world_, *found) : nullptr;
}

}  // namespace parallax::harness
