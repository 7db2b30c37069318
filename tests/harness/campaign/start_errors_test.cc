// Initial states that a campaign cannot begin in: what they end does not depend on the number of
// jobs.
#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "compiler/base/codes/campaigns.h"
#include "harness/campaign/campaign.h"
#include "tests/harness/campaign/many_states.h"
#include "tests/harness/campaign/two_regions.h"

namespace parallax::harness {
namespace {

using test::CellFeed;
using test::CellRates;

/// The trace from one of its initial states is an error.
class FaultyFeed final : public CellFeed {
 public:
  FaultyFeed(std::size_t cells, std::size_t faulty, base::DiagnosticSink& sink)
      : CellFeed(cells, boxes(cells)), faulty_(faulty), sink_(sink) {}
  base::Result<std::pair<base::Known, std::optional<CampaignTrace>>> from(
      const CampaignTrace& trace, std::span<const compiler::FluentId> fluents,
      const std::vector<compiler::FluentId>& wanted) override {
    if (std::find(wanted.begin(), wanted.end(), box(faulty_)) != wanted.end()) {
      return sink_.error_about(codes::kNoJournal, "faulty");
    }
    return CellFeed::from(trace, fluents, wanted);
  }

 private:
  std::size_t faulty_;
  base::DiagnosticSink& sink_;
};

struct Ended {
  bool has_result = false, failed = false;
  CampaignVerdict verdict = CampaignVerdict::kInconclusive;
  std::int64_t simulations = 0;
  std::vector<std::string> caveats;
  std::vector<std::string> errors;
  friend bool operator==(const Ended&, const Ended&) = default;
};

Ended end_of(std::size_t cells, const CellRates& rates, std::uint64_t seed, std::int64_t jobs,
             const std::function<std::unique_ptr<CellFeed>(base::DiagnosticSink&)>& make_feed) {
  test::TempFolder folder;
  base::SourceFiles files;
  base::DiagnosticSink sink;
  folder.write("domain.e", "sort region\n");
  auto scenario =
      load_scenario(folder.write("scenario.yaml", test::cell_scenario(cells)), files, sink);
  REQUIRE(scenario.has_value());
  CampaignOptions options;
  options.seed = seed;
  options.jobs = jobs;
  options.run_dir = folder.path() / "run";
  const auto feed = make_feed(sink);
  const auto result = run_campaign(
      *scenario, *feed, [&] { return std::make_unique<test::CellSimulator>(rates); }, options,
      files, sink);
  Ended out;
  out.has_result = result.has_value();
  for (const auto& diagnostic : sink.sorted()) out.errors.push_back(diagnostic.message);
  if (!result || result->traces.empty()) return out;
  out.failed = result->failed;
  out.verdict = result->verdict;
  out.simulations = result->traces.front().simulations;
  out.caveats = result->traces.front().caveats;
  return out;
}

TEST_CASE("an error in a start that ran ahead comes when it is its turn, if that comes") {
  constexpr std::size_t kCells = 8;
  int found = 0, failed = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    const auto with_jobs = [&](std::int64_t jobs) {
      CellRates rates{std::vector<double>(kCells, 0.0), std::vector<double>(kCells, 0.0)};
      rates.fails[2] = rates.fails[5] = 1.0;
      return end_of(kCells, rates, seed, jobs, [&](base::DiagnosticSink& sink) {
        return std::make_unique<FaultyFeed>(kCells, 7, sink);
      });
    };
    const auto alone = with_jobs(1);
    CHECK(with_jobs(4) == alone);
    const bool is_found = alone.verdict == CampaignVerdict::kDiscrepancy;
    CHECK(alone.errors.size() == (is_found ? 0U : 1U));
    ++(is_found ? found : failed);
  }
  CHECK(found > 0);
  CHECK(failed > 0);
}

TEST_CASE("a trace whose initial states can hardly be drawn is inconclusive, and says so") {
  constexpr std::size_t kCells = 64;  // 2 of 4096 candidates are initial states
  int ended = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    CAPTURE(seed);
    const auto with_jobs = [&](std::int64_t jobs) {
      const CellRates rates{std::vector<double>(kCells, 0.0), std::vector<double>(kCells, 0.0)};
      return end_of(kCells, rates, seed, jobs, [&](base::DiagnosticSink&) {
        const std::vector<CellFeed::Cells> states = {{1, 1}, {2, 2}};
        auto feed = std::make_unique<CellFeed>(kCells, states);
        feed->draw_from_all(kCells);
        return feed;
      });
    };
    const auto alone = with_jobs(1);
    CHECK(with_jobs(4) == alone);
    CHECK(alone.verdict == CampaignVerdict::kInconclusive);
    const auto says = [&](const std::string& text) {
      return std::any_of(alone.caveats.begin(), alone.caveats.end(), [&](const auto& caveat) {
        return caveat.find(text) != std::string::npos;
      });
    };
    const bool is_ended = says("drawing initial states ended");
    CHECK(is_ended != says("none could be drawn"));
    if (!is_ended) continue;
    ++ended;
    CHECK(alone.simulations < 90);
  }
  CHECK(ended > 0);
}

}  // namespace
}  // namespace parallax::harness
