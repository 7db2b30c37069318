#include "harness/campaign/sample_margin.h"

#include <doctest/doctest.h>

#include "harness/region/fluent_margin.h"

namespace parallax::harness {
namespace {

StateMapping one_region(std::optional<double> upright = {}) {
  base::DiagnosticSink sink;
  Region region;
  region.name = "r1";
  region.on(RegionAxis::kX) = Interval{0, 2};
  region.on(RegionAxis::kY) = Interval{0, 1};
  auto regions = RegionSet::make({region}, true, sink);
  REQUIRE(regions.has_value());
  InsideBinding inside{"{0}", 1, "{0}.held", {}};
  inside.upright = upright;
  return StateMapping(*regions, {{"In", 2, inside, {}},
                                 {"Open", 0, RangeBinding{"drawer.q", {0.3, 0.5}, {0.0, 0.1}}, {}},
                                 {"Holding", 1, FlagBinding{"{0}.held"}, {}}});
}

std::optional<double> margin(const StateMapping& mapping, const char* fluent, bool predicted,
                             const State& state) {
  return fluent_margin(mapping, ground_fluent(fluent), predicted, state);
}

State box_at(double x, double y) { return {{"box.x", x}, {"box.y", y}, {"box.held", false}}; }

TEST_CASE("margins: distance from the nearest face, in widths, negative outside") {
  const auto mapping = one_region();
  CHECK(*margin(mapping, "In(box,r1)", true, box_at(0.5, 0.5)) == doctest::Approx(0.25));
  CHECK(*margin(mapping, "In(box,r1)", true, box_at(1.0, 0.9)) == doctest::Approx(0.1));
  CHECK(*margin(mapping, "In(box,r1)", true, box_at(2.2, 0.5)) == doctest::Approx(-0.1));
  CHECK_FALSE(margin(mapping, "In(box,r1)", false, box_at(0.5, 0.5)));
  CHECK_FALSE(margin(mapping, "Holding(box)", true, box_at(0.5, 0.5)));
  CHECK_FALSE(margin(mapping, "Unknown", true, box_at(0.5, 0.5)));
  CHECK_FALSE(margin(mapping, "In(box,r1)", true, {{"box.x", 0.5}}));
  auto held = box_at(0.5, 0.5);
  held["box.held"] = true;
  CHECK_FALSE(margin(mapping, "In(box,r1)", true, held));
}

TEST_CASE("margins: a joint within the interval that is predicted") {
  const auto mapping = one_region();
  CHECK(*margin(mapping, "Open", true, {{"drawer.q", 0.35}}) == doctest::Approx(0.25));
  CHECK(*margin(mapping, "Open", false, {{"drawer.q", 0.35}}) == doctest::Approx(-2.5));
}

TEST_CASE("margins: what leans is near to lying") {
  const auto mapping = one_region(0.5);
  auto state = box_at(1.0, 0.5);
  state["box.roll"] = 0.4;
  state["box.pitch"] = 0.0;
  CHECK(*margin(mapping, "In(box,r1)", true, state) == doctest::Approx(0.2));
  state["box.roll"] = 1.0;
  CHECK(*margin(mapping, "In(box,r1)", true, state) == doctest::Approx(-1.0));
}

TEST_CASE("margins: each part in its own unit, the least counts") {
  MarginScale scale;
  scale.add({{"a", 100.0}, {"b", 0.001}}, false);
  scale.add({{"a", 50.0}, {"b", 0.002}}, false);
  CHECK(*scale.margin(0) == doctest::Approx(0.5));
  CHECK(scale.part_of(0) == "b");
  CHECK(*scale.margin(1) == doctest::Approx(0.5));
  CHECK(scale.part_of(1) == "a");
}

TEST_CASE("margins: a discrepancy is below zero, anything else above, whatever its parts") {
  MarginScale scale;
  scale.add({{"a", 1.0}}, false);
  scale.add({{"a", 0.5}}, true);
  scale.add({{"a", 0.0}}, false);
  CHECK(*scale.margin(1) < 0.0);
  CHECK(*scale.margin(2) > 0.0);
  CHECK(*scale.margin(0) == doctest::Approx(1.0));
}

TEST_CASE("margins: parts that are constant or contradict the verdict do not count") {
  MarginScale scale;
  scale.add({{"a", 1.0}, {"same", 0.1}, {"wrong", -3.0}}, false);
  CHECK_FALSE(scale.margin(0));
  scale.add({{"a", 0.7}, {"same", 0.1}, {"wrong", 2.0}}, false);
  CHECK(scale.contradicting() == std::set<std::string>{"wrong"});
  CHECK(*scale.margin(0) == doctest::Approx(1.0));
  CHECK(*scale.margin(1) == doctest::Approx(0.7));
  // A discrepancy without any part is one all the same.
  scale.add({}, true);
  CHECK(*scale.margin(2) < 0.0);
}

}  // namespace
}  // namespace parallax::harness
