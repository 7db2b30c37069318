#include "harness/region/measured.h"

#include <doctest/doctest.h>

#include <memory>

#include "harness/region/area.h"

namespace parallax::harness {
namespace {

Region rectangle(std::string name, Interval x, Interval y) {
  Region region;
  region.name = std::move(name);
  region.on(RegionAxis::kX) = x;
  region.on(RegionAxis::kY) = y;
  return region;
}

StateMapping table() {
  auto disc = rectangle("disc", {10, 12}, {0, 2});
  disc.area = std::make_shared<const Area>(std::vector<PlaneShape>{RingShape{{11, 1}, 0.0, 1.0}});
  auto drawer = rectangle("drawer", {-0.5, 0.5}, {-0.5, 0.5});
  drawer.frame = "chest";
  base::DiagnosticSink sink;
  std::vector<RegionFamily> families;
  const auto add = [&](std::string name, std::vector<Region> regions) {
    families.push_back({std::move(name), *RegionSet::make(std::move(regions), true, sink), {}});
  };
  add("cells", {rectangle("left", {0, 1}, {0, 1}), rectangle("right", {1, 2}, {0, 1})});
  add("discs", {disc});
  add("drawers", {drawer});
  InsideBinding inside{"{0}", 1, "{0}.held", {}};
  inside.upright = 0.35;
  const base::SourceRange nowhere{base::FileId(0), 1, 2};
  return StateMapping(RegionMap(std::move(families)),
                      {{"At", 2, inside, nowhere},
                       {"Holding", 1, FlagBinding{"{0}.held"}, nowhere},
                       {"Open", 0, RangeBinding{"door.angle", {1.4, 1.6}, {0.0, 0.1}}, nowhere},
                       {"Sees", 1, EqualsBinding{"camera.sees", "{0}"}, nowhere},
                       {"Heavy", 1, BorderBinding{"{0}.mass", 1.0}, nowhere},
                       {"Asleep", 0, FlagBinding{"Asleep()"}, nowhere},
                       {"Thinking", 0, IgnoredBinding{}, nowhere}});
}

State cup(double x, double y) {
  return {{"cup.x", x}, {"cup.y", y}, {"cup.held", false}, {"cup.roll", 0.0}, {"cup.pitch", 0.0}};
}

std::string measured(const char* fluent, const State& state) {
  return measured_text(table(), ground_fluent(fluent), state);
}

TEST_CASE("a region: the axis that decides, with its bounds") {
  CHECK(measured("At(cup,left)", cup(0.9, 0.5)) == "cup.x = 0.9 m within [0, 1]");
  CHECK(measured("At(cup,left)", cup(0.5, 0.02)) == "cup.y = 0.02 m within [0, 1]");
  CHECK(measured("At(cup,left)", cup(1.0055, 0.5)) == "cup.x = 1.006 m, 5.5 mm above [0, 1]");
  CHECK(measured("At(cup,left)", cup(0.5, -2.5)) == "cup.y = -2.5 m, 2.50 m below [0, 1]");
  // A shared border belongs to the region above it.
  CHECK(measured("At(cup,left)", cup(1.0, 0.5)) == "cup.x = 1 m, at the border of [0, 1]");
  CHECK(measured("At(cup,right)", cup(1.0, 0.5)) == "cup.x = 1 m within [1, 2]");
}

TEST_CASE("a region: an angle a turn away is the same angle") {
  base::DiagnosticSink sink;
  auto ahead = rectangle("ahead", {0, 1}, {0, 1});
  ahead.on(RegionAxis::kYaw) = Interval{-0.2, 0.2};
  const StateMapping mapping(
      *RegionSet::make({ahead}, true, sink),
      {{"At", 1, InsideBinding{"robot", 0, {}, {}}, {base::FileId(0), 1, 2}}});
  const auto fluent = ground_fluent("At(ahead)");
  const auto text = [&](double x, double yaw) {
    const State state = {{"robot.x", x}, {"robot.y", 0.5}, {"robot.yaw", yaw}};
    CHECK(mapping.holds(fluent, state) == (x < 1.0 && yaw > 6.0 && yaw < 6.4));
    return measured_text(mapping, fluent, state);
  };
  CHECK(text(0.5, 6.3) == "robot.yaw = 0.01681 rad within [-0.2, 0.2]");
  CHECK(text(1.5, 6.3) == "robot.x = 1.5 m, 500 mm above [0, 1]");
  CHECK(text(0.5, 6.7) == "robot.yaw = 0.4168 rad, 0.22 rad above [-0.2, 0.2]");
}

TEST_CASE("a region: flags and leaning come before the place") {
  auto state = cup(0.5, 0.5);
  state["cup.held"] = true;
  CHECK(measured("At(cup,left)", state) == "cup.held = true");
  state = cup(0.5, 0.5);
  state["cup.roll"] = 1.5;
  CHECK(measured("At(cup,left)", state) == "cup leans by 1.5 rad, more than 0.35");
}

TEST_CASE("areas and frames") {
  CHECK(measured("At(cup,disc)", cup(11.9, 1.9)) ==
        "(cup.x, cup.y) = (11.9, 1.9) m, 273 mm outside of a disc of 1 m around (11, 1)");
  auto state = cup(3.0, 4.7);
  state.insert({{"chest.x", 3.0}, {"chest.y", 4.0}, {"chest.z", 0.0}, {"chest.yaw", 0.0}});
  CHECK(measured("At(cup,drawer)", state) ==
        "cup.y = 0.7 m in the frame of chest, 200 mm above [-0.5, 0.5]");
}

TEST_CASE("flags, ranges, words and borders") {
  CHECK(measured("Holding(cup)", cup(0, 0)) == "cup.held = false");
  CHECK(measured("Open()", {{"door.angle", 0.7}}) ==
        "door.angle = 0.7; it holds within [1.4, 1.6], and fails within [0, 0.1]");
  CHECK(measured("Sees(cup)", {{"camera.sees", std::string("milk")}}) ==
        "camera.sees = \"milk\"; it holds for \"cup\"");
  CHECK(measured("Heavy(cup)", {{"cup.mass", 0.4}}) == "cup.mass = 0.4; it holds above 1");
}

TEST_CASE("nothing is said of what is not compared or not in the state") {
  CHECK(measured("Thinking()", cup(0, 0)).empty());
  CHECK(measured("Unknown()", cup(0, 0)).empty());
  CHECK(measured("Asleep()", {{"Asleep()", true}}).empty());
  for (const auto* fluent :
       {"At(cup,left)", "At(cup,nowhere)", "Holding(cup)", "Open()", "Sees(cup)", "Heavy(cup)"}) {
    CHECK(measured(fluent, {}).empty());
  }
}

}  // namespace
}  // namespace parallax::harness
