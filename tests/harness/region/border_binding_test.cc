// Fluents for the side of a border on which a value was at the start.

#include <doctest/doctest.h>

#include "compiler/base/codes/scenarios.h"
#include "harness/region/state_mapping.h"

namespace parallax::harness {
namespace {

StateMapping mapping() {
  Region cell;
  cell.name = "c";
  cell.on(RegionAxis::kX) = Interval{1, 2};
  base::DiagnosticSink sink;
  auto regions = RegionSet::make({cell}, false, sink);
  const BorderBinding far{"{0}.x", 1.75, true, {"a"}};
  const BorderBinding light{"b.mass", 0.5, false, {}};
  return StateMapping(*regions, {{"In", 2, InsideBinding{"{0}", 1, {}, {}}, {}},
                                 {"Far", 1, far, {}},
                                 {"Light", 0, light, {}}});
}

std::vector<GroundFluent> all() {
  std::vector<GroundFluent> out;
  for (const auto* text : {"In(a,c)", "In(b,c)", "Far(a)", "Far(b)", "Light()"}) {
    out.push_back(ground_fluent(text));
  }
  return out;
}

const std::vector<SampledDimension> kMass = {{"b.mass", {0.2, 0.9}}};

Interval drawn(const std::set<std::string>& holds, const std::string& variable) {
  base::DiagnosticSink sink;
  const auto start = mapping().start_cuboid(all(), holds, kMass, {}, sink);
  REQUIRE(start.has_value());
  for (const auto& dimension : start->dimensions) {
    if (dimension.variable == variable) return dimension.interval;
  }
  FAIL("nothing draws " << variable);
  return {};
}

TEST_CASE("a value on the border is not above it") {
  const auto map = mapping();
  const State start = {{"a.x", 1.75}, {"b.x", 1.9}, {"b.mass", 0.5}};
  CHECK_FALSE(*map.holds(ground_fluent("Far(a)"), start));
  CHECK(*map.holds(ground_fluent("Light()"), start));
  CHECK(*map.holds(ground_fluent("Far(a)"), {{"a.x", 1.7501}}));
  CHECK_FALSE(*map.holds(ground_fluent("Light()"), {{"b.mass", 0.51}}));
  // The fluent never holds of a body that the binding is not about, whatever is observed.
  CHECK_FALSE(*map.holds(ground_fluent("Far(b)"), start));
}

TEST_CASE("each half of a start is drawn from its side, and both are the whole") {
  const std::set<std::string> placed = {"In(a,c)", "In(b,c)"};
  const auto near = drawn(placed, "a.x");
  CHECK(near.lower == 1.0);
  CHECK(near.upper == 1.75);
  auto with = placed;
  with.insert("Far(a)");
  const auto far = drawn(with, "a.x");
  CHECK(far.lower == 1.75);
  CHECK(far.upper == 2.0);
  CHECK(drawn(with, "b.x").upper == 2.0);  // that is not split
  CHECK(drawn(placed, "b.mass").lower == 0.5);
  with.insert("Light()");
  CHECK(drawn(with, "b.mass").upper == 0.5);
}

TEST_CASE("a half that no start has is refused") {
  const auto refused = [](const std::set<std::string>& holds,
                          const std::vector<SampledDimension>& extra) {
    base::DiagnosticSink sink;
    const bool made = mapping().start_cuboid(all(), holds, extra, {}, sink).has_value();
    CHECK(made == sink.sorted().empty());
    for (const auto& diagnostic : sink.sorted()) {
      CHECK(diagnostic.code == codes::kStartNotSampleable);
    }
    return !made;
  };
  const std::set<std::string> placed = {"In(a,c)", "In(b,c)"};
  CHECK_FALSE(refused(placed, kMass));
  CHECK(refused({"In(a,c)", "In(b,c)", "Far(b)"}, kMass));  // only for a
  CHECK(refused(placed, {}));                               // nothing draws the mass
  CHECK(refused(placed, {{"b.mass", {0.2, 0.4}}}));         // all of it is light
  CHECK(refused({"In(a,c)", "In(b,c)", "Far(a)"}, {{"a.x", {1.0, 1.5}}, kMass.front()}));
}

}  // namespace
}  // namespace parallax::harness
