// Vectors, rotations, poses and transforms: made from parts and taken apart (cl-transforms,
// cl-transforms-stamped).
#include <utility>
#include <variant>

#include "compiler/builtins/pose_values.h"

namespace parallax::compiler {
namespace {

/// The part of a pose or transform that was asked for, and no other kind of value.
BuiltinResult part_of(const BuiltinCall& c, ValueKind kind, std::string_view wanted, bool place) {
  const auto value = c.values[c.args[0]];
  if (value.kind != kind) return c.wrong(0, wanted);
  return place ? make_vector(c, vector_of(value)) : make_rotation(c, rotation_of(value));
}
BuiltinResult origin(const BuiltinCall& c) { return part_of(c, ValueKind::kPose, "a pose", true); }
BuiltinResult orientation(const BuiltinCall& c) {
  return part_of(c, ValueKind::kPose, "a pose", false);
}
BuiltinResult translation(const BuiltinCall& c) {
  return part_of(c, ValueKind::kTransform, "a transform", true);
}
BuiltinResult rotation(const BuiltinCall& c) {
  return part_of(c, ValueKind::kTransform, "a transform", false);
}

template <double Vector3::*kOfVector, double Quaternion::*kOfRotation>
BuiltinResult coordinate(const BuiltinCall& c) {
  const auto& value = c.values[c.args[0]];
  if (value.kind == ValueKind::kQuaternion) return make_number(c, rotation_of(value).*kOfRotation);
  if (value.kind == ValueKind::kVector) return make_number(c, vector_of(value).*kOfVector);
  return c.wrong(0, "a vector or a rotation");
}

BuiltinResult w_coordinate(const BuiltinCall& c) {
  const auto q = rotation_argument(c, 0);
  if (const auto* failure = std::get_if<BuiltinFailure>(&q)) return *failure;
  return make_number(c, std::get<0>(q).w);
}

/// Frame of a stamped argument, or why the argument is not stamped.
Argument<PoseFrame> stamped(const BuiltinCall& c) {
  const auto& value = c.values[c.args[0]];
  const bool placed = is_pose(value) || is_transform(value) || value.kind == ValueKind::kVector;
  auto frame = frame_of(value);
  if (!placed || !frame.stamp) return c.wrong(0, "stamped; `pose->pose-stamped` stamps a pose");
  return frame;
}
BuiltinResult frame_id(const BuiltinCall& c) {
  const auto frame = stamped(c);
  if (const auto* failure = std::get_if<BuiltinFailure>(&frame)) return *failure;
  return c.values.string(std::get<0>(frame).frame);
}
BuiltinResult stamp(const BuiltinCall& c) {
  const auto frame = stamped(c);
  if (const auto* failure = std::get_if<BuiltinFailure>(&frame)) return *failure;
  return *std::get<0>(frame).stamp;
}
BuiltinResult child_frame_id(const BuiltinCall& c) {
  const auto frame = stamped(c);
  if (const auto* failure = std::get_if<BuiltinFailure>(&frame)) return *failure;
  if (!is_transform(c.values[c.args[0]])) return c.wrong(0, "a stamped transform");
  return c.values.string(std::get<0>(frame).child);
}

BuiltinResult make_3d_vector(const BuiltinCall& c) {
  double parts[3] = {};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto number = number_argument(c, i);
    if (const auto* failure = std::get_if<BuiltinFailure>(&number)) return *failure;
    parts[i] = std::get<0>(number);
  }
  return make_vector(c, {parts[0], parts[1], parts[2]});
}

BuiltinResult make_quaternion(const BuiltinCall& c) {
  double parts[4] = {};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto number = number_argument(c, i);
    if (const auto* failure = std::get_if<BuiltinFailure>(&number)) return *failure;
    parts[i] = std::get<0>(number);
  }
  return make_rotation(c, {parts[0], parts[1], parts[2], parts[3]});
}

BuiltinResult identity_vector(const BuiltinCall& c) { return make_vector(c, {}); }
BuiltinResult identity_rotation(const BuiltinCall& c) { return make_rotation(c, {}); }
template <ValueKind kKind>
BuiltinResult identity_placed(const BuiltinCall& c) {
  return make_placed(c, kKind, {}, {});
}

