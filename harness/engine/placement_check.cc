// Faults in the placement of bodies and regions that can be told before any start is drawn.
//
// Two bodies overlap at every start if no start may choose the place of either, or of what it
// hangs on; the engine is asked about these at their default places (sweep.cc), and about the
// floor alone where only the height is fixed. Fixed furniture may reach into furniture, but two
// pieces whose boxes cover each other are one too many. A point is without support if neither
// furniture nor floor is met there, and so is a box grown by the longest travel of a slider;
// boxes that begin below the height of all free bodies stacked are not looked at. A region is
// buried if it lies wholly inside one box of a fixed body. A box is in another if all its
// corners are, as both are convex.
//
// Cost: for each body one question to the engine, and quadratic in the fixed bodies.

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <memory>
#include <set>

#include "harness/engine/physics_world.h"
#include "harness/engine/sweep.h"
#include "harness/engine/world_check.h"
#include "harness/world/shapes.h"

namespace parallax::harness {
namespace {

constexpr double kRounding_m = 1e-9;
constexpr double kPlay_m = 0.005;
constexpr double kPoint_m = 0.004;  // edge of the box that stands for a point

Eigen::Matrix3d turn(double yaw_rad) {
  return Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

/// A box of a body at its default placement: upright, turned about z.
struct SolidBox {
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero(), p_WS = Eigen::Vector3d::Zero();
  double yaw_rad = 0.0;
  bool contains(const Eigen::Vector3d& p_W) const;
  bool contains(const SolidBox& other) const;  // all its corners: both are convex
};

bool SolidBox::contains(const Eigen::Vector3d& p_W) const {
  const Eigen::Vector3d p_S = turn(yaw_rad).transpose() * (p_W - p_WS);
  return (p_S.cwiseAbs().array() <= 0.5 * size_m.array() + kRounding_m).all();
}

bool SolidBox::contains(const SolidBox& other) const {
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d sign((corner & 1) != 0 ? 0.5 : -0.5, (corner & 2) != 0 ? 0.5 : -0.5,
                               (corner & 4) != 0 ? 0.5 : -0.5);
    const Eigen::Vector3d p_S = sign.cwiseProduct(other.size_m);
    if (!contains(Eigen::Vector3d(other.p_WS + turn(other.yaw_rad) * p_S))) return false;
  }
  return true;
}

/// The upright boxes of a body that collides; none of another.
std::vector<SolidBox> solid_boxes(const BodySpec& body) {
  std::vector<SolidBox> boxes;
  if (!body.collides) return boxes;
  for (const BodyShape& shape : body.shapes) {
    if (!is_upright_box(shape)) continue;
    boxes.push_back(
        {shape.size_m, body.p_WB + turn(body.yaw_rad) * shape.p_BS, body.yaw_rad + shape.yaw_rad});
  }
  return boxes;
}

bool can_set_any(const BodySpec& body, std::initializer_list<std::string_view> items) {
  return std::any_of(items.begin(), items.end(),
                     [&](std::string_view item) { return body.can_set(item); });
}

/// Checks overlaps. Bodies that every start puts at the same place can be tested against each other
/// beforehand.
class OverlapChecker {
 public:
  OverlapChecker(const WorldSpec& spec, ProblemList& problems)
      : spec_(spec), problems_(problems), owned_(make_world(spec)), layout_(world_.layout()) {
    for (std::size_t i = 0; i < layout_.bodies.size(); ++i) {
      elsewhere_.push_back(chosen(i, {"x", "y", "z", "bottom", "yaw"}));
    }
  }

  void run() {
    for (std::size_t i = 0; i < layout_.bodies.size(); ++i) {
      if (!layout_.link_of[i]) {
        check_twins(i);
      } else if (!elsewhere_[i]) {
        check_against(i, elsewhere_);
      } else if (!chosen(i, {"z", "bottom"})) {
        check_against(i, BodyMask(layout_.bodies.size(), true));  // the floor is left
      }
    }
  }

 private:
  const BodySpec& body(std::size_t i) const { return layout_.bodies[layout_.bodies.id_at(i)]; }

  /// May a start choose one of these items of the body, or of a body that it hangs on?
  bool chosen(std::size_t i, std::initializer_list<std::string_view> items) const {
    if (!layout_.link_of[i]) return false;
    for (std::size_t k = 0; k < layout_.bodies.size(); ++k) {
      const bool together =
          k == i || (!layout_.is_free[i] && layout_.assembly_of[k] == layout_.assembly_of[i]);
      if (together && can_set_any(body(k), items)) return true;
    }
    return false;
  }

  void check_against(std::size_t i, BodyMask ignored) {
    BodyMask self(layout_.bodies.size(), false);
    self[i] = true;
    for (std::size_t k = 0; k < layout_.bodies.size(); ++k) {
      const bool together = !layout_.is_free[i] && layout_.link_of[k] &&
                            layout_.assembly_of[k] == layout_.assembly_of[i];
      if (together || layout_.never_collide(layout_.bodies.id_at(i), layout_.bodies.id_at(k))) {
        ignored[k] = true;
      }
    }
    const Sweep sweep(world_, self, ignored, spec_.solver.start_penetration_m);
    const Eigen::Vector3d none = Eigen::Vector3d::Zero();
    const auto hit = sweep.along(none, none, 1.0);
    if (!hit || !reported_.insert(std::minmax(hit->part, hit->obstacle)).second) return;
    problems_.add("bodies/" + hit->part,
                  fmt::format("overlaps `{}` at every start", hit->obstacle));
  }

