// Answers of each kind of condition, asked directly.

#include "harness/region/fluent_binding.h"

#include <doctest/doctest.h>

namespace parallax::harness {
namespace {

RegionMap regions() {
  base::DiagnosticSink sink;
  std::vector<Region> cells(2);
  cells[0].name = "r1", cells[1].name = "r2";
  cells[0].on(RegionAxis::kX) = Interval{0, 1};
  cells[1].on(RegionAxis::kX) = Interval{1, 2};
  for (auto& cell : cells) cell.on(RegionAxis::kY) = Interval{-1, 1};
  auto set = RegionSet::make(std::move(cells), false, sink);
  REQUIRE(set.has_value());
  return RegionMap(*std::move(set));
}

using Names = std::vector<std::string>;

TEST_CASE("binding: a body in a region") {
  const auto map = regions();
  const FluentBinding binding{"In", 2, InsideBinding{"{0}", 1, "{0}.held", "{0}.seen"}, {}};
  const auto fluent = ground_fluent("In(box,r2)");
  CHECK(binding.variables(fluent, map) == Names{"box.x", "box.y", "box.held", "box.seen"});
  CHECK(binding.constant_variables(map).empty());  // all depend on the fluent
  State state = {{"box.x", 1.5}, {"box.y", 0.0}, {"box.held", false}, {"box.seen", true}};
  CHECK(binding.read(fluent, state, map, nullptr) == Reading::kHolds);
  state["box.held"] = true;
  CHECK(binding.read(fluent, state, map, nullptr) == Reading::kFails);
  std::set<std::string> missing;
  CHECK(binding.read(fluent, {{"box.x", 1.5}}, map, &missing) == Reading::kFails);
  CHECK(missing == std::set<std::string>{"box.held", "box.seen", "box.y"});
  CHECK(binding.reset_conflict(fluent, true) ==
        "`In(box,r2)` holds, but a reset cannot make `box.seen` true");
  CHECK_FALSE(binding.reset_conflict(fluent, false).has_value());
  State start = {{"box.seen", true}};
  binding.add_reset_values(fluent, map, start);
  CHECK(start == State{{"box.held", false}, {"box.seen", true}});  // what is given stays
  CHECK(binding.inside() != nullptr);
  CHECK_FALSE(binding.is_ignored());
  const FluentBinding fixed{"RobotIn", 1, InsideBinding{"robot", 0, {}, {}}, {}};
  CHECK(fixed.constant_variables(map) == Names{"robot.x", "robot.y"});
}

TEST_CASE("binding: a body in a region that has to stand upright there") {
  const auto map = regions();
  InsideBinding inside{"{0}", 1, {}, {}};
  inside.upright = 0.35;
  inside.upright_except = {"r1"};
  const FluentBinding binding{"In", 2, inside, {}};
  const auto fluent = ground_fluent("In(box,r2)");
  CHECK(binding.variables(fluent, map) == Names{"box.x", "box.y", "box.roll", "box.pitch"});
  State state = {{"box.x", 1.5}, {"box.y", 0.0}, {"box.roll", 0.0}, {"box.pitch", 0.0}};
  const auto leaning = [&](double roll, double pitch) {
    state["box.roll"] = roll;
    state["box.pitch"] = pitch;
    return binding.read(fluent, state, map, nullptr);
  };
  CHECK(leaning(0.0, 0.0) == Reading::kHolds);
  CHECK(leaning(0.34, 0.0) == Reading::kHolds);
  CHECK(leaning(0.36, 0.0) == Reading::kFails);
  CHECK(leaning(0.0, -0.36) == Reading::kFails);
  CHECK(leaning(0.3, 0.3) == Reading::kFails);  // 0.42 rad together
  CHECK(leaning(1.57, 0.0) == Reading::kFails);
  CHECK(leaning(3.14, 0.0) == Reading::kFails);  // on its head
  state["box.x"] = 0.5;                          // where it may lie
  CHECK(binding.read(ground_fluent("In(box,r1)"), state, map, nullptr) == Reading::kHolds);
  std::set<std::string> missing;
  CHECK(binding.read(fluent, {{"box.x", 1.5}, {"box.y", 0.0}}, map, &missing) == Reading::kFails);
  CHECK(missing == std::set<std::string>{"box.pitch", "box.roll"});
  State start;
  binding.add_reset_values(fluent, map, start);
  CHECK(start == State{{"box.pitch", 0.0}, {"box.roll", 0.0}});
}

TEST_CASE("binding: a flag") {
  const auto map = regions();
  const FluentBinding binding{"Held", 1, FlagBinding{"{0}.held"}, {}};
  const auto fluent = ground_fluent("Held(box)");
  CHECK(binding.variables(fluent, map) == Names{"box.held"});
  CHECK(binding.read(fluent, {{"box.held", true}}, map, nullptr) == Reading::kHolds);
  CHECK(binding.read(fluent, {{"box.held", std::int64_t{0}}}, map, nullptr) == Reading::kFails);
  CHECK(binding.reset_conflict(fluent, true) ==
        "`Held(box)` holds, but a reset cannot make `box.held` true");
  CHECK_FALSE(binding.reset_conflict(fluent, false).has_value());
  const FluentBinding lit{"Lit", 0, FlagBinding{"lamp.lit", true}, {}};
  CHECK_FALSE(lit.reset_conflict(ground_fluent("Lit()"), true).has_value());
  CHECK(lit.reset_conflict(ground_fluent("Lit()"), false) ==
        "`Lit()` does not hold, but a reset makes `lamp.lit` true");
  State start;
  lit.add_reset_values(ground_fluent("Lit()"), map, start);
  CHECK(start == State{{"lamp.lit", true}});
  CHECK(lit.constant_variables(map) == Names{"lamp.lit"});
  CHECK(lit.inside() == nullptr);
}

TEST_CASE("binding: a range with a gap") {
  const auto map = regions();
  const FluentBinding binding{"Open", 1, RangeBinding{"{0}.q", {0.3, 0.5}, {0, 0.1}, 0.2}, {}};
  const auto fluent = ground_fluent("Open(drawer)");
  const auto at = [&](double q) { return binding.read(fluent, {{"drawer.q", q}}, map, nullptr); };
  CHECK(at(0.3) == Reading::kHolds);
  CHECK(at(0.5) == Reading::kHolds);
  CHECK(at(0.1) == Reading::kFails);
  CHECK(at(0.2) == Reading::kNeither);
  CHECK(at(0.6) == Reading::kNeither);
  CHECK(binding.reset_conflict(fluent, true) ==
        "`Open(drawer)` holds, but a reset makes `drawer.q` 0.2");
  CHECK(binding.reset_conflict(fluent, false) ==
        "`Open(drawer)` does not hold, but a reset makes `drawer.q` 0.2");
  State start;
  binding.add_reset_values(fluent, map, start);
  CHECK(start == State{{"drawer.q", 0.2}});
}

TEST_CASE("binding: a text, and nothing at all") {
  const auto map = regions();
  const FluentBinding text{"On", 1, EqualsBinding{"lamp", "{0}"}, {}};
  const auto fluent = ground_fluent("On(red)");
  CHECK(text.read(fluent, {{"lamp", std::string("red")}}, map, nullptr) == Reading::kHolds);
  CHECK(text.read(fluent, {{"lamp", std::string("off")}}, map, nullptr) == Reading::kFails);
  std::set<std::string> missing;
  CHECK(text.read(fluent, {{"lamp", 1.0}}, map, &missing) == Reading::kFails);
  CHECK(missing == std::set<std::string>{"lamp"});
  CHECK(text.reset_conflict(fluent, true).has_value());
  State start;
  text.add_reset_values(fluent, map, start);
  CHECK(start == State{{"lamp", std::string()}});
  const FluentBinding nothing{"Tired", 0, IgnoredBinding{}, {}};
  CHECK(nothing.is_ignored());
  CHECK_FALSE(nothing.read(ground_fluent("Tired()"), {}, map, nullptr).has_value());
  CHECK(nothing.variables(ground_fluent("Tired()"), map).empty());
  CHECK_FALSE(nothing.reset_conflict(ground_fluent("Tired()"), true).has_value());
}

}  // namespace
}  // namespace parallax::harness
