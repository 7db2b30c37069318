// A way of an arm's tool between two points, from few straight stretches.
//
// Straight is tried first. Else the tool goes back, up, across, down and forward: for each
// height, lowest first, up to three retreats of either end from which the way up is free, the
// shortest first, are joined by a level stretch. A stretch is free if neither the palm, what it
// holds nor, for a chain, a link meets anything on it, and the joints can follow. Postures at
// new points are found from the nearest known one. If no such way exists, a chain may swing all
// joints at once: postures that have the tool there are sought from several starts, first those
// that one swing leads to, then by a search (chain_search.cc).
//
// Cost: up to some hundred stretches.

#include "harness/robot/tool_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/kinematics/chain_search.h"
#include "harness/world/angles.h"

namespace parallax::harness {
namespace {

constexpr double kStep_m = 0.010;    // of the sweeps
constexpr double kStep_rad = 0.02;   // of those round a centre
constexpr double kRetreat_m = 0.05;  // between the retreats that are tried
constexpr int kRetreats = 11;        // up to 0.5 m
constexpr double kHeight_m = 0.10;   // between the heights
constexpr double kSame_m = 1e-6;
constexpr int kPostures = 12;  // of a goal that are looked for
constexpr int kSearchRounds = 400;
constexpr double kTurned_rad = 0.02;  // of a wrist, where it is to be
constexpr double kShareOfJump = 0.8;  // that is planned with: the motion begins a little elsewhere
constexpr double kLeastUpright = 0.95;  // cosine of how far a hand that holds something may lean

class Ways {
 public:
  explicit Ways(const StretchTest& test) : test_(test) {}

  bool free(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    auto fault = test_(a, b);
    const bool is_free = !fault;
    if (fault) blocked_ = std::move(fault);
    return is_free;
  }
  const std::optional<WayFault>& blocked() const { return blocked_; }

 private:
  const StretchTest& test_;
  std::optional<WayFault> blocked_;
};

/// The retreats from `point` from which the way up to `height_m` is free, nearest first.
std::vector<Eigen::Vector3d> shafts(Ways& ways, const Eigen::Vector3d& point,
                                    const Eigen::Vector3d& back, double height_m) {
  std::vector<Eigen::Vector3d> found;
  Eigen::Vector3d last = point;
  for (int i = 0; i < kRetreats && found.size() < 3; ++i) {
    const Eigen::Vector3d foot = point + i * kRetreat_m * back;
    if (!ways.free(last, foot)) break;
    last = foot;
    if (ways.free(foot, {foot.x(), foot.y(), height_m})) found.push_back(foot);
  }
  return found;
}

Eigen::Vector3d raised(const Eigen::Vector3d& p, double height_m) {
  return {p.x(), p.y(), height_m};
}

BodyMask moving_with(const PhysicsWorld& world, const Arm& arm, std::optional<BodyId> load) {
  BodyMask mask(world.layout().bodies.size(), false);
  for (const BodyId id : arm.bodies()) mask[id.index()] = true;
  if (load) mask[load->index()] = true;
  return mask;
}

BodyMask joined(BodyMask a, const BodyMask& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] = a[i] || b[i];
  return a;
}

double heading_from(const Eigen::Vector3d& centre, const Eigen::Vector3d& p) {
  return std::atan2(p.y() - centre.y(), p.x() - centre.x());
}

}  // namespace

std::string WayFault::text(const char* meets) const {
  return hit ? fmt::format("`{}` {} `{}`", hit->part, meets, hit->obstacle) : unfollowed;
}

ToolPath find_tool_path(const StretchTest& test, const Eigen::Vector3d& from,
                        const Eigen::Vector3d& to, const Eigen::Vector3d& back, double ceiling_m) {
  Ways ways(test);
  if (ways.free(from, to)) return {{to}, std::nullopt};
  const double lowest_m = std::max(from.z(), to.z());
  for (double height_m = lowest_m; height_m <= std::max(ceiling_m, lowest_m) + kSame_m;
       height_m += kHeight_m) {
    const auto starts = shafts(ways, from, back, height_m);
    const auto ends = starts.empty() ? starts : shafts(ways, to, back, height_m);
    for (const Eigen::Vector3d& start : starts) {
      for (const Eigen::Vector3d& end : ends) {
        if (!ways.free(raised(start, height_m), raised(end, height_m))) continue;
        ToolPath path;
        Eigen::Vector3d last = from;
        for (const Eigen::Vector3d& corner :
             {start, raised(start, height_m), raised(end, height_m), end, to}) {
          if ((corner - last).norm() > kSame_m) path.corners.push_back(corner);
          last = corner;
        }
        return path;
      }
    }
  }
  return {{}, ways.blocked()};
}

StretchTest swept(const Sweep& sweep, const Eigen::Vector3d& from) {
  return [&sweep, from](const Eigen::Vector3d& a,
                        const Eigen::Vector3d& b) -> std::optional<WayFault> {
    if (auto hit = sweep.along(a - from, b - a, kStep_m)) return WayFault{std::move(hit), {}};
    return std::nullopt;
  };
}

ArmWays::ArmWays(const PhysicsWorld& world, const Arm& arm, std::optional<BodyId> load,
                 BodyMask ignored, const BodyMask& robot, double tolerance_m)
    : arm_(arm),
      chain_(arm.chain()),
      wrist_rad_(arm.wrist_goal_rad()),
      holds_(load.has_value()),
      tool_W_(arm.tool()),
      palm_(world, moving_with(world, arm, load), joined(ignored, robot), tolerance_m) {
  if (chain_ == nullptr) return;
  links_.emplace(world, *chain_, load, joined(std::move(ignored), robot), robot, tolerance_m);
  known_.emplace_back(tool_W_, chain_->positions());
}

