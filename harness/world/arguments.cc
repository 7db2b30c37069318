#include "harness/world/arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace parallax::harness {
namespace {

std::string in_quotes(std::string_view name) { return "`" + std::string(name) + "`"; }

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
                                                    {"rad", 6.3},     // a turn
                                                    {"rad/s", 12.6},  // two turns a second
                                                    {"s", 86400.0}}};
  const auto found = std::find_if(kLimits.begin(), kLimits.end(),
                                  [&](const Limit& limit) { return limit.unit == argument.unit; });
  const double largest = found == kLimits.end() ? 1000.0 : found->largest;
  const double low = argument.positive ? 0.0 : -largest;
  return {std::isnan(argument.low) ? low : argument.low,
          std::isnan(argument.high) ? largest : argument.high,
          argument.positive && std::isnan(argument.low)};
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
  const auto fault = [&](const char* what) { return "is " + in_quotes(name) + ", which " + what; };
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
                                           force, most, in_quotes(world.robot.finger_joint))};
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
  const double most = layout.sliders[*finger].max_force_n /
                      grip_gain(layout, arm->finger_joint, arm->near_pad_body);

  const auto said = given.find("effort_n");
  if (said != given.end()) {
    const double force = as_number(said->second).value_or(0.0);
    if (!(force > most)) return std::nullopt;
    return ArgumentFault{
        "effort_n", fmt::format("is {:g} N, more than the {:g} N (max_force_n) of {}", force, most,
                                in_quotes(arm->finger_joint))};
  }
  if (effort->fallback > most) {
    return ArgumentFault{"arm", fmt::format("is {}: the {:g} N of `effort_n` are more than the "
                                            "{:g} N (max_force_n) of {}",
                                            in_quotes(arm->name), effort->fallback, most,
                                            in_quotes(arm->finger_joint))};
  }
  const auto body = layout.find_body(name_of("object"));
  if (!body || !layout.bodies[*body].grasp) return std::nullopt;
  const double force = layout.bodies[*body].grasp->effort_n;
  if (!(force > most)) return std::nullopt;
  return ArgumentFault{
      "object",
      fmt::format("is {}, whose grasp asks for {:g} N (effort_n), more than the {:g} N "
                  "(max_force_n) of {}",
                  in_quotes(name_of("object")), force, most, in_quotes(arm->finger_joint))};
}

std::optional<ArgumentFault> wrong_tolerance(const ControllerSpec& spec, const State& given,
                                             const WorldLayout& layout) {
  const ArgumentSpec* joint = find_argument(spec, "joint");
  const auto named = given.find("joint");
  if (joint == nullptr || named == given.end()) return std::nullopt;
  const auto* name = std::get_if<std::string>(&named->second);
  if (name == nullptr || !is_name(*joint)) return std::nullopt;
  const bool door = joint->unit == "door";
  const char* const key = door ? "stop_tolerance_rad" : "stop_tolerance_m";
  const char* const unit = door ? "rad" : "m";
  double way = std::numeric_limits<double>::infinity();
  if (const auto hinge = layout.find_hinge(*name); door && hinge) {
    const JointSpec& spec_of = layout.hinges[*hinge];
    if (spec_of.low_rad && spec_of.high_rad) way = *spec_of.high_rad - *spec_of.low_rad;
  } else if (const auto slider = layout.find_slider(*name); !door && slider) {
    const JointSpec& spec_of = layout.sliders[*slider];
    if (spec_of.low_m && spec_of.high_m) way = *spec_of.high_m - *spec_of.low_m;
  }
  const ArgumentSpec* tolerance = find_argument(spec, key);
  const auto said = given.find(key);
  if (tolerance == nullptr) return std::nullopt;
  if (said != given.end()) {
    const double value = as_number(said->second).value_or(0.0);
    if (value < 0.5 * way) return std::nullopt;
    return ArgumentFault{
        key, fmt::format("is {:g} {}, half of the {:g} {} between the stops of {} or more: it "
                         "would tell neither stop from the middle",
                         value, unit, way, unit, in_quotes(*name))};
  }
  if (tolerance->fallback < 0.5 * way) return std::nullopt;
  return ArgumentFault{
      "joint", fmt::format("is {}, whose stops are {:g} {} apart: the {:g} {} of `{}` are half of "
                           "that or more; give less",
                           in_quotes(*name), way, unit, tolerance->fallback, unit, key)};
}

std::optional<ArgumentFault> wrong_call(const ControllerSpec& spec, const State& given,
                                        const WorldSpec& world, const WorldLayout& layout) {
  if (auto fault = wrong_together(spec, given)) return fault;
  if (auto fault = wrong_effort(spec, given, world, layout)) return fault;
  return wrong_tolerance(spec, given, layout);
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
    if (known == nullptr) return in_quotes(spec.name) + " takes no argument " + in_quotes(name);
    if (is_name(*known)) {
      const auto* text = std::get_if<std::string>(&value);
      if (text == nullptr) return "argument " + in_quotes(name) + " is not a name";
      const std::string fault = wrong_name(*known, *text, world, layout);
      if (!fault.empty()) return "argument " + in_quotes(name) + " " + fault;
      arguments.names_.emplace(name, *text);
      continue;
    }
    const std::optional<double> number = as_number(value);
    if (!number || !std::isfinite(*number)) {
      return "argument " + in_quotes(name) + " is not a finite number";
    }
    const std::string fault = wrong_number(*known, *number);
    if (!fault.empty()) return "argument " + in_quotes(name) + " " + fault;
    arguments.numbers_.emplace(name, *number);
  }
  if (const auto fault = wrong_call(spec, given, world, layout)) {
    return "argument " + in_quotes(fault->name) + " " + fault->text;
  }
  for (const ArgumentSpec& one : spec.arguments) {
    if (!one.required || given.find(one.name) != given.end()) continue;
    return in_quotes(spec.name) + " needs the argument " + in_quotes(one.name);
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
