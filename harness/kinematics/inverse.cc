// Inverse kinematics by damped least squares (Wampler 1986; damping of Levenberg and Marquardt).
//
// The error of the tool is its offset and its turn, a radian weighed as so many metres. Each
// step solves (J J^T + damping I) y = error and moves the joints by J^T y; a step that helps
// lowers the damping, one that does not raises it. A joint at its stop that the step would push
// out is taken out of the Jacobian and the step is solved again, so that the others make up for
// it. A descent that ends short is followed by others from an even sequence of starts (Halton),
// always the same; the nearest result is returned.
//
// Cost: at most `steps` Jacobians and 6 by 6 solutions for each start. That none is found does
// not prove that there is none.

#include "harness/kinematics/inverse.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace parallax::harness {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double kFirstDamping = 1e-4, kLeastDamping = 1e-9, kMostDamping = 1e2;
constexpr double kLongestStep = 0.5;  // of any joint [rad or m]
constexpr double kAtStop = 1e-9;
/// Bases of the Halton sequence, one a joint.
constexpr std::array<int, kMostChainJoints> kPrimes = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37};

double halton(int index, int base) {
  double share = 1.0, sum = 0.0;
  for (int i = index; i > 0; i /= base) {
    share /= base;
    sum += share * (i % base);
  }
  return sum;
}

class Descent {
 public:
  Descent(const SerialChain& chain, const Eigen::Isometry3d& goal, const InverseOptions& options)
      : chain_(chain), goal_(goal), options_(options) {}

  InverseResult run(JointVector q) const {
    q = within(q);
    Vector6 error = error_at(q);
    double damping = kFirstDamping;
    for (int step = 0; step < options_.steps && !good(error); ++step) {
      const JointVector next = within(q + change(q, error, damping));
      const Vector6 after = error_at(next);
      if (after.squaredNorm() < error.squaredNorm()) {
        const bool stuck = (next - q).cwiseAbs().maxCoeff() < 1e-12;
        q = next;
        error = after;
        damping = std::max(0.1 * damping, kLeastDamping);
        if (stuck) break;
      } else if (damping >= kMostDamping) {
        break;
      } else {
        damping *= 10.0;
      }
    }
    return result(q, error);
  }

 private:
  Vector6 error_at(const JointVector& q) const {
    Vector6 error = pose_error(chain_.tool(q), goal_);
    error.tail<3>() *= options_.radian_as_m;
    return error;
  }
  double short_rad(const Vector6& error) const {
    return error.tail<3>().norm() / options_.radian_as_m;
  }
  bool good(const Vector6& error) const {
    return error.head<3>().norm() <= options_.tolerance_m &&
           short_rad(error) <= options_.tolerance_rad;
  }

  JointVector within(JointVector q) const {
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      const ChainJoint& joint = chain_.joints()[static_cast<std::size_t>(i)];
      q(i) = std::clamp(q(i), joint.low, joint.high);
    }
    return q;
  }

  /// The step that damped least squares ask for; again without those that it would push into their
  /// stops, until no more are.
  JointVector change(const JointVector& q, const Vector6& error, double damping) const {
    ChainJacobian J = chain_.jacobian(q);
    J.bottomRows<3>() *= options_.radian_as_m;
    for (;;) {
      const Matrix6 normal = J * J.transpose() + damping * Matrix6::Identity();
      JointVector step = J.transpose() * normal.ldlt().solve(error);
      bool pushed = false;
      for (Eigen::Index i = 0; i < q.size(); ++i) {
        const ChainJoint& joint = chain_.joints()[static_cast<std::size_t>(i)];
        const bool out = (q(i) <= joint.low + kAtStop && step(i) < 0.0) ||
                         (q(i) >= joint.high - kAtStop && step(i) > 0.0);
        if (!out) continue;
        J.col(i).setZero();
        pushed = true;
      }
      if (pushed) continue;
      const double longest = step.cwiseAbs().maxCoeff();
      return longest > kLongestStep ? JointVector(step * (kLongestStep / longest)) : step;
    }
  }

  InverseResult result(const JointVector& q, const Vector6& error) const {
    InverseResult out{good(error), q, error.head<3>().norm(), short_rad(error), 0};
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      const ChainJoint& joint = chain_.joints()[static_cast<std::size_t>(i)];
      if (q(i) <= joint.low + kAtStop || q(i) >= joint.high - kAtStop) out.at_stop |= 1U << i;
    }
    return out;
  }

  const SerialChain& chain_;
  const Eigen::Isometry3d& goal_;
  const InverseOptions& options_;
};

double weighed(const InverseResult& result, const InverseOptions& options) {
  return std::hypot(result.short_m, options.radian_as_m * result.short_rad);
}

}  // namespace

Eigen::Matrix<double, 6, 1> pose_error(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(to.linear() * from.linear().transpose()));
  Vector6 error;
  error << to.translation() - from.translation(), turn.angle() * turn.axis();
  return error;
}

JointVector spread_positions(const SerialChain& chain, int index) {
  JointVector q(chain.size());
  for (Eigen::Index i = 0; i < chain.size(); ++i) {
    const ChainJoint& joint = chain.joints()[static_cast<std::size_t>(i)];
    const double low = std::max(joint.low, -std::numbers::pi);
    const double high = std::min(joint.high, std::numbers::pi);
    q(i) = low + (high - low) * halton(index, kPrimes[static_cast<std::size_t>(i)]);
  }
  return q;
}

InverseResult solve_inverse(const SerialChain& chain, const Eigen::Isometry3d& X_RT,
                            const JointVector& start, const InverseOptions& options) {
  const Descent descent(chain, X_RT, options);
  InverseResult best = descent.run(start);
  for (int i = 1; i <= options.restarts && !best.reached; ++i) {
    InverseResult other = descent.run(spread_positions(chain, i));
    if (other.reached || weighed(other, options) < weighed(best, options)) best = other;
  }
  return best;
}

InverseResult solve_inverse_from(const SerialChain& chain, const Eigen::Isometry3d& X_RT, int index,
                                 const InverseOptions& options) {
  return Descent(chain, X_RT, options).run(spread_positions(chain, index));
}

}  // namespace parallax::harness
