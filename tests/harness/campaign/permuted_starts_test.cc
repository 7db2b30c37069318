// The bounds for runs that go through initial states in random orders, by exact enumeration.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "harness/confidence/criterion.h"

namespace parallax::harness {
namespace {

/// The probabilities that the first 0, 1, ..., `most` runs are all clean, where runs go through the
/// states in orders of which each is equally likely. `good`: of a clean run, by state.
std::vector<double> clean_prefixes(const std::vector<double>& good, std::size_t most) {
  // Sums over all orders, by the number of runs.
  std::vector<double> within(good.size() + 1, 0.0);
  std::vector<std::size_t> order(good.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  double orders = 0.0;
  do {
    double product = 1.0;
    within[0] += product;
    for (std::size_t k = 0; k < order.size(); ++k) within[k + 1] += product *= good[order[k]];
    ++orders;
  } while (std::next_permutation(order.begin(), order.end()));
  std::vector<double> out;
  double whole = 1.0;
  for (std::size_t n = 0; n <= most; ++n) {
    const auto rest = n % good.size();
    if (n > 0 && rest == 0) whole *= within.back() / orders;
    out.push_back(whole * within[rest] / orders);
  }
  return out;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Every way to give `states` states values of the grid, up to their order.
std::vector<std::vector<double>> all_worlds(std::size_t states, const std::vector<double>& grid) {
  std::vector<std::vector<double>> out = {{}};
  for (std::size_t i = 0; i < states; ++i) {
    std::vector<std::vector<double>> longer;
    for (const auto& world : out) {
      for (const double value : grid) {
        if (!world.empty() && value < world.back()) continue;
        longer.push_back(world);
        longer.back().push_back(value);
      }
    }
    out = std::move(longer);
  }
  return out;
}

TEST_CASE("clean runs in random orders are no likelier than independent ones, at any number") {
  const std::vector<double> grid = {0.0, 0.2, 0.5, 0.8, 0.95, 1.0};
  double closest = 0.0;
  for (std::size_t states = 1; states <= 5; ++states) {
    for (const auto& good : all_worlds(states, grid)) {
      const auto prefixes = clean_prefixes(good, 13);
      for (std::size_t n = 0; n < prefixes.size(); ++n) {
        const double bound = std::pow(mean(good), static_cast<double>(n));
        CHECK(prefixes[n] <= bound + 1e-12);
        const bool differs = good.front() != good.back();
        if (differs && n > 1 && bound > 0.0) closest = std::max(closest, prefixes[n] / bound);
      }
    }
  }
  // The bound is no waste: it is nearly met where states hardly differ.
  CHECK(closest > 0.99);
}

/// The probability that the criterion is ever met within `most` runs. Failures are lost runs. Draws
/// are in random orders up to the first of them, and independent after it.
double chance_to_pass(const CriterionSpec& spec, const std::vector<double>& good, int most) {
  const auto criterion = make_criterion(spec);
  std::map<std::pair<int, int>, bool> known;
  const auto stops = [&](int runs, int lost) {
    const auto [at, is_new] = known.try_emplace({runs, lost}, false);
    if (is_new) {
      Tally tally(RegressionFrame{});
      for (int i = 0; i < runs - lost; ++i) tally.add_clean_of_many();
      for (int i = 0; i < lost; ++i) tally.add_lost();
      at->second = criterion->decide(tally).stop;
    }
    return at->second;
  };
  const auto prefixes = clean_prefixes(good, static_cast<std::size_t>(most));
  const double later = mean(good);
  double passed = 0.0;
  std::vector<double> by_lost(static_cast<std::size_t>(most) + 1, 0.0);  // those that go on
  double clean = 1.0;                                                    // that none was lost yet
  for (int runs = 1; runs <= most; ++runs) {
    std::vector<double> next(by_lost.size(), 0.0);
    for (std::size_t lost = 1; lost < static_cast<std::size_t>(runs); ++lost) {
      next[lost] += by_lost[lost] * later;
      next[lost + 1] += by_lost[lost] * (1.0 - later);
    }
    const auto now = static_cast<std::size_t>(runs);
    if (clean > 0.0) {
      next[1] += prefixes[now - 1] - prefixes[now];
      clean = prefixes[now];
      if (stops(runs, 0)) {
        passed += clean;
        clean = 0.0;
      }
    }
    for (std::size_t lost = 1; lost <= now; ++lost) {
      if (next[lost] <= 0.0 || !stops(runs, static_cast<int>(lost))) continue;
      passed += next[lost];
      next[lost] = 0.0;
    }
    by_lost = std::move(next);
  }
  return passed;
}

TEST_CASE("with lost runs among them, criteria are met as rarely as they say") {
  CriterionSpec anytime, clean_runs;
  anytime.kind = CriterionKind::kAnytime;
  for (auto* spec : {&anytime, &clean_runs}) {
    spec->confidence_level = 0.9;
    spec->epsilon = 0.2;
  }
  // States in which 0 to 100 % of the runs are lost, the mean being what is to be excluded.
  std::size_t worlds = 0;
  for (std::size_t states = 1; states <= 5; ++states) {
    for (const auto& good : all_worlds(states, {0.0, 0.2, 0.4, 0.6, 0.7, 0.8, 0.9, 1.0})) {
      if (std::abs(mean(good) - 0.8) > 1e-9) continue;
      ++worlds;
      CAPTURE(good.size());
      CHECK(chance_to_pass(anytime, good, 80) <= 0.1);
      CHECK(chance_to_pass(clean_runs, good, 80) <= 0.2);
    }
  }
  CHECK(worlds > 20);
}

}  // namespace
}  // namespace parallax::harness
