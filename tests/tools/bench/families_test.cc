// The families of tools/bench: every text compiles and has as many traces as it should.

#include "tools/bench/families/families.h"

#include <doctest/doctest.h>

#include "tests/support/checked_traces.h"
#include "tests/support/text_model.h"
#include "tests/tools/bench/path_count.h"

namespace parallax::test {
namespace {

/// The traces of a family's model, each checked by the reference evaluator.
std::int64_t traces_of(const std::string& name) {
  const auto text = tools::family_model(name);
  REQUIRE_MESSAGE(text, name);
  const TextModel model(*text);
  REQUIRE_MESSAGE(model.codes().empty(), name << ": " << model.codes());
  return static_cast<std::int64_t>(checked_traces(*model.typed, model.compiled).size());
}

TEST_CASE("lamps: an odd number of flips for each, 2^(lamps*(horizon-1)) traces") {
  CHECK(traces_of("lamps_1_1") == 1);
  CHECK(traces_of("lamps_1_5") == 16);
  CHECK(traces_of("lamps_2_3") == 16);
  CHECK(traces_of("lamps_3_3") == 64);
  CHECK(traces_of("lamps_4_2") == 16);
}

TEST_CASE("distant: lamps that are not flipped both first and last, (3*2^(horizon-3))^lamps") {
  CHECK(traces_of("distant_1_3") == 3);
  CHECK(traces_of("distant_1_5") == 12);
  CHECK(traces_of("distant_2_4") == 36);
}

TEST_CASE("pigeons: injective maps into the holes") {
  CHECK(traces_of("pigeon_1_1") == 1);
  CHECK(traces_of("ringed_3_4") == 24);
  CHECK(traces_of("ringed_4_3") == 0);
  CHECK(traces_of("pigeon_2_3") == 3 * 2);
  CHECK(traces_of("pigeon_3_4") == 4 * 3 * 2);
  CHECK(traces_of("pigeon_4_3") == 0);
}

TEST_CASE("robots: as many traces as courses through rooms and hands") {
  for (const auto& [rooms, things, slack] :
       {std::tuple{2, 1, 0}, {2, 1, 3}, {3, 1, 3}, {2, 2, 2}, {3, 2, 1}, {3, 3, 0}, {4, 2, -1}}) {
    const auto sign = slack < 0 ? "m1" : std::to_string(slack);
    const auto name = "robot_" + std::to_string(rooms) + "_" + std::to_string(things) + "_" + sign;
    CAPTURE(name);
    CHECK(traces_of(name) == robot_courses(rooms, things, slack));
  }
}

TEST_CASE("robots without a goal: every course") {
  CHECK(traces_of("roaming_2_1_3") == roaming_courses(2, 1, 3));
  CHECK(traces_of("roaming_3_2_3") == roaming_courses(3, 2, 3));
  CHECK(roaming_courses(3, 2, 3) > 20);
}

TEST_CASE("robots: the courses of the sizes that are measured") {
  CHECK(robot_courses(4, 2, 4) == 3'488);
  CHECK(robot_courses(4, 2, 8) == 1'759'222);
  CHECK(robot_courses(6, 3, 0) == 2);
  CHECK(robot_courses(6, 4, -1) == 0);
}

TEST_CASE("many bodies: as many traces as courses") {
  CHECK(traces_of("hanoi_2_3") == hanoi_courses(2, 3));
  CHECK(hanoi_courses(2, 2) == 0);
  CHECK(hanoi_courses(2, 3) == 1);
  CHECK(traces_of("hanoi_2_5") == hanoi_courses(2, 5));
  CHECK(traces_of("hanoi_3_7") == 1);
  CHECK(traces_of("grid_2_1_3") == grid_courses(2, 1, 3));
  CHECK(traces_of("grid_2_3_2") == grid_courses(2, 3, 2));
  CHECK(traces_of("grid_3_2_4") == grid_courses(3, 2, 4));
  CHECK(grid_courses(3, 2, 4) > 1);
  CHECK(traces_of("logistics_1_1_2_4") == logistics_courses(1, 1, 2, 4));
  CHECK(traces_of("logistics_2_2_2_4") == logistics_courses(2, 2, 2, 4));
  CHECK(traces_of("logistics_2_1_3_6") == logistics_courses(2, 1, 3, 6));
  CHECK(logistics_courses(2, 2, 2, 4) > 1);
}

TEST_CASE("a task is the world, the goal as a formula, and both as a model") {
  const auto task = tools::family_task("hanoi_2_3").value();
  CHECK(task.goal == "HoldsAt(On(1,Right),time) & HoldsAt(On(2,Right),time)");
  CHECK(task.model.starts_with(task.world));
  CHECK(task.model == tools::family_model("hanoi_2_3"));
  CHECK_FALSE(tools::family_task("lamps_2_3"));
}

TEST_CASE("banks: told transfers have one outcome, open ones as many as there are series") {
  CHECK(traces_of("bankproj_2_10_3_8") == 1);
  CHECK(traces_of("bankproj_3_12_3_8") == 1);
  CHECK(traces_of("bankplan_2_6_2_3") == transfer_series(2, 6, 2, 3));
  CHECK(traces_of("bankplan_3_6_2_3") == transfer_series(3, 6, 2, 3));
  CHECK(traces_of("bankplan_3_6_4_2") == transfer_series(3, 6, 4, 2));
  CHECK(transfer_series(3, 6, 2, 3) > 1);
  CHECK(transfer_series(3, 12, 4, 5) == 10'720);
}

TEST_CASE(
    "chains: the last stage is reached just in time from every start, denying it leaves no trace") {
  CHECK(traces_of("chain_2") == 0);
  CHECK(traces_of("chain_8") == 0);
  auto text = tools::chain_model(8);
  const std::string denied = "!HoldsAt(Lit(8),7).";
  const auto at = text.find(denied);
  REQUIRE(at != std::string::npos);
  text.replace(at, denied.size(), "HoldsAt(Lit(8),7).");
  const TextModel reached(text);
  CHECK(checked_traces(*reached.typed, reached.compiled).size() == 128);  // 7 others, lit or not
}

TEST_CASE("falling things: one trace, on the ground one step before the end") {
  for (const int horizon : {3, 5, 12}) {
    const TextModel model(tools::falling_model(horizon));
    REQUIRE(model.codes().empty());
    const auto traces = checked_traces(*model.typed, model.compiled);
    REQUIRE(traces.size() == 1);
    const auto course = tools::valuation_of(traces.front());
    const auto last = static_cast<std::size_t>(horizon);
    CHECK(course.happens[last - 2].count("HitGround(Plate)") == 1);
    CHECK(course.holds[last] == std::set<std::string>{"Above(Plate,0)"});
  }
}

TEST_CASE("names that are no family, or sizes out of range, have no model") {
  for (const auto* name : {"",
                           "robot",
                           "robot_4_2",
                           "robot_4_2_8_1",
                           "robot_4_m2_8",
                           "robot_1_2_0",
                           "robot_4_2_x",
                           "robot_2_1_m9",
                           "lamps_0_3",
                           "lamps_3_-1",
                           "lamps_3_",
                           "bankproj_5_4_1_3",
                           "falling_2",
                           "distant_3_2",
                           "roaming_1_2_3",
                           "robot_1000000_1000000_0",
                           "lamps_99999999999_1",
                           "zoo_3",
                           "grid_2_5_3",
                           "logistics_2_1_1_4"}) {
    CHECK_MESSAGE(!tools::family_model(name), name);
  }
}

}  // namespace
}  // namespace parallax::test
