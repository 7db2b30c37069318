#include <doctest/doctest.h>

#include <cmath>

#include "tests/harness/kitchen/kitchen_world.h"

namespace parallax::harness {
namespace {

/// Distance in the plane between the believed and the true place of the milk [m].
double off_m(Kitchen& kitchen) {
  return std::hypot(kitchen.number("milk1.seen.x") - kitchen.number("milk1.x"),
                    kitchen.number("milk1.seen.y") - kitchen.number("milk1.y"));
}

TEST_CASE("what is detected is believed near where it is, otherwise in each run, and alike again") {
  Kitchen kitchen(kitchen_world());
  std::vector<double> offs_m;
  for (const std::uint64_t seed : {1, 2, 3, 1}) {
    REQUIRE(ok(kitchen.simulator().reset({}, seed)));
    REQUIRE(ok(kitchen.look("pw1")));
    REQUIRE(ok(kitchen.detect("milk")));
    offs_m.push_back(off_m(kitchen));
    CHECK(offs_m.back() > 1e-5);
    CHECK(offs_m.back() < 0.014 + 1e-6);
    CHECK(std::abs(kitchen.number("milk1.seen.yaw") - kitchen.number("milk1.yaw")) < 0.1);
    CHECK(std::abs(kitchen.number("milk1.seen.bottom") - 0.85) < 0.001);
    const double before_m = kitchen.number("milk1.seen.x");
    REQUIRE(ok(kitchen.detect("milk")));
    CHECK(kitchen.number("milk1.seen.x") != before_m);  // every look has a noise of its own
  }
  CHECK(offs_m[0] != offs_m[1]);
  CHECK(offs_m[1] != offs_m[2]);
  CHECK(offs_m[0] == offs_m[3]);
}

TEST_CASE("an exact camera sees where things are") {
  WorldSpec exact = kitchen_world();
  exact.mobile->camera.detection = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  Kitchen kitchen(exact);
  kitchen.start({});
  REQUIRE(ok(kitchen.look("pw1")));
  REQUIRE(ok(kitchen.detect("milk")));
  CHECK(off_m(kitchen) < 1e-6);
}

TEST_CASE("the hand goes to where the carton is believed to be") {
  WorldSpec biased = kitchen_world();
  biased.mobile->camera.detection = {0.30, 0.0, 0.0, 0.0, 0.0, 0.0};  // far beside it
  Kitchen kitchen(biased);
  for (const std::uint64_t seed : {1, 2, 3}) {
    REQUIRE(ok(kitchen.simulator().reset({}, seed)));
    REQUIRE(ok(kitchen.look("pw1")));
    REQUIRE(ok(kitchen.detect("milk")));
    if (off_m(kitchen) < 0.1) continue;
    CHECK_FALSE(ok(kitchen.pick("milk1")));
    CHECK_FALSE(kitchen.flag("milk1.held"));
  }
}

TEST_CASE("a body in sight can be missed") {
  WorldSpec blind = kitchen_world();
  blind.mobile->camera.detection.miss_rate = 1.0;
  Kitchen kitchen(blind);
  kitchen.start({});
  REQUIRE(ok(kitchen.look("pw1")));
  const Outcome outcome = kitchen.detect("milk");
  CHECK(outcome.status == SimStatus::kFailed);
  CHECK(outcome.reason == "object-not-found: `milk1` is in sight and was missed");
  CHECK_FALSE(kitchen.flag("milk1.perceived"));
}

TEST_CASE("something else in sight can be taken for what is looked for, and is not it") {
  WorldSpec confused = kitchen_world();
  confused.mobile->camera.detection = {0.0, 0.0, 0.0, 0.0, 0.0, 1.0};
  Kitchen kitchen(confused);
  kitchen.start({{"milk1.y", 0.375}, {"bowl1.y", 0.075}});
  REQUIRE(ok(kitchen.look("pw1")));  // where the bowl is
  REQUIRE(ok(kitchen.detect("breakfastCereal")));
  CHECK(kitchen.flag("cereal1.perceived"));
  CHECK(std::abs(kitchen.number("cereal1.seen.x") - kitchen.number("bowl1.x")) < 0.02);
  CHECK(std::abs(kitchen.number("cereal1.seen.y") - kitchen.number("bowl1.y")) < 0.02);
  CHECK_FALSE(kitchen.flag("bowl1.perceived"));
  CHECK_FALSE(ok(kitchen.pick("cereal1")));
}

}  // namespace
}  // namespace parallax::harness
