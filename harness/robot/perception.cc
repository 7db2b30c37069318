#include "harness/robot/perception.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "harness/world/angles.h"
#include "harness/world/shapes.h"

namespace parallax::harness {
namespace {

/// Bounding box of a body in its own frame.
BodyBounds own_bounds(const BodySpec& body) {
  BodyBounds all;
  bool first = true;
  for (const BodyShape& shape : body.shapes) {
    const auto [from, to] = span(shape.form, shape.size_m, shape.hull.get(), shape_rotation(shape));
    const Eigen::Vector3d low = shape.p_BS + from, high = shape.p_BS + to;
    all.low = first ? low : Eigen::Vector3d(all.low.cwiseMin(low));
    all.high = first ? high : Eigen::Vector3d(all.high.cwiseMax(high));
    first = false;
  }
  return all;
}

/// Points along the longest middle line of the box, in the body's frame.
std::vector<Eigen::Vector3d> sample_points(const BodySpec& body, int count) {
  const BodyBounds box = own_bounds(body);
  const Eigen::Vector3d size = box.high - box.low;
  Eigen::Index longest = 0;
  size.maxCoeff(&longest);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) {
    Eigen::Vector3d point = 0.5 * (box.low + box.high);
    point(longest) += size(longest) * ((i + 0.5) / count - 0.5);
    points.push_back(point);
  }
  return points;
}

/// Coordinate by coordinate, the lower of two: rays that clip an edge do not move it.
Eigen::Vector3d median(std::vector<Eigen::Vector3d> points) {
  const auto middle = static_cast<std::ptrdiff_t>((points.size() - 1) / 2);
  Eigen::Vector3d result;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::nth_element(points.begin(), points.begin() + middle, points.end(),
                     [axis](const auto& a, const auto& b) { return a(axis) < b(axis); });
    result(axis) = points[static_cast<std::size_t>(middle)](axis);
  }
  return result;
}

/// Is the point, in the body's frame, in the matter of the body?
bool is_solid_at(const BodySpec& body, const Eigen::Vector3d& p_B) {
  return std::any_of(body.shapes.begin(), body.shapes.end(),
                     [&](const BodyShape& shape) { return contains(shape, p_B); });
}

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

Perception::Perception(const PhysicsWorld& world, const MobileRobot& robot)
    : world_(world),
      robot_(robot),
      beliefs_(world.layout().bodies.size()),
      errors_(robot.spec().camera.detection) {}

void Perception::reset(std::uint64_t seed) {
  errors_.reset(seed);
  gaze_ = PlaceSpec{};
  looking_ = false;
  beliefs_.assign(beliefs_.size(), BodyBelief{});
}

Eigen::Vector3d Perception::from_frame(const std::string& frame, const Eigen::Vector3d& p_F) const {
  if (frame.empty()) return p_F;
  const BodyId id = *world_.layout().find_body(frame);
  return world_.position(id) + world_.rotation(id) * p_F;
}

Eigen::Vector3d Perception::place_in_world(const PlaceSpec& place) const {
  return from_frame(place.frame, place.p_FP);
}

std::optional<std::string> Perception::look_at(const PlaceSpec& place) {
  const CameraSpec& camera = robot_.spec().camera;
  const Eigen::Vector3d way = place_in_world(place) - robot_.camera();
  const double pan = wrapped(std::atan2(way.y(), way.x()) - robot_.base().pose().yaw_rad);
  const double tilt = std::atan2(-way.z(), way.head<2>().norm());
  if (std::abs(pan) > camera.max_pan_rad) return fmt::format("a turn of {:.2f} rad", pan);
  if (tilt < camera.min_tilt_rad || tilt > camera.max_tilt_rad) {
    return fmt::format("a tilt of {:.2f} rad", tilt);
  }
  gaze_ = place;
  looked_W_ = place_in_world(place);
  neck_B_ = world_.rotation(robot_.base().body()).transpose() * way;
  looking_ = true;
  return std::nullopt;
}

bool Perception::is_on_target() const {
  const Eigen::Vector3d neck_W = world_.rotation(robot_.base().body()) * neck_B_;
  const double off_rad = angle_between(neck_W, looked_W_ - robot_.camera());
  return off_rad <= robot_.spec().camera.half_angle_rad;
}

std::string Perception::gaze() const {
  return looking_ && is_on_target() ? gaze_.name : std::string();
}

void Perception::drop_lost_gaze() { looking_ = looking_ && is_on_target(); }

std::optional<Gaze> Perception::line_of_sight() const {
  if (!looking_) return std::nullopt;
  return Gaze{robot_.camera(), place_in_world(gaze_)};
}

