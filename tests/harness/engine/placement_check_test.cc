#include <doctest/doctest.h>

#include "harness/engine/world_check.h"
#include "tests/harness/world/hand_made.h"

namespace parallax::harness {
namespace {

/// "PATH: MESSAGE; ..." of all overlaps.
std::string overlaps(const WorldSpec& spec) {
  ProblemList problems;
  check_overlaps(spec, problems);
  std::string all;
  for (const WorldProblem& problem : problems.take()) {
    all += (all.empty() ? "" : "; ") + problem.path + ": " + problem.message;
  }
  return all;
}

const BodySpec kTable = box_body("table", {1.0, 1.0, 0.7}, {0.0, 0.0, 0.35});

TEST_CASE("a world without bodies, and one whose bodies stand apart, has no overlaps") {
  CHECK(overlaps(WorldSpec{}).empty());
  CHECK(overlaps(world_of({kTable, box_body("cup", {0.1, 0.1, 0.1}, {0.0, 0.0, 0.75}, 0.2)}))
            .empty());
}

TEST_CASE("a free body in furniture, in another one or in the floor is reported once") {
  BodySpec cup = box_body("cup", {0.1, 0.1, 0.1}, {0.0, 0.0, 0.7}, 0.2);
  CHECK(overlaps(world_of({kTable, cup})) == "bodies/cup: overlaps `table` at every start");
  BodySpec jug = box_body("jug", {0.1, 0.1, 0.2}, {0.05, 0.0, 1.0}, 0.2);
  cup.p_WB = {0.0, 0.0, 1.0};
  CHECK(overlaps(world_of({jug, cup})) == "bodies/cup: overlaps `jug` at every start");
  cup.p_WB = {0.0, 0.0, 0.02};
  CHECK(overlaps(world_of({cup})) == "bodies/cup: overlaps `floor` at every start");
}

TEST_CASE("an overlap no deeper than a start allows is none") {
  WorldSpec spec = world_of({kTable, box_body("cup", {0.1, 0.1, 0.1}, {0.0, 0.0, 0.747}, 0.2)});
  spec.solver.start_penetration_m = 0.002;
  CHECK_FALSE(overlaps(spec).empty());
  spec.solver.start_penetration_m = 0.004;
  CHECK(overlaps(spec).empty());
}

TEST_CASE("a body whose place a start chooses is held against the floor only") {
  BodySpec cup = box_body("cup", {0.1, 0.1, 0.1}, {0.0, 0.0, 0.5}, 0.2);
  cup.settable = {"x", "y"};
  CHECK(overlaps(world_of({kTable, cup})).empty());
  cup.p_WB.z() = 0.02;
  CHECK(overlaps(world_of({cup})) == "bodies/cup: overlaps `floor` at every start");
  cup.settable = {"bottom"};
  CHECK(overlaps(world_of({cup})).empty());
  cup.settable = {"mass"};  // which moves nothing
  CHECK_FALSE(overlaps(world_of({cup})).empty());
}

TEST_CASE("parts that hang together may overlap, but not what stands beside them") {
  BodySpec box = box_body("chest", {0.4, 0.4, 0.4}, {0.0, 0.0, 0.4}, 5.0);
  BodySpec drawer = box_body("drawer", {0.3, 0.3, 0.1}, {0.1, 0.0, 0.4}, 1.0);
  WorldSpec spec = world_of({box, drawer});
  JointSpec slide;
  slide.name = "slide";
  slide.parent = "chest";
  slide.child = "drawer";
  spec.joints = {slide};
  CHECK(overlaps(spec).empty());
  spec.bodies.push_back(box_body("post", {0.02, 0.02, 1.0}, {0.22, 0.0, 0.5}));
  CHECK(overlaps(spec) == "bodies/drawer: overlaps `post` at every start");
}

TEST_CASE("furniture may reach into furniture, but not be the same twice") {
  BodySpec shelf = box_body("shelf", {0.2, 1.0, 0.3}, {0.3, 0.0, 0.6});
  CHECK(overlaps(world_of({kTable, shelf})).empty());
  BodySpec twin = kTable;
  twin.name = "twin";
  CHECK(overlaps(world_of({kTable, twin})) == "bodies/twin: occupies the same place as `table`");
  twin.yaw_rad = 0.1;
  CHECK(overlaps(world_of({kTable, twin})).empty());
  twin.yaw_rad = 0.0;
  twin.collides = false;
  CHECK(overlaps(world_of({kTable, twin})).empty());
}

TEST_CASE("points are supported by furniture and by the floor, not by what can fall itself") {
  const WorldSpec spec =
      world_of({kTable, box_body("cup", {0.1, 0.1, 0.1}, {0.0, 0.0, 0.75}, 0.2)});
  const std::vector<NamedPoint> points = {{"on the table", {0.3, 0.3, 0.7}},
                                          {"on the cup", {0.0, 0.0, 0.8}},
                                          {"in the air", {0.3, 0.3, 0.9}},
                                          {"on the floor", {2.0, 0.0, 0.0}}};
  CHECK(unsupported_points(spec, points) == std::vector<std::string>{"on the cup", "in the air"});
}

TEST_CASE("a box holds no support where it is in the air above a stack of all that is free") {
  const WorldSpec spec =
      world_of({kTable, box_body("stick", {0.5, 0.02, 0.02}, {0.0, 0.0, 0.71}, 0.2)});
  const auto at = [](std::string name, const Eigen::Vector3d& low) {
    return NamedBox{std::move(name), low, low + Eigen::Vector3d::Constant(0.1)};
  };
  const std::vector<NamedBox> boxes = {
      at("on the table", {0.0, 0.0, 0.65}), at("high", {0.0, 0.0, 0.9}),
      at("beside, low", {2.0, 0.0, 0.45}), at("beside, high", {2.0, 0.0, 0.55})};
  CHECK(boxes_without_support(spec, boxes) == std::vector<std::string>{"high", "beside, high"});
}

TEST_CASE("a box is buried only in the box of a fixed body that swallows it") {
  const WorldSpec spec =
      world_of({kTable, box_body("chest", {1.0, 1.0, 0.7}, {3.0, 0.0, 0.35}, 50.0)});
  const auto around = [](std::string name, const Eigen::Vector3d& middle) {
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.05);
    return NamedBox{std::move(name), middle - half, middle + half};
  };
  const auto found = buried_boxes(
      spec, {around("inside", {0.0, 0.0, 0.3}), around("at the top", {0.0, 0.0, 0.65}),
             around("at the side", {0.48, 0.0, 0.3}), around("in the chest", {3.0, 0.0, 0.3})});
  REQUIRE(found.size() == 1);
  CHECK(found.front().name == "inside");
  CHECK(found.front().body == "table");
}

}  // namespace
}  // namespace parallax::harness
