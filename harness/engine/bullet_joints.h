#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>

#include <optional>

namespace parallax::harness {

/// The law of a row.
enum class RowKind { kMotor, kDamper, kLowStop, kHighStop, kSpring, kFollow };

/// The task of a row, in the units of its joint.
struct RowSpec {
  RowKind kind = RowKind::kMotor;
  double speed = 0.0, most = 0.0;  // of a motor: its speed and its greatest force
  double stop = 0.0;               // of a stop
  double stiffness = 0.0, damping = 0.0, rest = 0.0, preload = 0.0;  // of a spring, a damper
  double ratio = 1.0;  // of a follower: its position to that of its leader
  double erp = 0.2;    // the share of an error that a step takes back
};

/// A joint coordinate of a tree.
struct RowPlace {
  btMultiBody* body = nullptr;
  int link = -1;
  const btCollisionObject* collider = nullptr;  // of what the joint moves
};

/// One row of the solver on one joint coordinate, or on that of a follower and its leader. Springs
/// and dampers act with the speed at the end of the step, so no stiffness makes them swing up.
class JointRow final : public btMultiBodyConstraint {
 public:
  JointRow(const RowSpec& spec, const RowPlace& at, const RowPlace& leader = {});

  RowSpec spec;

  void finalizeMultiDof() override;
  int getIslandIdA() const override;
  int getIslandIdB() const override;
  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;
  void debugDraw(btIDebugDraw* /*drawer*/) override {}

 private:
  /// The solver is asked for a speed along the row, which gives way by `softness` for each
  /// unit of impulse, and bounds of the impulse.
  struct Demand {
    double speed = 0.0, softness = 0.0, low, high;
  };
  std::optional<Demand> demand(double step_s) const;
  bool is_of_two_trees() const { return leader_.body != nullptr && leader_.body != at_.body; }

  RowPlace at_, leader_;
};

}  // namespace parallax::harness
