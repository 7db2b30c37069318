// Are claims about traces with several initial states true as often as they say? Whole campaigns in
// random worlds whose probabilities are known.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "harness/campaign/campaign.h"
#include "harness/sampling/sampler.h"
#include "tests/harness/campaign/many_states.h"
#include "tests/harness/campaign/two_regions.h"
#include "tests/support/deep.h"

namespace parallax::harness {
namespace {

using test::CellFeed;
using test::CellRates;

constexpr double kLevel = 0.9, kEpsilon = 0.2;
const int kCampaigns = parallax::test::is_deep() ? 2000 : 400;

/// Every line of a journal is written through, which takes time on a disk.
std::filesystem::path quick_folder() {
  const std::filesystem::path memory = "/dev/shm";
  std::error_code none;
  return std::filesystem::is_directory(memory, none) ? memory
                                                     : std::filesystem::temp_directory_path();
}

/// States whose mean probability to go wrong is what is to be excluded, so that every claim that is
/// made is false. `lost_share` of it is lost instead of seen.
CellRates random_rates(std::uint64_t world, double lost_share) {
  const CounterRng rng({.campaign_seed = 77, .sample = world});
  const std::size_t cells = 1 + static_cast<std::size_t>(rng.uniform(0) * 6.0);
  std::vector<double> wrong;
  for (std::size_t i = 0; i < cells; ++i) {
    // Some of the states hardly ever go wrong, others may do so always.
    const double u = rng.uniform(i + 1);
    wrong.push_back(u < 0.4 ? 0.01 : u * u);
  }
  wrong.back() = std::max(wrong.back(), 0.05);
  // Scaled to the mean; what would be above 1 goes to the others.
  for (int i = 0; i < 200; ++i) {
    double sum = 0.0;
    for (const double p : wrong) sum += p;
    const double factor = kEpsilon * static_cast<double>(cells) / sum;
    for (double& p : wrong) p = std::min(1.0, p * factor);
  }
  CellRates out;
  for (const double p : wrong) {
    out.fails.push_back(p * (1.0 - lost_share));
    out.loses.push_back(p * lost_share);
  }
  return out;
}

/// Campaigns in a folder that each of them empties.
class Campaigns {
 public:
  Campaigns(CriterionKind kind, std::size_t cells, const std::filesystem::path& parent)
      : folder_(parent), cells_(cells) {
    folder_.write("domain.e", "sort region\n");
    base::DiagnosticSink sink;
    auto loaded =
        load_scenario(folder_.write("scenario.yaml", test::cell_scenario(cells)), files_, sink);
    REQUIRE(loaded.has_value());
    scenario = std::move(*loaded);
    scenario.criterion.kind = kind;
    scenario.criterion.confidence_level = kLevel;
    scenario.criterion.epsilon = kEpsilon;
  }

  CampaignResult run(const CellRates& rates, std::uint64_t seed, std::int64_t jobs = 1) {
    std::error_code none;
    std::filesystem::remove_all(run_dir(), none);
    CampaignOptions options;
    options.seed = seed;
    options.jobs = jobs;
    options.run_dir = run_dir();
    base::SourceFiles files;
    base::DiagnosticSink sink;
    CellFeed feed(cells_, CellFeed::boxes(cells_));
    auto result = run_campaign(
        scenario, feed, [&] { return std::make_unique<test::CellSimulator>(rates); }, options,
        files, sink);
    REQUIRE(result.has_value());
    REQUIRE(result->traces.size() == 1);
    return *std::move(result);
  }
  std::string journal() const { return test::slurp(run_dir() / "journal.ndjson"); }

  Scenario scenario;

 private:
  std::filesystem::path run_dir() const { return folder_.path() / "run"; }

