// Data that pictures take from a recording, compared with the simulator that made it.

#include "harness/draw/recorded_actions.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "harness/draw/action_recorder.h"
#include "harness/recording/recording_format.h"
#include "harness/robot/motion_recorder.h"
#include "tests/harness/config/scenario_world.h"
#include "tests/harness/kitchen/kitchen_world.h"

namespace parallax::harness {
namespace {

constexpr double kPlace_m = 1e-3;

/// The greatest distance between bodies and hands of two scenes of one world.
double apart_m(const Scene& a, const Scene& b) {
  REQUIRE(a.boxes.size() == b.boxes.size());
  REQUIRE(a.arms.size() == b.arms.size());
  double out = 0.0;
  for (std::size_t i = 0; i < a.boxes.size(); ++i) {
    REQUIRE(a.boxes[i].body == b.boxes[i].body);
    CHECK(a.boxes[i].kind == b.boxes[i].kind);
    CHECK(a.boxes[i].box.size_m == b.boxes[i].box.size_m);
    out = std::max(out, (a.boxes[i].origin_W - b.boxes[i].origin_W).norm());
  }
  for (std::size_t i = 0; i < a.arms.size(); ++i) {
    CHECK(a.arms[i].name == b.arms[i].name);
    out = std::max(out, (a.arms[i].to_W - b.arms[i].to_W).norm());
  }
  return out;
}

/// Checks that at the time of every moment that was seen, everything in it was recorded.
void check_ways(const std::vector<SceneMoment>& seen, const std::vector<SceneMoment>& recorded) {
  REQUIRE_FALSE(recorded.empty());
  CHECK(recorded.size() <= seen.size());
  std::size_t at = 0;
  for (const SceneMoment& moment : seen) {
    while (at + 1 < recorded.size() && recorded[at + 1].time_s <= moment.time_s + 1e-3) ++at;
    CAPTURE(moment.time_s);
    CHECK(apart_m(moment.scene, recorded[at].scene) <= kPlace_m);
  }
}

std::vector<std::string> bodies_of(const std::vector<SceneBox>& boxes) {
  std::vector<std::string> out;
  for (const SceneBox& box : boxes) out.push_back(box.body);
  return out;
}

void check_marks(const SceneAction& seen, const SceneAction& recorded) {
  CHECK(seen.notes == recorded.notes);
  CHECK(seen.met == recorded.met);
  CHECK(bodies_of(seen.ghost.boxes) == bodies_of(recorded.ghost.boxes));
  CHECK(bodies_of(seen.meeting.boxes) == bodies_of(recorded.meeting.boxes));
  REQUIRE(seen.tracks.size() == recorded.tracks.size());
  for (std::size_t i = 0; i < seen.tracks.size(); ++i) {
    CHECK(seen.tracks[i].name == recorded.tracks[i].name);
    CHECK(seen.tracks[i].kind == recorded.tracks[i].kind);
  }
  REQUIRE(seen.measures.size() == recorded.measures.size());
  for (std::size_t i = 0; i < seen.measures.size(); ++i) {
    CHECK(seen.measures[i].label == recorded.measures[i].label);
    CHECK((seen.measures[i].to_W - recorded.measures[i].to_W).norm() <= 2.0 * kPlace_m);
  }
  REQUIRE(seen.goal.has_value() == recorded.goal.has_value());
  if (seen.goal) {
    CHECK(seen.goal->reached == recorded.goal->reached);
    CHECK((seen.goal->to_W - recorded.goal->to_W).norm() <= kPlace_m);
  }
  REQUIRE(seen.gaze.has_value() == recorded.gaze.has_value());
  if (seen.gaze) {
    CHECK((seen.gaze->camera_W - recorded.gaze->camera_W).norm() <= kPlace_m);
    CHECK((seen.gaze->point_W - recorded.gaze->point_W).norm() <= kPlace_m);
  }
  REQUIRE(seen.sought.size() == recorded.sought.size());
  for (std::size_t i = 0; i < seen.sought.size(); ++i) {
    CHECK(seen.sought[i].body == recorded.sought[i].body);
    CHECK(seen.sought[i].seen == recorded.sought[i].seen);
    CHECK((seen.sought[i].p_W - recorded.sought[i].p_W).norm() < 1e-9);  // as observed
  }
  REQUIRE(seen.reach.has_value() == recorded.reach.has_value());
}

TEST_CASE("a recording shows the ways, grips, gazes and lengths that a simulation shows") {
  const WorldSpec& spec = kitchen_world();
  OdeSimulator simulator(spec);
  simulator.record_motion(0.05);
  const auto start =
      simulator.reset({{"robot.x", 0.78}, {"robot.y", 0.12}, {"robot.yaw", 0.05}}, 7);
  REQUIRE(ok(start));
  Recording recording;
  recording.trace = recording.sample = 1;
  recording.simulator = "ode";
  recording.status = "ok";
  recording.interval_s = 0.05;
  recording.scene = *simulator.info().scene;
  recording.frames = start.motion.frames;
  recording.observations.push_back(simulator.state());

  const std::string left = "left";
  const std::vector<std::pair<std::string, State>> calls = {
      {"look", {{"place", std::string("pw1")}}},
      {"detect", {{"kind", std::string("milk")}}},
      {"pick-up", {{"arm", left}, {"object", std::string("milk1")}}},
      {"park", {{"arm", left}}},
      {"open-gripper", {{"arm", left}}},
      {"open-drawer", {{"arm", left}, {"joint", std::string("dMid")}}},
      {"park", {{"arm", left}}},
      {"drive", {{"place", std::string("bTable")}}},  // meets the drawer
      {"detect", {{"kind", std::string("spoon")}}},   // in its drawer
      {"close-drawer", {{"arm", left}, {"joint", std::string("dMid")}}},
      {"park", {{"arm", left}}},
      {"drive", {{"place", std::string("bTable")}}},
      {"detect", {{"kind", std::string("milk")}}},  // the gaze was lost on the way
  };
  struct Shown {
    Outcome outcome;
    std::vector<SceneMoment> moments;
    SceneAction action;
    Scene after;
  };
  std::vector<Shown> shown;
  ActionRecorder watched(simulator, spec);
  double time_s = 0.0;
  for (const auto& [controller, arguments] : calls) {
    const Outcome outcome = watched.act(controller, arguments, 60.0);
    CAPTURE(controller);
    CAPTURE(outcome.reason);
    REQUIRE((outcome.status == SimStatus::kOk || outcome.status == SimStatus::kFailed));
    RecordedEvent event{controller,
                        time_s,
                        time_s + outcome.sim_time_s,
                        std::string(to_string(outcome.status)),
                        outcome.reason,
                        outcome.margins};
    time_s = event.end_s;
    recording.events.push_back(std::move(event));
    recording.frames += outcome.motion.frames;
    recording.observations.push_back(simulator.state());
    shown.push_back({outcome, watched.moments(), watched.action(), watched.scene()});
  }
  const auto failed = [&](std::size_t i) { return shown[i].outcome.status == SimStatus::kFailed; };
  CHECK(failed(7));
  CHECK(failed(8));
  CHECK_FALSE(shown[7].action.measures.empty());
  CHECK(shown[1].action.gaze.has_value());

  // As a file holds it.
  auto decoded = decode_recording(encode(recording));
  const auto* read = std::get_if<Recording>(&decoded);
  REQUIRE(read != nullptr);
  CHECK(unlike_world(*read, spec).empty());
  RecordedActions recorded(*read, spec);
  for (std::size_t i = 0; i < calls.size(); ++i) {
    CAPTURE(i);
    CAPTURE(calls[i].first);
    const Outcome outcome = recorded.act(calls[i].first, calls[i].second);
    CHECK(outcome.status == shown[i].outcome.status);
    CHECK(outcome.reason == shown[i].outcome.reason);
    CHECK(outcome.margins == shown[i].outcome.margins);
    CHECK(outcome.sim_time_s == doctest::Approx(shown[i].outcome.sim_time_s));
    check_ways(shown[i].moments, recorded.moments());
    check_marks(shown[i].action, recorded.action());
    CHECK(apart_m(shown[i].after, recorded.scene()) <= kPlace_m);
  }
  CHECK(recorded.act("park", {{"arm", left}}).status == SimStatus::kLost);  // there is no more

  // Frames of every millisecond do not fill the memory.
  auto dense = *read;
  MotionWriter writer({dense.scene.moving().size(), dense.scene.grippers.size()});
  std::vector<Pose> poses(dense.scene.moving().size());
  for (int ms = 0; ms < 2000; ++ms) {
    poses.front().p[0] = 0.001 * ms;
    REQUIRE(writer.add(0.001 * ms, poses, {}));
  }
  dense.frames = writer.take();
  dense.events = {{"long", 0.0, 2.0, "ok", "", {}}};
  dense.observations.clear();
  RecordedActions often(dense, spec);
  REQUIRE(ok(often.act("park", {{"arm", left}})));
  CHECK(often.moments().size() > 40);
  CHECK(often.moments().size() < 110);

  auto other = *read;
  other.scene.bodies.front().name += "'";
  CHECK_FALSE(unlike_world(other, spec).empty());
}

TEST_CASE("an arm of joints is drawn by its links: no line stands for it") {
  const WorldSpec world = world_of("arms/warehouse_arms.yaml");
  OdeSimulator simulator(world);
  REQUIRE(simulator.reset({}, 1).status == SimStatus::kOk);
  const Scene scene = scene_of(simulator.world(), world);
  CHECK(scene.arms.empty());
  CHECK(std::any_of(scene.boxes.begin(), scene.boxes.end(),
                    [](const SceneBox& box) { return box.body == "left_fore"; }));
  CHECK(recorded_scene(world, simulator.world().layout()).arms.empty());
}

}  // namespace
}  // namespace parallax::harness