/// A pose or a transform of the vector and the rotation that begin at argument `at`.
BuiltinResult join(const BuiltinCall& c, ValueKind kind, std::size_t at, const PoseFrame& frame) {
  const auto place = vector_argument(c, at);
  if (const auto* failure = std::get_if<BuiltinFailure>(&place)) return *failure;
  const auto turn = rotation_argument(c, at + 1);
  if (const auto* failure = std::get_if<BuiltinFailure>(&turn)) return *failure;
  return make_placed(c, kind, {std::get<0>(place), std::get<0>(turn)}, frame);
}

template <ValueKind kKind>
BuiltinResult join_plain(const BuiltinCall& c) {
  return join(c, kKind, 0, {});
}

BuiltinResult make_2d_pose(const BuiltinCall& c) {
  double parts[3] = {};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto number = number_argument(c, i);
    if (const auto* failure = std::get_if<BuiltinFailure>(&number)) return *failure;
    parts[i] = std::get<0>(number);
  }
  const auto turn = around({0.0, 0.0, 1.0}, parts[2]).value_or(Quaternion());
  return make_placed(c, ValueKind::kPose, {{parts[0], parts[1], 0.0}, turn}, {});
}

/// Frame, for transforms the child frame, and stamp, which begin the arguments.
Argument<PoseFrame> frame_arguments(const BuiltinCall& c, bool transform) {
  PoseFrame out;
  const std::size_t names = transform ? 2 : 1;
  for (std::size_t i = 0; i < names; ++i) {
    auto name = name_argument(c, i);
    if (auto* failure = std::get_if<BuiltinFailure>(&name)) return *failure;
    (i == 0 ? out.frame : out.child) = std::get<0>(std::move(name));
  }
  if (!is_stamp(c, names)) return c.wrong(names, "a time stamp");
  out.stamp = c.args[names];
  return out;
}

BuiltinResult make_pose_stamped(const BuiltinCall& c) {
  const auto frame = frame_arguments(c, false);
  if (const auto* failure = std::get_if<BuiltinFailure>(&frame)) return *failure;
  return join(c, ValueKind::kPose, 2, std::get<0>(frame));
}

BuiltinResult make_transform_stamped(const BuiltinCall& c) {
  const auto frame = frame_arguments(c, true);
  if (const auto* failure = std::get_if<BuiltinFailure>(&frame)) return *failure;
  return join(c, ValueKind::kTransform, 3, std::get<0>(frame));
}

BuiltinResult make_point_stamped(const BuiltinCall& c) {
  const auto frame = frame_arguments(c, false);
  if (const auto* failure = std::get_if<BuiltinFailure>(&frame)) return *failure;
  const auto place = vector_argument(c, 2);
  if (const auto* failure = std::get_if<BuiltinFailure>(&place)) return *failure;
  Value value = c.values[c.args[2]];
  value.pose.frame = std::get<0>(frame).frame;
  value.head = *std::get<0>(frame).stamp;
  return c.values.intern(std::move(value));
}

BuiltinResult copy_3d_vector(const BuiltinCall& c) {
  const auto place = vector_argument(c, 0);
  if (const auto* failure = std::get_if<BuiltinFailure>(&place)) return *failure;
  const auto keys = key_arguments(c, 1, {"x", "y", "z"});
  if (const auto* failure = std::get_if<BuiltinFailure>(&keys)) return *failure;
  auto out = std::get<0>(place);
  for (const auto& [name, member] :
       {std::pair("x", &Vector3::x), std::pair("y", &Vector3::y), std::pair("z", &Vector3::z)}) {
    const auto index = key_argument(std::get<0>(keys), name);
    if (!index) continue;
    const auto number = number_argument(c, *index);
    if (const auto* failure = std::get_if<BuiltinFailure>(&number)) return *failure;
    out.*member = std::get<0>(number);
  }
  return make_vector(c, out);
}

BuiltinResult copy_quaternion(const BuiltinCall& c) {
  const auto turn = rotation_argument(c, 0);
  if (const auto* failure = std::get_if<BuiltinFailure>(&turn)) return *failure;
  return c.args[0];
}

