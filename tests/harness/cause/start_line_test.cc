// Failing starts moved to the middle of their cell, and borders, against known rules.

#include "harness/cause/start_line.h"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <set>

#include "tests/support/random.h"

namespace parallax::test {
namespace {

using harness::BorderBracket;
using harness::CellParameter;
using harness::ParameterRole;
using harness::StartPoint;
using harness::StartVerdict;

using Rule = std::function<StartVerdict(const StartPoint&)>;

/// Answers by a rule, and counts.
struct Oracle {
  Rule rule;
  std::size_t budget = 100'000;
  std::vector<StartPoint> asked = {};

  harness::StartProbe probe() {
    return [this](const std::vector<StartPoint>& starts) {
      std::vector<StartVerdict> out;
      for (const auto& start : starts) {
        if (asked.size() == budget) break;
        asked.push_back(start);
        out.push_back(rule(start));
      }
      return out;
    };
  }
};

StartVerdict fails_if(bool fails) { return fails ? StartVerdict::kFails : StartVerdict::kClean; }

double uniform(Random& random) {
  return static_cast<double>(random.below(1U << 30U)) / (1U << 30U);
}

TEST_CASE(
    "a start shrinks to what a rule of thresholds asks for, and brackets hold the thresholds") {
  Random random(1);
  int with_borders = 0;
  for (int round = 0; round < 500; ++round) {
    const auto count = 1 + random.below(6);
    std::vector<CellParameter> cell;
    std::vector<double> threshold, tolerances;
    std::vector<int> side;  // 0: no condition, 1: above, -1: below
    StartPoint failing;
    for (std::size_t p = 0; p < count; ++p) {
      const double lower = 10.0 * uniform(random) - 5.0, width = 0.01 + 3.0 * uniform(random);
      cell.push_back({"p" + std::to_string(p), lower, lower + width});
      threshold.push_back(lower + width * (0.1 + 0.8 * uniform(random)));
      side.push_back(static_cast<int>(random.below(3)) - 1);
      tolerances.push_back(width * std::pow(10.0, -1.0 - random.below(8)));
      const double share = 0.001 + 0.998 * uniform(random);
      failing.push_back(side[p] > 0   ? threshold[p] + share * (cell[p].upper - threshold[p])
                        : side[p] < 0 ? lower + share * (threshold[p] - lower)
                                      : lower + share * width);
    }
    Oracle oracle{[&](const StartPoint& start) {
      bool fails = true;
      for (std::size_t p = 0; p < count; ++p) {
        if (side[p] > 0) fails = fails && start[p] > threshold[p];
        if (side[p] < 0) fails = fails && start[p] < threshold[p];
      }
      return fails_if(fails);
    }};
    const auto shrunk = harness::shrink_start(cell, failing, tolerances, oracle.probe());
    REQUIRE(shrunk.finished);
    CHECK(oracle.rule(shrunk.start) == StartVerdict::kFails);
    std::size_t borders = 0;
    for (std::size_t p = 0; p < count; ++p) {
      const double middle = cell[p].middle();
      const bool decides =
          (side[p] > 0 && middle <= threshold[p]) || (side[p] < 0 && middle >= threshold[p]);
      CHECK(shrunk.roles[p] == (decides ? ParameterRole::kDecides : ParameterRole::kIndifferent));
      CHECK(shrunk.start[p] == (decides ? failing[p] : middle));
      if (!decides) continue;
      ++with_borders;
      const auto& border = shrunk.borders.at(borders++);
      CHECK(border.parameter == p);
      CHECK(border.width() <= tolerances[p]);
      CHECK(border.beyond == StartVerdict::kClean);
      if (side[p] > 0) {
        CHECK(border.other <= threshold[p]);
        CHECK(border.fails > threshold[p]);
      } else {
        CHECK(border.fails < threshold[p]);
        CHECK(border.other >= threshold[p]);
      }
    }
    CHECK(shrunk.borders.size() == borders);
  }
  CHECK(with_borders > 300);
}

TEST_CASE("parameters that matter together: none that is left can be moved alone") {
  const std::vector<CellParameter> cell = {{"a", 0.0, 1.0}, {"b", 0.0, 1.0}, {"c", 0.0, 1.0}};
  Oracle oracle{[](const StartPoint& start) { return fails_if(start[0] + start[1] > 1.6); }};
  const auto shrunk =
      harness::shrink_start(cell, {0.9, 0.95, 0.1}, {0.001, 0.001, 0.001}, oracle.probe());
  REQUIRE(shrunk.finished);
  CHECK(shrunk.roles ==
        std::vector{ParameterRole::kDecides, ParameterRole::kDecides, ParameterRole::kIndifferent});
  // Each with the other as in the failing start.
  CHECK(shrunk.borders.at(0).fails > 0.65);
  CHECK(shrunk.borders.at(0).other <= 0.651);
  CHECK(shrunk.borders.at(1).fails > 0.7);
  CHECK(shrunk.borders.at(1).other <= 0.701);
  // One that only a later move sets free is moved after all.
  Oracle late{[](const StartPoint& start) {
    return fails_if(start[2] > 0.8 && (start[1] > 0.9 ? start[0] > 0.9 : true));
  }};
  const auto moved = harness::shrink_start(cell, {0.95, 0.95, 0.9}, {0.1, 0.1, 0.1}, late.probe());
  CHECK(moved.roles == std::vector{ParameterRole::kIndifferent, ParameterRole::kIndifferent,
                                   ParameterRole::kDecides});
}

TEST_CASE("the middle fails, is no start, or another thing goes wrong there") {
  const std::vector<CellParameter> cell = {{"a", 0.0, 1.0}, {"b", 0.0, 1.0}};
  const std::vector<double> tolerances = {0.01, 0.01};
  Oracle always{[](const StartPoint&) { return StartVerdict::kFails; }};
  const auto all = harness::shrink_start(cell, {0.1, 0.2}, tolerances, always.probe());
  CHECK(all.finished);
  CHECK(all.middle == StartVerdict::kFails);
  CHECK(all.start == StartPoint{0.5, 0.5});
  CHECK(all.borders.empty());
  CHECK(always.asked.size() == 1);

  Oracle wall{[](const StartPoint& start) {
    return start[0] > 0.4 ? StartVerdict::kNoStart : StartVerdict::kFails;
  }};
  const auto none = harness::shrink_start(cell, {0.1, 0.2}, tolerances, wall.probe());
  CHECK(none.finished);
  CHECK(none.middle == StartVerdict::kNoStart);
  CHECK(none.roles == std::vector{ParameterRole::kNoStart, ParameterRole::kIndifferent});
  CHECK(none.borders.empty());

  Oracle gap{[](const StartPoint& start) {
    if (start[0] > 0.45) return StartVerdict::kOtherwise;
    return start[0] > 0.2 ? StartVerdict::kNoStart : StartVerdict::kFails;
  }};
  const auto other = harness::shrink_start(cell, {0.1, 0.2}, tolerances, gap.probe());
  CHECK(other.finished);
  REQUIRE(other.borders.size() == 1);
  CHECK(other.borders.front().beyond == StartVerdict::kOtherwise);
  CHECK(other.borders.front().no_start.has_value());
  CHECK(other.borders.front().fails == 0.1);  // nothing between the ends was a start
  CHECK(other.borders.front().other == 0.5);
}

TEST_CASE("a probe that ends leaves what was found, and is not asked again") {
  const std::vector<CellParameter> cell = {{"a", 0.0, 1.0}, {"b", 0.0, 1.0}};
  const auto rule = [](const StartPoint& start) { return fails_if(start[0] > 0.7); };
  Oracle free{rule};
  const auto whole = harness::shrink_start(cell, {0.9, 0.9}, {1e-6, 1e-6}, free.probe());
  for (std::size_t budget = 0; budget <= free.asked.size(); ++budget) {
    Oracle oracle{rule, budget};
    const auto shrunk = harness::shrink_start(cell, {0.9, 0.9}, {1e-6, 1e-6}, oracle.probe());
    CHECK(shrunk.finished == (budget == free.asked.size()));
    CHECK(oracle.asked.size() == budget);
    for (const auto& border : shrunk.borders) {
      CHECK(border.fails > 0.7);
      CHECK(border.other <= 0.7);
    }
    if (shrunk.finished) CHECK(shrunk.borders == whole.borders);
  }
}

TEST_CASE("a line with several borders: each change that was seen is bracketed") {
  Random random(2);
  for (int round = 0; round < 200; ++round) {
    const CellParameter range{"a", -1.0, 1.0};
    std::set<double> changes;
    for (std::size_t i = random.below(4); i > 0; --i) changes.insert(2.0 * uniform(random) - 1.0);
    const auto changed = [&](double value) {
      return std::distance(changes.begin(), changes.lower_bound(value));
    };
    const StartPoint failing = {2.0 * uniform(random) - 1.0, 7.0};
    const auto parity = changed(failing[0]) % 2;
    Oracle oracle{
        [&](const StartPoint& start) { return fails_if(changed(start[0]) % 2 == parity); }};
    const auto scan =
        harness::scan_line(range, 0, failing, 2 + random.below(30), 1e-4, oracle.probe());
    REQUIRE(scan.finished);
    CHECK(scan.points.front().value == -1.0);
    CHECK(scan.points.back().value == 1.0);
    for (const auto& border : scan.borders) {
      CHECK(border.width() <= 1e-4);
      const auto low = std::min(border.fails, border.other);
      const auto high = std::max(border.fails, border.other);
      // An odd number of borders between the ends, as it claims.
      CHECK((changed(high) - changed(low)) % 2 == 1);
    }
    // As many as the values that were looked at tell.
    std::size_t seen = 0;
    for (std::size_t i = 1; i < scan.points.size(); ++i) {
      seen += scan.points[i].verdict != scan.points[i - 1].verdict ? 1 : 0;
    }
    CHECK(scan.borders.size() == seen);
    for (const auto& start : oracle.asked) CHECK(start[1] == 7.0);
  }
}

TEST_CASE("a tolerance below what numbers can tell ends where they end") {
  const CellParameter range{"a", 1.0, 2.0};
  Oracle oracle{[](const StartPoint& start) { return fails_if(start[0] > 1.3); }};
  const auto scan = harness::scan_line(range, 0, {1.5}, 2, 1e-300, oracle.probe());
  CHECK(scan.finished);
  REQUIRE(scan.borders.size() == 1);
  CHECK(std::nextafter(scan.borders.front().other, 2.0) == scan.borders.front().fails);
}

}  // namespace
}  // namespace parallax::test
