#pragma once

#include <optional>

namespace parallax::compiler {

/// Vectors, rotations and rigid motions as plans use them. Results may be infinite; callers that
/// make values of them must check.
struct Vector3 {
  double x = 0.0, y = 0.0, z = 0.0;
};
struct Quaternion {
  double x = 0.0, y = 0.0, z = 0.0, w = 1.0;
};
/// A rotation followed by a translation.
struct RigidMotion {
  Vector3 at;
  Quaternion turn;  // unit quaternion
};

/// Below this length a quaternion or an axis has no direction.
inline constexpr double kNoDirection = 1e-6;

Vector3 sum(const Vector3& a, const Vector3& b);
Vector3 scaled(const Vector3& a, double factor);
double dot(const Vector3& a, const Vector3& b);
Vector3 cross(const Vector3& a, const Vector3& b);
double length(const Vector3& a);

Quaternion product(const Quaternion& a, const Quaternion& b);
double length(const Quaternion& q);
double dot(const Quaternion& a, const Quaternion& b);
/// The quaternion at unit length; none if it has no direction (kNoDirection) or is not finite. The
/// same for the inverse.
std::optional<Quaternion> unit(const Quaternion& q);
std::optional<Quaternion> inverse(const Quaternion& q);
/// `v` rotated by a unit quaternion.
Vector3 rotated(const Quaternion& q, const Vector3& v);
std::optional<Quaternion> around(const Vector3& axis, double angle_rad);
/// Rotation about the fixed axes x, then y, then z.
Quaternion from_euler(double x_rad, double y_rad, double z_rad);
/// Rotation angle of a unit quaternion, in [0, 2 pi].
double angle_rad(const Quaternion& q);
/// The angle normalized to [-pi, pi).
double normalized_angle_rad(double angle_rad);

/// The motion `b` followed by `a`.
RigidMotion composed(const RigidMotion& a, const RigidMotion& b);
RigidMotion inverse(const RigidMotion& a);

bool is_finite(const Vector3& v);
bool is_finite(const Quaternion& q);

}  // namespace parallax::compiler
