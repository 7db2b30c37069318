#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/support/interpreter/interpreter.h"
#include "tests/support/interpreter/kitchen_world.h"
#include "tests/support/interpreter/shelf_world.h"
#include "tests/support/kitchen_locator.h"
#include "tests/support/planned_model.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;
using Strings = std::vector<std::string>;

const fs::path kRoot = PARALLAX_SOURCE_DIR;
const fs::path kKitchen = kRoot / "scenarios" / "kitchen";
const fs::path kPlans = kRoot / "tests" / "plans";

constexpr const char* kArrived = "{base} (Happens(Go(base),time-1) & HoldsAt(RobotAt(base),time))";
constexpr const char* kGrasped =
    "{arm,item} (Happens(PickUp(arm,item),time-1) & !HoldsAt(Holding(arm,item),time-1) & "
    "HoldsAt(Holding(arm,item),time))";
constexpr const char* kStocked =
    "({board} HoldsAt(At(fresh1,board),time)) & ({board} HoldsAt(At(fresh2,board),time))";

std::string text_of(const fs::path& path) {
  std::ifstream in(path);
  REQUIRE(in);
  return {std::istreambuf_iterator<char>(in), {}};
}

struct Setting {
  std::vector<fs::path> models;
  fs::path binding;
  const char* constraint;
};
Setting kitchen(const char* start, const char* constraint) {
  return {{kKitchen / "domain.e", start}, kKitchen / "robot.bind", constraint};
}

/// Checks that the solver's traces are the executions of the plan by hand, `expected` in number.
void check_plan(const fs::path& plan, const Setting& setting, World& world, int horizon,
                std::size_t expected, bool complete) {
  CAPTURE(plan.string());
  CAPTURE(horizon);
  const auto text = text_of(plan);
  const PlannedModel model(setting.models, text, text_of(setting.binding), setting.constraint,
                           horizon, KitchenLocator());
  REQUIRE_MESSAGE(model.compiles(), model.codes());
  const auto executed = execute_all(text, world, horizon);
  auto found = model.keys();
  std::sort(found.keys.begin(), found.keys.end());
  CHECK(found.keys == Strings(executed.keys.begin(), executed.keys.end()));
  CHECK(executed.keys.size() == expected);
  CHECK(executed.beyond_horizon == !complete);
  CHECK(found.exploration == (complete ? runtime::Exploration::kAllTracesExplored
                                       : runtime::Exploration::kCompleteUpToBound));
}

const std::string kTidy = (kKitchen / "start.e").string();
const std::string kUntidy = (kPlans / "start_untidy.e").string();

TEST_CASE("the bowl on the counter: one trace for each cell") {
  KitchenWorld world(KitchenWorld::Goal::kGrasped, false);
  const auto setting = kitchen(kTidy.c_str(), kGrasped);
  check_plan(kPlans / "fetch_bowl.lisp", setting, world, 5, 2, false);
  check_plan(kPlans / "fetch_bowl.lisp", setting, world, 8, 3, true);
}

TEST_CASE("drawers that may stand open: what holds now decides what is done") {
  KitchenWorld world(KitchenWorld::Goal::kGrasped, true);
  const auto setting = kitchen(kUntidy.c_str(), kGrasped);
  check_plan(kPlans / "open_what_is_shut.lisp", setting, world, 8, 6, false);
  check_plan(kPlans / "open_what_is_shut.lisp", setting, world, 16, 14, true);
}

TEST_CASE("three nested failure handlers with retries") {
  KitchenWorld world(KitchenWorld::Goal::kGrasped, true);
  const auto setting = kitchen(kUntidy.c_str(), kGrasped);
  check_plan(kPlans / "nested_failures.lisp", setting, world, 12, 7, false);
  check_plan(kPlans / "nested_failures.lisp", setting, world, 18, 8, true);
}

TEST_CASE("restocking a shelf with two arms, what stands there is seen on the way") {
  ShelfWorld world;
  const Setting setting = {{kPlans / "shelf.e"}, kPlans / "shelf.bind", kStocked};
  check_plan(kPlans / "restock_shelf.lisp", setting, world, 14, 5, false);
  check_plan(kPlans / "restock_shelf.lisp", setting, world, 30, 7, true);
}

TEST_CASE("a plan of more than 150 lines lays the table") {
  const auto text = text_of(kPlans / "lay_the_table.lisp");
  CHECK(std::count(text.begin(), text.end(), '\n') >= 150);
  KitchenWorld world(KitchenWorld::Goal::kArrived, true);
  check_plan(kPlans / "lay_the_table.lisp", kitchen(kUntidy.c_str(), kArrived), world, 20, 24,
             true);
}

TEST_CASE("the plans of the kitchen scenario") {
  KitchenWorld arrived(KitchenWorld::Goal::kArrived, false);
  check_plan(kKitchen / "plan1.lisp", kitchen(kTidy.c_str(), kArrived), arrived, 10, 3, true);
  check_plan(kKitchen / "plan2.lisp", kitchen(kTidy.c_str(), kArrived), arrived, 11, 2, false);
  check_plan(kKitchen / "plan2.lisp", kitchen(kTidy.c_str(), kArrived), arrived, 16, 3, true);
  KitchenWorld grasped(KitchenWorld::Goal::kGrasped, false);
  check_plan(kKitchen / "plan3.lisp", kitchen(kTidy.c_str(), kGrasped), grasped, 33, 3, true);
}

}  // namespace
}  // namespace parallax::test
