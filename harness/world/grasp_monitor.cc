#include "harness/world/grasp_monitor.h"

#include <algorithm>
#include <cmath>

namespace parallax::harness {
namespace {

constexpr double kHeldFor_s = 0.2;
constexpr double kClearance_m = 0.010;

bool overlap_in_plan(const Bounds& a, const Bounds& b) {
  return a.low.x() < b.high.x() && b.low.x() < a.high.x() && a.low.y() < b.high.y() &&
         b.low.y() < a.high.y();
}

}  // namespace

GraspMonitor::GraspMonitor(const WorldSpec& spec, const OdeWorld& world)
    : world_(world), steps_(world.layout().bodies.size(), 0) {
  const WorldLayout& layout = world.layout();
  if (const auto pad = layout.find_body(spec.robot.near_pad_body)) {
    robot_assembly_ = layout.assembly_of[pad->index()];
  }
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    if (layout.is_free[i]) free_bodies_.push_back(layout.bodies.id_at(i));
  }
  steps_needed_ = std::max<std::int64_t>(1, std::llround(kHeldFor_s / world.timestep_s()));
}

void GraspMonitor::reset() { std::fill(steps_.begin(), steps_.end(), 0); }

void GraspMonitor::update() {
  for (const BodyId id : free_bodies_) {
    const Touch& touch = world_.touch(id);
    const bool grasped = touch.near_pad && touch.far_pad && clearance_m(id) > kClearance_m;
    steps_[id.index()] = grasped ? steps_[id.index()] + 1 : 0;
  }
}

double GraspMonitor::clearance_m(BodyId id) const {
  const WorldLayout& layout = world_.layout();
  const Bounds self = world_.bounds(id);
  double highest_support_m = 0.0;  // the floor
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    const BodyId other = layout.bodies.id_at(i);
    const bool robot = robot_assembly_ != 0 && layout.assembly_of[i] == robot_assembly_;
    if (other == id || robot || !layout.bodies[other].collides) continue;
    for (const BoxShape& shape : layout.bodies[other].shapes) {
      const Bounds support = world_.bounds(other, shape);
      if (support.low.z() >= self.low.z() || !overlap_in_plan(self, support)) continue;
      highest_support_m = std::max(highest_support_m, support.high.z());
    }
  }
  return self.low.z() - highest_support_m;
}

}  // namespace parallax::harness
