// Joint positions along a straight way of the tool.
//
// The tool's pose is moved evenly and turned about one axis; at each small step the positions
// are found from those before (inverse.cc, without restarts), so the arm keeps its posture. The
// way ends early where no positions are near, where a joint would have to jump, or where a check
// of the caller says so, and says why. Between samples positions are interpolated linearly. A
// swing moves all joints evenly instead. Cost: a few steps of least squares for each sample.

#include "harness/kinematics/chain_way.h"

#include <algorithm>
#include <cmath>

namespace parallax::harness {
namespace {

/// The way from `from` to `to`, a part of it: straight, turning about one axis.
Eigen::Isometry3d between(const Eigen::Isometry3d& from, const Eigen::Matrix<double, 6, 1>& way,
                          double share) {
  Eigen::Isometry3d X = from;
  X.translation() += share * way.head<3>();
  const double angle = way.tail<3>().norm();
  if (angle > 0.0) {
    const Eigen::AngleAxisd turn(share * angle, way.tail<3>() / angle);
    X.linear() = turn.toRotationMatrix() * from.linear();
  }
  return X;
}

std::string fault_of(const SerialChain& chain, const InverseResult& result) {
  std::string text;
  for (std::size_t i = 0; i < chain.joints().size(); ++i) {
    if ((result.at_stop >> i & 1U) == 0) continue;
    text += (text.empty() ? "`" : ", `") + chain.joints()[i].name + "`";
  }
  return text.empty() ? "the arm is stretched" : text + " at its stop";
}

}  // namespace

JointVector ChainWay::at(double share_of_way) const {
  const double place = std::clamp(share_of_way, 0.0, share) / step_share;
  const auto index = std::min(static_cast<std::size_t>(place), samples.size() - 1);
  if (index + 1 >= samples.size()) return samples.back();
  const double rest = place - static_cast<double>(index);
  return samples[index] + rest * (samples[index + 1] - samples[index]);
}

JointVector ChainWay::slope(double share_of_way) const {
  if (samples.size() < 2) return JointVector::Zero(samples.front().size());
  const double place = std::clamp(share_of_way, 0.0, share) / step_share;
  const auto index = std::min(static_cast<std::size_t>(place), samples.size() - 2);
  return (samples[index + 1] - samples[index]) / step_share;
}

ChainWay follow_way(const SerialChain& chain, const JointVector& start,
                    const Eigen::Isometry3d& goal, const WayOptions& options,
                    const ChainCheck& check) {
  const Eigen::Isometry3d from = chain.tool(start);
  const Eigen::Matrix<double, 6, 1> way = pose_error(from, goal);
  const double most =
      std::max(way.head<3>().norm() / options.step_m, way.tail<3>().norm() / options.step_rad);
  const int steps = std::max(1, static_cast<int>(std::ceil(most)));
  InverseOptions inverse;
  inverse.restarts = 0;
  ChainWay out;
  out.samples = {start};
  out.step_share = 1.0 / steps;
  for (int i = 1; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    const InverseResult next = solve_inverse(chain, between(from, way, share), out.last(), inverse);
    if (!next.reached) {
      out.fault = fault_of(chain, next);
    } else {
      Eigen::Index joint = 0;
      if ((next.q - out.last()).cwiseAbs().maxCoeff(&joint) > options.jump) {
        out.fault =
            "`" + chain.joints()[static_cast<std::size_t>(joint)].name + "` would have to jump";
      } else if (auto hit = check ? check(next.q) : std::nullopt) {
        out.fault = *hit;
      }
    }
    if (!out.whole()) {
      out.share = share - out.step_share;
      break;
    }
    out.samples.push_back(next.q);
  }
  return out;
}

ChainWay swing_way(const JointVector& start, const JointVector& goal, double step) {
  const JointVector way = goal - start;
  const int steps = std::max(1, static_cast<int>(std::ceil(way.cwiseAbs().maxCoeff() / step)));
  ChainWay out;
  out.step_share = 1.0 / steps;
  for (int i = 0; i <= steps; ++i) {
    out.samples.push_back(start + (static_cast<double>(i) / steps) * way);
  }
  return out;
}

}  // namespace parallax::harness
