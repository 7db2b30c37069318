#include "harness/geometry_proof/sight_error.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace parallax::harness {
namespace {

constexpr double kRayRounding_m = 1e-6;

double size_of(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  return (high - low).norm();
}

std::pair<Eigen::Vector3d, Eigen::Vector3d> own_bounds_of(const BodySpec& body) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(INFINITY), high = -low;
  for (const BodyShape& shape : body.shapes) {
    const double c = std::abs(std::cos(shape.yaw_rad)), s = std::abs(std::sin(shape.yaw_rad));
    const Eigen::Vector3d& size = shape.size_m;
    const Eigen::Vector3d half =
        0.5 * Eigen::Vector3d(c * size.x() + s * size.y(), s * size.x() + c * size.y(), size.z());
    low = low.cwiseMin(shape.p_BS - half);
    high = high.cwiseMax(shape.p_BS + half);
  }
  return {low, high};
}

/// Ranges of the way from the camera to a body's origin, in the body's frame.
std::array<Bounds1, 3> way_in_body(const ProofScene& scene, std::span<const Bounds1> box,
                                   BodyId body) {
  const ProofScene::Base base = scene.base(box);
  const ProofScene::Point camera = scene.on_torso(scene.spec().mobile->camera.p_BC, base);
  const ProofScene::Base at = scene.free_body(body, box);
  const AffineForm x = at.x - camera.x, y = at.y - camera.y;
  const AffineForm along = at.cosine * x + at.sine * y, across = at.cosine * y - at.sine * x;
  const Bounds1 height = scene.free_height(body);
  std::array<Bounds1, 3> way = {
      along.bounds(), across.bounds(),
      Bounds1{height.lower - camera.z.upper(), height.upper - camera.z.lower()}};
  // A body that keeps its place may lean, about both level axes.
  double square = 0.0;
  for (const Bounds1& one : way) square += std::pow(std::max(-one.lower, one.upper), 2);
  const double lean_m = scene.state().slack.drift_rad * std::sqrt(square);
  for (Bounds1& one : way) one = {one.lower - lean_m, one.upper + lean_m};
  return way;
}

using Way = std::array<Bounds1, 3>;

double most_of(const Bounds1& part) { return std::max(-part.lower, part.upper); }
double least_of(const Bounds1& part) { return std::max({part.lower, -part.upper, 0.0}); }
bool has_sign(const Bounds1& part) { return least_of(part) > 0.0; }

/// Within which share of its way to a point a ray stays no farther from it than `room`, at most;
/// `besides`: an axis that is not looked at.
double share_within(const Way& way, const Eigen::Vector3d& room, Eigen::Index besides) {
  double share = INFINITY;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double least = least_of(way[static_cast<std::size_t>(k)]);
    if (k != besides && least > 0.0) share = std::min(share, room(k) / least);
  }
  return share;
}

/// To which sides of a point the middle of the chord through it may lie.
struct ChordError {
  bool towards_camera = false, away = false;
};

