// Behaviour of the paper's rule in simple worlds: documented, whether wanted or not.
#include <doctest/doctest.h>

#include <cmath>

#include "harness/confidence/paper_rule.h"
#include "harness/confidence/quantiles.h"
#include "harness/sampling/sampler.h"

namespace parallax::harness {
namespace {

/// Runs a world until the rule stops; 0 if it has not after `cap` runs. The world gets the unit
/// coordinates of the start and a source of randomness.
template <typename World>
std::int64_t runs_until_stop(const World& world, RegressionInput input, const PaperRuleSpec& spec,
                             double level, std::uint64_t loop, std::int64_t cap) {
  for (std::int64_t run = 1; run <= cap; ++run) {
    const CounterRng rng(
        {.campaign_seed = 31, .trace_key = loop, .sample = static_cast<std::uint64_t>(run)});
    std::vector<double> x;
    for (std::size_t i = 0; i < input.x_range.size(); ++i) {
      x.push_back(input.x_range[i].lower + input.x_range[i].width() * rng.uniform(i));
    }
    input.y.push_back(world(x, rng));
    input.x.push_back(std::move(x));
    if (paper_rule(input, spec, level).stop) return run;
  }
  return 0;
}

/// n initial and two final parameters, in unit cells that begin at `x_origin` and `y_origin`.
RegressionInput cells_at(std::size_t n, double x_origin, double y_origin) {
  RegressionInput input;
  for (std::size_t i = 0; i < n; ++i) input.x_range.push_back({x_origin, x_origin + 1});
  input.y_cell.assign(2, Interval{y_origin, y_origin + 1});
  return input;
}

PaperRuleSpec centred() {
  auto spec = paper_literal();
  spec.intercept = InterceptKind::kCentred;
  return spec;
}

TEST_CASE("origin: a constant goal never satisfies the literal rule if both frames agree") {
  for (const std::size_t n : {2U, 6U}) {
    for (const double origin : {0.0, 1.0, 3.0}) {
      const auto goal = [&](const auto&, const auto&) {
        return std::vector<double>{origin + 0.5, origin + 0.5};
      };
      for (std::uint64_t loop = 0; loop < 5; ++loop) {
        CHECK(runs_until_stop(goal, cells_at(n, origin, origin), paper_literal(), 0.99, loop,
                              100) == 0);
      }
    }
  }
}

TEST_CASE("origin: the same world with the start far from the origin stops at once") {
  const auto goal = [](const auto&, const auto&) { return std::vector<double>{0.5, 0.5}; };
  for (const std::size_t n : {2U, 6U}) {
    double sum = 0.0;
    for (std::uint64_t loop = 0; loop < 50; ++loop) {
      const auto runs = runs_until_stop(goal, cells_at(n, 3, 0), paper_literal(), 0.99, loop, 300);
      REQUIRE(runs > 0);
      sum += static_cast<double>(runs);
    }
    CHECK(sum / 50 >= static_cast<double>(n + 1));
    CHECK(sum / 50 < static_cast<double>(n) + 1.5);
  }
}

TEST_CASE("origin: with centred coordinates the frame does not matter") {
  for (const double origin : {0.0, 3.0, -7.0}) {
    const auto goal = [&](const auto&, const auto&) {
      return std::vector<double>{origin + 0.5, origin + 0.5};
    };
    for (std::uint64_t loop = 0; loop < 20; ++loop) {
      CHECK(runs_until_stop(goal, cells_at(2, origin, origin), centred(), 0.99, loop, 300) == 3);
    }
  }
}

TEST_CASE(
    "units: the literal verdict depends on metres or millimetres, the repaired one does not") {
  const auto in_unit = [](double per_metre, const PaperRuleSpec& spec) {
    RegressionInput input = cells_at(2, 0, 0);
    for (auto& range : input.x_range) range = {0, per_metre};
    for (auto& cell : input.y_cell) cell = Interval{0, per_metre};
    for (std::uint64_t run = 0; run < 12; ++run) {
      const CounterRng rng({.campaign_seed = 8, .sample = run});
      const double x1 = rng.uniform(0), x2 = rng.uniform(1);
      input.x.push_back({per_metre * x1, per_metre * x2});
      input.y.push_back({per_metre * (0.4 + 0.1 * x1 + 0.01 * rng.uniform(2)),
                         per_metre * (0.5 - 0.1 * x2 + 0.01 * rng.uniform(3))});
    }
    return paper_rule(input, spec, 0.99);
  };
  CHECK(in_unit(1.0, centred()).stop);
  CHECK_FALSE(in_unit(1000.0, centred()).stop);
  // The half-width has squared units: a thousand times too wide in a thousand times smaller ones.
  const auto metres = in_unit(1.0, centred()), millimetres = in_unit(1000.0, centred());
  auto bare = centred();
  bare.sigma = SigmaKind::kRmse;
  const double wide_m = metres.intervals[0].upper - in_unit(1.0, bare).intervals[0].upper;
  const double wide_mm =
      (millimetres.intervals[0].upper - in_unit(1000.0, bare).intervals[0].upper) / 1000.0;
  CHECK(std::abs(wide_mm) > 100 * std::abs(wide_m));

  auto repaired = paper_repaired();
  repaired.tolerance_m = 0.0;
  CHECK(in_unit(1.0, repaired).stop);
  CHECK(in_unit(1000.0, repaired).stop);
  CHECK(in_unit(1000.0, repaired).intervals[1].upper ==
        doctest::Approx(1000.0 * in_unit(1.0, repaired).intervals[1].upper).epsilon(1e-9));
}

/// Mean half-width of the interval of one final parameter, normal noise of 0.1, two parameters.
double mean_half_width(SigmaKind sigma, std::int64_t runs) {
  auto spec = paper_literal();
  spec.sigma = sigma;
  const int loops = runs > 50 ? 300 : 3000;
  double sum = 0.0;
  for (int loop = 0; loop < loops; ++loop) {
    RegressionInput input;
    input.x_range = {{0, 1}, {0, 1}};
    input.y_cell = {Interval{0, 1}};
    for (std::int64_t run = 0; run < runs; ++run) {
      const CounterRng rng({.campaign_seed = 9,
                            .trace_key = static_cast<std::uint64_t>(loop),
                            .sample = static_cast<std::uint64_t>(run)});
      input.x.push_back({rng.uniform(0), rng.uniform(1)});
      // Half a step up: uniform in (0, 1) without its ends.
      input.y.push_back({0.1 * normal_quantile(rng.uniform(2) + 0x1.0p-54)});
    }
    const auto verdict = paper_rule(input, spec, 0.95);
    const auto& interval = verdict.intervals.at(0);
    double bare = 0.0;
    for (const double b : interval.coefficients) bare += std::abs(b);
    sum += 0.5 * (interval.upper - interval.lower - bare);
  }
  return sum / loops;
}

TEST_CASE(
    "size: the literal interval grows with the number of runs, the repaired sigma shrinks it") {
  // Means of at least 300 loops; the tolerance of 6 % is over five standard errors everywhere.
  const std::vector<std::pair<std::int64_t, double>> literal = {
      {3, 0.013}, {5, 0.031}, {10, 0.058}, {20, 0.091}, {80, 0.196}};
  for (const auto& [runs, width] : literal) {
    CHECK(mean_half_width(SigmaKind::kSse, runs) == doctest::Approx(width).epsilon(0.06));
  }
  const std::vector<std::pair<std::int64_t, double>> repaired = {
      {3, 0.101}, {5, 0.093}, {10, 0.070}, {20, 0.050}, {80, 0.025}};
  for (const auto& [runs, width] : repaired) {
    CHECK(mean_half_width(SigmaKind::kResidualSd, runs) == doctest::Approx(width).epsilon(0.06));
  }
}

TEST_CASE(
    "inertia: an untouched object with jitter blocks the literal rule, not the repaired one") {
  const auto untouched = [](const auto& x, const auto& rng) {
    return std::vector<double>{x[0] + 0.001 * (rng.uniform(8) - 0.5), 0.5};
  };
  auto input = cells_at(2, 0, 0);
  input.x_names = {"box.x", "robot.x"};
  input.y_names = {"box.x", "robot.x"};
  for (std::uint64_t loop = 0; loop < 10; ++loop) {
    CHECK(runs_until_stop(untouched, input, paper_literal(), 0.99, loop, 60) == 0);
    CHECK(runs_until_stop(untouched, input, paper_repaired(), 0.99, loop, 60) > 0);
  }
  input.x = {{0.1, 0.2}, {0.3, 0.9}, {0.8, 0.5}, {0.6, 0.1}};
  input.y = {{0.101, 0.5}, {0.3, 0.5}, {0.799, 0.5}, {0.6, 0.5}};
  CHECK(paper_rule(input, paper_repaired(), 0.99).exempt == std::vector<std::string>{"box.x"});
  CHECK(paper_rule(input, paper_literal(), 0.99).exempt.empty());
}

TEST_CASE("refusals: too few runs, a start that does not vary, nothing to test, dependence") {
  auto input = cells_at(2, 0, 0);
  CHECK(paper_rule(input, paper_literal(), 0.99).why_not == "0 runs, 3 needed at least");
  input.x = {{0.1, 0.2}, {0.2, 0.4}, {0.3, 0.6}, {0.4, 0.8}};
  input.y = {{0.5, 0.5}, {0.5, 0.5}, {0.5, 0.5}, {0.5, 0.5}};
  for (const auto& spec : {paper_literal(), paper_repaired()}) {
    const auto verdict = paper_rule(input, spec, 0.99);
    CHECK_FALSE(verdict.stop);
    CHECK(verdict.why_not == "the initial parameters of these runs are not linearly independent");
  }
  auto fixed = input;
  for (auto& range : fixed.x_range) range.upper = range.lower;
  CHECK(paper_rule(fixed, paper_literal(), 0.99).why_not == "no initial parameter varies");
  auto blind = input;
  blind.y_cell = {std::nullopt, std::nullopt};
  CHECK(paper_rule(blind, paper_literal(), 0.99).why_not == "no final parameter to test");
  auto lost = input;
  lost.y[2][1] = std::nan("");
  lost.x[1][0] = 0.9;
  CHECK_FALSE(paper_rule(lost, paper_literal(), 0.99).stop);
  auto tight = paper_repaired();
  tight.extra_runs = 0;
  auto few = input;
  few.x.resize(3);
  few.y.resize(3);
  CHECK(paper_rule(few, tight, 0.99).why_not == "3 runs leave nothing over for 3 coefficients");
}

TEST_CASE("columns: one of zero width is dropped and does not count for n") {
  RegressionInput with = cells_at(2, 3, 0);
  with.x_range.insert(with.x_range.begin() + 1, Interval{0.03, 0.03});
  RegressionInput without = cells_at(2, 3, 0);
  for (std::uint64_t run = 0; run < 6; ++run) {
    const CounterRng rng({.campaign_seed = 17, .sample = run});
    const double a = 3 + rng.uniform(0), b = 3 + rng.uniform(1);
    with.x.push_back({a, 0.03, b});
    without.x.push_back({a, b});
    with.y.push_back({0.1 * a, 0.05 * b + 0.01 * rng.uniform(2)});
    without.y = with.y;
  }
  for (const auto& spec : {paper_literal(), paper_repaired(), centred()}) {
    const auto wide = paper_rule(with, spec, 0.99), narrow = paper_rule(without, spec, 0.99);
    CHECK(wide.stop == narrow.stop);
    CHECK(wide.z == narrow.z);
    REQUIRE(wide.intervals.size() == 2);
    CHECK(wide.intervals[1].lower == narrow.intervals[1].lower);
    CHECK(wide.intervals[1].coefficients[1] == 0.0);
    CHECK(wide.intervals[1].coefficients[2] == narrow.intervals[1].coefficients[1]);
  }
}

TEST_CASE("readings: root, Bonferroni and centring change what they say and nothing else") {
  RegressionInput input = cells_at(2, 0, 0);
  input.y_cell.push_back(Interval{0, 1});
  for (std::uint64_t run = 0; run < 8; ++run) {
    const CounterRng rng({.campaign_seed = 18, .sample = run});
    input.x.push_back({rng.uniform(0), rng.uniform(1)});
    input.y.push_back({rng.uniform(2), rng.uniform(3), rng.uniform(4)});
  }
  auto spec = paper_literal();
  CHECK(paper_rule(input, spec, 0.95).z == doctest::Approx(2.236477).epsilon(1e-6));
  spec.bonferroni = true;
  CHECK(paper_rule(input, spec, 0.95).z == doctest::Approx(2.241403).epsilon(1e-6));
  spec.bonferroni = false;
  spec.root = RootKind::kFinal;  // three final parameters
  CHECK(paper_rule(input, spec, 0.95).z ==
        doctest::Approx(two_sided_z(std::cbrt(0.95))).epsilon(1e-12));
  // A free intercept makes centring pointless: the same line either way.
  auto free = spec;
  free.intercept = InterceptKind::kFree;
  const auto verdict = paper_rule(input, free, 0.95);
  auto moved = input;
  for (auto& row : moved.x) row[0] += 5.0;
  moved.x_range[0] = {5, 6};
  const auto shifted = paper_rule(moved, free, 0.95);
  for (std::size_t j = 0; j < 3; ++j) {
    CHECK(shifted.intervals[j].lower == doctest::Approx(verdict.intervals[j].lower).epsilon(1e-9));
    CHECK(shifted.intervals[j].upper == doctest::Approx(verdict.intervals[j].upper).epsilon(1e-9));
  }
  // Centred coefficients are reported in the original coordinates.
  const auto middle = paper_rule(input, centred(), 0.95);
  const auto& first = middle.intervals[0];
  CHECK(first.intercept + 0.5 * first.coefficients[0] + 0.5 * first.coefficients[1] ==
        doctest::Approx(0.5).epsilon(1e-12));
}

}  // namespace
}  // namespace parallax::harness
