#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "harness/engine/geometry_check.h"
#include "harness/engine/jaws.h"
#include "harness/engine/ode_world.h"

namespace parallax::harness {
namespace {

constexpr double kRounding_m = 1e-6;

/// Something that pads are to close on.
struct Grip {
  std::string path;
  double width_m = 0.0;
};

/// What an arm's pads can close on.
struct GripRange {
  const ArmSpec* arm = nullptr;
  double narrowest_m = 0.0, widest_m = 0.0;  // by the stops of the finger
  bool grips(const Grip& grip) const {
    return std::min(arm->opening_m, widest_m) > grip.width_m && narrowest_m < grip.width_m;
  }
};

std::vector<Grip> grips_of(const WorldSpec& spec) {
  std::vector<Grip> grips;
  for (const BodySpec& body : spec.bodies) {
    if (body.grasp)
      grips.push_back({"bodies/" + body.name + "/grasp/width_m", body.grasp->width_m});
  }
  for (const JointSpec& joint : spec.joints) {
    if (!joint.handle) continue;
    grips.push_back({"joints/" + joint.name + "/handle/width_m", joint.handle->width_m});
  }
  return grips;
}

class GripperChecker {
 public:
  GripperChecker(const WorldSpec& spec, std::vector<WorldProblem>& problems)
      : problems_(problems), grips_(grips_of(spec)) {
    const OdeWorld world(spec);
    for (const ArmSpec& arm : spec.mobile->arms) {
      const auto limits = Jaws(arm, world).opening_limits_m();
      ranges_.push_back({&arm, limits.first, limits.second});
    }
  }

  void run() {
    const auto before = problems_.size();
    for (const GripRange& range : ranges_) check(range);
    if (problems_.size() != before) return;  // all that follows from it would be reported, too
    double widest_m = 0.0;
    for (const GripRange& range : ranges_) widest_m = std::max(widest_m, range.arm->opening_m);
    for (const Grip& grip : grips_) {
      const bool held = std::any_of(ranges_.begin(), ranges_.end(),
                                    [&](const GripRange& range) { return range.grips(grip); });
      if (held) continue;
      problems_.push_back({grip.path,
                           widest_m <= grip.width_m
                               ? fmt::format("is {:g} m, but no gripper opens wider than {:g} m",
                                             grip.width_m, widest_m)
                               : fmt::format("is {:g} m, to which no gripper closes", grip.width_m),
                           {}});
    }
  }

 private:
  void check(const GripRange& range) {
    const ArmSpec& arm = *range.arm;
    const std::string opening = "robot/arms/" + arm.name + "/opening_m";
    if (arm.opening_m > range.widest_m + kRounding_m ||
        arm.opening_m < range.narrowest_m - kRounding_m) {
      problems_.push_back(
          {opening,
           fmt::format("is {:g} m, but `{}` takes the pads from {:.4g} to {:.4g} m", arm.opening_m,
                       arm.finger_joint, range.narrowest_m, range.widest_m),
           {}});
      return;
    }
    if (grips_.empty() || std::any_of(grips_.begin(), grips_.end(),
                                      [&](const Grip& grip) { return range.grips(grip); })) {
      return;
    }
    const bool narrow = std::all_of(grips_.begin(), grips_.end(), [&](const Grip& grip) {
      return grip.width_m >= arm.opening_m;
    });
    problems_.push_back(
        {narrow ? opening : "joints/" + arm.finger_joint + "/range_m",
         fmt::format("lets the pads hold nothing: they go from {:.4g} to {:.4g} m, and no grasp or "
                     "handle is between",
                     range.narrowest_m, std::min(arm.opening_m, range.widest_m)),
         {}});
  }

  std::vector<WorldProblem>& problems_;
  std::vector<Grip> grips_;
  std::vector<GripRange> ranges_;
};

}  // namespace

void check_grippers(const WorldSpec& spec, std::vector<WorldProblem>& problems) {
  if (spec.mobile) GripperChecker(spec, problems).run();
}

}  // namespace parallax::harness
