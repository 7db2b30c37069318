#include "harness/robot/grasp_monitor.h"

#include <algorithm>
#include <cmath>

namespace parallax::harness {
namespace {

bool overlap_in_plan(const BodyBounds& a, const BodyBounds& b) {
  return a.low.x() < b.high.x() && b.low.x() < a.high.x() && a.low.y() < b.high.y() &&
         b.low.y() < a.high.y();
}

}  // namespace

GraspMonitor::GraspMonitor(const WorldSpec& spec, const PhysicsWorld& world)
    : world_(world), clearance_needed_m_(spec.solver.held_clearance_m) {
  const WorldLayout& layout = world.layout();
  const std::vector<GripperSpec> all = grippers(spec);
  steps_.resize(all.size(), std::vector<std::int64_t>(layout.bodies.size(), 0));
  if (!all.empty()) {
    robot_assembly_ = layout.assembly_of[layout.find_body(all.front().near_pad_body)->index()];
  }
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    if (layout.is_free[i]) free_bodies_.push_back(layout.bodies.id_at(i));
  }
  steps_needed_ =
      std::max<std::int64_t>(1, std::llround(spec.solver.held_after_s / world.timestep_s()));
}

void GraspMonitor::reset() {
  for (auto& steps : steps_) std::fill(steps.begin(), steps.end(), 0);
}

void GraspMonitor::update() {
  for (const BodyId id : free_bodies_) {
    const Touch& touch = world_.touch(id);
    const bool grasped =
        (touch.near_pads & touch.far_pads) != 0 && clearance_m(id) > clearance_needed_m_;
    for (std::uint32_t gripper = 0; gripper < steps_.size(); ++gripper) {
      std::int64_t& steps = steps_[gripper][id.index()];
      steps = grasped && touch.near_pad(gripper) && touch.far_pad(gripper) ? steps + 1 : 0;
    }
  }
}

bool GraspMonitor::held(BodyId id) const {
  return std::any_of(steps_.begin(), steps_.end(), [&](const std::vector<std::int64_t>& steps) {
    return steps[id.index()] >= steps_needed_;
  });
}

std::optional<BodyId> GraspMonitor::held_body(std::uint32_t gripper) const {
  for (const BodyId id : free_bodies_) {
    if (held_by(gripper, id)) return id;
  }
  return std::nullopt;
}

double GraspMonitor::clearance_m(BodyId id) const {
  const WorldLayout& layout = world_.layout();
  const BodyBounds self = world_.bounds(id);
  double highest_support_m = 0.0;  // the floor
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    const BodyId other = layout.bodies.id_at(i);
    const bool robot = robot_assembly_ != 0 && layout.assembly_of[i] == robot_assembly_;
    if (other == id || robot || !layout.bodies[other].collides) continue;
    for (const BodyShape& shape : layout.bodies[other].shapes) {
      const BodyBounds support = world_.bounds(other, shape);
      if (support.low.z() >= self.low.z() || !overlap_in_plan(self, support)) continue;
      highest_support_m = std::max(highest_support_m, support.high.z());
    }
  }
  return self.low.z() - highest_support_m;
}

}  // namespace parallax::harness