Eigen::Vector3d Perception::middle_of_chord(const Eigen::Vector3d& from, const Eigen::Vector3d& p_B,
                                            BodyId id) const {
  const BodySpec& body = world_.layout().bodies[id];
  const BodyBounds box = own_bounds(body);
  const Eigen::Vector3d aim = from + (world_.position(id) + world_.rotation(id) * p_B - from);
  // Near wall and bottom, which a ray at the hollow of a bowl meets, do not lie about its middle.
  if (!is_solid_at(body, p_B)) return aim;
  const Eigen::Vector3d direction = (aim - from).normalized();
  const Eigen::Vector3d beyond = aim + (box.high - box.low).norm() * direction;
  const auto front_m = world_.ray_meets(from, beyond, id);
  const auto back_m = world_.ray_meets(beyond, from, id);
  if (!front_m || !back_m) return aim;  // the ray grazes an edge
  return 0.5 * (from + *front_m * direction + beyond - *back_m * direction);
}

Sighting Perception::sight(BodyId id, int points) const {
  Sighting sighting;
  sighting.points = points;
  if (!looking_) return sighting;
  const CameraSpec& camera = robot_.spec().camera;
  const Eigen::Vector3d p_WC = robot_.camera();
  const Eigen::Vector3d gaze = place_in_world(gaze_) - p_WC;
  const Eigen::Vector3d p_WB = world_.position(id);
  const Eigen::Matrix3d R_WB = world_.rotation(id);
  std::vector<Eigen::Vector3d> estimates;
  for (const Eigen::Vector3d& point : sample_points(world_.layout().bodies[id], points)) {
    const Eigen::Vector3d way = p_WB + R_WB * point - p_WC;
    const double distance_m = way.norm();
    if (distance_m < camera.min_range_m || distance_m > camera.max_range_m) continue;
    if (angle_between(way, gaze) > camera.half_angle_rad) continue;
    const auto hit = world_.cast_ray(p_WC, p_WC + way, robot_.parts());
    if (hit && hit->body != world_.layout().bodies[id].name) {
      sighting.hidden_by = hit->body;
      continue;
    }
    estimates.push_back(middle_of_chord(p_WC, point, id) - R_WB * point);
  }
  sighting.seen = static_cast<int>(estimates.size());
  if (!estimates.empty()) sighting.p_W = median(std::move(estimates));
  return sighting;
}

void Perception::store(BodyId id, BodyId like, const Eigen::Vector3d& p_W, double yaw_rad,
                       const std::string& frame) {
  BodyBelief& belief = beliefs_[id.index()];
  belief.located = true;
  belief.frame = frame;
  const double below_m = world_.position(like).z() - world_.bounds(like).low.z();
  belief.yaw_rad = yaw_rad;
  belief.p_F = p_W;
  if (!belief.frame.empty()) {
    const BodyId carrier = *world_.layout().find_body(belief.frame);
    belief.p_F = world_.rotation(carrier).transpose() * (p_W - world_.position(carrier));
  }
  belief.bottom_F_m = belief.p_F.z() - below_m;
}

void Perception::believe(BodyId id, const Sighting& sighting, std::optional<BodyId> taken_for) {
  const DetectionError error = errors_.next();
  Eigen::Vector3d p_W = sighting.p_W;
  p_W.head<2>() += error.shift_m;
  const BodyId believed = taken_for.value_or(id);
  store(believed, id, p_W, wrapped(heading_rad(world_.rotation(id)) + error.turn_rad), gaze_.frame);
  beliefs_[believed.index()].perceived = true;
}

void Perception::believe_as_is(BodyId id) {
  store(id, id, world_.position(id), heading_rad(world_.rotation(id)), {});
}

std::optional<Eigen::Vector3d> Perception::believed(BodyId id) const {
  const BodyBelief& belief = beliefs_[id.index()];
  if (!belief.located) return std::nullopt;
  return from_frame(belief.frame, belief.p_F);
}

std::optional<double> Perception::believed_bottom_m(BodyId id) const {
  const BodyBelief& belief = beliefs_[id.index()];
  if (!belief.located) return std::nullopt;
  return from_frame(belief.frame, {belief.p_F.x(), belief.p_F.y(), belief.bottom_F_m}).z();
}

std::vector<BodyId> Perception::bodies_of_kind(const std::string& kind) const {
  std::vector<BodyId> found;
  const WorldLayout& layout = world_.layout();
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    const BodyId id = layout.bodies.id_at(i);
    if (layout.is_free[i] && layout.bodies[id].kind_name() == kind) found.push_back(id);
  }
  return found;
}

}  // namespace parallax::harness
