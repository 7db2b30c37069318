#include "harness/robot/grip_watch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace parallax::harness {
namespace {

// Contacts of a held body come and go for single steps, and longer while a load bounces.
constexpr double kApart_s = 0.05;

double friction_between(const FrictionSpec& friction, const std::string& a, const std::string& b) {
  const auto found = friction.pairs.find(std::minmax(a, b));
  return found == friction.pairs.end() ? friction.fallback : found->second;
}

std::int64_t steps_of(double time_s, double timestep_s) {
  return std::max<std::int64_t>(1, std::llround(time_s / timestep_s));
}

}  // namespace

GripWatch::GripWatch(const WorldSpec& spec, const PhysicsWorld& world)
    : world_(world),
      gravity_m_s2_(std::abs(spec.solver.gravity_m_s2)),
      steps_to_grip_(steps_of(spec.solver.held_after_s, world.timestep_s())),
      steps_to_lose_(steps_of(kApart_s, world.timestep_s())) {
  const WorldLayout& layout = world.layout();
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    if (layout.is_free[i]) free_bodies_.push_back(layout.bodies.id_at(i));
  }
  for (const GripperSpec& gripper : grippers(spec)) {
    const std::string& near = layout.bodies[*layout.find_body(gripper.near_pad_body)].material;
    const std::string& far = layout.bodies[*layout.find_body(gripper.far_pad_body)].material;
    auto& of_bodies = friction_.emplace_back();
    for (const BodyId id : free_bodies_) {
      const std::string& material = layout.bodies[id].material;
      of_bodies.push_back(std::min(friction_between(spec.friction, material, near),
                                   friction_between(spec.friction, material, far)));
    }
  }
  grips_.resize(friction_.size());
  reset();
}

void GripWatch::reset() {
  for (Grip& grip : grips_) {
    grip = Grip{};
    grip.touched.assign(free_bodies_.size(), 0);
  }
  states_.clear();
  losses_.clear();
}

double GripWatch::margin_of(std::uint32_t gripper, BodyId body, const GripDemand& demand) const {
  const auto place = static_cast<std::size_t>(
      std::find(free_bodies_.begin(), free_bodies_.end(), body) - free_bodies_.begin());
  const double holds_n = 2.0 * friction_[gripper][place] * demand.squeeze_n;
  const double pull_n =
      world_.mass_kg(body) * std::hypot(gravity_m_s2_ + demand.upright_m_s2, demand.level_m_s2);
  return pull_n > 0.0 ? holds_n / pull_n : std::numeric_limits<double>::infinity();
}

void GripWatch::grip_anew(std::uint32_t gripper, const GripDemand& demand) {
  Grip& grip = grips_[gripper];
  for (std::size_t i = 0; i < free_bodies_.size(); ++i) {
    if (grip.touched[i] < steps_to_grip_) continue;
    grip.load = free_bodies_[i];
    grip.margin = margin_of(gripper, *grip.load, demand);
    grip.apart = 0;
    states_[{gripper, grip.load->index()}] = GripState::kInGrip;
    return;
  }
}

void GripWatch::lose(std::uint32_t gripper) {
  Grip& grip = grips_[gripper];
  losses_.push_back({gripper, *grip.load, grip.margin});
  states_[{gripper, grip.load->index()}] = GripState::kLost;
  grip.load.reset();
  std::fill(grip.touched.begin(), grip.touched.end(), 0);
}

void GripWatch::update(const std::vector<GripDemand>& demands) {
  for (std::uint32_t gripper = 0; gripper < grips_.size(); ++gripper) {
    Grip& grip = grips_[gripper];
    const GripDemand& demand = demands[gripper];
    if (demand.squeeze_n <= 0.0) {
      // Opened while the load was about to leave: it had left.
      if (grip.load && grip.apart > 1) lose(gripper);
      if (grip.load) states_[{gripper, grip.load->index()}] = GripState::kLetGo;
      grip.load.reset();
      std::fill(grip.touched.begin(), grip.touched.end(), 0);
      continue;
    }
    for (std::size_t i = 0; i < free_bodies_.size(); ++i) {
      const Touch& touch = world_.touch(free_bodies_[i]);
      const bool between = touch.near_pad(gripper) && touch.far_pad(gripper);
      grip.touched[i] = between ? grip.touched[i] + 1 : 0;
      if (grip.load != free_bodies_[i]) continue;
      grip.apart = between ? 0 : grip.apart + 1;
    }
    if (!grip.load) {
      grip_anew(gripper, demand);
      continue;
    }
    grip.margin = std::min(grip.margin, margin_of(gripper, *grip.load, demand));
    if (grip.apart >= steps_to_lose_) lose(gripper);
  }
}

void GripWatch::end_act() {
  for (std::uint32_t gripper = 0; gripper < grips_.size(); ++gripper) {
    if (grips_[gripper].load && grips_[gripper].apart > 0) lose(gripper);
  }
}

GripState GripWatch::state(std::uint32_t gripper, BodyId body) const {
  const auto found = states_.find({gripper, body.index()});
  return found == states_.end() ? GripState::kNever : found->second;
}

}  // namespace parallax::harness
