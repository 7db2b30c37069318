#include <map>

#include "harness/engine/bullet_engine.h"
#include "harness/engine/tree_start.h"

namespace parallax::harness {
namespace {

RowSpec motor_row() {
  RowSpec row;
  row.kind = RowKind::kMotor;
  return row;
}

RowSpec spring_row(double stiffness, double damping, double preload) {
  RowSpec row;
  row.kind = RowKind::kSpring;
  row.stiffness = stiffness;
  row.damping = damping;
  row.preload = preload;
  return row;
}

}  // namespace

JointRow& BulletStage::add_row(const RowSpec& spec, LinkId id, int axis) {
  const BulletLink& link = engine_.links[id.index()];
  rows_.push_back(std::make_unique<JointRow>(
      spec, RowPlace{link.body, link.first_axis + axis, colliders_[id.index()]}));
  world_->addMultiBodyConstraint(rows_.back().get());
  return *rows_.back();
}

void BulletStage::add_rows(LinkId id) {
  const TreeLink& link = engine_.tree.links[id];
  const WorldLayout& layout = engine_.layout;
  const auto add_one = [&](double damping, const std::optional<double>& low,
                           const std::optional<double>& high) {
    RowSpec row;
    row.erp = engine_.solver.erp;
    if (damping > 0.0) {
      row.kind = RowKind::kDamper;
      row.damping = damping;
      add_row(row, id, 0);
    }
    for (const auto& [kind, stop] :
         {std::pair(RowKind::kLowStop, low), std::pair(RowKind::kHighStop, high)}) {
      if (!stop) continue;
      row.kind = kind;
      row.stop = *stop;
      add_row(row, id, 0);
    }
    return &add_row(motor_row(), id, 0);
  };
  switch (link.joint) {
    case LinkJoint::kFree:
      return;
    case LinkJoint::kSlider: {
      const JointSpec& spec = layout.sliders[layout.sliders.id_at(link.joint_index)];
      engine_.sliders[link.joint_index].motor =
          add_one(spec.damping_n_s_m, spec.low_m, spec.high_m);
      return;
    }
    case LinkJoint::kHinge: {
      const JointSpec& spec = layout.hinges[layout.hinges.id_at(link.joint_index)];
      engine_.hinges[link.joint_index].motor =
          add_one(spec.damping_nm_s, spec.low_rad, spec.high_rad);
      return;
    }
    case LinkJoint::kGantry:
      break;
  }
  const auto& springs = layout.gantries[layout.gantries.id_at(link.joint_index)].suspension;
  BulletMotors& motors = engine_.gantries[link.joint_index];
  motors.motor = &add_row(motor_row(), id, 0);
  motors.side = &add_row(motor_row(), id, 1);
  if (springs) {
    const double weight_n = carried_weight_n(layout, engine_.tree, id, engine_.solver.gravity_m_s2);
    motors.height =
        &add_row(spring_row(springs->stiffness_n_m, springs->damping_n_s_m, weight_n), id, 2);
    for (const int lean : {4, 5}) {
      add_row(spring_row(springs->stiffness_nm_rad, springs->damping_nm_s, 0.0), id, lean);
    }
  } else {
    motors.height = &add_row(motor_row(), id, 2);
  }
  motors.turn = &add_row(motor_row(), id, 3);
}

void BulletStage::add_followers() {
  std::map<std::string, LinkId> moved;  // by the joint that moves it
  for (std::size_t i = 0; i < engine_.tree.links.size(); ++i) {
    const LinkId id = engine_.tree.links.id_at(i);
    moved[engine_.tree.links[id].joint_name] = id;
  }
  const auto place = [&](LinkId id) {
    const BulletLink& link = engine_.links[id.index()];
    return RowPlace{link.body, link.first_axis, colliders_[id.index()]};
  };
  const auto add = [&](const JointSpec& spec) {
    if (!spec.follows) return;
    RowSpec row;
    row.kind = RowKind::kFollow;
    row.ratio = spec.follows->ratio;
    row.erp = engine_.solver.erp;
    rows_.push_back(std::make_unique<JointRow>(row, place(moved.at(spec.name)),
                                               place(moved.at(spec.follows->leader))));
    world_->addMultiBodyConstraint(rows_.back().get());
  };
  for (const JointSpec& spec : engine_.layout.sliders) add(spec);
  for (const JointSpec& spec : engine_.layout.hinges) add(spec);
}

}  // namespace parallax::harness
