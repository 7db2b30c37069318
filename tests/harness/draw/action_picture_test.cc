#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "harness/draw/action_recorder.h"
#include "harness/draw/scene_svg.h"
#include "tests/harness/kitchen/kitchen_world.h"
#include "tests/support/xml.h"

namespace parallax::harness {
namespace {

const State kNear = {{"robot.x", 0.78}, {"robot.y", 0.12}, {"robot.yaw", 0.05}};
const State kFar = {{"robot.x", 0.66}, {"robot.y", 0.0}};
const State kLeft = {{"arm", std::string("left")}};

/// A kitchen whose actions are watched.
struct Watched {
  explicit Watched(const State& start) : kitchen(kitchen_world()) { kitchen.start(start); }
  Outcome act(const std::string& controller, const State& arguments) {
    return recorder.act(controller, arguments, 60.0);
  }
  void open(const std::string& drawer) {
    State arguments = kLeft;
    arguments["joint"] = drawer;
    REQUIRE(ok(act("open-drawer", arguments)));
  }
  std::string svg() const {
    const std::vector<Picture> pictures = {{recorder.scene(), recorder.action()}};
    return scene_svg(pictures.front(), frame_around(pictures, nullptr), {"title", "", false});
  }
  Kitchen kitchen;
  ActionRecorder recorder{kitchen.simulator(), kitchen_world()};
};

/// The kinds of marks in both views, and that each is in both.
std::set<std::string> marks_of(const std::string& svg) {
  std::multiset<std::string> all;
  const auto parsed = test::parse_xml(svg);
  for (const auto* group : parsed.all("g")) all.insert(group->at("class"));
  const std::set<std::string> kinds(all.begin(), all.end());
  for (const std::string& kind : kinds) CHECK(all.count(kind) % 2 == 0);
  return kinds;
}

/// The interval of a box's corners along a direction.
std::pair<double, double> ends_along(const Probe& box, const Eigen::Vector3d& direction) {
  std::pair<double, double> out{1e9, -1e9};
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d sign(corner % 2 == 0 ? 0.5 : -0.5, corner / 2 % 2 == 0 ? 0.5 : -0.5,
                               corner / 4 == 0 ? 0.5 : -0.5);
    const double at = (box.p_WS + box.R_WS * sign.cwiseProduct(box.size_m)).dot(direction);
    out = {std::min(out.first, at), std::max(out.second, at)};
  }
  return out;
}

using Kinds = std::set<std::string>;

TEST_CASE("a refused drive shows the straight way, its goal and the body that is met") {
  Watched watched(kNear);
  watched.open("dMid");
  REQUIRE(ok(watched.act("park", kLeft)));
  const Outcome outcome = watched.act("drive", {{"place", std::string("bTable")}});
  REQUIRE(outcome.status == SimStatus::kFailed);
  const SceneAction& action = watched.recorder.action();
  CHECK(action.met == std::vector<std::string>{"drawer_mid"});
  REQUIRE(action.goal.has_value());
  CHECK_FALSE(action.goal->reached);
  CHECK(action.goal->from_W.x() == doctest::Approx(0.78).epsilon(0.01));
  const auto& places = kitchen_world().places;
  const auto table = std::find_if(places.begin(), places.end(),
                                  [](const PlaceSpec& place) { return place.name == "bTable"; });
  REQUIRE(table != places.end());
  CHECK((action.goal->to_W - table->p_FP).head<2>().norm() < 1e-12);
  // The body stands on the way, as far from the start as the sweep got.
  REQUIRE_FALSE(action.meeting.boxes.empty());
  const Scene now = watched.recorder.scene();
  const auto& stopped = action.meeting.boxes.front();
  const auto same = std::find_if(now.boxes.begin(), now.boxes.end(),
                                 [](const SceneBox& box) { return box.body == "base"; });
  const Eigen::Vector3d moved = stopped.box.p_WS - same->box.p_WS;
  CHECK(moved.norm() == doctest::Approx(std::get<double>(outcome.margins.at("free_way"))));
  CHECK(moved.cross(action.goal->to_W - action.goal->from_W).norm() < 1e-6);
  CHECK(marks_of(watched.svg()) == Kinds{"ghost", "goal", "measure", "met"});

  // The missing width to pass the obstacle, from the corners of both, seen along the way.
  const Eigen::Vector3d way = action.goal->to_W - action.goal->from_W;
  const Eigen::Vector3d across = way.cross(Eigen::Vector3d::UnitZ()).normalized();
  double missing_m = 0.0;
  for (const SceneBox& part : now.boxes) {
    for (const SceneBox& obstacle : now.boxes) {
      if (part.body != "base" || obstacle.body != "drawer_mid") continue;
      const auto [left, right] = ends_along(part.box, across);
      const auto [from, to] = ends_along(obstacle.box, across);
      const auto [low, high] = ends_along(part.box, Eigen::Vector3d::UnitZ());
      const auto [bottom, top] = ends_along(obstacle.box, Eigen::Vector3d::UnitZ());
      if (low >= top || bottom >= high) continue;
      missing_m = std::max(missing_m, std::min(right - from, to - left));
    }
  }
  CHECK(missing_m > 0.0);
  CHECK(std::get<double>(outcome.margins.at("clearance")) == doctest::Approx(-missing_m));
  REQUIRE(action.measures.size() == 1);
  CHECK(action.measures[0].label ==
        "`base` and `drawer_mid`: " + length_text(missing_m) + " too little room");
  CHECK((action.measures[0].to_W - action.measures[0].from_W).norm() == doctest::Approx(missing_m));
}

TEST_CASE("a drive that worked shows the way from its start to its end") {
  Watched watched(kFar);
  REQUIRE(ok(watched.act("drive", {{"place", std::string("bTable")}})));
  const SceneAction& action = watched.recorder.action();
  CHECK(action.goal->reached);
  CHECK(action.met.empty());
  REQUIRE(action.tracks.size() == 1);
  const SceneTrack& track = action.tracks.front();
  CHECK(track.name == "base");
  CHECK(track.points_W.front().x() == doctest::Approx(0.66).epsilon(0.01));
  CHECK(track.points_W.back().x() == doctest::Approx(watched.kitchen.number("robot.x")));
  for (const SceneBox& box : action.ghost.boxes) CHECK(box.body == "base");
  CHECK(marks_of(watched.svg()) == Kinds{"ghost", "goal", "track"});
}

TEST_CASE("a look shows the camera's cone, a detection what was looked for as well") {
  Watched watched(kNear);
  REQUIRE(ok(watched.act("look", {{"place", std::string("pw1")}})));
  const std::string looking = watched.svg();
  CHECK(marks_of(looking) == Kinds{"gaze"});
  const CameraSpec& camera = kitchen_world().mobile->camera;
  const SceneGaze gaze = watched.recorder.action().gaze.value();
  const Eigen::Vector3d ahead = (gaze.point_W - gaze.camera_W).normalized();
  CHECK(gaze.point_W.x() == doctest::Approx(1.46));
  for (const Eigen::Vector3d& end : gaze.border_W) {
    const Eigen::Vector3d ray = end - gaze.camera_W;
    CHECK(ray.norm() <= camera.max_range_m * 1.000001);
    CHECK(end.z() > -1e-9);
    CHECK(std::acos(ray.normalized().dot(ahead)) == doctest::Approx(camera.half_angle_rad));
  }
  REQUIRE(ok(watched.act("detect", {{"kind", std::string("milk")}})));
  REQUIRE(watched.recorder.action().sought.size() == 1);
  CHECK(watched.recorder.action().sought.front().body == "milk1");
  CHECK(watched.recorder.action().sought.front().seen);
  CHECK(marks_of(watched.svg()) == Kinds{"gaze", "sought"});
  CHECK(watched.svg() != looking);

  CHECK_FALSE(ok(watched.act("detect", {{"kind", std::string("spoon")}})));  // in its drawer
  CHECK_FALSE(watched.recorder.action().sought.front().seen);
  CHECK(watched.svg().find("spoon1: not seen") != std::string::npos);
}

TEST_CASE("opening a drawer shows it half way, and watching changes nothing") {
  Watched watched(kFar);
  watched.open("dMid");
  const double open_m = watched.kitchen.number("dMid.q");
  const auto end = std::get<double>(watched.kitchen.simulator().state().at("drawer_mid.x"));
  const auto& ghost = watched.recorder.action().ghost.boxes;
  const auto drawer = std::find_if(ghost.begin(), ghost.end(),
                                   [](const SceneBox& box) { return box.body == "drawer_mid"; });
  REQUIRE(drawer != ghost.end());
  CHECK(drawer->origin_W.x() - end == doctest::Approx(0.5 * open_m).epsilon(0.05));
  const auto has = [&](const std::string& body) {
    return std::any_of(ghost.begin(), ghost.end(),
                       [&](const SceneBox& box) { return box.body == body; });
  };
  CHECK(has("left_palm"));
  CHECK_FALSE(has("right_palm"));
  CHECK_FALSE(has("cabinet"));
  const auto kinds = marks_of(watched.svg());
  CHECK(kinds == Kinds{"ghost", "track"});

  Watched again(kFar);
  again.open("dMid");
  CHECK(again.svg() == watched.svg());
  Kitchen alone(kitchen_world());
  alone.start(kFar);
  REQUIRE(ok(alone.open("dMid")));
  CHECK(alone.simulator().state() == watched.kitchen.simulator().state());  // with its digest
}

TEST_CASE("what is covered by something nearer is dotted in that view") {
  const Watched watched(kFar);
  const std::string svg = watched.svg();
  CHECK(marks_of(svg).empty());
  int dotted = 0;
  const auto parsed = test::parse_xml(svg);
  for (const auto* line : parsed.all("polyline")) {
    dotted += line->attributes.contains("class") && line->at("class") == "covered" ? 1 : 0;
  }
  CHECK(dotted >= 2 * 3);  // three closed drawers below the counter and behind its side
  for (const auto* name : {"cabinet", "table", "base", "drawer_top", "spoon1", "left"}) {
    CAPTURE(name);
    const auto texts = parsed.all("text");
    CHECK(std::count_if(texts.begin(), texts.end(),
                        [&](const auto* text) { return text->text == name; }) == 2);
  }
}

}  // namespace
}  // namespace parallax::harness