/// copy-pose, copy-pose-stamped, copy-transform, copy-transform-stamped, with other parts by key.
BuiltinResult copy_placed(const BuiltinCall& c, ValueKind kind, bool needs_stamp) {
  const auto value = c.values[c.args[0]];
  const bool transform = kind == ValueKind::kTransform;
  auto frame = frame_of(value);
  if (value.kind != kind) return c.wrong(0, transform ? "a transform" : "a pose");
  if (needs_stamp && !frame.stamp) return c.wrong(0, "stamped");
  const std::string_view place_key = transform ? "translation" : "origin";
  const std::string_view turn_key = transform ? "rotation" : "orientation";
  const auto found =
      key_arguments(c, 1, {place_key, turn_key, "stamp", "frame-id", "child-frame-id"});
  if (const auto* failure = std::get_if<BuiltinFailure>(&found)) return *failure;
  const auto& keys = std::get<0>(found);
  auto motion = motion_of(value);
  if (const auto index = key_argument(keys, place_key)) {
    const auto place = vector_argument(c, *index);
    if (const auto* failure = std::get_if<BuiltinFailure>(&place)) return *failure;
    motion.at = std::get<0>(place);
  }
  if (const auto index = key_argument(keys, turn_key)) {
    const auto turn = rotation_argument(c, *index);
    if (const auto* failure = std::get_if<BuiltinFailure>(&turn)) return *failure;
    motion.turn = std::get<0>(turn);
  }
  if (const auto index = key_argument(keys, "stamp")) {
    if (!is_stamp(c, *index)) return c.wrong(*index, "a time stamp");
    frame.stamp = c.args[*index];
  }
  for (const auto& [key, part] :
       {std::pair("frame-id", &frame.frame), std::pair("child-frame-id", &frame.child)}) {
    const auto index = key_argument(keys, key);
    if (!index) continue;
    auto name = name_argument(c, *index);
    if (const auto* failure = std::get_if<BuiltinFailure>(&name)) return *failure;
    *part = std::get<0>(std::move(name));
  }
  return make_placed(c, kind, motion, frame);
}
template <ValueKind kKind, bool kStamped>
BuiltinResult copy_of(const BuiltinCall& c) {
  return copy_placed(c, kKind, kStamped);
}

constexpr BuiltinEntry kPartTable[] = {
    {{"make-3d-vector", 3, 3}, make_3d_vector},
    {{"make-quaternion", 4, 4}, make_quaternion},
    {{"make-identity-vector", 0, 1}, identity_vector},
    {{"make-identity-rotation", 0, 1}, identity_rotation},
    {{"make-identity-pose", 0, 0}, identity_placed<ValueKind::kPose>},
    {{"make-identity-transform", 0, 1}, identity_placed<ValueKind::kTransform>},
    {{"make-pose", 2, 2}, join_plain<ValueKind::kPose>},
    {{"make-transform", 2, 2}, join_plain<ValueKind::kTransform>},
    {{"make-2d-pose", 3, 3}, make_2d_pose},
    {{"make-pose-stamped", 4, 4}, make_pose_stamped},
    {{"make-transform-stamped", 5, 5}, make_transform_stamped},
    {{"make-point-stamped", 3, 3}, make_point_stamped},
    {{"make-vector-stamped", 3, 3}, make_point_stamped},
    {{"copy-3d-vector", 1, kAnyNumber}, copy_3d_vector},
    {{"copy-quaternion", 1, 1}, copy_quaternion},
    {{"copy-pose", 1, kAnyNumber}, copy_of<ValueKind::kPose, false>},
    {{"copy-transform", 1, kAnyNumber}, copy_of<ValueKind::kTransform, false>},
    {{"copy-pose-stamped", 1, kAnyNumber}, copy_of<ValueKind::kPose, true>},
    {{"copy-transform-stamped", 1, kAnyNumber}, copy_of<ValueKind::kTransform, true>},
    {{"x", 1, 1}, coordinate<&Vector3::x, &Quaternion::x>},
    {{"y", 1, 1}, coordinate<&Vector3::y, &Quaternion::y>},
    {{"z", 1, 1}, coordinate<&Vector3::z, &Quaternion::z>},
    {{"w", 1, 1}, w_coordinate},
    {{"origin", 1, 1}, origin},
    {{"orientation", 1, 1}, orientation},
    {{"translation", 1, 1}, translation},
    {{"rotation", 1, 1}, rotation},
    {{"frame-id", 1, 1}, frame_id},
    {{"child-frame-id", 1, 1}, child_frame_id},
    {{"stamp", 1, 1}, stamp},
};

}  // namespace

std::span<const BuiltinEntry> pose_part_builtins() { return kPartTable; }

}  // namespace parallax::compiler
