#include "harness/engine/engine_world.h"

#include <algorithm>
#include <utility>

#include "compiler/base/contract.h"

namespace parallax::harness {

EngineState::EngineState(const WorldSpec& spec, WorldLayout its_layout)
    : layout(std::move(its_layout)),
      solver(spec.solver),
      rules(spec, layout),
      touches(layout.bodies.size()) {}

std::optional<Overlap> EngineWorld::reset(std::span<const Placement> placements,
                                          std::uint64_t seed) {
  PARALLAX_REQUIRE(placements.size() == layout().bodies.size(), "one placement per body");
  place(placements, seed);
  for (std::size_t i = 0; i < layout().sliders.size(); ++i) {
    const SliderId id = layout().sliders.id_at(i);
    set_motor(id, 0.0, layout().sliders[id].max_force_n);
  }
  for (std::size_t i = 0; i < layout().gantries.size(); ++i) {
    set_gantry(layout().gantries.id_at(i), Eigen::Vector3d::Zero(), 0.0);
  }
  for (std::size_t i = 0; i < layout().hinges.size(); ++i) {
    const HingeId id = layout().hinges.id_at(i);
    set_hinge_motor(id, 0.0, layout().hinges[id].max_torque_nm);
  }
  std::fill(state_->touches.begin(), state_->touches.end(), Touch{});
  state_->digest.restart();
  fold_state();

  const std::optional<Overlap> overlap = deepest_overlap();
  if (overlap && overlap->depth_m > state_->solver.start_penetration_m) return overlap;
  return std::nullopt;
}

std::optional<Overlap> EngineWorld::find_obstacle(const Probe& probe, const BodyMask& ignored,
                                                  double tolerance_m) const {
  const auto met = deepest_met(probe, Sought::all_but(ignored));
  if (!met || met->metres <= tolerance_m) return std::nullopt;
  return Overlap{name_of(layout(), *met->side), {}, met->metres};
}

bool EngineWorld::overlaps(const Probe& probe, BodyId id) const {
  return deepest_met(probe, Sought::only(id)).has_value();
}

std::optional<RayHit> EngineWorld::cast_ray(const Eigen::Vector3d& from_W,
                                            const Eigen::Vector3d& to_W,
                                            const BodyMask& ignored) const {
  const auto met = first_met(from_W, to_W, Sought::all_but(ignored));
  if (!met) return std::nullopt;
  return RayHit{name_of(layout(), *met->side), met->metres};
}

std::optional<double> EngineWorld::ray_meets(const Eigen::Vector3d& from_W,
                                             const Eigen::Vector3d& to_W, BodyId id) const {
  const auto met = first_met(from_W, to_W, Sought::only(id));
  if (!met) return std::nullopt;
  return met->metres;
}

double EngineWorld::mass_kg(BodyId id) const {
  const std::optional<LinkId> link = layout().link_of[id.index()];
  return link ? state_->masses_kg[link->index()] : 0.0;
}

Eigen::Vector3d EngineWorld::position(BodyId id) const {
  const PoseInLink& place = state_->in_link[id.index()];
  const std::optional<LinkId> link = layout().link_of[id.index()];
  if (!link) return place.p_LB;
  return link_position(*link) + link_rotation(*link) * place.p_LB;
}

Eigen::Matrix3d EngineWorld::rotation(BodyId id) const {
  const PoseInLink& place = state_->in_link[id.index()];
  const std::optional<LinkId> link = layout().link_of[id.index()];
  if (!link) return place.R_LB;
  return link_rotation(*link) * place.R_LB;
}

}  // namespace parallax::harness
