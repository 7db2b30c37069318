#include "harness/robot/perception.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "harness/engine/ode_world.h"
#include "tests/harness/world/hand_made.h"

namespace parallax::harness {
namespace {

const Eigen::Vector3d kMilk_W(1.0, 0.0, 0.9);
const PlaceSpec kAhead{"ahead", "", kMilk_W, 0.0};

/// A robot at the origin without arms, its camera 1 m above the floor, and a carton 1 m before it.
WorldSpec room() {
  WorldSpec spec = world_of({box_body("base", {0.2, 0.2, 0.2}, {0.0, 0.0, 0.2}, 20.0),
                             box_body("milk", {0.06, 0.06, 0.2}, kMilk_W, 0.5)});
  JointSpec drive;
  drive.name = "drive";
  drive.type = JointType::kGantry;
  drive.child = "base";
  drive.max_force_n = 100.0;
  spec.joints = {drive};
  MobileRobotSpec robot;
  robot.base_joint = "drive";
  robot.base_body = "base";
  robot.camera.p_BC = {0.0, 0.0, 0.8};
  robot.camera.detection = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  spec.mobile = robot;
  return spec;
}

/// Nothing is stepped: the camera's view depends on where things are put.
struct Observer {
  explicit Observer(const WorldSpec& spec = room())
      : world(spec), robot(spec, world), perception(world, robot) {
    perception.reset();
  }

  BodyId id(std::string_view name) const { return *world.layout().find_body(name); }
  void put(std::string_view name, const Eigen::Vector3d& p_W, double yaw_rad = 0.0) {
    placements[id(name).index()] = {p_W, yaw_rad, 0.0};
    world.reset(placements, 1);
  }
  Sighting sight(int points = 9) const { return perception.sight(id("milk"), points); }

