#include "harness/monitor/observation_reader.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "tests/harness/config/scenario_world.h"

namespace parallax::test {
namespace {

using harness::GroundFluent;
using harness::ObservationReader;
using harness::Reading;
using harness::SeenState;
using harness::State;
using harness::StateMapping;
using harness::Value;

/// Every fluent of the kitchen, as its models ground them.
std::vector<GroundFluent> kitchen_fluents() {
  const std::vector<std::string> items = {"milk1", "cereal1", "bowl1", "spoon1"};
  const std::vector<std::string> places = {"pw1", "pw2",  "pw3",  "pt1",  "pt2",   "pt3",
                                           "pt4", "dTop", "dMid", "dLow", "pFloor"};
  const std::vector<std::string> arms = {"left", "right"};
  std::vector<std::string> texts = {"RobotAt(bWork)",    "RobotAt(bTable)",    "RobotAt(bHome)",
                                    "TorsoAt(torsoLow)", "TorsoAt(torsoHigh)", "HandFree(left)"};
  for (const auto& place : places) {
    texts.push_back("LookingAt(" + place + ")");
    for (const auto& item : items) {
      texts.push_back("ItemAt(" + item + "," + place + ")");
      texts.push_back("BelievedAt(" + item + "," + place + ")");
    }
  }
  for (const auto& arm : arms) {
    texts.push_back("Parked(" + arm + ")");
    texts.push_back("GripperOpen(" + arm + ")");
    for (const auto& item : items) texts.push_back("Holding(" + arm + "," + item + ")");
  }
  for (const auto* drawer : {"dTop", "dMid", "dLow"}) {
    texts.push_back(std::string("DrawerOpen(") + drawer + ")");
  }
  for (const auto& item : items) texts.push_back("Perceived(" + item + ")");
  std::vector<GroundFluent> out;
  for (const auto& text : texts) out.push_back(harness::ground_fluent(text));
  return out;
}

StateMapping kitchen_mapping() { return *harness::scenario_of("kitchen/plan2.yaml").mapping; }

/// A value of the kind, near where regions begin and end as often as not.
Value random_value(ObservationReader::Kind kind, const std::string& name,
                   const StateMapping& mapping, std::mt19937_64& random) {
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  switch (kind) {
    case ObservationReader::Kind::kFlag:
      if (below(2) == 0) return below(2) == 0;
      return static_cast<std::int64_t>(below(2));
    case ObservationReader::Kind::kText: {
      static const char* const kTexts[] = {"pw1", "dTop", "pt4", "nothing", ""};
      return std::string(kTexts[below(5)]);
    }
    case ObservationReader::Kind::kNumber:
      break;
  }
  const auto& regions = mapping.regions().regions();
  const auto& region = regions[below(regions.size())];
  const auto dot = name.rfind('.');
  const auto axis = harness::kRegionAxisWords.find(name.substr(dot + 1));
  const auto& bound = axis ? region.on(*axis) : std::nullopt;
  double value = static_cast<double>(below(1000)) / 250.0 - 2.0;
  if (bound && below(4) != 0) {
    const double at[] = {bound->lower, bound->upper, bound->midpoint()};
    value = at[below(3)];
    if (below(2) == 0) value += below(2) == 0 ? 1e-9 : -1e-9;
  }
  if (name.ends_with(".roll") || name.ends_with(".pitch")) value *= below(2) == 0 ? 0.1 : 1.0;
  if (name.ends_with(".q")) value = static_cast<double>(below(50)) / 100.0;
  if (below(20) == 0) return static_cast<std::int64_t>(std::llround(value));
  return value;
}

TEST_CASE("where all is reported it reads what the mapping reads, and where less is, no more") {
  const auto mapping = kitchen_mapping();
  const auto fluents = kitchen_fluents();
  const ObservationReader reader(mapping, fluents);
  std::mt19937_64 random(5);
  std::size_t holding = 0, unknown = 0, outside = 0, neither = 0;
  for (int round = 0; round < 3000; ++round) {
    harness::ReportedValues values(reader.variables().size());
    State state;
    for (std::size_t v = 0; v < values.size(); ++v) {
      const auto& name = reader.variables()[v];
      values[v] = random_value(reader.kind(v), name, mapping, random);
      CHECK(reader.fits(v, *values[v]));
      state.emplace(name, *values[v]);
    }
    SeenState seen, partly;
    reader.read(values, true, seen);
    std::set<std::string> missing;
    for (std::size_t f = 0; f < fluents.size(); ++f) {
      CAPTURE(fluents[f].text);
      const auto wanted = mapping.read(fluents[f], state, &missing);
      const bool is_neither =
          std::find(seen.neither.begin(), seen.neither.end(), f) != seen.neither.end();
      CHECK(is_neither == (wanted == Reading::kNeither));
      const int reading = !wanted || is_neither ? 0 : (*wanted == Reading::kHolds ? 1 : -1);
      CHECK(static_cast<int>(seen.fluents[f]) == reading);
      if (reading > 0) ++holding;
      if (is_neither) ++neither;
    }
    CHECK(missing.empty());
    CHECK(seen.outside == mapping.outside(fluents, state));
    outside += seen.outside.size();
    // A fluent whose value is not reported is unknown, and nothing else changes.
    for (auto& value : values) {
      if (random() % 3 == 0) value.reset();
    }
    reader.read(values, true, partly);
    for (std::size_t f = 0; f < fluents.size(); ++f) {
      if (partly.fluents[f] == 0) {
        ++unknown;
      } else {
        CHECK(partly.fluents[f] == seen.fluents[f]);
      }
    }
    for (const auto& text : partly.outside) {
      CHECK(std::find(seen.outside.begin(), seen.outside.end(), text) != seen.outside.end());
    }
  }
  CHECK(holding > 1000);
  CHECK(unknown > 1000);
  CHECK(outside > 1000);
  CHECK(neither > 1000);
  // With nothing reported nothing is known.
  SeenState seen;
  reader.read(harness::ReportedValues(reader.variables().size()), true, seen);
  CHECK(std::count(seen.fluents.begin(), seen.fluents.end(), 0) ==
        static_cast<std::ptrdiff_t>(fluents.size()));
  CHECK_FALSE(seen.in_no_state());
}

}  // namespace
}  // namespace parallax::test
