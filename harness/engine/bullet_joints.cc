#include "harness/engine/bullet_joints.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <algorithm>
#include <cmath>

namespace parallax::harness {
namespace {

constexpr double kAny = 1e30;  // an impulse without a bound

btMultiBody* second_tree(const RowPlace& at, const RowPlace& leader) {
  return leader.body == at.body ? nullptr : leader.body;
}

}  // namespace

JointRow::JointRow(const RowSpec& row, const RowPlace& at, const RowPlace& leader)
    : btMultiBodyConstraint(at.body, second_tree(at, leader), at.link, leader.link, 1, false,
                            MULTIBODY_CONSTRAINT_1DOF_JOINT_MOTOR),
      spec(row),
      at_(at),
      leader_(leader) {
  JointRow::finalizeMultiDof();
}

void JointRow::finalizeMultiDof() {
  allocateJacobiansMultiDof();
  const auto place = [](const RowPlace& of) { return 6 + of.body->getLink(of.link).m_dofOffset; };
  jacobianA(0)[place(at_)] = spec.kind == RowKind::kHighStop ? -1.0 : 1.0;
  if (leader_.body != nullptr) {
    (is_of_two_trees() ? jacobianB(0) : jacobianA(0))[place(leader_)] = -spec.ratio;
  }
  m_numDofsFinalized = m_jacSizeBoth;
}

int JointRow::getIslandIdA() const { return at_.collider->getIslandTag(); }

int JointRow::getIslandIdB() const {
  return is_of_two_trees() ? leader_.collider->getIslandTag() : -1;
}

std::optional<JointRow::Demand> JointRow::demand(double step_s) const {
  const double q = at_.body->getJointPos(at_.link);
  switch (spec.kind) {
    case RowKind::kMotor:
      if (spec.most == 0.0) return std::nullopt;
      return Demand{spec.speed, 0.0, -spec.most * step_s, spec.most * step_s};
    case RowKind::kDamper:
      return Demand{0.0, 1.0 / (spec.damping * step_s), -kAny, kAny};
    case RowKind::kLowStop:
    case RowKind::kHighStop: {
      constexpr double kAnySpeed = 50.0;  // a stop that is farther than a step at this is no row
      const double gap = spec.kind == RowKind::kLowStop ? q - spec.stop : spec.stop - q;
      if (gap > kAnySpeed * step_s) return std::nullopt;
      return Demand{-gap * (gap > 0.0 ? 1.0 : spec.erp) / step_s, 0.0, 0.0, kAny};
    }
    case RowKind::kSpring: {
      const double resistance = spec.damping + step_s * spec.stiffness;
      return Demand{(spec.stiffness * (spec.rest - q) + spec.preload) / resistance,
                    1.0 / (step_s * resistance), -kAny, kAny};
    }
    case RowKind::kFollow:
      break;
  }
  const double error = q - spec.ratio * leader_.body->getJointPos(leader_.link);
  return Demand{-spec.erp * error / step_s, 0.0, -kAny, kAny};
}

void JointRow::createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                                    const btContactSolverInfo& info) {
  const auto asked = demand(info.m_timeStep);
  if (!asked) {
    internalSetAppliedImpulse(0, 0.0);  // else a later step would begin with it
    return;
  }
  btMultiBodySolverConstraint& row = rows.expandNonInitializing();
  row.m_orgConstraint = this;
  row.m_orgDofIndex = 0;
  row.m_solverBodyIdA = row.m_solverBodyIdB = data.m_fixedBodyId;
  row.m_frictionIndex = 0;
  row.m_originalContactPoint = nullptr;
  const btVector3 none(0.0, 0.0, 0.0);
  fillMultiBodyConstraint(row, data, jacobianA(0), is_of_two_trees() ? jacobianB(0) : nullptr, none,
                          none, none, none, 0.0, info, asked->low, asked->high, false, 1.0, false,
                          asked->speed);
  if (row.m_jacDiagABInv == 0.0 || asked->softness == 0.0) return;
  const double stiff = row.m_jacDiagABInv;
  row.m_jacDiagABInv = 1.0 / (1.0 / stiff + asked->softness);
  row.m_rhs *= row.m_jacDiagABInv / stiff;
  row.m_cfm = asked->softness * row.m_jacDiagABInv;
}

}  // namespace parallax::harness
