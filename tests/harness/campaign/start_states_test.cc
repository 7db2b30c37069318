// The initial states that samples begin in: random orders, weights, and rejection.
#include "harness/campaign/start_states.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "tests/harness/campaign/many_states.h"
#include "tests/harness/campaign/two_regions.h"

namespace parallax::harness {
namespace {

using test::CellFeed;

/// StartStates with all that it refers to.
struct Starts {
  test::TempFolder folder;
  base::SourceFiles files;
  base::DiagnosticSink sink;
  Scenario scenario;
  CellFeed feed;
  SimulatorInfo simulator = test::CellSimulator::description();
  std::optional<ModelFluents> fluents;
  std::optional<StartStates> states;

  Starts(std::size_t cells, std::vector<CellFeed::Cells> all) : feed(cells, std::move(all)) {
    folder.write("domain.e", "sort region\n");
    auto loaded =
        load_scenario(folder.write("scenario.yaml", test::cell_scenario(cells)), files, sink);
    REQUIRE(loaded.has_value());
    scenario = std::move(*loaded);
  }
  StartStates& make(std::uint64_t seed = 1) {
    fluents.emplace(*feed.symbols());
    auto trace = feed.next();
    auto made =
        StartStates::make({scenario, *fluents, simulator, feed, sink, seed}, **std::move(trace));
    REQUIRE(made.has_value());
    states.emplace(*std::move(made));
    return *states;
  }
  std::int64_t at(std::int64_t sample, bool independent = false) {
    const auto state = states->state_of(sample, independent);
    REQUIRE(state.has_value());
    REQUIRE(state->has_value());
    return **state;
  }
};

/// Pearson's statistic of counts against expected shares.
double chi_square(const std::map<std::int64_t, int>& counts, const std::vector<double>& shares,
                  int draws) {
  double sum = 0.0;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const double expected = shares[i] * draws;
    const auto found = counts.find(static_cast<std::int64_t>(i) + 1);
    const double off = (found == counts.end() ? 0 : found->second) - expected;
    sum += off * off / expected;
  }
  return sum;
}

// Quantiles at 1e-4 for 3, 4, 5 and 23 degrees of freedom.
constexpr double kMost3 = 21.1, kMost4 = 23.5, kMost5 = 25.7, kMost23 = 57.1;

TEST_CASE("each block of samples is a permutation of all initial states") {
  Starts starts(5, CellFeed::boxes(5));
  auto& states = starts.make();
  CHECK(states.count() == 5);
  CHECK(states.law_text() == "uniform of 5");
  constexpr int kBlocks = 4000;
  std::map<std::int64_t, int> first;
  for (std::int64_t block = 0; block < kBlocks; ++block) {
    std::vector<std::int64_t> seen;
    for (std::int64_t i = 1; i <= 5; ++i) seen.push_back(starts.at(5 * block + i));
    ++first[seen.front()];
    std::sort(seen.begin(), seen.end());
    REQUIRE(seen == std::vector<std::int64_t>{1, 2, 3, 4, 5});
  }
  CHECK(chi_square(first, std::vector<double>(5, 0.2), kBlocks) < kMost4);
}

TEST_CASE("all orders of four states come equally often, one block like another") {
  Starts starts(4, CellFeed::boxes(4));
  starts.make(7);
  constexpr int kBlocks = 24'000;
  std::map<std::vector<std::int64_t>, std::int64_t> numbers;
  std::vector<std::int64_t> order = {1, 2, 3, 4};
  do {
    const auto number = static_cast<std::int64_t>(numbers.size()) + 1;
    numbers.emplace(order, number);
  } while (std::next_permutation(order.begin(), order.end()));
  std::map<std::int64_t, int> counts;
  for (std::int64_t block = 0; block < kBlocks; ++block) {
    for (std::size_t i = 0; i < 4; ++i) order[i] = starts.at(4 * block + static_cast<int>(i) + 1);
    ++counts[numbers.at(order)];
  }
  CHECK(chi_square(counts, std::vector<double>(24, 1.0 / 24), kBlocks) < kMost23);
}

TEST_CASE(
    "draws follow a search's samples, do not depend on the order of questions, but on seeds") {
  Starts plain(5, CellFeed::boxes(5)), later(5, CellFeed::boxes(5)), other(5, CellFeed::boxes(5));
  plain.make(1);
  later.make(1).begin_after(30);
  other.make(2);
  std::vector<std::int64_t> forth, back, seeded;
  for (std::int64_t i = 1; i <= 50; ++i) {
    CHECK(plain.at(i) == later.at(30 + i));
    forth.push_back(plain.at(i));
    seeded.push_back(other.at(i));
  }
  for (std::int64_t i = 50; i >= 1; --i) back.push_back(plain.at(i));
  std::reverse(back.begin(), back.end());
  CHECK(forth == back);
  CHECK(forth != seeded);
}

TEST_CASE("independent draws are uniform, and weighted ones as likely as their weights") {
  constexpr int kDraws = 40'000;
  Starts uniform(4, CellFeed::boxes(4)), weighted(4, CellFeed::boxes(4));
  weighted.feed.weights = {4.0, 1.0, 3.0, 2.0};
  weighted.scenario.initial = Initial::kWeights;
  uniform.make();
  CHECK(weighted.make().law_text() == "weights of 4");
  std::map<std::int64_t, int> counts, by_weight;
  for (int i = 1; i <= kDraws; ++i) {
    ++counts[uniform.at(i, true)];
    ++by_weight[weighted.at(i, i % 2 == 0)];
  }
  CHECK(chi_square(counts, std::vector<double>(4, 0.25), kDraws) < kMost3);
  CHECK(chi_square(by_weight, {0.4, 0.1, 0.3, 0.2}, kDraws) < kMost3);
  CHECK(chi_square(by_weight, std::vector<double>(4, 0.25), kDraws) > 100.0);
}

TEST_CASE("too many states are drawn from parts, uniformly over those that the model has") {
  // Box and robot each in one of three cells, but never in the same.
  std::vector<CellFeed::Cells> apart;
  for (std::size_t box = 1; box <= 3; ++box) {
    for (std::size_t robot = 1; robot <= 3; ++robot) {
      if (box != robot) apart.emplace_back(box, robot);
    }
  }
  Starts starts(3, apart);
  auto& feed = starts.feed;
  feed.more = true;
  feed.parts.resize(2);
  for (std::size_t cell = 1; cell <= 3; ++cell) {
    feed.parts[0].push_back({feed.box(cell)});
    feed.parts[1].push_back({feed.robot(cell)});
  }
  auto& states = starts.make();
  CHECK(states.count() == std::nullopt);
  CHECK_FALSE(states.is_single());
  constexpr int kDraws = 12'000;
  std::map<std::int64_t, int> counts;
  for (int i = 1; i <= kDraws; ++i) ++counts[starts.at(i)];
  CHECK(counts.size() == 6);
  CHECK(chi_square(counts, std::vector<double>(6, 1.0 / 6), kDraws) < kMost5);
  for (int i = 1; i <= 100; ++i) CHECK(starts.at(i) == starts.at(i, true));
  StartResult result;
  states.describe(result, kDraws);
  CHECK(result.all == std::nullopt);
  CHECK_FALSE(result.only_first);
  CHECK(result.candidates - result.refused == kDraws);
  // Samples that ran ahead do not count.
  StartResult half;
  states.describe(half, kDraws / 2);
  CHECK(half.candidates - half.refused == kDraws / 2);
  // A third of the candidates has both in one cell.
  const double share = static_cast<double>(result.refused) / static_cast<double>(result.candidates);
  CHECK(share == doctest::Approx(1.0 / 3).epsilon(0.05));
  // A state that was drawn before is not asked for again.
  CHECK(feed.asked - result.refused <= 6);
}

TEST_CASE(
    "where no candidate is an initial state only the trace's own is sampled, and it is told") {
  Starts starts(2, {{1, 1}, {2, 2}});
  auto& feed = starts.feed;
  feed.more = true;
  feed.parts = {{{feed.box(1)}}, {{feed.robot(2)}}};
  auto& states = starts.make();
  CHECK(starts.at(1) == 1);
  CHECK(starts.at(2) == 1);
  StartResult result;
  states.describe(result, 2);
  CHECK(result.only_first);
  CHECK_FALSE(result.is_covered());
}

TEST_CASE("drawing ends where hardly any candidate is an initial state, even after a lucky draw") {
  constexpr std::size_t kCells = 64;  // 2 of 4096 candidates are
  int lucky = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    CAPTURE(seed);
    Starts starts(kCells, {{1, 1}, {2, 2}});
    starts.feed.draw_from_all(kCells);
    auto& states = starts.make(seed);
    std::int64_t sample = 1;
    for (; sample <= 200; ++sample) {
      const auto state = states.state_of(sample, false);
      REQUIRE(state.has_value());
      if (!*state) break;
    }
    StartResult result, before;
    states.describe(result, sample);
    if (result.only_first) continue;  // not even one was found
    ++lucky;
    REQUIRE(sample <= 200);
    CHECK(states.ran_out(sample));
    CHECK_FALSE(states.ran_out(sample - 1));
    CHECK(result.ran_out);
    CHECK(result.candidates - result.refused == sample - 1);
    CHECK(result.refused == 1000 * sample);
    CHECK_FALSE(result.is_covered());
    states.describe(before, sample - 1);
    CHECK_FALSE(before.ran_out);
    CHECK_FALSE(states.state_of(sample, false)->has_value());
  }
  CHECK(lucky > 0);
}

