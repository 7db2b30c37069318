#include "harness/region/start_share.h"

#include <doctest/doctest.h>

namespace parallax::harness {
namespace {

/// A counter cell of 0.24 by 0.15 m and 4 cm of height, and one that is drawn from as a whole.
RegionMap cells() {
  base::DiagnosticSink sink;
  std::vector<Region> regions(2);
  regions[0].name = "pw1", regions[1].name = "pw2";
  for (std::size_t i = 0; i < 2; ++i) {
    const double y = 0.15 * static_cast<double>(i);
    regions[i].on(RegionAxis::kX) = Interval{1.34, 1.58};
    regions[i].on(RegionAxis::kY) = Interval{y, y + 0.15};
    regions[i].on(RegionAxis::kBottom) = Interval{0.83, 0.87};
  }
  regions[0].start[static_cast<std::size_t>(RegionAxis::kX)] = Interval{1.41, 1.51};
  regions[0].start[static_cast<std::size_t>(RegionAxis::kY)] = Interval{0.06, 0.09};
  regions[0].start[static_cast<std::size_t>(RegionAxis::kBottom)] = Interval{0.85, 0.85};
  auto set = RegionSet::make(std::move(regions), true, sink);
  REQUIRE(set.has_value());
  return RegionMap(*std::move(set));
}

TEST_CASE("the share of a cell is that of the stretches that are drawn; fixed axes are named") {
  const StateMapping mapping(cells(), {{"At", 2, InsideBinding{"{0}", 1, {}, {}}, {}}});
  const std::vector<GroundFluent> fluents = {
      ground_fluent("At(milk,pw1)"), ground_fluent("At(milk,pw2)"), ground_fluent("At(cup,pw1)"),
      ground_fluent("At(cup,pw2)")};
  const std::set<std::string> start = {"At(milk,pw1)", "At(cup,pw2)"};
  base::DiagnosticSink sink;
  const auto cuboid = mapping.start_cuboid(fluents, start, {}, {}, sink);
  REQUIRE(cuboid.has_value());
  const auto shares = start_shares(mapping, start, *cuboid);
  REQUIRE(shares.size() == 2);
  CHECK(shares[0].body == "cup");
  CHECK(shares[0].region == "pw2");
  CHECK(shares[0].share == doctest::Approx(1.0));
  CHECK(shares[0].fixed.empty());
  CHECK(shares[1].body == "milk");
  CHECK(shares[1].share == doctest::Approx(0.10 * 0.03 / (0.24 * 0.15)));
  REQUIRE(shares[1].axes.size() == 2);
  CHECK(shares[1].axes[0].drawn == doctest::Approx(0.10));
  CHECK(shares[1].axes[0].whole == doctest::Approx(0.24));
  CHECK(shares[1].fixed == std::vector<std::string>{"bottom"});
}

TEST_CASE("what `sampling` narrows counts, too") {
  const StateMapping mapping(cells(), {{"At", 2, InsideBinding{"{0}", 1, {}, {}}, {}}});
  base::DiagnosticSink sink;
  const std::vector<SampledDimension> extra = {{"cup.x", {1.40, 1.46}}};
  const auto cuboid =
      mapping.start_cuboid({ground_fluent("At(cup,pw2)")}, {"At(cup,pw2)"}, extra, {}, sink);
  REQUIRE(cuboid.has_value());
  const auto shares = start_shares(mapping, {"At(cup,pw2)"}, *cuboid);
  REQUIRE(shares.size() == 1);
  CHECK(shares[0].share == doctest::Approx(0.06 / 0.24));
}

TEST_CASE("ends that are not drawn are no part of the share") {
  const StateMapping mapping(cells(), {{"At", 2, InsideBinding{"{0}", 1, {}, {}}, {}}});
  base::DiagnosticSink sink;
  const auto cuboid =
      mapping.start_cuboid({ground_fluent("At(cup,pw2)")}, {"At(cup,pw2)"}, {}, {}, sink);
  REQUIRE(cuboid.has_value());
  const auto shares = start_shares(mapping, {"At(cup,pw2)"}, *cuboid, 0.01);
  REQUIRE(shares.size() == 1);
  CHECK(shares[0].share == doctest::Approx(0.22 / 0.24 * 0.13 / 0.15 * 0.02 / 0.04));
}

}  // namespace
}  // namespace parallax::harness
