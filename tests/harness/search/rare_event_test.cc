#include "harness/search/rare_event.h"

#include <doctest/doctest.h>

#include <cmath>

#include "harness/search/normal_mixture.h"
#include "harness/search/start_population.h"
#include "harness/search/weighted_bounds.h"
#include "tools/bench/search/rare_worlds.h"

namespace parallax::harness {
namespace {

using bench::RareWorld;

RareEventOptions options_for(RareEventMethod method, std::int64_t budget, std::uint64_t seed) {
  RareEventOptions options;
  options.method = method;
  options.dimensions = 4;
  options.budget = budget;
  options.seed = seed;
  return options;
}

template <typename Answer>
RareEventResult estimated(const RareEventOptions& options, Answer answer) {
  return estimate_rare_event(options, [&](std::span<const UnitPoint> points) {
    std::vector<Evaluation> out;
    for (const auto& point : points) out.push_back(answer(point));
    return std::optional(std::move(out));
  });
}

Evaluation judged(double margin) {
  return {{}, margin < 0.0 ? EvaluationKind::kDiscrepancy : EvaluationKind::kClean, margin};
}

constexpr RareEventMethod kMethods[] = {RareEventMethod::kImportance, RareEventMethod::kSplitting};

TEST_CASE("weighted bounds: hold for any law of draws, and adapt to what was drawn before") {
  // Discrepancies are x < 0.02. Draws are from the uniform law or from that of [0, width), where
  // the width follows from the last discrepancy; with a width of 0.004 most of them are missed.
  constexpr double kTruth = 0.02;
  constexpr int kLoops = 1000;
  for (const double least_width : {0.004, 0.03}) {
    int above = 0, below = 0;
    for (int loop = 0; loop < kLoops; ++loop) {
      SearchRng rng(7, static_cast<std::uint64_t>(loop));
      WeightedBounds bounds;
      double width = 0.3;
      for (int i = 0; i < 300; ++i) {
        const double share = 0.5;
        const double x = rng.uniform() < share ? rng.uniform() : width * rng.uniform();
        WeightedBounds::Draw draw;
        draw.weight = 1.0 / (share + (x < width ? (1.0 - share) / width : 0.0));
        draw.share = share;
        draw.failed = x < kTruth;
        bounds.add(draw, 0.1);
        if (draw.failed) width = std::max(least_width, x);
      }
      above += bounds.upper(0.05) < kTruth ? 1 : 0;
      below += bounds.lower(0.05) > kTruth ? 1 : 0;
    }
    // 5 % and four standard errors.
    CHECK(above <= 77);
    CHECK(below <= 77);
  }
}

TEST_CASE("weighted bounds: clean uniform draws, and lost ones at either end") {
  const auto bounds_of = [](int clean, int failed, int lost) {
    WeightedBounds bounds;
    for (int i = 0; i < clean + failed + lost; ++i) {
      WeightedBounds::Draw draw;
      draw.failed = i >= clean && i < clean + failed;
      draw.lost = i >= clean + failed;
      bounds.add(draw, 0.01);
    }
    return bounds;
  };
  // No bound can be below that of clean runs; this one is little above it.
  const double least = 1.0 - std::pow(0.05, 1.0 / 3000.0);
  CHECK(bounds_of(3000, 0, 0).upper(0.05) > least);
  CHECK(bounds_of(3000, 0, 0).upper(0.05) < 1.05 * least);
  CHECK(bounds_of(3000, 0, 0).lower(0.05) == 0.0);
  CHECK(bounds_of(0, 0, 0).upper(0.05) == 1.0);
  CHECK(bounds_of(0, 50, 0).upper(0.05) == 1.0);
  // With 20 failed and 10 lost runs of 1000, any number from 20 to 30 may have failed.
  const auto lost = bounds_of(970, 20, 10);
  CHECK(lost.upper(0.05) == doctest::Approx(bounds_of(970, 30, 0).upper(0.05)));
  CHECK(lost.lower(0.05) == doctest::Approx(bounds_of(980, 20, 0).lower(0.05)));
  CHECK(lost.lower(0.05) < 0.02);
  CHECK(lost.upper(0.05) > 0.03);
}

TEST_CASE("normal mixture: its density is that of its draws") {
  SearchRng rng(3, 1);
  std::vector<WeightedPoint> points;
  for (int i = 0; i < 200; ++i) {
    const double x = 0.3 + 0.02 * rng.normal();
    points.push_back({{x, i % 2 == 0 ? x + 0.01 * rng.normal() : 0.8 + 0.02 * rng.normal()}, 1.0});
  }
  const auto mixture = NormalMixture::fit(points, rng);
  CHECK(mixture.size() >= 2);
  // The area of a square around both, by draws.
  double area = 0.0;
  constexpr int kDraws = 200'000;
  for (int i = 0; i < kDraws; ++i) {
    const auto point = mixture.draw(rng);
    const bool inside = std::abs(point[0] - 0.3) < 0.02 && std::abs(point[1] - 0.8) < 0.02;
    if (inside) area += 1.0 / mixture.density(point) / kDraws;
  }
  CHECK(area == doctest::Approx(0.04 * 0.04).epsilon(0.05));
}

TEST_CASE("moves: keep the uniform law, also beside faces of the cube") {
  // Guides along a diagonal: steps whose coordinates go together.
  std::vector<UnitPoint> guides;
  for (int i = 0; i < 20; ++i) guides.push_back({0.02 * i, 0.02 * i, 0.3 + 0.01 * i});
  SearchRng rng(5, 1);
  const auto is_in = [](const UnitPoint& x) { return x[0] + x[1] + x[2] < 0.5; };
  double mean[3] = {}, product = 0.0;
  constexpr int kChains = 40'000;
  for (int chain = 0; chain < kChains; ++chain) {
    auto point = uniform_start(rng, 3);
    while (!is_in(point)) point = uniform_start(rng, 3);
    for (int move = 0; move < 20; ++move) {
      const auto next = moved(point, guides, rng);
      if (next && is_in(*next)) point = *next;
    }
    for (std::size_t i = 0; i < 3; ++i) mean[i] += point[i] / kChains;
    product += point[0] * point[1] / kChains;
  }
  // Moments of the uniform law on a simplex of size 0.5 in three dimensions; 5 standard errors.
  for (const double one : mean) CHECK(std::abs(one - 0.125) < 0.0025);
  CHECK(std::abs(product - 0.0125) < 0.0005);
}

TEST_CASE("importance: holds what is known to be true, also where margins lead away from it") {
  for (const char* name : {"edge", "two", "hidden"}) {
    CAPTURE(name);
    const RareWorld world(name, 4, 1e-3);
    int covered = 0;
    double ratio = 0.0;
    for (std::uint64_t seed = 1; seed <= 25; ++seed) {
      const auto result = estimated(options_for(RareEventMethod::kImportance, 3'500, seed),
                                    [&](const auto& point) { return world.evaluate(point); });
      REQUIRE(result.end == RareEventEnd::kEstimated);
      CHECK(result.runs == 3'500);
      CHECK(result.lower <= result.probability);
      CHECK(result.probability <= result.upper);
      ratio += result.upper / std::max(result.lower, 1e-9) / 25.0;
      if (result.lower <= 1e-3 && 1e-3 <= result.upper) ++covered;
    }
    CHECK(covered >= 20);  // of 25 at 95 % fewer come once in 800 times
    if (world.name() != "hidden") CHECK(ratio < 6.0);
  }
}

TEST_CASE("splitting: holds what is known to be true where margins lead to it") {
  for (const char* name : {"edge", "band"}) {
    CAPTURE(name);
    const RareWorld world(name, 4, 1e-4);
    int covered = 0;
    double mean = 0.0;
    for (std::uint64_t seed = 1; seed <= 15; ++seed) {
      const auto result = estimated(options_for(RareEventMethod::kSplitting, 35'000, seed),
                                    [&](const auto& point) { return world.evaluate(point); });
      REQUIRE(result.end == RareEventEnd::kEstimated);
      CHECK(result.runs <= 35'000);
      mean += result.probability / 15.0;
      if (result.lower <= 1e-4 && 1e-4 <= result.upper) ++covered;
    }
    CHECK(covered >= 11);  // of 15 at 92 % fewer come once in 400 times
    CHECK(std::abs(mean / 1e-4 - 1.0) < 0.35);
  }
}

TEST_CASE("rare events: the law is that of valid starts") {
  for (const auto method : kMethods) {
    double mean = 0.0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const auto result = estimated(options_for(method, 10'000, seed), [](const auto& x) {
        return x[0] > 0.5 ? Evaluation{{}, EvaluationKind::kInvalid} : judged(x[1] - 0.01);
      });
      CHECK(result.invalid > 0);
      CHECK(result.lower <= 0.01);
      CHECK(result.upper >= 0.01);
      mean += result.probability / 10.0;
    }
    CHECK(std::abs(mean / 0.01 - 1.0) < 0.2);
  }
}

TEST_CASE("rare events: what cannot be estimated is called so") {
  const auto end_of = [](RareEventMethod method, auto answer) {
    return estimated(options_for(method, 4'000, 1), answer).end;
  };
  using End = RareEventEnd;
  const auto constant = [](const auto&) { return judged(1.0); };
  const auto far = [](const auto& x) { return judged(1.0 + x[0]); };
  const auto invalid = [](const auto&) { return Evaluation{{}, EvaluationKind::kInvalid}; };
  CHECK(end_of(RareEventMethod::kSplitting, constant) == End::kFlat);
  CHECK(end_of(RareEventMethod::kSplitting, far) != End::kEstimated);
  CHECK(end_of(RareEventMethod::kImportance, constant) == End::kUnreached);
  CHECK(end_of(RareEventMethod::kImportance, far) == End::kUnreached);
  for (const auto method : kMethods) {
    CHECK(end_of(method, invalid) == End::kInvalid);
    const auto stopped = estimate_rare_event(
        options_for(method, 4'000, 1),
        [](std::span<const UnitPoint>) { return std::optional<std::vector<Evaluation>>(); });
    CHECK(stopped.end == End::kStopped);
  }
  // Without a discrepancy there still is a bound, little above that of as many clean runs.
  const auto none = estimated(options_for(RareEventMethod::kImportance, 4'000, 1), constant);
  CHECK(none.lower == 0.0);
  CHECK(none.upper > 3.0 / 4'000.0);
  CHECK(none.upper < 3.5 / 4'000.0);
}

TEST_CASE("rare events: lost runs widen the interval of importance, and splitting has none") {
  // Lost wherever it should have shown a discrepancy in half of the starts that give one.
  const auto answer = [](const auto& x) {
    const bool lost = x[1] < 0.002 && x[0] < 0.5;
    return lost ? Evaluation{{}, EvaluationKind::kLost} : judged(x[1] - 0.002);
  };
  const auto widened = estimated(options_for(RareEventMethod::kImportance, 10'000, 1), answer);
  CHECK(widened.lost > 0);
  CHECK(widened.lower < 0.001);
  CHECK(widened.upper > 0.002);
  const auto refused = estimated(options_for(RareEventMethod::kSplitting, 10'000, 1), answer);
  CHECK(refused.end == RareEventEnd::kLost);
}

TEST_CASE("rare events: one that is frequent is counted rightly, and the seed decides everything") {
  for (const auto method : kMethods) {
    const auto answer = [](const auto& x) { return judged(x[0] - 0.5); };
    const auto a = estimated(options_for(method, 4'000, 5), answer);
    const auto b = estimated(options_for(method, 4'000, 5), answer);
    const auto c = estimated(options_for(method, 4'000, 6), answer);
    CHECK(a.end == RareEventEnd::kEstimated);
    CHECK(a.lower <= 0.5);
    CHECK(a.upper >= 0.5);
    CHECK(std::abs(a.probability - 0.5) < 0.1);
    CHECK(a.probability == b.probability);
    CHECK(a.upper == b.upper);
    CHECK(a.probability != c.probability);
  }
}

TEST_CASE("rare worlds: the probability is as stated") {
  SearchRng rng(11, 1);
  for (const auto& name : bench::rare_world_names()) {
    CAPTURE(name);
    for (const std::size_t dimensions : {4U, 8U}) {
      const RareWorld world(name, dimensions, 0.005);
      constexpr int kDraws = 100'000;
      int found = 0;
      for (int i = 0; i < kDraws; ++i) {
        found += world.evaluate(uniform_start(rng, dimensions)).margin < 0.0 ? 1 : 0;
      }
      CHECK(std::abs(found / (0.005 * kDraws) - 1.0) < 0.22);  // five standard errors
    }
  }
}

}  // namespace
}  // namespace parallax::harness
