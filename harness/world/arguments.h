#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "harness/simulator/simulator.h"
#include "harness/world/world_layout.h"

namespace parallax::harness {

/// One argument of a controller, as an action's `args` name it.
struct ArgumentSpec {
  std::string_view name;  // "target.x"
  /// "m", "s", "n"; or what a name stands for: "body" (a free one), "graspable" (with a `grasp`),
  /// "arm", "place", "drawer" (a slider with a handle and stops), "door" (a hinge with a
  /// handle), "kind" (what detection looks for).
  std::string_view unit;
  bool required = false;
  double fallback = 0.0;  // unless required; NaN: see `help`
  bool positive = false;  // 0 and less are refused
  std::string_view help;
  /// Narrower bounds than those of the unit; NaN: none.
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();
  bool whole = false;             // 2.5 is refused
  std::string_view at_most = {};  // another argument that this one must not exceed
};

/// The bounds of a number that is given as this argument.
struct ArgumentBounds {
  double low = 0.0, high = 0.0;
  bool low_open = false;
};
ArgumentBounds bounds_of(const ArgumentSpec& argument);

/// Is the argument a name, not a number?
bool is_name(const ArgumentSpec& argument);

enum class RobotKind : std::uint8_t { kLine, kMobile };

struct ControllerSpec {
  std::string_view name;  // "picking-up"
  std::span<const ArgumentSpec> arguments;
  std::string_view help;
  RobotKind robot = RobotKind::kLine;  // whose it is
};

/// All controllers of the built-in robots, sorted by name.
std::span<const ControllerSpec> controllers();

/// None if there is no controller `name`.
const ControllerSpec* find_controller(std::string_view name);

/// The arguments of one action, checked against the controller's table and the world's names.
class Arguments {
 public:
  /// A message instead if an argument is unknown, missing, of the wrong kind or not finite.
  /// `world` outlives the arguments.
  static std::variant<Arguments, std::string> check(const ControllerSpec& spec, const State& given,
                                                    const WorldSpec& world,
                                                    const WorldLayout& layout);

  /// `name` must be in the table; its fallback (possibly NaN) unless given; NaN if the controller
  /// has no such argument.
  double number(std::string_view name) const;
  /// None unless given.
  std::optional<std::string> text(std::string_view name) const;
  std::optional<BodyId> body(std::string_view name) const;
  std::optional<SliderId> slider(std::string_view name) const;
  std::optional<HingeId> hinge(std::string_view name) const;
  const PlaceSpec* place(std::string_view name) const;

 private:
  Arguments(const ControllerSpec& spec, const WorldSpec& world, const WorldLayout& layout)
      : spec_(&spec), world_(&world), layout_(&layout) {}
  const ControllerSpec* spec_;  // of the static table
  const WorldSpec* world_;
  const WorldLayout* layout_;
  std::map<std::string, double, std::less<>> numbers_;
  std::map<std::string, std::string, std::less<>> names_;
};

/// A number whether it was written as 1 or as 1.0.
std::optional<double> as_number(const Value& value);

/// The fault of `name` as an argument of this kind in this world, to be read after "the argument
/// `x` ..."; empty if there is none.
std::string wrong_name(const ArgumentSpec& argument, std::string_view name, const WorldSpec& world,
                       const WorldLayout& layout);
/// The same of a number.
std::string wrong_number(const ArgumentSpec& argument, double value);
/// The same of all that is given together: numbers that must not exceed others.
struct ArgumentFault {
  std::string name;  // of the argument
  std::string text;
};
std::optional<ArgumentFault> wrong_together(const ControllerSpec& spec, const State& given);
/// The same of a squeezing force, given or that of the object's grasp: the motor of the arm's
/// finger has to be able to exert it.
std::optional<ArgumentFault> wrong_effort(const ControllerSpec& spec, const State& given,
                                          const WorldSpec& world, const WorldLayout& layout);
/// The same of how near to its stop a drawer or a door has to be, given or the fallback: from half
/// of its way on, it would be where it is to be before anything has moved it.
std::optional<ArgumentFault> wrong_tolerance(const ControllerSpec& spec, const State& given,
                                             const WorldLayout& layout);
/// The first of these three.
std::optional<ArgumentFault> wrong_call(const ControllerSpec& spec, const State& given,
                                        const WorldSpec& world, const WorldLayout& layout);

/// The names that would do, sorted.
std::vector<std::string> names_for(const ArgumentSpec& argument, const WorldSpec& world,
                                   const WorldLayout& layout);

/// None if the controller has no such argument.
const ArgumentSpec* find_argument(const ControllerSpec& spec, std::string_view name);

}  // namespace parallax::harness