  test::TempFolder folder_;
  base::SourceFiles files_;
  std::size_t cells_;
};

/// Counts of kCampaigns campaigns.
struct Claims {
  int made = 0;          // that the mean is below epsilon, which is false
  int false_bounds = 0;  // the bound beside the verdict, of those without a discrepancy
  int lost = 0;          // campaigns with lost runs
  int found = 0;
};

Claims count_claims(CriterionKind kind, double lost_share) {
  std::vector<std::unique_ptr<Campaigns>> by_cells;
  const auto parent = quick_folder();
  for (std::size_t cells = 1; cells <= 6; ++cells) {
    by_cells.push_back(std::make_unique<Campaigns>(kind, cells, parent));
  }
  Claims out;
  for (int i = 0; i < kCampaigns; ++i) {
    // Twenty campaigns in each world.
    const auto rates = random_rates(static_cast<std::uint64_t>(i / 20), lost_share);
    CHECK(rates.mean() == doctest::Approx(kEpsilon));
    const auto result =
        by_cells[rates.cells() - 1]->run(rates, static_cast<std::uint64_t>(1000 + i));
    const auto& trace = result.traces.front();
    out.made += trace.verdict == CampaignVerdict::kNoDiscrepancy ? 1 : 0;
    const bool found = trace.verdict == CampaignVerdict::kDiscrepancy;
    out.found += found ? 1 : 0;
    out.false_bounds += !found && trace.stated.epsilon <= rates.mean() - 1e-9 ? 1 : 0;
    out.lost += trace.lost > 0 ? 1 : 0;
  }
  return out;
}

/// Four standard errors above what may be.
int most(double share) {
  return static_cast<int>(kCampaigns * share + 4.0 * std::sqrt(kCampaigns * share * (1 - share)));
}

TEST_CASE("claims about several initial states are false as rarely as they say") {
  const auto claims = count_claims(CriterionKind::kCleanRuns, 0.0);
  MESSAGE(claims.made << " false claims of " << kCampaigns);
  CHECK(claims.made <= most(1.0 - kLevel));
  CHECK(claims.false_bounds <= most(1.0 - kLevel));
  CHECK(claims.lost == 0);
  CHECK(claims.made + claims.found == kCampaigns);
  CHECK(claims.made > 0);  // it is a test
}

TEST_CASE("and so they are where runs are lost") {
  for (const double lost_share : {0.5, 1.0}) {
    CAPTURE(lost_share);
    const auto clean = count_claims(CriterionKind::kCleanRuns, lost_share);
    MESSAGE("clean-runs: " << clean.made << " false claims of " << kCampaigns);
    CHECK(clean.made <= most(2.0 * (1.0 - kLevel)));
    CHECK(clean.lost > kCampaigns / 4);
    const auto anytime = count_claims(CriterionKind::kAnytime, lost_share);
    MESSAGE("anytime: " << anytime.made << " false claims of " << kCampaigns);
    CHECK(anytime.made <= most(1.0 - kLevel));
    CHECK(anytime.false_bounds <= most(1.0 - kLevel));
  }
  const auto fixed = count_claims(CriterionKind::kClopperPearson, 1.0);
  MESSAGE("clopper-pearson: " << fixed.made << " false claims of " << kCampaigns);
  CHECK(fixed.made <= most(1.0 - kLevel));
}

TEST_CASE("every initial state is tried once before any is tried twice") {
  Campaigns campaigns(CriterionKind::kCleanRuns, 5, quick_folder());
  const CellRates sound{std::vector<double>(5, 0.0), std::vector<double>(5, 0.0)};
  const auto result = campaigns.run(sound, 3);
  const auto& trace = result.traces.front();
  CHECK(trace.verdict == CampaignVerdict::kNoDiscrepancy);
  CHECK(trace.simulations == 11);
  CHECK(trace.starts.tried == 5);
  CHECK(trace.starts.all == 5);
  CHECK(trace.starts.visits == 0);
  for (const auto& [number, counts] : trace.starts.states) {
    CAPTURE(number);
    CHECK(counts.clean >= 2);
    CHECK(counts.clean <= 3);
  }
  CHECK(trace.claim.find("one of the 5 initial states that lead to its events, each equally likely "
                         "and each tried") != std::string::npos);
}

TEST_CASE("more states than runs: the rest is visited once each, and counts for no claim") {
  constexpr std::size_t kStates = 30;
  Campaigns campaigns(CriterionKind::kCleanRuns, kStates, quick_folder());
  CellRates rates{std::vector<double>(kStates, 0.0), std::vector<double>(kStates, 0.0)};
  const auto clean = campaigns.run(rates, 4);
  const auto& trace = clean.traces.front();
  CHECK(trace.verdict == CampaignVerdict::kNoDiscrepancy);
  CHECK(trace.simulations == 11);
  CHECK(trace.starts.visits == 19);
  CHECK(trace.starts.tried == 30);
  CHECK(campaigns.journal().find("\"phase\":\"visit\"") != std::string::npos);
  // One of thirty states that always fails is found for sure.
  for (std::size_t wrong : {std::size_t{0}, std::size_t{13}, std::size_t{29}}) {
    auto one = rates;
    one.fails[wrong] = 1.0;
    CHECK(campaigns.run(one, 4).verdict == CampaignVerdict::kDiscrepancy);
  }
  // No room for all of them: inconclusive.
  campaigns.scenario.limits.max_runs = 20;
  const auto cut = campaigns.run(rates, 4);
  CHECK(cut.verdict == CampaignVerdict::kInconclusive);
  CHECK(cut.traces.front().starts.tried == 11);
  CHECK(cut.traces.front().is_decided);
}

TEST_CASE("`initial: first` claims of the first state, and says so") {
  Campaigns campaigns(CriterionKind::kCleanRuns, 4, quick_folder());
  campaigns.scenario.initial = Initial::kFirst;
  // The others are bad, and nobody looks.
  const CellRates rates{{0.0, 1.0, 1.0, 1.0}, std::vector<double>(4, 0.0)};
  const auto result = campaigns.run(rates, 5);
  const auto& trace = result.traces.front();
  CHECK(trace.verdict == CampaignVerdict::kNoDiscrepancy);
  CHECK(trace.starts.all == 4);
  CHECK(trace.starts.tried == 1);
  CHECK(trace.claim.find("the first of its 4 initial states") != std::string::npos);
  CHECK(std::any_of(trace.caveats.begin(), trace.caveats.end(), [](const std::string& text) {
    return text.starts_with("only 1 of 4 initial states");
  }));
}

TEST_CASE("the number of jobs changes no byte, with losses and states that are visited") {
  Campaigns campaigns(CriterionKind::kCleanRuns, 4, quick_folder());
  const std::vector<CellRates> worlds = {
      {{0.0, 0.0, 0.0, 0.0}, {0.0, 0.1, 0.0, 0.05}},
      {{0.0, 0.02, 0.0, 0.0}, {0.3, 0.0, 0.1, 0.0}},
      {{0.0, 0.0, 0.1, 0.0}, {0.0, 0.0, 0.0, 0.0}},
  };
  int with_losses = 0;
  for (const auto& rates : worlds) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      CAPTURE(seed);
      const auto one = campaigns.run(rates, seed, 1);
      with_losses += one.traces.front().lost > 0 ? 1 : 0;
      const auto journal = campaigns.journal();
      for (const std::int64_t jobs : {2, 5}) {
        const auto more = campaigns.run(rates, seed, jobs);
        CHECK(campaigns.journal() == journal);
        CHECK(more.verdict == one.verdict);
        CHECK(more.traces.front().claim == one.traces.front().claim);
        CHECK(more.traces.front().caveats == one.traces.front().caveats);
      }
    }
  }
  CHECK(with_losses > 3);
}

}  // namespace
}  // namespace parallax::harness