/// `axis`: of the line on which the points lie. Against the chord of a prism about the point, which
/// ends alike on both sides, one end may be nearer (the shape ends before) or farther (the ray goes
/// on in another shape).
ChordError chord_error(const BodySpec& body, const Eigen::Vector3d& point, Eigen::Index axis,
                       const Way& way, const Eigen::Vector3d& room) {
  const Bounds1& along = way[static_cast<std::size_t>(axis)];
  const auto own = std::find_if(body.shapes.begin(), body.shapes.end(), [&](const auto& shape) {
    const Eigen::Vector3d off = point - shape.p_BS;
    return (off.cwiseAbs() - 0.5 * shape.size_m).maxCoeff() <= kRayRounding_m;
  });
  const bool is_turned = std::any_of(body.shapes.begin(), body.shapes.end(),
                                     [](const auto& shape) { return shape.yaw_rad != 0.0; });
  if (is_turned) return {true, true};
  if (own == body.shapes.end()) return {};  // nothing there: the point itself is taken
  const Eigen::Vector3d half = 0.5 * own->size_m, off = point - own->p_BS;
  Eigen::Vector3d beside = off;
  beside(axis) = 0.0;
  if (beside.norm() > 1e-9 || half(axis) - std::abs(off(axis)) < kRayRounding_m) {
    return {true, true};
  }
  const double most = most_of(along);
  const double in_own = share_within(way, half, axis) * most + kRayRounding_m;
  const double in_any = share_within(way, room, axis) * most + kRayRounding_m;
  bool is_short[2] = {}, is_long[2] = {};  // below the point along the axis, and above it
  for (const int side : {0, 1}) {
    const double sign = side == 0 ? -1.0 : 1.0;
    is_short[side] = half(axis) - sign * off(axis) < in_own;
    for (const BodyShape& other : body.shapes) {
      if (&other == &*own) continue;
      const Eigen::Vector3d way_there = other.p_BS - point, wide = 0.5 * other.size_m;
      const double far = sign * way_there(axis) + wide(axis);
      const double near = sign * way_there(axis) - wide(axis);
      if (far < 0.0 || near > in_any) continue;
      Eigen::Vector3d beyond = (other.p_BS - own->p_BS).cwiseAbs() + wide - half;
      beyond(axis) = 0.0;
      is_long[side] = is_long[side] || beyond.maxCoeff() > 1e-9;
    }
  }
  ChordError error;
  for (const int front : {0, 1}) {
    // Seen from the camera the front is below where the way leads upwards.
    if (has_sign(along) && (along.lower > 0.0) != (front == 0)) continue;
    const int back = 1 - front;
    error.towards_camera = error.towards_camera || is_long[front] || is_short[back];
    error.away = error.away || is_short[front] || is_long[back];
  }
  return error;
}

}  // namespace

std::vector<Eigen::Vector3d> sighted_points(const BodySpec& body, int count) {
  const auto [low, high] = own_bounds_of(body);
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) {
    Eigen::Vector3d point = 0.5 * (low + high);
    point(axis) += (high - low)(axis) * ((i + 0.5) / count - 0.5);
    points.push_back(point);
  }
  return points;
}

SightError sight_error(const ProofScene& scene, std::span<const Bounds1> box, BodyId id, int points,
                       int needed) {
  const BodySpec& body = scene.layout().bodies[id];
  const auto [low, high] = own_bounds_of(body);
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  const Way way = way_in_body(scene, box, id);
  int towards_camera = 0, away = 0;
  bool all_above = true, all_below = true;
  double share = 0.0;  // of the way to a point, by which its estimate may be off
  for (const Eigen::Vector3d& point : sighted_points(body, points)) {
    Way there = way;
    for (Eigen::Index k = 0; k < 3; ++k) {
      Bounds1& part = there[static_cast<std::size_t>(k)];
      part = {part.lower + point(k), part.upper + point(k)};
    }
    const Eigen::Vector3d room = (point - low).cwiseMax(high - point);
    all_above = all_above && there[2].upper < 0.0;
    all_below = all_below && there[2].lower > 0.0;
    const ChordError error = chord_error(body, point, axis, there, room);
    towards_camera += error.towards_camera ? 1 : 0;
    away += error.away ? 1 : 0;
    if (!error.towards_camera && !error.away) continue;
    constexpr Eigen::Index kNone = -1;
    share = std::max(share, 0.5 * share_within(there, room, kNone));
  }
  share = std::min(share, 1e6);
  // Beyond their ends no ray is in the body.
  double level = 0.0;
  for (const std::size_t k : {0U, 1U})
    level = std::hypot(level, most_of(way[k]) + size_of(low, high));
  SightError out{std::min(share * level, size_of(low, high)),
                 std::min(share * most_of(way[2]), 0.5 * (high - low).z())};
  if (std::max(towards_camera, away) <= (needed - 1) / 2) {
    // As many are exact as to either side of the median; but where a coordinate of the rays has not
    // one sign, sides are not the same in all of them, and it is small: no more than the points
    // differ in it.
    out.level_m = std::min(out.level_m, share * size_of(low, high));
    out.height_m = all_above || all_below ? 0.0 : std::min(out.height_m, out.level_m);
  }
  // The body may lean: what is level in it counts as height, too, and the other way round.
  const double lean = scene.state().slack.drift_rad;
  return {out.level_m + lean * out.height_m + kRayRounding_m,
          out.height_m + lean * out.level_m + kRayRounding_m};
}

}  // namespace parallax::harness