  OdeWorld world;
  MobileRobot robot;
  Perception perception;
  std::vector<Placement> placements = default_placements(world.layout());
};

TEST_CASE("a body in the cone is seen, and located to a few millimetres") {
  Observer observer;
  CHECK(observer.sight().seen == 0);  // the camera has looked at nothing yet
  REQUIRE_FALSE(observer.perception.look_at(kAhead).has_value());
  for (const double yaw_rad : {0.0, 0.4, 2.0}) {
    observer.put("milk", kMilk_W, yaw_rad);
    const Sighting sighting = observer.sight();
    CHECK(sighting.points == 9);
    CHECK(sighting.seen == 9);
    CHECK(sighting.hidden_by.empty());
    CHECK((sighting.p_W - kMilk_W).norm() < 0.01);
  }
}

TEST_CASE("a hollow body is located without a bias away from the camera") {
  WorldSpec spec = room();
  auto& bowl = spec.bodies.back();
  // A tray: a floor and four walls, its origin in the middle of its bounding box.
  bowl.shapes = {{{0.14, 0.14, 0.005}, {0.0, 0.0, -0.03}, 0.0},
                 {{0.005, 0.14, 0.065}, {0.0675, 0.0, 0.0}, 0.0},
                 {{0.005, 0.14, 0.065}, {-0.0675, 0.0, 0.0}, 0.0},
                 {{0.14, 0.005, 0.065}, {0.0, 0.0675, 0.0}, 0.0},
                 {{0.14, 0.005, 0.065}, {0.0, -0.0675, 0.0}, 0.0}};
  Observer observer(spec);
  const std::vector<Eigen::Vector3d> places = {{0.7, 0.0, 0.5}, {0.8, 0.1, 0.4}};
  for (const Eigen::Vector3d& p_W : places) {
    for (const double yaw_rad : {0.0, 0.6}) {
      observer.put("milk", p_W, yaw_rad);
      REQUIRE_FALSE(observer.perception.look_at({"it", "", p_W, 0.0}).has_value());
      const Sighting sighting = observer.sight();
      CHECK(sighting.seen == 9);
      CHECK((sighting.p_W - p_W).norm() < 0.005);
    }
  }
}

TEST_CASE("what is beside the cone, too near or too far is not seen") {
  Observer observer;
  REQUIRE_FALSE(observer.perception.look_at(kAhead).has_value());
  observer.put("milk", {1.0, 0.5, 0.9});
  CHECK(observer.sight().seen == 0);
  observer.put("milk", {0.2, 0.0, 0.98});
  CHECK(observer.sight().seen == 0);
  observer.put("milk", {3.0, 0.0, 0.7});
  CHECK(observer.sight().seen == 0);
  observer.put("milk", {2.0, 0.0, 0.8});
  CHECK(observer.sight().seen == 9);
  // A cone of 0.2 rad round the gaze ends 0.2 m to the side at 1 m.
  observer.put("milk", {1.0, 0.0, 1.08});  // its upper points are above the cone
  const Sighting upper = observer.sight();
  CHECK(upper.seen > 0);
  CHECK(upper.seen < 9);
}

TEST_CASE("a point behind another body is hidden, and by which is told") {
  WorldSpec spec = room();
  spec.bodies.push_back(box_body("screen", {0.02, 0.4, 0.92}, {0.5, 0.0, 0.46}));
  Observer observer(spec);
  REQUIRE_FALSE(observer.perception.look_at(kAhead).has_value());
  // The ray over the screen's edge meets the carton 0.16 m below the camera: its foot is hidden.
  const Sighting half = observer.sight();
  CHECK(half.hidden_by == "screen");
  CHECK(half.seen > 0);
  CHECK(half.seen < 9);
  // The estimate comes from the visible part, and is about the whole carton.
  CHECK((half.p_W - kMilk_W).norm() < 0.02);
  observer.put("milk", {1.0, 0.0, 0.7});
  CHECK(observer.sight().seen == 0);
  CHECK(observer.sight().p_W.isZero(0.0));
}

TEST_CASE("the robot's own parts hide nothing") {
  WorldSpec spec = room();
  spec.bodies.push_back(box_body("mast", {0.05, 0.05, 0.05}, {0.3, 0.0, 0.97}, 1.0));
  JointSpec weld;
  weld.name = "weld";
  weld.type = JointType::kFixed;
  weld.parent = "base";
  weld.child = "mast";
  spec.joints.push_back(weld);
  Observer observer(spec);
  REQUIRE_FALSE(observer.perception.look_at(kAhead).has_value());
  CHECK(observer.sight().seen == 9);
}

TEST_CASE("the neck turns and tilts so far and no farther") {
  Observer observer;
  const auto limit = [&](const Eigen::Vector3d& p_W) {
    return observer.perception.look_at({"there", "", p_W, 0.0}).value_or("");
  };
  CHECK(limit({-1.0, 0.01, 1.0}) == "a turn of 3.13 rad");
  CHECK(limit({1.0, 0.0, 2.0}) == "a tilt of -0.79 rad");
  CHECK(limit({0.1, 0.0, 0.0}) == "a tilt of 1.47 rad");
  CHECK(observer.perception.gaze().empty());  // a refused look leaves the gaze as it was
  CHECK(limit({-1.0, 1.0, 1.0}).empty());
  CHECK(observer.perception.gaze() == "there");
}

TEST_CASE("a robot that turns away looks at nothing, for good once that was noticed") {
  Observer observer;
  REQUIRE_FALSE(observer.perception.look_at(kAhead).has_value());
  CHECK(observer.perception.gaze() == "ahead");
  REQUIRE(observer.perception.line_of_sight().has_value());
  CHECK(observer.perception.line_of_sight()->camera_W.isApprox(Eigen::Vector3d(0.0, 0.0, 1.0)));
  const Eigen::Vector3d base_W(0.0, 0.0, 0.2);
  observer.put("base", base_W, 0.1);
  CHECK(observer.perception.gaze() == "ahead");
  observer.put("base", base_W, 0.3);
  CHECK(observer.perception.gaze().empty());
  observer.put("base", base_W, 0.0);
  CHECK(observer.perception.gaze() == "ahead");
  observer.put("base", {0.0, 0.5, 0.2}, 0.0);
  observer.perception.drop_lost_gaze();
  observer.put("base", base_W, 0.0);
  CHECK(observer.perception.gaze().empty());
  CHECK_FALSE(observer.perception.line_of_sight().has_value());
  CHECK(observer.sight().seen == 0);
}

TEST_CASE("beliefs are kept until they are taken back") {
  Observer observer;
  Perception& perception = observer.perception;
  const BodyId milk = observer.id("milk");
  CHECK_FALSE(perception.believed(milk).has_value());
  CHECK_FALSE(perception.believed_bottom_m(milk).has_value());
  REQUIRE_FALSE(perception.look_at(kAhead).has_value());
  const Sighting sighting = observer.sight();
  perception.believe(milk, sighting);
  CHECK(perception.belief(milk).perceived);
  CHECK(*perception.believed(milk) == sighting.p_W);
  CHECK(*perception.believed_bottom_m(milk) == doctest::Approx(sighting.p_W.z() - 0.1));

  observer.put("milk", {1.0, 0.3, 0.9});  // a thing not looked at again is believed where it was
  CHECK(*perception.believed(milk) == sighting.p_W);
  perception.believe_as_is(milk);
  CHECK(perception.believed(milk)->isApprox(Eigen::Vector3d(1.0, 0.3, 0.9)));
  perception.unsee(milk);
  CHECK_FALSE(perception.belief(milk).perceived);
  CHECK(perception.believed(milk).has_value());
  perception.forget(milk);
  CHECK_FALSE(perception.believed(milk).has_value());
  perception.believe_as_is(milk);
  perception.reset();
  CHECK_FALSE(perception.believed(milk).has_value());
}

TEST_CASE("what was seen in a drawer is believed to move along with it") {
  WorldSpec spec = room();
  spec.bodies.push_back(box_body("drawer", {0.3, 0.3, 0.02}, {1.0, 0.0, 0.78}, 2.0));
  JointSpec slide;
  slide.name = "slide";
  slide.child = "drawer";
  spec.joints.push_back(slide);
  Observer observer(spec);
  const BodyId milk = observer.id("milk");
  const PlaceSpec in_drawer{"in the drawer", "drawer", {0.0, 0.0, 0.12}, 0.0};
  CHECK(observer.perception.place_in_world(in_drawer).isApprox(kMilk_W));
  REQUIRE_FALSE(observer.perception.look_at(in_drawer).has_value());
  const Sighting sighting = observer.sight();
  REQUIRE(sighting.seen == 9);
  observer.perception.believe(milk, sighting);
  observer.put("drawer", {0.8, 0.0, 0.78});
  const Eigen::Vector3d expected = sighting.p_W - Eigen::Vector3d(0.2, 0.0, 0.0);
  CHECK(observer.perception.believed(milk)->isApprox(expected, 1e-9));
  CHECK(*observer.perception.believed_bottom_m(milk) == doctest::Approx(expected.z() - 0.1));
}

TEST_CASE("bodies are found by their kind, and by their name where they have none") {
  WorldSpec spec = room();
  for (const double y_m : {1.0, 2.0}) {
    const char* name = y_m == 1.0 ? "cup1" : "cup2";
    spec.bodies.push_back(box_body(name, {0.1, 0.1, 0.1}, {2.0, y_m, 0.5}, 0.1));
    spec.bodies.back().kind = "cup";
  }
  spec.bodies.push_back(box_body("cup", {0.1, 0.1, 0.1}, {2.0, 5.0, 0.5}));  // furniture
  const Observer observer(spec);
  CHECK(observer.perception.bodies_of_kind("cup") ==
        std::vector<BodyId>{observer.id("cup1"), observer.id("cup2")});
  CHECK(observer.perception.bodies_of_kind("milk") == std::vector<BodyId>{observer.id("milk")});
  CHECK(observer.perception.bodies_of_kind("cup1").empty());
}

}  // namespace
}  // namespace parallax::harness
