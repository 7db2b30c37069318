#include <fmt/core.h>

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <variant>

#include "compiler/plan/builtin_call.h"

namespace parallax::compiler {
namespace {

ValueId make(const BuiltinCall& c, ValueKind kind, const Pose& pose) {
  Value value;
  value.kind = kind;
  value.pose = pose;
  return c.values.intern(std::move(value));
}

/// Arguments [begin, begin + count) as finite doubles.
std::variant<std::array<double, 4>, BuiltinFailure> doubles(const BuiltinCall& c,
                                                            std::size_t count) {
  std::array<double, 4> out{};
  for (std::size_t i = 0; i < count; ++i) {
    const auto* number = c.number(i);
    if (number == nullptr || !std::isfinite(number->value())) return c.wrong(i, "a finite number");
    out[i] = number->value();
  }
  return out;
}

BuiltinResult make_vector(const BuiltinCall& c) {
  const auto parts = doubles(c, 3);
  if (const auto* failure = std::get_if<BuiltinFailure>(&parts)) return *failure;
  const auto& xyz = std::get<0>(parts);
  Pose pose;
  pose.x_m = xyz[0], pose.y_m = xyz[1], pose.z_m = xyz[2];
  return make(c, ValueKind::kVector, pose);
}

BuiltinResult make_quaternion(const BuiltinCall& c) {
  const auto parts = doubles(c, 4);
  if (const auto* failure = std::get_if<BuiltinFailure>(&parts)) return *failure;
  const auto& q = std::get<0>(parts);
  const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(norm > 0.0) || !std::isfinite(norm)) {
    return BuiltinFailure{BuiltinError::kValue, "the quaternion has no direction"};
  }
  Pose pose;
  pose.qx = q[0] / norm, pose.qy = q[1] / norm, pose.qz = q[2] / norm, pose.qw = q[3] / norm;
  return make(c, ValueKind::kQuaternion, pose);
}

template <ValueKind kKind>
BuiltinResult make_identity(const BuiltinCall& c) {
  return make(c, kKind, {});
}

/// Joins the position of argument `at` with the rotation of the next one.
BuiltinResult join_pose(const BuiltinCall& c, std::size_t at, std::string frame) {
  const auto& position = c.values[c.args[at]];
  const auto& rotation = c.values[c.args[at + 1]];
  if (position.kind != ValueKind::kVector) return c.wrong(at, "a vector");
  if (rotation.kind != ValueKind::kQuaternion) return c.wrong(at + 1, "a rotation");
  Pose pose = rotation.pose;
  pose.x_m = position.pose.x_m, pose.y_m = position.pose.y_m, pose.z_m = position.pose.z_m;
  pose.frame = std::move(frame);
  return make(c, ValueKind::kPose, pose);
}

BuiltinResult make_pose(const BuiltinCall& c) { return join_pose(c, 0, "map"); }

BuiltinResult make_pose_stamped(const BuiltinCall& c) {
  const auto& frame = c.values[c.args[0]];
  if (frame.kind != ValueKind::kString) return c.wrong(0, "the name of a frame");
  if (c.number(1) == nullptr) return c.wrong(1, "a time stamp");
  return join_pose(c, 2, frame.text);
}

BuiltinResult stamp_pose(const BuiltinCall& c) {
  const auto& frame = c.values[c.args[0]];
  const auto& pose = c.values[c.args[2]];
  if (frame.kind != ValueKind::kString) return c.wrong(0, "the name of a frame");
  if (c.number(1) == nullptr) return c.wrong(1, "a time stamp");
  if (pose.kind != ValueKind::kPose) return c.wrong(2, "a pose");
  Pose stamped = pose.pose;
  stamped.frame = frame.text;
  return make(c, ValueKind::kPose, stamped);
}

constexpr BuiltinEntry kPoseTable[] = {
    {{"make-3d-vector", 3, 3}, make_vector},
    {{"make-quaternion", 4, 4}, make_quaternion},
    {{"make-identity-rotation", 0, 0}, make_identity<ValueKind::kQuaternion>},
    {{"make-identity-vector", 0, 0}, make_identity<ValueKind::kVector>},
    {{"make-identity-pose", 0, 0}, make_identity<ValueKind::kPose>},
    {{"make-pose", 2, 2}, make_pose},
    {{"make-pose-stamped", 4, 4}, make_pose_stamped},
    {{"pose->pose-stamped", 3, 3}, stamp_pose},
};

}  // namespace

std::span<const BuiltinEntry> pose_builtins() { return kPoseTable; }

}  // namespace parallax::compiler
