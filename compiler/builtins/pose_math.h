#pragma once

#include <optional>

namespace parallax::compiler {

/// What plans do with vectors, rotations and rigid motions. Results may be infinite; whoever makes
/// values of them looks.
struct Vector3 {
  double x = 0.0, y = 0.0, z = 0.0;
};
struct Quaternion {
  double x = 0.0, y = 0.0, z = 0.0, w = 1.0;
};
/// Turns, then moves.
struct RigidMotion {
  Vector3 at;
  Quaternion turn;  // of length one
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
/// None without a direction.
std::optional<Quaternion> unit(const Quaternion& q);
std::optional<Quaternion> inverse(const Quaternion& q);
/// By a quaternion of length one.
Vector3 rotated(const Quaternion& q, const Vector3& v);
std::optional<Quaternion> around(const Vector3& axis, double angle_rad);
/// About x, then y, then z, which stay where they are.
Quaternion from_euler(double x_rad, double y_rad, double z_rad);
/// How far a quaternion of length one turns, in [0, 2 pi].
double angle_rad(const Quaternion& q);
/// In [-pi, pi).
double normalized_angle_rad(double angle_rad);

/// `b` first.
RigidMotion composed(const RigidMotion& a, const RigidMotion& b);
RigidMotion inverse(const RigidMotion& a);

bool is_finite(const Vector3& v);
bool is_finite(const Quaternion& q);

}  // namespace parallax::compiler
