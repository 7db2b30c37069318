#include "compiler/builtins/pose_values.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "compiler/builtins/unknown_values.h"

namespace parallax::compiler {
namespace {

BuiltinFailure too_large() { return {BuiltinError::kValue, "the result is too large a number"}; }

}  // namespace

Vector3 vector_of(const Value& value) { return {value.pose.x_m, value.pose.y_m, value.pose.z_m}; }

Quaternion rotation_of(const Value& value) {
  return {value.pose.qx, value.pose.qy, value.pose.qz, value.pose.qw};
}

RigidMotion motion_of(const Value& value) { return {vector_of(value), rotation_of(value)}; }

PoseFrame frame_of(const Value& value) {
  PoseFrame out{value.pose.frame, value.text, std::nullopt};
  if (value.head != ValueId()) out.stamp = value.head;
  return out;
}

BuiltinResult make_vector(const BuiltinCall& c, const Vector3& v) {
  if (!is_finite(v)) return too_large();
  Value value;
  value.kind = ValueKind::kVector;
  value.pose.x_m = v.x, value.pose.y_m = v.y, value.pose.z_m = v.z;
  return c.values.intern(std::move(value));
}

BuiltinResult make_rotation(const BuiltinCall& c, const Quaternion& q) {
  if (!is_finite(q)) return too_large();
  if (!(length(q) >= kNoDirection)) {
    return BuiltinFailure{BuiltinError::kValue, "the quaternion has no direction"};
  }
  Value value;
  value.kind = ValueKind::kQuaternion;
  value.pose.qx = q.x, value.pose.qy = q.y, value.pose.qz = q.z, value.pose.qw = q.w;
  return c.values.intern(std::move(value));
}

BuiltinResult make_placed(const BuiltinCall& c, ValueKind kind, const RigidMotion& motion,
                          const PoseFrame& frame) {
  const auto turn = unit(motion.turn);
  if (!is_finite(motion.at) || !turn) return too_large();
  Value value;
  value.kind = kind;
  value.pose.x_m = motion.at.x, value.pose.y_m = motion.at.y, value.pose.z_m = motion.at.z;
  value.pose.qx = turn->x, value.pose.qy = turn->y, value.pose.qz = turn->z;
  value.pose.qw = turn->w;
  value.pose.frame = frame.frame;
  if (kind == ValueKind::kTransform) value.text = frame.child;
  if (frame.stamp) value.head = *frame.stamp;
  return c.values.intern(std::move(value));
}

BuiltinResult make_number(const BuiltinCall& c, double value) {
  if (!std::isfinite(value)) return too_large();
  constexpr double kExact = 9007199254740992.0;  // integers up to here are exact
  const bool integer = std::abs(value) < kExact && value == std::trunc(value);
  const auto number = integer ? Number(static_cast<std::int64_t>(value)) : Number::inexact(value);
  return c.values.number(number.as_float());
}

Argument<Vector3> vector_argument(const BuiltinCall& c, std::size_t index) {
  const auto& value = c.values[c.args[index]];
  if (value.kind != ValueKind::kVector) return c.wrong(index, "a vector");
  return vector_of(value);
}

Argument<Quaternion> rotation_argument(const BuiltinCall& c, std::size_t index) {
  const auto& value = c.values[c.args[index]];
  if (value.kind != ValueKind::kQuaternion) return c.wrong(index, "a rotation");
  return rotation_of(value);
}

Argument<RigidMotion> placed_argument(const BuiltinCall& c, std::size_t index) {
  const auto& value = c.values[c.args[index]];
  if (!is_pose(value) && !is_transform(value)) return c.wrong(index, "a pose or a transform");
  return motion_of(value);
}

Argument<double> number_argument(const BuiltinCall& c, std::size_t index) {
  const auto* number = c.number(index);
  if (number == nullptr || !std::isfinite(number->value()))
    return c.wrong(index, "a finite number");
  return number->value();
}

Argument<std::string> name_argument(const BuiltinCall& c, std::size_t index) {
  const auto& value = c.values[c.args[index]];
  if (value.kind != ValueKind::kString) return c.wrong(index, "the name of a frame");
  return value.text;
}

bool is_stamp(const BuiltinCall& c, std::size_t index) {
  return c.number(index) != nullptr || is_robot_time(c.values[c.args[index]]);
}

Argument<KeyArguments> key_arguments(const BuiltinCall& c, std::size_t from,
                                     std::initializer_list<std::string_view> allowed) {
  KeyArguments out;
  for (auto i = from; i < c.args.size(); i += 2) {
    const auto& key = c.values[c.args[i]];
    const bool known = key.kind == ValueKind::kSymbol && key.keyword &&
                       std::find(allowed.begin(), allowed.end(), key.text) != allowed.end();
    if (!known) {
      std::string names;
      for (const auto name : allowed)
        names += fmt::format("{}:{}", names.empty() ? "" : ", ", name);
      return c.wrong(i, fmt::format("one of {}", names));
    }
    if (i + 1 == c.args.size()) {
      return BuiltinFailure{BuiltinError::kValue, fmt::format("no value for `:{}`", key.text)};
    }
    // If a key is given twice, Lisp takes the first.
    if (!c.values.is_nil(c.args[i + 1])) out.emplace_back(key.text, i + 1);
  }
  return out;
}

std::optional<std::size_t> key_argument(const KeyArguments& keys, std::string_view name) {
  for (const auto& [key, index] : keys) {
    if (key == name) return index;
  }
  return std::nullopt;
}

}  // namespace parallax::compiler