  /// Furniture may reach into furniture; two pieces at one place are one too many.
  void check_twins(std::size_t i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (layout_.link_of[k] ||
          layout_.never_collide(layout_.bodies.id_at(i), layout_.bodies.id_at(k)) ||
          !covers(body(k), body(i)) || !covers(body(i), body(k)))
        continue;
      problems_.add("bodies/" + body(i).name,
                    fmt::format("occupies the same place as `{}`", body(k).name));
      return;
    }
  }

  /// Is every shape of `inner` an upright box inside one of `outer`?
  bool covers(const BodySpec& outer, const BodySpec& inner) const {
    if (!std::all_of(inner.shapes.begin(), inner.shapes.end(), &is_upright_box)) return false;
    const auto outer_boxes = solid_boxes(outer), inner_boxes = solid_boxes(inner);
    return !inner_boxes.empty() &&
           std::all_of(inner_boxes.begin(), inner_boxes.end(), [&](const SolidBox& box) {
             return std::any_of(outer_boxes.begin(), outer_boxes.end(),
                                [&](const SolidBox& other) { return other.contains(box); });
           });
  }

  const WorldSpec& spec_;
  ProblemList& problems_;
  std::unique_ptr<const PhysicsWorld> owned_;
  const PhysicsWorld& world_ = *owned_;
  const WorldLayout& layout_;
  BodyMask elsewhere_;  // those whose place a start may choose
  std::set<std::pair<std::string, std::string>> reported_;
};

/// The height of all free bodies stacked, each standing on its longest edge [m].
double stack_height_m(const PhysicsWorld& world) {
  const WorldLayout& layout = world.layout();
  double height_m = 0.0;
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    if (!layout.is_free[i]) continue;
    const BodyBounds bounds = world.bounds(layout.bodies.id_at(i));
    height_m += (bounds.high - bounds.low).maxCoeff();
  }
  return height_m;
}

double longest_travel_m(const WorldLayout& layout) {
  double travel_m = 0.0;
  for (const JointSpec& joint : layout.sliders) {
    if (joint.low_m && joint.high_m) travel_m = std::max(travel_m, *joint.high_m - *joint.low_m);
  }
  return travel_m;
}

}  // namespace

void check_overlaps(const WorldSpec& spec, ProblemList& problems) {
  if (!spec.bodies.empty()) OverlapChecker(spec, problems).run();
}

std::vector<std::string> unsupported_points(const WorldSpec& spec,
                                            const std::vector<NamedPoint>& points) {
  const std::unique_ptr<const PhysicsWorld> owned = make_world(spec);
  const PhysicsWorld& world = *owned;
  const WorldLayout& layout = world.layout();
  BodyMask ignored(layout.bodies.size(), false);
  const auto base = layout.find_body(base_body(spec));
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    const bool robot = base && layout.assembly_of[i] == layout.assembly_of[base->index()];
    ignored[i] = layout.is_free[i] || (robot && layout.link_of[i]);
  }
  std::vector<std::string> found;
  for (const NamedPoint& point : points) {
    const Probe probe{Eigen::Vector3d::Constant(kPoint_m), point.p_W, Eigen::Matrix3d::Identity()};
    if (!world.find_obstacle(probe, ignored, 0.0)) found.push_back(point.name);
  }
  return found;
}

std::vector<std::string> boxes_without_support(const WorldSpec& spec,
                                               const std::vector<NamedBox>& boxes) {
  const std::unique_ptr<const PhysicsWorld> owned = make_world(spec);
  const PhysicsWorld& world = *owned;
  const WorldLayout& layout = world.layout();
  const double stack_m = stack_height_m(world);
  const Eigen::Vector3d travel_m = Eigen::Vector3d::Constant(longest_travel_m(layout));
  std::vector<std::string> found;
  for (const NamedBox& box : boxes) {
    if (box.low_W.z() <= stack_m) continue;
    const Eigen::Vector3d low = box.low_W - travel_m, high = box.high_W + travel_m;
    const Probe probe{high - low, 0.5 * (low + high), Eigen::Matrix3d::Identity()};
    if (!world.find_obstacle(probe, layout.is_free, 0.0)) found.push_back(box.name);
  }
  return found;
}

std::vector<BuriedBox> buried_boxes(const WorldSpec& spec, const std::vector<NamedBox>& boxes) {
  const WorldLayout layout = lay_out(spec);
  std::vector<BuriedBox> found;
  for (const NamedBox& box : boxes) {
    // A body that lies on another is just above the other's top.
    const Eigen::Vector3d high = box.high_W + Eigen::Vector3d(0.0, 0.0, kPlay_m);
    const SolidBox region{high - box.low_W, 0.5 * (box.low_W + high), 0.0};
    for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
      if (layout.link_of[i]) continue;
      const BodySpec& body = layout.bodies[layout.bodies.id_at(i)];
      const auto solids = solid_boxes(body);
      const bool inside = std::any_of(solids.begin(), solids.end(), [&](const SolidBox& solid) {
        return solid.contains(region);
      });
      if (!inside) continue;
      found.push_back({box.name, body.name});
      break;
    }
  }
  return found;
}

}  // namespace parallax::harness
