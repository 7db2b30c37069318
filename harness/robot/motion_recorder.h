#pragma once

#include <cstdint>
#include <vector>

#include "harness/engine/physics_world.h"
#include "harness/recording/motion_stream.h"
#include "harness/recording/recorded_scene.h"
#include "harness/robot/grasp_monitor.h"
#include "harness/robot/perception.h"

namespace parallax::harness {

/// The bodies of a world, as recordings have them: welded ones hang on the first of their link, and
/// a mobile robot's camera is one more, called "camera of BASE".
RecordedScene recorded_scene(const WorldSpec& spec, const WorldLayout& layout);

/// Writes down where the bodies of a world are, at steps that their number alone decides: the same
/// simulation leaves the same bytes.
class MotionRecorder {
 public:
  /// All but `spec` outlive the recorder; `robot` and `perception` may be null.
  MotionRecorder(const WorldSpec& spec, const PhysicsWorld& world, const GraspMonitor& grasp,
                 const MobileRobot* robot, const Perception* perception);

  const RecordedScene& scene() const { return scene_; }
  /// 0: nothing is recorded.
  void set_interval(double interval_s);
  bool is_on() const { return every_ > 0; }
  /// Records the first frame after a reset.
  void begin();
  /// Call it after each timestep.
  void step() {
    if (every_ > 0 && ++steps_ % every_ == 0) add();
  }
  /// Returns the motion recorded since the last call, with a frame of now.
  RecordedMotion take();

 private:
  void add();
  void fill_grips(BodyId id, std::size_t index);

  const PhysicsWorld& world_;
  const GraspMonitor& grasp_;
  const MobileRobot* robot_;
  const Perception* perception_;
  RecordedScene scene_;
  std::vector<BodyId> leaders_;  // the first body of each link
  std::size_t grippers_ = 0;
  std::int64_t every_ = 0;  // steps; 0: off
  std::int64_t steps_ = 0, added_ = -1;
  std::vector<Pose> poses_;
  std::vector<std::uint8_t> grips_;
  MotionWriter writer_;
};

}  // namespace parallax::harness
