// Initial states are equally likely, also where the starts of one of them are hardly ever valid.

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <memory>

#include "harness/campaign/campaign.h"
#include "harness/campaign/rare_rates.h"
#include "harness/campaign/rates.h"
#include "harness/report/report.h"
#include "tests/harness/campaign/many_states.h"
#include "tests/harness/campaign/two_regions.h"

namespace parallax::harness {
namespace {

/// Refuses nine of ten places in the first cell; where it takes one there, the push always fails.
class RefusingCells final : public Simulator {
 public:
  explicit RefusingCells(double refused) : refused_(refused), cells_({{1.0, 0.0}, {0.0, 0.0}}) {}
  SimulatorInfo info() override { return cells_.info(); }
  Outcome reset(const State& initial, std::uint64_t seed) override {
    const double box_m = std::get<double>(initial.at("box.x"));
    if (box_m < 1.0 && box_m < refused_)
      return {SimStatus::kInvalidStart, "inside of a wall", 0.0, {}};
    return cells_.reset(initial, seed);
  }
  Outcome act(std::string_view action, const State& arguments, double limit_s) override {
    return cells_.act(action, arguments, limit_s);
  }
  State observe() override { return cells_.observe(); }

 private:
  double refused_;
  test::CellSimulator cells_;
};

TEST_CASE("rare rates: starts that are not valid in some initial states give no rate over all") {
  const test::TempFolder folder;
  folder.write("domain.e", "sort region\n");
  for (const double refused : {0.0, 0.9}) {
    base::DiagnosticSink sink;
    base::SourceFiles files;
    const auto scenario =
        load_scenario(folder.write("scenario.yaml", test::cell_scenario(2)), files, sink);
    REQUIRE(scenario.has_value());
    const auto factory = [refused] { return std::make_unique<RefusingCells>(refused); };
    RatesOptions options;
    options.runs = 2000;
    for (const auto method : {RareEventMethod::kImportance, RareEventMethod::kSplitting}) {
      if (method == RareEventMethod::kSplitting) options.runs = 4000;
      test::CellFeed feed(2, test::CellFeed::boxes(2));
      const auto result = estimate_rare_rates(*scenario, feed, factory, options, method, sink);
      REQUIRE(result.has_value());
      const auto& estimate = result->traces.at(0).estimate;
      CAPTURE(refused);
      if (refused > 0.0) {
        CHECK_FALSE(result->is_answered());
        CHECK(estimate.end != RareEventEnd::kEstimated);
        CHECK(rates_json(*result).find("\"any\"") == std::string::npos);
      } else if (method == RareEventMethod::kImportance) {
        CHECK(estimate.lower <= 0.5);
        CHECK(estimate.upper >= 0.5);
      }
      // The method chose the starts: how many of them failed is no rate.
      CHECK(rates_text(*result).find(" runs from ") == std::string::npos);
    }
    // Counting draws each state equally often, whatever it refuses.
    test::CellFeed feed(2, test::CellFeed::boxes(2));
    options.runs = 400;
    const auto counted = estimate_rates(*scenario, feed, factory, options, sink);
    REQUIRE(counted.has_value());
    CHECK(std::abs(counted->traces.at(0).any.rate - 0.5) < 0.1);
  }
}

/// Shows the robot in the middle of its cell, wherever it was to begin.
class StubbornCells final : public Simulator {
 public:
  StubbornCells() : cells_({{0.0, 0.0}, {0.0, 0.0}}) {}
  SimulatorInfo info() override { return cells_.info(); }
  Outcome reset(const State& initial, std::uint64_t seed) override {
    return cells_.reset(initial, seed);
  }
  Outcome act(std::string_view action, const State& arguments, double limit_s) override {
    return cells_.act(action, arguments, limit_s);
  }
  State observe() override {
    auto seen = cells_.observe();
    seen["robot.x"] = 0.5;
    return seen;
  }

 private:
  test::CellSimulator cells_;
};

TEST_CASE("a run whose simulator does not take its starts claims nothing of them") {
  const test::TempFolder folder;
  folder.write("domain.e", "sort region\n");
  base::DiagnosticSink sink;
  base::SourceFiles files;
  const auto scenario =
      load_scenario(folder.write("scenario.yaml", test::cell_scenario(2)), files, sink);
  REQUIRE(scenario.has_value());
  for (const bool stubborn : {false, true}) {
    CampaignOptions options;
    options.run_dir = folder.write(stubborn ? "stubborn" : "obedient", "");
    std::filesystem::remove(options.run_dir);
    test::CellFeed feed(2, test::CellFeed::boxes(2));
    const auto factory = [stubborn]() -> std::unique_ptr<Simulator> {
      if (stubborn) return std::make_unique<StubbornCells>();
      return std::make_unique<test::CellSimulator>(test::CellRates{{0.0, 0.0}, {0.0, 0.0}});
    };
    const auto result = run_campaign(*scenario, feed, factory, options, files, sink);
    REQUIRE(result.has_value());
    CHECK(result->verdict ==
          (stubborn ? CampaignVerdict::kInconclusive : CampaignVerdict::kNoDiscrepancy));
    const auto summary = campaign_summary(*result, {});
    CHECK((summary.find("does not begin where it is told to") != std::string::npos) == stubborn);
    CHECK((summary.find("`robot.x` was drawn from") != std::string::npos) == stubborn);
  }
}

}  // namespace
}  // namespace parallax::harness
