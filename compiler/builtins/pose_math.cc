#include "compiler/builtins/pose_math.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace parallax::compiler {

Vector3 sum(const Vector3& a, const Vector3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }

Vector3 scaled(const Vector3& a, double factor) {
  return {a.x * factor, a.y * factor, a.z * factor};
}

double dot(const Vector3& a, const Vector3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

double length(const Vector3& a) { return std::hypot(a.x, a.y, a.z); }

Quaternion product(const Quaternion& a, const Quaternion& b) {
  return {
      a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
      a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

double length(const Quaternion& q) {
  return std::hypot(std::hypot(q.x, q.y), std::hypot(q.z, q.w));
}

double dot(const Quaternion& a, const Quaternion& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
}

std::optional<Quaternion> unit(const Quaternion& q) {
  const double size = length(q);
  if (!(size >= kNoDirection) || !std::isfinite(size)) return std::nullopt;
  return Quaternion{q.x / size, q.y / size, q.z / size, q.w / size};
}

std::optional<Quaternion> inverse(const Quaternion& q) {
  const double size = length(q);
  if (!(size >= kNoDirection) || !std::isfinite(size)) return std::nullopt;
  return Quaternion{-q.x / size / size, -q.y / size / size, -q.z / size / size, q.w / size / size};
}

Vector3 rotated(const Quaternion& q, const Vector3& v) {
  const Vector3 axis = {q.x, q.y, q.z};
  const auto twice = scaled(cross(axis, v), 2.0);
  return sum(v, sum(scaled(twice, q.w), cross(axis, twice)));
}

std::optional<Quaternion> around(const Vector3& axis, double angle_rad) {
  const double size = length(axis);
  if (!(size >= kNoDirection) || !std::isfinite(size)) return std::nullopt;
  const double part = std::sin(angle_rad / 2.0);
  return Quaternion{axis.x / size * part, axis.y / size * part, axis.z / size * part,
                    std::cos(angle_rad / 2.0)};
}

Quaternion from_euler(double x_rad, double y_rad, double z_rad) {
  const Quaternion x = {std::sin(x_rad / 2.0), 0.0, 0.0, std::cos(x_rad / 2.0)};
  const Quaternion y = {0.0, std::sin(y_rad / 2.0), 0.0, std::cos(y_rad / 2.0)};
  const Quaternion z = {0.0, 0.0, std::sin(z_rad / 2.0), std::cos(z_rad / 2.0)};
  return product(z, product(y, x));
}

double angle_rad(const Quaternion& q) { return 2.0 * std::acos(std::clamp(q.w, -1.0, 1.0)); }

double normalized_angle_rad(double angle_rad) {
  const double out = std::remainder(angle_rad, 2.0 * std::numbers::pi);
  return out >= std::numbers::pi ? -std::numbers::pi : out;
}

RigidMotion composed(const RigidMotion& a, const RigidMotion& b) {
  const auto turn = product(a.turn, b.turn);
  // Rounding errors of long products do not add up.
  return {sum(a.at, rotated(a.turn, b.at)), unit(turn).value_or(turn)};
}

RigidMotion inverse(const RigidMotion& a) {
  const Quaternion back = {-a.turn.x, -a.turn.y, -a.turn.z, a.turn.w};
  return {rotated(back, scaled(a.at, -1.0)), back};
}

bool is_finite(const Vector3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool is_finite(const Quaternion& q) {
  return std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z) && std::isfinite(q.w);
}

}  // namespace parallax::compiler
