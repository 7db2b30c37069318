// Poses and transforms with frames (cl-transforms-stamped, cram-tf), and what only the robot knows
// of them.
#include <optional>
#include <variant>

#include "compiler/builtins/pose_values.h"
#include "compiler/builtins/unknown_values.h"

namespace parallax::compiler {
namespace {

constexpr auto kPose = ValueKind::kPose;
constexpr auto kTransform = ValueKind::kTransform;

/// (pose->pose-stamped frame stamp pose), (transform->pose-stamped ...),
/// (transform->transform-stamped frame child stamp transform), (pose->transform-stamped ...).
template <ValueKind kFrom, ValueKind kTo>
BuiltinResult stamped_as(const BuiltinCall& c) {
  PoseFrame frame;
  std::size_t next = 0;
  for (auto* part : {&frame.frame, &frame.child}) {
    if (part == &frame.child && kTo == kPose) continue;
    auto name = name_argument(c, next++);
    if (const auto* failure = std::get_if<BuiltinFailure>(&name)) return *failure;
    *part = std::get<0>(std::move(name));
  }
  if (!is_stamp(c, next)) return c.wrong(next, "a time stamp");
  frame.stamp = c.args[next++];
  const auto value = c.values[c.args[next]];
  if (value.kind != kFrom) return c.wrong(next, kFrom == kPose ? "a pose" : "a transform");
  return make_placed(c, kTo, motion_of(value), frame);
}

BuiltinResult unstamped(const BuiltinCall& c) {
  const auto value = c.values[c.args[0]];
  if (!is_pose(value)) return c.wrong(0, "a pose");
  return make_placed(c, kPose, motion_of(value), {value.pose.frame, "", std::nullopt});
}

/// Frame of a stamped pose or transform, or why the argument is not one.
Argument<PoseFrame> stamped_argument(const BuiltinCall& c, std::size_t index, ValueKind kind) {
  const auto& value = c.values[c.args[index]];
  const auto frame = frame_of(value);
  const bool fits = value.kind == kind && frame.stamp;
  if (!fits) return c.wrong(index, kind == kPose ? "a stamped pose" : "a stamped transform");
  return frame;
}

/// (pose-stamped->transform-stamped pose child).
BuiltinResult pose_to_transform(const BuiltinCall& c) {
  const auto found = stamped_argument(c, 0, kPose);
  if (const auto* failure = std::get_if<BuiltinFailure>(&found)) return *failure;
  auto child = name_argument(c, 1);
  if (const auto* failure = std::get_if<BuiltinFailure>(&child)) return *failure;
  auto frame = std::get<0>(found);
  frame.child = std::get<0>(std::move(child));
  return make_placed(c, kTransform, motion_of(c.values[c.args[0]]), frame);
}

/// The pose that a stamped transform takes the origin to.
BuiltinResult strip(const BuiltinCall& c) {
  const auto found = stamped_argument(c, 0, kTransform);
  if (const auto* failure = std::get_if<BuiltinFailure>(&found)) return *failure;
  return make_placed(c, kPose, motion_of(c.values[c.args[0]]), std::get<0>(found));
}

BuiltinResult stamped_inverse(const BuiltinCall& c) {
  const auto found = stamped_argument(c, 0, kTransform);
  if (const auto* failure = std::get_if<BuiltinFailure>(&found)) return *failure;
  const auto& frame = std::get<0>(found);
  return make_placed(c, kTransform, inverse(motion_of(c.values[c.args[0]])),
                     {frame.child, frame.frame, frame.stamp});
}

BuiltinResult multiply(const BuiltinCall& c, std::size_t at, PoseFrame frame, ValueKind kind) {
  const auto first = stamped_argument(c, at, kTransform);
  if (const auto* failure = std::get_if<BuiltinFailure>(&first)) return *failure;
  const auto second = stamped_argument(c, at + 1, kTransform);
  if (const auto* failure = std::get_if<BuiltinFailure>(&second)) return *failure;
  const auto& a = std::get<0>(first);
  const auto& b = std::get<0>(second);
  if (a.child != b.frame) {
    return BuiltinFailure{
        BuiltinError::kValue,
        fmt::format("the first transform leads to `{}`, the second begins at `{}`", a.child,
                    b.frame)};
  }
  const auto& one = c.values[*a.stamp];
  const auto& other = c.values[*b.stamp];
  const bool known = one.kind == ValueKind::kNumber && other.kind == ValueKind::kNumber;
  frame.stamp = !known || compare(one.number, other.number) <= 0 ? a.stamp : b.stamp;
  if (frame.frame.empty()) frame.frame = a.frame;
  if (frame.child.empty()) frame.child = b.child;
  const auto out = composed(motion_of(c.values[c.args[at]]), motion_of(c.values[c.args[at + 1]]));
  return make_placed(c, kind, out, frame);
}

/// (multiply-transform-stampeds x-frame z-frame xTy yTz :result-as-pose-or-transform kind).
BuiltinResult multiply_stamped(const BuiltinCall& c) {
  PoseFrame frame;
  auto x = name_argument(c, 0);
  if (const auto* failure = std::get_if<BuiltinFailure>(&x)) return *failure;
  auto z = name_argument(c, 1);
  if (const auto* failure = std::get_if<BuiltinFailure>(&z)) return *failure;
  frame.frame = std::get<0>(std::move(x)), frame.child = std::get<0>(std::move(z));
  const auto keys = key_arguments(c, 4, {"result-as-pose-or-transform"});
  if (const auto* failure = std::get_if<BuiltinFailure>(&keys)) return *failure;
  const auto result = key_argument(std::get<0>(keys), "result-as-pose-or-transform");
  const bool pose = result && c.values[c.args[*result]].text == "pose";
  return multiply(c, 2, frame, pose ? kPose : kTransform);
}

BuiltinResult apply_transform(const BuiltinCall& c) {
  return multiply(c, 0, {"", "", std::nullopt}, kTransform);
}

/// translate-pose, translate-transform-stamped: by :x-offset, :y-offset, :z-offset.
template <ValueKind kKind>
BuiltinResult translate(const BuiltinCall& c) {
  const auto value = c.values[c.args[0]];
  if (value.kind != kKind) return c.wrong(0, kKind == kPose ? "a pose" : "a transform");
  const auto keys = key_arguments(c, 1, {"x-offset", "y-offset", "z-offset"});
  if (const auto* failure = std::get_if<BuiltinFailure>(&keys)) return *failure;
  auto motion = motion_of(value);
  for (const auto& [name, member] :
       {std::pair("x-offset", &Vector3::x), std::pair("y-offset", &Vector3::y),
        std::pair("z-offset", &Vector3::z)}) {
    const auto index = key_argument(std::get<0>(keys), name);
    if (!index) continue;
    const auto by = number_argument(c, *index);
    if (const auto* failure = std::get_if<BuiltinFailure>(&by)) return *failure;
    motion.at.*member += std::get<0>(by);
  }
  return make_placed(c, kKind, motion, frame_of(value));
}

/// (rotate-pose pose :z angle), about an axis of the pose's frame.
BuiltinResult rotate_pose(const BuiltinCall& c) {
  const auto value = c.values[c.args[0]];
  if (!is_pose(value)) return c.wrong(0, "a pose");
  const auto& axis = c.values[c.args[1]].text;
  if (axis != "x" && axis != "y" && axis != "z") return c.wrong(1, ":x, :y or :z");
  const auto angle = number_argument(c, 2);
  if (const auto* failure = std::get_if<BuiltinFailure>(&angle)) return *failure;
  const Vector3 about = {axis == "x" ? 1.0 : 0.0, axis == "y" ? 1.0 : 0.0, axis == "z" ? 1.0 : 0.0};
  auto motion = motion_of(value);
  motion.turn = product(around(about, std::get<0>(angle)).value_or(Quaternion()), motion.turn);
  return make_placed(c, kPose, motion, frame_of(value));
}

/// (pose->list pose): ((x y z) (qx qy qz qw)); pose->flat-list: all seven.
template <bool kFlat>
BuiltinResult pose_to_list(const BuiltinCall& c) {
  const auto value = c.values[c.args[0]];
  if (!is_pose(value)) return c.wrong(0, "a pose");
  const auto& p = value.pose;
  std::vector<ValueId> numbers;
  for (const double part : {p.x_m, p.y_m, p.z_m, p.qx, p.qy, p.qz, p.qw}) {
    numbers.push_back(std::get<ValueId>(make_number(c, part)));
  }
  if (kFlat) return c.values.list(numbers);
  const auto place = c.values.list({numbers.begin(), numbers.begin() + 3});
  return c.values.list({place, c.values.list({numbers.begin() + 3, numbers.end()})});
}

BuiltinResult list_to_pose(const BuiltinCall& c) {
  constexpr std::string_view kWanted = "a list of three numbers and of four";
  std::vector<double> numbers;
  std::vector<ValueId> open = {c.args[0]};
  while (!open.empty() && numbers.size() < 8) {
    const auto id = open.back();
    open.pop_back();
    const auto items = c.values.elements(id);
    if (items) {
      if (items->size() > 7) return c.wrong(0, kWanted);
      open.insert(open.end(), items->rbegin(), items->rend());
    } else if (c.values.kind(id) == ValueKind::kNumber) {
      numbers.push_back(c.values[id].number.value());
    } else {
      return c.wrong(0, kWanted);
    }
  }
  if (numbers.size() != 7) return c.wrong(0, kWanted);
  const Quaternion turn = {numbers[3], numbers[4], numbers[5], numbers[6]};
  if (!unit(turn)) return BuiltinFailure{BuiltinError::kValue, "the quaternion has no direction"};
  return make_placed(c, kPose, {{numbers[0], numbers[1], numbers[2]}, turn}, {});
}

BuiltinResult poses_equal(const BuiltinCall& c) {
  const auto a = placed_argument(c, 0);
  if (const auto* failure = std::get_if<BuiltinFailure>(&a)) return *failure;
  const auto b = placed_argument(c, 1);
  if (const auto* failure = std::get_if<BuiltinFailure>(&b)) return *failure;
  const auto distance = number_argument(c, 2);
  if (const auto* failure = std::get_if<BuiltinFailure>(&distance)) return *failure;
  const auto angle = number_argument(c, 3);
  if (const auto* failure = std::get_if<BuiltinFailure>(&angle)) return *failure;
  const auto& one = std::get<0>(a);
  const auto& other = std::get<0>(b);
  const auto back = inverse(one.turn).value_or(Quaternion());
  const bool near = length(sum(one.at, scaled(other.at, -1.0))) <= std::get<0>(distance);
  return c.values.boolean(near && angle_rad(product(back, other.turn)) <= std::get<0>(angle));
}

/// Term for a value that only the robot knows: the function of the call and its arguments.
BuiltinResult from_robot(const BuiltinCall& c) { return unknown_value(c.name, c.args, c.values); }

/// (ensure-pose-in-frame pose frame). Only the robot can transform a stamped pose that is in
/// another frame, so the result is then a term of the call.
BuiltinResult ensure_in_frame(const BuiltinCall& c) {
  const auto value = c.values[c.args[0]];
  if (c.values.is_nil(c.args[0])) return c.args[0];
  if (!is_pose(value)) return c.wrong(0, "a pose");
  const auto frame = name_argument(c, 1);
  if (const auto* failure = std::get_if<BuiltinFailure>(&frame)) return *failure;
  if (value.pose.frame == std::get<0>(frame) && frame_of(value).stamp) return c.args[0];
  if (frame_of(value).stamp) return from_robot(c);
  return make_placed(c, kPose, motion_of(value),
                     {std::get<0>(frame), "", c.values.number(Number(0).as_float())});
}

/// (ensure-pose-stamped pose frame stamp): stamps a pose or transform that has no stamp.
BuiltinResult ensure_stamped(const BuiltinCall& c) {
  const auto value = c.values[c.args[0]];
  auto frame = frame_of(value);
  if (!is_pose(value) && !is_transform(value)) return c.wrong(0, "a pose or a transform");
  if (is_pose(value) && frame.stamp) return c.args[0];
  if (c.args.size() > 1 && !c.values.is_nil(c.args[1])) {
    auto name = name_argument(c, 1);
    if (const auto* failure = std::get_if<BuiltinFailure>(&name)) return *failure;
    frame.frame = std::get<0>(std::move(name));
  }
  if (c.args.size() > 2 && is_stamp(c, 2)) frame.stamp = c.args[2];
  if (!frame.stamp) return c.wrong(0, "stamped; name its frame and stamp");
  return make_placed(c, kPose, motion_of(value), frame);
}

constexpr BuiltinEntry kFrameTable[] = {
    {{"pose->pose-stamped", 3, 3}, stamped_as<kPose, kPose>},
    {{"transform->pose-stamped", 3, 3}, stamped_as<kTransform, kPose>},
    {{"pose->transform-stamped", 4, 4}, stamped_as<kPose, kTransform>},
    {{"transform->transform-stamped", 4, 4}, stamped_as<kTransform, kTransform>},
    {{"pose-stamped->pose", 1, 1}, unstamped},
    {{"pose-stamped->transform-stamped", 2, 2}, pose_to_transform},
    {{"strip-transform-stamped", 1, 1}, strip},
    {{"transform-stamped-inv", 1, 1}, stamped_inverse},
    {{"multiply-transform-stampeds", 4, 6}, multiply_stamped},
    {{"apply-transform", 2, 2}, apply_transform},
    {{"translate-pose", 1, kAnyNumber}, translate<kPose>},
    {{"translate-transform-stamped", 1, kAnyNumber}, translate<kTransform>},
    {{"rotate-pose", 3, 3}, rotate_pose},
    {{"pose->list", 1, 1}, pose_to_list<false>},
    {{"pose->flat-list", 1, 1}, pose_to_list<true>},
    {{"list->pose", 1, 1}, list_to_pose},
    {{"flat-list->pose", 1, 1}, list_to_pose},
    {{"poses-equal-p", 4, 4}, poses_equal},
    {{"ensure-pose-in-frame", 2, 6}, ensure_in_frame},
    {{"ensure-pose-stamped", 1, 3}, ensure_stamped},
};

constexpr BuiltinEntry kRobotTable[] = {
    {{"robot-current-pose", 0, 0}, from_robot},
    {{"frame-to-pose-in-fixed-frame", 1, 1}, from_robot},
    {{"lookup-transform", 0, kAnyNumber}, from_robot},
    {{"transform-pose-stamped", 0, kAnyNumber}, from_robot},
    {{"transform-point-stamped", 0, kAnyNumber}, from_robot},
    {{"get-object-pose", 1, 1}, from_robot},
    {{"get-object-pose-in-map", 1, 1}, from_robot},
    {{"get-object-transform", 1, 1}, from_robot},
    {{"get-object-transform-in-map", 1, 1}, from_robot},
    {{"object-pose", 1, 1}, from_robot},
    {{"link-pose", 2, 2}, from_robot},
    {{"ros-time", 0, 0}, from_robot},
};

}  // namespace

std::span<const BuiltinEntry> frame_builtins() { return kFrameTable; }
std::span<const BuiltinEntry> robot_builtins() { return kRobotTable; }

bool is_unknown_source(std::string_view name) {
  for (const auto& entry : kRobotTable) {
    if (entry.builtin.name == name) return true;
  }
  return false;
}

}  // namespace parallax::compiler
