#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "compiler/builtins/builtin_call.h"
#include "compiler/builtins/pose_math.h"

namespace parallax::compiler {

// Vectors, rotations, poses and transforms as values of a plan: made, taken apart, checked. The
// numbers stand in Value::pose. For stamped values Value::head is the stamp, for transforms
// Value::text is the child frame. Values without a stamp are taken to be in the frame `map`, where
// the regions are; values without a frame named by the plan have an empty one.

Vector3 vector_of(const Value& value);
Quaternion rotation_of(const Value& value);
RigidMotion motion_of(const Value& value);
inline bool is_pose(const Value& value) { return value.kind == ValueKind::kPose; }
inline bool is_transform(const Value& value) { return value.kind == ValueKind::kTransform; }

struct PoseFrame {
  std::string frame = "map";
  std::string child;             // of a transform
  std::optional<ValueId> stamp;  // none: not stamped
};
PoseFrame frame_of(const Value& value);

BuiltinResult make_vector(const BuiltinCall& c, const Vector3& v);
BuiltinResult make_rotation(const BuiltinCall& c, const Quaternion& q);
/// A pose or a transform; its rotation is made to have length one.
BuiltinResult make_placed(const BuiltinCall& c, ValueKind kind, const RigidMotion& motion,
                          const PoseFrame& frame);
BuiltinResult make_number(const BuiltinCall& c, double value);

/// An argument of that kind, or the error in it.
template <typename T>
using Argument = std::variant<T, BuiltinFailure>;
Argument<Vector3> vector_argument(const BuiltinCall& c, std::size_t index);
Argument<Quaternion> rotation_argument(const BuiltinCall& c, std::size_t index);
Argument<RigidMotion> placed_argument(const BuiltinCall& c, std::size_t index);
Argument<double> number_argument(const BuiltinCall& c, std::size_t index);
Argument<std::string> name_argument(const BuiltinCall& c, std::size_t index);
/// A number, or a time that only the robot knows.
bool is_stamp(const BuiltinCall& c, std::size_t index);

/// `:key value` pairs from an argument on; one that is nil counts as not given.
using KeyArguments = std::vector<std::pair<std::string, std::size_t>>;  // the value's index
Argument<KeyArguments> key_arguments(const BuiltinCall& c, std::size_t from,
                                     std::initializer_list<std::string_view> allowed);
std::optional<std::size_t> key_argument(const KeyArguments& keys, std::string_view name);

}  // namespace parallax::compiler