TEST_CASE("a state that no start of the world can have is left out, with the reason") {
  Starts starts(3, CellFeed::boxes(3));
  // The box cannot be in two cells at once.
  class Twice final : public CellFeed {
   public:
    using CellFeed::CellFeed;
    base::Result<std::optional<TraceStarts>> starts(
        const CampaignTrace& trace, std::span<const compiler::FluentId> fluents) override {
      auto out = CellFeed::starts(trace, fluents);
      auto both = std::vector{box(1), box(2), robot(1)};
      std::sort(both.begin(), both.end());
      (*out)->states.push_back(std::move(both));
      return out;
    }
  };
  Twice feed(3, CellFeed::boxes(3));
  starts.fluents.emplace(*feed.symbols());
  auto trace = feed.next();
  auto made =
      StartStates::make({starts.scenario, *starts.fluents, starts.simulator, feed, starts.sink, 1},
                        **std::move(trace));
  REQUIRE(made.has_value());
  CHECK(made->count() == 3);
  StartResult result;
  made->describe(result, 1);
  CHECK(result.all == 4);
  REQUIRE(result.unrealisable.size() == 1);
  CHECK(result.unrealisable[0].starts_with("BoxIn(s1) BoxIn(s2): "));
  result.tried = 3;
  CHECK_FALSE(result.is_covered());
}

TEST_CASE("`initial: first` simulates the trace's own state and says of how many it is one") {
  Starts starts(6, CellFeed::boxes(6));
  starts.scenario.initial = Initial::kFirst;
  auto& states = starts.make();
  CHECK(states.is_single());
  CHECK(starts.at(1) == 0);
  CHECK(states.law_text().empty());
  StartResult result;
  states.describe(result, 1);
  CHECK(result.all == 6);
  CHECK(result.is_covered());
}

}  // namespace
}  // namespace parallax::harness
