#include "harness/search/strategy.h"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "harness/search/search_rng.h"
#include "tools/bench/search/search_worlds.h"
#include "tools/bench/search/verifai_samplers.h"

namespace parallax::harness {
namespace {

constexpr StrategyKind kAll[] = {
    StrategyKind::kUniform,      StrategyKind::kSobol,   StrategyKind::kBoundary,
    StrategyKind::kCrossEntropy, StrategyKind::kDescent, StrategyKind::kExpectedImprovement,
    StrategyKind::kPortfolio,
};

using Answer = std::function<Evaluation(const UnitPoint&)>;

Evaluation clean(const UnitPoint& point, double margin) {
  return {point, EvaluationKind::kClean, margin};
}

SearchHistory searched(SearchStrategy& strategy, std::size_t dimensions, std::size_t batches,
                       const Answer& answer) {
  SearchHistory history(dimensions);
  for (std::size_t i = 0; i < batches; ++i) {
    for (const auto& point : strategy.propose(history, kSearchBatch)) history.add(answer(point));
  }
  return history;
}

/// Runs until the first discrepancy; more than `most`: none was found.
std::size_t runs_until_found(const bench::SearchWorld& world, SearchStrategy& strategy,
                             std::size_t most) {
  SearchHistory history(world.dimensions());
  while (history.all().size() <= most) {
    for (const auto& point : strategy.propose(history, kSearchBatch)) {
      history.add(world.evaluate(point, 0));
      if (history.all().back().kind == EvaluationKind::kDiscrepancy) return history.all().size();
    }
  }
  return most + 1;
}

TEST_CASE("search: names of strategies and back") {
  for (const auto kind : kAll) CHECK(kSearchStrategies.find(to_string(kind)) == kind);
  CHECK_FALSE(kSearchStrategies.find("sobel"));
}

TEST_CASE("search: whatever the answers, points are in the cube, and follow from the seed") {
  const std::vector<Answer> answers = {
      [](const auto& x) { return clean(x, x[0] + x[1] * x[2]); },
      [](const auto& x) { return clean(x, 1.0); },
      [](const auto& x) { return clean(x, std::numeric_limits<double>::quiet_NaN()); },
      [](const auto& x) { return clean(x, x[0] < 0.5 ? 1e300 : -1e300); },
      [](const auto& x) {
        return Evaluation{x, EvaluationKind::kInvalid};
      },
      [](const auto& x) {
        return Evaluation{x, EvaluationKind::kLost};
      },
      [](const auto& x) {
        if (x[1] < 0.3) return Evaluation{x, EvaluationKind::kInvalid};
        return clean(x, x[0]);
      },
  };
  for (const auto kind : kAll) {
    for (const auto& answer : answers) {
      auto a = make_strategy(kind, 3, 11), b = make_strategy(kind, 3, 11);
      auto c = make_strategy(kind, 3, 12);
      const auto first = searched(*a, 3, 20, answer), again = searched(*b, 3, 20, answer);
      const auto other = searched(*c, 3, 20, answer);
      bool same = true;
      for (std::size_t i = 0; i < first.all().size(); ++i) {
        REQUIRE(first[i].point == again[i].point);
        same = same && first[i].point == other[i].point;
        REQUIRE(first[i].point.size() == 3);
        for (const double value : first[i].point) {
          REQUIRE(value >= 0.0);
          REQUIRE(value <= 1.0);
        }
      }
      CHECK_FALSE(same);
    }
  }
}

TEST_CASE("search: more than 200 points and one dimension are no trouble") {
  for (const auto kind : kAll) {
    auto strategy = make_strategy(kind, 1, 4);
    const auto history = searched(*strategy, 1, 70,
                                  [](const auto& x) { return clean(x, 2.0 + std::cos(9 * x[0])); });
    CHECK(history.all().size() == 280);
  }
}

TEST_CASE("search: the history knows its least margins in order, and what says nothing") {
  SearchHistory history(1);
  CHECK(history.is_flat());
  CHECK_FALSE(history.best());
  SearchRng rng(1, 1);
  for (int i = 0; i < 2000; ++i) {
    const double margin = rng.uniform();
    history.add({{rng.uniform()},
                 i % 7 == 0 ? EvaluationKind::kLost : EvaluationKind::kClean,
                 i % 7 == 0 ? std::numeric_limits<double>::quiet_NaN() : margin});
  }
  CHECK_FALSE(history.is_flat());
  REQUIRE(history.leading().size() == SearchHistory::kLeading);
  CHECK(history.leading().front() == *history.best());
  std::vector<double> margins;
  for (const auto number : history.judged()) margins.push_back(history[number].margin);
  std::sort(margins.begin(), margins.end());
  for (std::size_t i = 0; i < history.leading().size(); ++i) {
    REQUIRE(history[history.leading()[i]].margin == margins[i]);
  }
}

TEST_CASE("search: the surrogate keeps away from where starts are invalid") {
  auto strategy = make_strategy(StrategyKind::kExpectedImprovement, 2, 3);
  // The margin falls towards where no start is valid.
  const auto history = searched(*strategy, 2, 30, [](const auto& x) {
    if (x[0] > 0.7) return Evaluation{x, EvaluationKind::kInvalid};
    return clean(x, 2.0 - x[0]);
  });
  std::size_t late = 0;
  for (std::size_t i = 60; i < history.all().size(); ++i) {
    if (history[i].kind == EvaluationKind::kInvalid) ++late;
  }
  CHECK(late < 30);  // without that: 60
  CHECK(history[*history.best()].margin < 1.32);
}

TEST_CASE("search: worlds fail as often as they say") {
  for (const auto& name : bench::search_world_names()) {
    const bench::SearchWorld world(name, 5, {0.01}, 200'000);
    SearchRng rng(8, 8);
    int failed = 0;
    for (int i = 0; i < 40'000; ++i) {
      UnitPoint point(5);
      for (auto& value : point) value = rng.uniform();
      if (world.evaluate(point, 0).kind == EvaluationKind::kDiscrepancy) ++failed;
    }
    // Five standard errors of the two samples together.
    CHECK(std::abs(failed - 400) < 5.0 * std::sqrt(400.0 * (1.0 + 0.2)));
  }
}

TEST_CASE("search: the portfolio needs a tenth of uniform's runs where margins inform") {
  for (const auto& name : bench::search_world_names()) {
    if (name == "flat") continue;
    const bench::SearchWorld world(name, 6, {0.001}, 100'000);
    std::size_t all = 0;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      all += runs_until_found(world, *make_strategy(StrategyKind::kPortfolio, 6, seed), 2000);
    }
    CAPTURE(name);
    CHECK(all < 5 * 150);  // uniform: 5,000 on average
  }
}

TEST_CASE("search: where nothing informs the portfolio spreads its points") {
  auto strategy = make_strategy(StrategyKind::kPortfolio, 2, 5);
  const auto history = searched(*strategy, 2, 100, [](const auto& x) { return clean(x, 1.0); });
  int cells[4][4] = {};
  for (const auto& one : history.all()) {
    ++cells[std::min(3, static_cast<int>(4 * one.point[0]))]
           [std::min(3, static_cast<int>(4 * one.point[1]))];
  }
  for (const auto& row : cells) {
    for (const int count : row) CHECK(count >= 15);  // 25 if all were equal
  }
}

TEST_CASE("search: samplers to compare with propose points of the cube") {
  for (int which = 0; which < 4; ++which) {
    auto strategy = which == 3   ? bench::verifai_bayesian(3, 2)
                    : which == 2 ? bench::verifai_bandit(3, 2)
                                 : bench::verifai_cross_entropy(3, 2, which == 1);
    const auto history =
        searched(*strategy, 3, 30, [](const auto& x) { return clean(x, x[0] + 0.1); });
    for (const auto& one : history.all()) {
      for (const double value : one.point) CHECK((value >= 0.0 && value <= 1.0));
    }
  }
}

}  // namespace
}  // namespace parallax::harness
