// Does a criterion err as rarely as it says? Four synthetic worlds whose discrepancy probability is
// known exactly; cells are one unit wide, start values uniform in the unit cube.
#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include "harness/confidence/clean_runs.h"
#include "harness/confidence/criterion.h"
#include "harness/confidence/quantiles.h"
#include "harness/sampling/sampler.h"

namespace parallax::harness {
namespace {

constexpr std::size_t kParameters = 6;

/// Final values of two parameters; a discrepancy is a value outside [0, 1).
using World = std::function<std::vector<double>(const std::vector<double>&, double noise)>;

/// Share of the unit square of (a, b) that `fails`, by the midpoint rule.
template <typename Predicate>
double area(Predicate fails) {
  constexpr int kSide = 1500;
  int count = 0;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) count += fails((i + 0.5) / kSide, (j + 0.5) / kSide) ? 1 : 0;
  }
  return static_cast<double>(count) / (kSide * kSide);
}

/// The scale at which a failure share that grows with it reaches p.
double scale_for(double p, const std::function<double(double)>& share) {
  double low = 0.0, high = 4.0;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    (share(middle) < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// y1 = 0.2 + 0.3 x1 + 0.3 x2 + normal noise, scaled so that y1 leaves [0, 1) with probability p.
World linear_gaussian(double p) {
  const auto share = [](double scale) {
    double sum = 0.0;
    constexpr int kSide = 200;
    for (int i = 0; i < kSide; ++i) {
      for (int j = 0; j < kSide; ++j) {
        const double mean = 0.2 + 0.3 * (i + 0.5) / kSide + 0.3 * (j + 0.5) / kSide;
        sum += normal_cdf(-mean / scale) + normal_cdf((mean - 1.0) / scale);
      }
    }
    return sum / (kSide * kSide);
  };
  const double scale = scale_for(p, share);
  return [scale](const std::vector<double>& x, double noise) {
    return std::vector<double>{0.2 + 0.3 * x[0] + 0.3 * x[1] + scale * normal_quantile(noise), 0.5};
  };
}

/// Well inside its cell, except in a corner box of volume p, where the object falls.
World rare_box(double p) {
  const double side = std::sqrt(p);
  return [side](const std::vector<double>& x, double) {
    const bool falls = x[0] < side && x[1] < side;
    return std::vector<double>{falls ? 2.5 : 0.4 + 0.2 * x[0], 0.5};
  };
}

/// y1 = 0.4 + 0.2 x1 + Student noise with 1.5 degrees of freedom.
World heavy_tail(double p) {
  const auto share = [](double scale) {
    double sum = 0.0;
    constexpr int kSteps = 400;
    for (int i = 0; i < kSteps; ++i) {
      const double mean = 0.4 + 0.2 * (i + 0.5) / kSteps;
      sum += student_t_cdf(-mean / scale, 1.5) + student_t_cdf((mean - 1.0) / scale, 1.5);
    }
    return sum / kSteps;
  };
  const double scale = scale_for(p, share);
  return [scale](const std::vector<double>& x, double noise) {
    return std::vector<double>{0.4 + 0.2 * x[0] + scale * student_t_quantile(noise, 1.5), 0.5};
  };
}

/// A grip offset |x1 - x2| beyond a threshold drops the object; a smaller one makes it jump.
World drop_map(double p) {
  // P(|x1 - x2| > d) = (1 - d)^2.
  const double drop = 1.0 - std::sqrt(p), jump = 0.5 * drop;
  return [drop, jump](const std::vector<double>& x, double) {
    const double offset = std::abs(x[0] - x[1]);
    const double y = offset > drop ? -1.0 : offset > jump ? 0.7 : 0.3 + 0.1 * x[0];
    return std::vector<double>{y, 0.5};
  };
}

bool matches(const std::vector<double>& y) {
  return y[0] >= 0.0 && y[0] < 1.0 && y[1] >= 0.0 && y[1] < 1.0;
}

RegressionFrame frame() {
  RegressionFrame result;
  for (std::size_t i = 0; i < kParameters; ++i) {
    result.x_names.push_back("x" + std::to_string(i));
    result.x_range.push_back({0, 1});
  }
  result.y_names = {"y0", "y1"};
  result.y_cell.assign(2, Interval{0, 1});
  return result;
}

/// Share of `loops` that the criterion ends with "no discrepancy"; a mismatch ends a loop too.
double clean_stop_share(const World& world, const ConfidenceCriterion& criterion,
                        std::uint64_t world_key, std::uint64_t loops, std::uint64_t cap) {
  std::uint64_t stopped = 0;
  for (std::uint64_t loop = 0; loop < loops; ++loop) {
    Tally tally(frame());
    for (std::uint64_t run = 0; run < cap; ++run) {
      const CounterRng rng({.campaign_seed = 1000 + loop, .trace_key = world_key, .sample = run});
      std::vector<double> x;
      for (std::size_t i = 0; i < kParameters; ++i) x.push_back(rng.uniform(i));
      const auto y = world(x, rng.uniform(kParameters) + 0x1.0p-54);
      if (!matches(y)) break;
      tally.add_clean(x, y);
      if (!criterion.decide(tally).stop) continue;
      ++stopped;
      break;
    }
  }
  return static_cast<double>(stopped) / static_cast<double>(loops);
}

const std::vector<std::pair<std::string, World (*)(double)>> kWorlds = {
    {"linear and Gaussian", linear_gaussian},
    {"rare failure box", rare_box},
    {"heavy tail", heavy_tail},
    {"contact and drop", drop_map}};

TEST_CASE("calibration: the worlds fail as often as they are meant to") {
  CHECK(area([](double a, double b) { return std::abs(a - b) > 1 - std::sqrt(0.05); }) ==
        doctest::Approx(0.05).epsilon(0.01));
  for (std::size_t w = 0; w < kWorlds.size(); ++w) {
    CAPTURE(kWorlds[w].first);
    const auto world = kWorlds[w].second(0.05);
    int failed = 0;
    for (std::uint64_t run = 0; run < 20000; ++run) {
      const CounterRng rng({.campaign_seed = 77, .trace_key = w, .sample = run});
      std::vector<double> x;
      for (std::size_t i = 0; i < kParameters; ++i) x.push_back(rng.uniform(i));
      failed += matches(world(x, rng.uniform(kParameters) + 0x1.0p-54)) ? 0 : 1;
    }
    // 4.9 standard errors: a chance of failing below 1e-6 for another seed.
    CHECK(std::abs(failed - 1000) < 4.9 * std::sqrt(20000 * 0.05 * 0.95));
  }
}

TEST_CASE("calibration: clean-runs stops falsely as often as it says, in every world") {
  // 4000 loops; expected share (1-p)^90, four standard errors (chance of failing with another seed
  // 1e-4 a world; this seed is fixed). At p = 4 % the claim "p < 5 %" is true.
  constexpr std::uint64_t kLoops = 4000;
  const auto criterion = make_criterion({});
  for (std::size_t w = 0; w < kWorlds.size(); ++w) {
    for (const double p : {0.04, 0.05, 0.06}) {
      CAPTURE(kWorlds[w].first);
      CAPTURE(p);
      const double share = clean_stop_share(kWorlds[w].second(p), *criterion, w, kLoops, 300);
      const double expected = std::pow(1 - p, 90);
      const double error = std::sqrt(expected * (1 - expected) / kLoops);
      CAPTURE(share);
      CHECK(std::abs(share - expected) < 4 * error);
    }
  }
}

TEST_CASE("calibration: even the worst peeker is wrong at most as often as the bound says") {
  // Stops at the first clean run at which the bound is below the true p: false claims (1-p)^n(p).
  constexpr std::uint64_t kLoops = 40000;
  for (const double p : {0.05, 0.1, 0.3}) {
    std::int64_t first = 1;
    while (bound_after(first, 0.99) >= p) ++first;
    std::uint64_t wrong = 0;
    for (std::uint64_t loop = 0; loop < kLoops; ++loop) {
      const CounterRng rng({.campaign_seed = 55, .sample = loop});
      std::int64_t clean = 0;
      while (clean < first && rng.uniform(static_cast<std::uint64_t>(clean)) >= p) ++clean;
      wrong += clean == first ? 1 : 0;
    }
    // 1 % of 40 000 plus 4.9 standard errors of 20: a chance below 1e-6.
    CHECK(wrong <= 498);
    CHECK(wrong > 0);
  }
}

/// Share of `loops` that end with "no discrepancy" where every start fails with probability p, and
/// failing runs are lost, not seen: the worst a simulator can do.
double stop_share_of_losses(const CriterionSpec& spec, double p, std::uint64_t loops,
                            std::int64_t cap) {
  const auto criterion = make_criterion(spec);
  // Such runs differ in nothing but their number, so that one decision stands for all loops.
  std::map<std::pair<std::int64_t, std::int64_t>, bool> stops;
  std::uint64_t stopped = 0;
  for (std::uint64_t loop = 0; loop < loops; ++loop) {
    const CounterRng rng({.campaign_seed = 4242, .sample = loop});
    Tally tally(frame());
    for (std::int64_t run = 0; run < cap; ++run) {
      if (rng.uniform(static_cast<std::uint64_t>(run)) < p) {
        tally.add_lost();
      } else {
        tally.add_clean_elsewhere();
      }
      const auto [known, is_new] = stops.try_emplace({tally.runs(), tally.lost()}, false);
      if (is_new) known->second = criterion->decide(tally).stop;
      if (!known->second) continue;
      // The bound that is then stated is at most the rate to be excluded, at the level asked for.
      CHECK(stated_bound(tally, spec).epsilon <= spec.epsilon);
      ++stopped;
      break;
    }
  }
  return static_cast<double>(stopped) / static_cast<double>(loops);
}

TEST_CASE(
    "calibration: anytime and a fixed number of runs err within their level, losses and all") {
  constexpr std::uint64_t kLoops = 4000;
  const double noise = 4 * std::sqrt(0.01 * 0.99 / kLoops);
  CriterionSpec anytime, fixed;
  anytime.kind = CriterionKind::kAnytime;
  fixed.kind = CriterionKind::kClopperPearson;
  fixed.runs = 250;
  for (const double p : {0.05, 0.06, 0.1}) {
    CAPTURE(p);
    CHECK(stop_share_of_losses(anytime, p, kLoops, 600) <= 0.01 + noise);
    CHECK(stop_share_of_losses(fixed, p, kLoops, 250) <= 0.01 + noise);
  }
  // And they are of use: where one start in a hundred fails they come to an end as a rule, after
  // losses that the all-clean bound does not survive.
  CHECK(stop_share_of_losses(anytime, 0.01, 400, 600) > 0.9);
  CHECK(stop_share_of_losses(fixed, 0.01, 400, 250) > 0.7);
}

TEST_CASE("calibration: the level that anytime states after a loss is the whole one") {
  CriterionSpec spec;
  spec.kind = CriterionKind::kAnytime;
  Tally tally(frame());
  tally.add_lost();
  while (!make_criterion(spec)->decide(tally).stop) tally.add_clean_elsewhere();
  CHECK(stated_bound(tally, spec).confidence_level == 0.99);
  CHECK(certified_bound(tally, 0.99).confidence_level == doctest::Approx(0.98));
  CHECK(claim(tally, spec, Comparison::kEveryStep)
            .starts_with("with 99 % confidence, fewer than 5 %"));
}

TEST_CASE("calibration: the paper's figure is no probability of error") {
  // With six parameters and p = 5 % the centred rule, stated at 99 %, stops falsely in about 70 %
  // of the loops of the rare-box world; measured 69-70 % +- 2, standard error here 2.
  CriterionSpec spec;
  spec.kind = CriterionKind::kPaper;
  spec.paper.intercept = InterceptKind::kCentred;
  const auto criterion = make_criterion(spec);
  const double share = clean_stop_share(rare_box(0.05), *criterion, 9, 500, 300);
  CHECK(share > 0.58);
  CHECK(share < 0.82);
}

}  // namespace
}  // namespace parallax::harness
