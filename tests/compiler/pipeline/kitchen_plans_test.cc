#include <doctest/doctest.h>

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/support/kitchen_locator.h"
#include "tests/support/planned_model.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;
using runtime::Exploration;
using Strings = std::vector<std::string>;

const fs::path kFolder = fs::path(PARALLAX_SOURCE_DIR) / "scenarios" / "kitchen";

constexpr const char* kArrived = "{base} (Happens(Go(base),time-1) & HoldsAt(RobotAt(base),time))";
constexpr const char* kGrasped =
    "{arm,item} (Happens(PickUp(arm,item),time-1) & !HoldsAt(Holding(arm,item),time-1) & "
    "HoldsAt(Holding(arm,item),time))";

std::string text_of(const char* name) {
  std::ifstream in(kFolder / name);
  return {std::istreambuf_iterator<char>(in), {}};
}

PlannedModel kitchen(const char* plan, const char* constraint, std::int64_t horizon) {
  return {{kFolder / "domain.e", kFolder / "start.e"},
          text_of(plan),
          text_of("robot.bind"),
          constraint,
          horizon,
          KitchenLocator()};
}

Strings lengths(const Strings& keys) {
  Strings out;
  for (const auto& key : keys) {
    out.push_back(std::to_string(std::count(key.begin(), key.end(), ';')));
  }
  return out;
}

TEST_CASE("the kitchen is as large as the model it stands for") {
  const auto model = kitchen("plan2.lisp", kArrived, 3);
  REQUIRE(model.compiles());
  const auto& typed = model.typed();
  const auto count = [&](compiler::SymbolKind kind) {
    std::size_t n = 0;
    for (const auto& symbol : typed.symbols) {
      // Those of the event calculus come before the model's.
      if (symbol.kind == kind && symbol.declared.file != typed.symbols.begin()->declared.file) ++n;
    }
    return n;
  };
  CHECK(count(compiler::SymbolKind::kFluent) == 16);
  CHECK(count(compiler::SymbolKind::kEvent) == 10);
  CHECK(count(compiler::SymbolKind::kPredicate) == 2);
}

TEST_CASE("bowl and spoon: one, two and three traces at the horizons 7, 11 and 15") {
  const Strings first = {
      "OpenDrawer(left,dTop);LookAt(dTop);Detect(spoon)=spoon1;PickUp(left,spoon1);ParkArm(left);"
      "ParkArm(right);Go(bTable);"};
  std::size_t expected = 0;
  for (const int horizon : {6, 7, 10, 11, 14, 15, 20}) {
    CAPTURE(horizon);
    const auto model = kitchen("plan2.lisp", kArrived, horizon);
    REQUIRE(model.compiles());
    const auto found = model.keys();
    if (horizon == 7 || horizon == 11 || horizon == 15) ++expected;
    CHECK(found.keys.size() == expected);
    CHECK(found.exploration ==
          (horizon < 15 ? Exploration::kCompleteUpToBound : Exploration::kAllTracesExplored));
    if (expected > 0) CHECK(found.keys.front() == first.front());
    if (expected == 3) CHECK(lengths(found.keys) == Strings{"7", "11", "15"});
  }
}

TEST_CASE("bowl and spoon: nine hits in all for each cell that the bowl can be on") {
  for (const auto* cell : {"pw1", "pw3"}) {
    CAPTURE(cell);
    std::string name = (fs::temp_directory_path() / "parallax_bowl_XXXXXX").string();
    REQUIRE(::mkdtemp(name.data()) != nullptr);
    const auto fact = fs::path(name) / "bowl.e";
    std::ofstream(fact) << "HoldsAt(ItemAt(bowl1," << cell << "),0).\n";
    const PlannedModel model({kFolder / "domain.e", kFolder / "start.e", fact},
                             text_of("plan2.lisp"), text_of("robot.bind"), kArrived, 32,
                             KitchenLocator());
    fs::remove_all(name);
    REQUIRE(model.compiles());
    const auto found = model.keys({.all_hits = true});
    CHECK(found.keys.size() == 9);
    CHECK(found.exploration == Exploration::kAllTracesExplored);
    // Milk and cereal change places: two initial states for every sequence.
    CHECK(model.keys({.all_hits = false, .split_initial = true}).keys.size() == 6);
  }
}

TEST_CASE("setting the table: three traces by the cell that the milk is on") {
  const auto model = kitchen("plan1.lisp", kArrived, 12);
  REQUIRE(model.compiles());
  const auto found = model.keys();
  CHECK(lengths(found.keys) == Strings{"5", "7", "9"});
  CHECK(found.keys.front() ==
        "LookAt(pw1);Detect(milk)=milk1;PickUp(left,milk1);ParkArm(left);Go(bTable);");
  CHECK(found.exploration == Exploration::kAllTracesExplored);
}

TEST_CASE("looking into drawers: the first stance decides, in each of three drawers") {
  const auto model = kitchen("plan3.lisp", kGrasped, 34);
  REQUIRE(model.compiles());
  const auto found = model.keys();
  CHECK(lengths(found.keys) == Strings{"6", "19", "32"});
  CHECK(found.exploration == Exploration::kAllTracesExplored);
}

TEST_CASE("bowl and spoon, modified: drawers closed, a second grip, the same three paths") {
  const PlannedModel model({kFolder / "domain_modified.e", kFolder / "start_modified.e"},
                           text_of("plan2_modified.lisp"), text_of("robot_modified.bind"), kArrived,
                           18, KitchenLocator());
  REQUIRE(model.compiles());
  const auto found = model.keys();
  CHECK(lengths(found.keys) == Strings{"9", "13", "17"});
  CHECK(found.exploration == Exploration::kAllTracesExplored);
}

}  // namespace
}  // namespace parallax::test
