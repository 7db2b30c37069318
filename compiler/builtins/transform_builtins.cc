// Arithmetic of vectors, rotations and transforms (cl-transforms).
#include <cmath>
#include <optional>
#include <variant>

#include "compiler/builtins/pose_values.h"

namespace parallax::compiler {
namespace {

BuiltinFailure no_direction(std::size_t index) {
  return {BuiltinError::kValue, fmt::format("argument {} has no direction", index + 1)};
}

/// Adds the further arguments to the first one, times `sign`; one vector alone is inverted by -.
BuiltinResult add_vectors(const BuiltinCall& c, double sign) {
  Vector3 out;
  for (std::size_t i = 0; i < c.args.size(); ++i) {
    const auto v = vector_argument(c, i);
    if (const auto* failure = std::get_if<BuiltinFailure>(&v)) return *failure;
    out = i == 0 && c.args.size() > 1 ? std::get<0>(v) : sum(out, scaled(std::get<0>(v), sign));
  }
  return make_vector(c, out);
}
BuiltinResult v_add(const BuiltinCall& c) { return add_vectors(c, 1.0); }
BuiltinResult v_subtract(const BuiltinCall& c) { return add_vectors(c, -1.0); }

BuiltinResult v_scale(const BuiltinCall& c) {
  const auto v = vector_argument(c, 0);
  if (const auto* failure = std::get_if<BuiltinFailure>(&v)) return *failure;
  const auto factor = number_argument(c, 1);
  if (const auto* failure = std::get_if<BuiltinFailure>(&factor)) return *failure;
  return make_vector(c, scaled(std::get<0>(v), std::get<0>(factor)));
}

BuiltinResult v_norm(const BuiltinCall& c) {
  const auto v = vector_argument(c, 0);
  if (const auto* failure = std::get_if<BuiltinFailure>(&v)) return *failure;
  return make_number(c, length(std::get<0>(v)));
}

BuiltinResult normalize_vector(const BuiltinCall& c) {
  const auto v = vector_argument(c, 0);
  if (const auto* failure = std::get_if<BuiltinFailure>(&v)) return *failure;
  const double size = length(std::get<0>(v));
  if (!(size >= kNoDirection)) return no_direction(0);
  return make_vector(c, scaled(std::get<0>(v), 1.0 / size));
}

template <typename Compute>
BuiltinResult of_two_vectors(const BuiltinCall& c, Compute compute) {
  const auto a = vector_argument(c, 0);
  if (const auto* failure = std::get_if<BuiltinFailure>(&a)) return *failure;
  const auto b = vector_argument(c, 1);
  if (const auto* failure = std::get_if<BuiltinFailure>(&b)) return *failure;
  return compute(std::get<0>(a), std::get<0>(b));
}
BuiltinResult v_dist(const BuiltinCall& c) {
  return of_two_vectors(c, [&](const Vector3& a, const Vector3& b) {
    return make_number(c, length(sum(a, scaled(b, -1.0))));
  });
}
BuiltinResult dot_product(const BuiltinCall& c) {
  return of_two_vectors(
      c, [&](const Vector3& a, const Vector3& b) { return make_number(c, dot(a, b)); });
}
BuiltinResult cross_product(const BuiltinCall& c) {
  return of_two_vectors(
      c, [&](const Vector3& a, const Vector3& b) { return make_vector(c, cross(a, b)); });
}

BuiltinResult q_multiply(const BuiltinCall& c) {
  Quaternion out;
  for (std::size_t i = 0; i < c.args.size(); ++i) {
    const auto q = rotation_argument(c, i);
    if (const auto* failure = std::get_if<BuiltinFailure>(&q)) return *failure;
    out = i == 0 ? std::get<0>(q) : product(out, std::get<0>(q));
  }
  return make_rotation(c, out);
}

template <std::optional<Quaternion> (*kFunction)(const Quaternion&)>
BuiltinResult of_rotation(const BuiltinCall& c) {
  const auto q = rotation_argument(c, 0);
  if (const auto* failure = std::get_if<BuiltinFailure>(&q)) return *failure;
  const auto out = kFunction(std::get<0>(q));
  if (!out) return no_direction(0);
  return make_rotation(c, *out);
}

BuiltinResult q_norm(const BuiltinCall& c) {
  const auto q = rotation_argument(c, 0);
  if (const auto* failure = std::get_if<BuiltinFailure>(&q)) return *failure;
  return make_number(c, length(std::get<0>(q)));
}

template <typename Compute>
BuiltinResult of_two_rotations(const BuiltinCall& c, Compute compute) {
  const auto a = rotation_argument(c, 0);
  if (const auto* failure = std::get_if<BuiltinFailure>(&a)) return *failure;
  const auto b = rotation_argument(c, 1);
  if (const auto* failure = std::get_if<BuiltinFailure>(&b)) return *failure;
  return compute(std::get<0>(a), std::get<0>(b));
}
BuiltinResult q_dot(const BuiltinCall& c) {
  return of_two_rotations(
      c, [&](const Quaternion& a, const Quaternion& b) { return make_number(c, dot(a, b)); });
}
BuiltinResult q_equal(const BuiltinCall& c) {
  return of_two_rotations(c, [&](const Quaternion& a, const Quaternion& b) -> BuiltinResult {
    return c.values.boolean(a.x == b.x && a.y == b.y && a.z == b.z && a.w == b.w);
  });
}
BuiltinResult angle_between(const BuiltinCall& c) {
  return of_two_rotations(c, [&](const Quaternion& a, const Quaternion& b) -> BuiltinResult {
    const auto back = inverse(a);
    if (!back) return no_direction(0);
    return make_number(c, angle_rad(product(*back, b)));
  });
}

BuiltinResult get_yaw(const BuiltinCall& c) {
  const auto q = rotation_argument(c, 0);
  if (const auto* failure = std::get_if<BuiltinFailure>(&q)) return *failure;
  return make_number(c, angle_rad(std::get<0>(q)));
}

BuiltinResult rotate(const BuiltinCall& c) {
  const auto q = rotation_argument(c, 0);
  if (const auto* failure = std::get_if<BuiltinFailure>(&q)) return *failure;
  const auto v = vector_argument(c, 1);
  if (const auto* failure = std::get_if<BuiltinFailure>(&v)) return *failure;
  const auto& turn = std::get<0>(q);
  if (!(std::abs(dot(turn, turn) - 1.0) < kNoDirection)) {
    return BuiltinFailure{BuiltinError::kValue,
                          "the rotation does not have length one; `normalize` it first"};
  }
  return make_vector(c, rotated(turn, std::get<0>(v)));
}

BuiltinResult axis_angle(const BuiltinCall& c) {
  const auto axis = vector_argument(c, 0);
  if (const auto* failure = std::get_if<BuiltinFailure>(&axis)) return *failure;
  const auto angle = number_argument(c, 1);
  if (const auto* failure = std::get_if<BuiltinFailure>(&angle)) return *failure;
  const auto out = around(std::get<0>(axis), std::get<0>(angle));
  if (!out) return no_direction(0);
  return make_rotation(c, *out);
}

BuiltinResult euler(const BuiltinCall& c) {
  const auto keys = key_arguments(c, 0, {"ax", "ay", "az"});
  if (const auto* failure = std::get_if<BuiltinFailure>(&keys)) return *failure;
  double angles[3] = {};
  const std::string_view names[3] = {"ax", "ay", "az"};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto index = key_argument(std::get<0>(keys), names[i]);
    if (!index) continue;
    const auto angle = number_argument(c, *index);
    if (const auto* failure = std::get_if<BuiltinFailure>(&angle)) return *failure;
    angles[i] = std::get<0>(angle);
  }
  return make_rotation(c, from_euler(angles[0], angles[1], angles[2]));
}

BuiltinResult normalize_angle(const BuiltinCall& c) {
  const auto angle = number_argument(c, 0);
  if (const auto* failure = std::get_if<BuiltinFailure>(&angle)) return *failure;
  return make_number(c, normalized_angle_rad(std::get<0>(angle)));
}

/// In which frame the numbers of the result stand: that of the first, onto that of the last one.
PoseFrame joined(const Value& first, const Value& last) {
  return {first.pose.frame, is_transform(last) ? last.text : "", std::nullopt};
}

BuiltinResult transform_inv(const BuiltinCall& c) {
  const auto value = c.values[c.args[0]];
  if (!is_transform(value)) return c.wrong(0, "a transform; `pose->transform` makes one of a pose");
  return make_placed(c, ValueKind::kTransform, inverse(motion_of(value)),
                     {value.text, value.pose.frame, std::nullopt});
}

BuiltinResult compose(const BuiltinCall& c) {
  RigidMotion out;
  for (std::size_t i = 0; i < c.args.size(); ++i) {
    if (!is_transform(c.values[c.args[i]])) {
      return c.wrong(i, "a transform; `pose->transform` makes one of a pose");
    }
    out = composed(out, motion_of(c.values[c.args[i]]));
  }
  return make_placed(c, ValueKind::kTransform, out,
                     joined(c.values[c.args.front()], c.values[c.args.back()]));
}

BuiltinResult transform_point(const BuiltinCall& c) {
  const auto& transform = c.values[c.args[0]];
  if (!is_transform(transform)) return c.wrong(0, "a transform");
  const auto motion = motion_of(transform);
  const auto v = vector_argument(c, 1);
  if (const auto* failure = std::get_if<BuiltinFailure>(&v)) return *failure;
  return make_vector(c, sum(motion.at, rotated(motion.turn, std::get<0>(v))));
}

/// (transform tr x): of a point a point, of a pose a pose.
BuiltinResult transform(const BuiltinCall& c) {
  const auto first = c.values[c.args[0]];
  const auto second = c.values[c.args[1]];
  if (!is_pose(second)) return transform_point(c);
  if (!is_transform(first)) return c.wrong(0, "a transform");
  return make_placed(c, ValueKind::kPose, composed(motion_of(first), motion_of(second)),
                     joined(first, second));
}

/// (transform-pose tr pose); the form of tf, with a transformer, only the robot can answer.
BuiltinResult transform_pose(const BuiltinCall& c) {
  if (c.args.size() == 2) return transform(c);
  return BuiltinFailure{BuiltinError::kValue, "takes a transform and a pose"};
}

/// A pose as a transform or the other way round; frames stay, stamps go.
template <ValueKind kFrom, ValueKind kTo>
BuiltinResult convert(const BuiltinCall& c) {
  const auto value = c.values[c.args[0]];
  if (value.kind == ValueKind::kTransform && kTo == ValueKind::kTransform) return c.args[0];
  if (value.kind != kFrom) {
    return c.wrong(0, kFrom == ValueKind::kPose ? "a pose" : "a transform");
  }
  return make_placed(c, kTo, motion_of(value), {value.pose.frame, "", std::nullopt});
}

constexpr BuiltinEntry kTransformTable[] = {
    {{"v+", 1, kAnyNumber}, v_add},
    {{"v-", 1, kAnyNumber}, v_subtract},
    {{"v*", 2, 2}, v_scale},
    {{"v-inv", 1, 1}, v_subtract},
    {{"v-norm", 1, 1}, v_norm},
    {{"v-dist", 2, 2}, v_dist},
    {{"dot-product", 2, 2}, dot_product},
    {{"cross-product", 2, 2}, cross_product},
    {{"normalize-vector", 1, 1}, normalize_vector},
    {{"q*", 1, kAnyNumber}, q_multiply},
    {{"q-inv", 1, 1}, of_rotation<inverse>},
    {{"normalize", 1, 1}, of_rotation<unit>},
    {{"q-norm", 1, 1}, q_norm},
    {{"q-dot", 2, 2}, q_dot},
    {{"q=", 2, 2}, q_equal},
    {{"angle-between-quaternions", 2, 2}, angle_between},
    {{"get-yaw", 1, 1}, get_yaw},
    {{"rotate", 2, 2}, rotate},
    {{"axis-angle->quaternion", 2, 2}, axis_angle},
    {{"euler->quaternion", 0, kAnyNumber}, euler},
    {{"normalize-angle", 1, 1}, normalize_angle},
    {{"transform-inv", 1, 1}, transform_inv},
    {{"transform*", 1, kAnyNumber}, compose},
    {{"transform-point", 2, 2}, transform_point},
    {{"transform-pose", 2, kAnyNumber}, transform_pose},
    {{"transform", 2, 2}, transform},
    {{"pose->transform", 1, 1}, convert<ValueKind::kPose, ValueKind::kTransform>},
    {{"reference-transform", 1, 1}, convert<ValueKind::kPose, ValueKind::kTransform>},
    {{"transform->pose", 1, 1}, convert<ValueKind::kTransform, ValueKind::kPose>},
};

}  // namespace

std::span<const BuiltinEntry> transform_builtins() { return kTransformTable; }

}  // namespace parallax::compiler