std::optional<JointVector> ArmWays::posture(const Eigen::Vector3d& tool_W) {
  const auto nearest =
      std::min_element(known_.begin(), known_.end(), [&](const auto& a, const auto& b) {
        return (a.first - tool_W).squaredNorm() < (b.first - tool_W).squaredNorm();
      });
  if ((nearest->first - tool_W).norm() < kSame_m) return nearest->second;
  const auto found =
      solve_inverse(chain_->arm().chain, chain_->upright(tool_W, wrist_rad_), nearest->second);
  if (!found.reached) return std::nullopt;
  known_.emplace_back(tool_W, found.q);
  return found.q;
}

std::optional<WayFault> ArmWays::lead(JointVector& q, const Eigen::Isometry3d& goal) const {
  std::optional<Obstacle> hit;
  const auto check = [&](const JointVector& at) -> std::optional<std::string> {
    hit = links_->at(at);
    return hit ? std::optional<std::string>("in the way") : std::nullopt;
  };
  WayOptions options;
  options.jump *= kShareOfJump;
  const ChainWay way = follow_way(chain_->arm().chain, q, goal, options, check);
  if (way.whole()) {
    q = way.last();
    return std::nullopt;
  }
  if (hit) return WayFault{std::move(hit), {}};
  return WayFault{{}, fmt::format("the joints cannot follow: {}", way.fault)};
}

std::optional<WayFault> ArmWays::along(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  if (is_turned()) {  // else its links alone tell what the palm meets
    if (auto hit = palm_.along(from - tool_W_, to - from, kStep_m)) {
      return WayFault{std::move(hit), {}};
    }
  }
  if (chain_ == nullptr) return std::nullopt;
  auto q = posture(from);
  if (!q) return WayFault{{}, "the joints cannot bring the tool there"};
  if (auto fault = lead(*q, chain_->upright(to, wrist_rad_))) return fault;
  known_.emplace_back(to, *q);
  return std::nullopt;
}

std::optional<WayFault> ArmWays::round(const Eigen::Vector3d& from, const Eigen::Vector3d& centre_W,
                                       double angle_rad, BodyId led) {
  if (auto hit = palm_.turning(from - tool_W_, centre_W, angle_rad, kStep_rad)) {
    return WayFault{std::move(hit), {}};
  }
  if (chain_ == nullptr) return std::nullopt;
  const auto q = posture(from);
  if (!q) return WayFault{{}, "the joints cannot bring the tool there"};
  std::optional<Obstacle> hit;
  const double start_rad = heading_from(centre_W, from);
  const auto check = [&](const JointVector& at) -> std::optional<std::string> {
    const Eigen::Vector3d tool_W = chain_->root() * chain_->arm().chain.tool(at).translation();
    hit = links_->at(at);
    if (!hit) {
      const double turned = wrapped(heading_from(centre_W, tool_W) - start_rad);
      hit = links_->meets_turned(at, led, centre_W, turned);
    }
    return hit ? std::optional<std::string>("in the way") : std::nullopt;
  };
  const ChainWay way = chain_->arc_way(*q, from, wrist_rad_, centre_W, angle_rad, check);
  if (way.whole()) return std::nullopt;
  if (hit) return WayFault{std::move(hit), {}};
  return WayFault{{}, fmt::format("the joints cannot follow: {}", way.fault)};
}

std::optional<WayFault> ArmWays::follow(const std::vector<Eigen::Vector3d>& corners) const {
  if (chain_ == nullptr) return std::nullopt;
  JointVector q = chain_->positions();
  for (const Eigen::Vector3d& corner : corners) {
    if (auto fault = lead(q, chain_->upright(corner, wrist_rad_))) return fault;
  }
  return std::nullopt;
}

bool ArmWays::is_turned() const {
  return std::abs(wrapped(wrist_rad_ - arm_.wrist_rad())) < kTurned_rad;
}

bool ArmWays::turns_on_the_spot(double wrist_rad) const {
  if (chain_ == nullptr) return true;
  JointVector q = chain_->positions();
  return !lead(q, chain_->upright(tool_W_, wrist_rad));
}

bool ArmWays::may_be(const JointVector& q) const {
  const double upright = chain_->arm().chain.tool(q).linear()(2, 2);
  return !(holds_ && upright < kLeastUpright) && !links_->at(q);
}

std::vector<ChainWay> ArmWays::swings(const Eigen::Vector3d& to) const {
  if (chain_ == nullptr) return {};
  const SerialChain& chain = chain_->arm().chain;
  const JointVector now = chain_->positions();
  const PostureTest test = [this](const JointVector& q) { return may_be(q); };
  if (!test(now)) return {};
  const Eigen::Isometry3d goal = chain_->upright(to, wrist_rad_);
  InverseOptions alone;
  alone.restarts = 0;
  std::vector<InverseResult> ends = {
      solve_inverse(chain, goal, JointVector::Zero(chain.size()), alone),
      solve_inverse(chain, goal, now, alone)};
  for (int i = 1; i <= kPostures; ++i) ends.push_back(solve_inverse_from(chain, goal, i));
  std::erase_if(ends, [&](const InverseResult& end) { return !end.reached || !test(end.q); });
  // First those that one swing leads to; a search only then.
  ChainSearchOptions options;
  for (const int rounds : {0, kSearchRounds}) {
    options.rounds = rounds;
    for (const InverseResult& end : ends) {
      const auto postures = search_swings(chain, now, end.q, test, options);
      std::vector<ChainWay> ways;
      for (std::size_t i = 0; i + 1 < postures.size(); ++i) {
        ways.push_back(swing_way(postures[i], postures[i + 1], options.step));
      }
      if (!ways.empty()) return ways;
      if (rounds > 0) return {};
    }
  }
  return {};
}

}  // namespace parallax::harness
