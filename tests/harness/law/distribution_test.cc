#include "harness/law/distribution.h"

#include <doctest/doctest.h>

#include "harness/sampling/sampler.h"
#include "tests/harness/law/goodness.h"

namespace parallax::harness {
namespace {

constexpr std::uint64_t kDraws = 20'000;

Distribution normal(double mean, double sd) {
  Distribution law;
  law.kind = Distribution::Kind::kNormal;
  law.mean = mean;
  law.sd = sd;
  return law;
}

Distribution triangular(double lower, double mode, double upper) {
  Distribution law;
  law.kind = Distribution::Kind::kTriangular;
  law.lower = lower;
  law.mode = mode;
  law.upper = upper;
  return law;
}

Distribution choice(std::vector<std::pair<double, double>> values) {
  Distribution law;
  law.kind = Distribution::Kind::kChoice;
  law.values = std::move(values);
  return law;
}

std::vector<double> draws(const ConditionedLaw& law, std::uint64_t seed) {
  std::vector<double> out;
  for (std::uint64_t i = 0; i < kDraws; ++i) {
    out.push_back(law.at(CounterRng({.campaign_seed = seed, .sample = i}).uniform(0)));
  }
  return out;
}

/// The distribution function of a density on a cell, by numerical integration alone.
std::function<double(double)> cdf_of(const std::function<double(double)>& density, double from,
                                     double to) {
  const double whole = test::integral(density, from, to);
  return [=](double x) { return test::integral(density, from, x, 400) / whole; };
}

TEST_CASE("a normal law in any cell, tails included, has the distribution of its density") {
  struct Cell {
    double lower, upper;
  };
  std::uint64_t seed = 1;
  // In standard deviations: whole, one side, narrow, far tails on either side.
  for (const auto& [lower, upper] : std::vector<Cell>{
           {-9, 9}, {-1, 2}, {0.5, 0.6}, {3, 9}, {-9, -6}, {8, 8.5}, {20, 21}, {-36, -30}}) {
    CAPTURE(lower);
    const double mean = 1.3, sd = 0.07;
    const Interval cell{mean + lower * sd, mean + upper * sd, false};
    const auto law = ConditionedLaw::make(normal(mean, sd), cell);
    REQUIRE(law.has_value());
    // Relative to the density at the end nearest to the mean, which would underflow alone.
    const double nearest = lower > 0.0 ? lower : upper < 0.0 ? upper : 0.0;
    const auto density = [&](double x) {
      const double z = (x - mean) / sd;
      return std::exp(-0.5 * (z - nearest) * (z + nearest));
    };
    // Beyond 9 standard deviations from that end nothing is left that the integral could see.
    const double reach = 9.0 * sd / std::max(1.0, std::abs(nearest) / 4.0);
    const double from = std::max(cell.lower, mean + nearest * sd - reach);
    const double to = std::min(cell.upper, mean + nearest * sd + reach);
    const auto values = draws(*law, seed++);
    for (const double value : values) CHECK(cell.contains(value));
    CHECK(test::kolmogorov(values, [&](double x) {
            return cdf_of(density, from, to)(std::clamp(x, from, to));
          }) < test::kKolmogorovLimit);
  }
}

TEST_CASE("triangular laws, with the mode inside or at an end, in a cell or whole") {
  std::uint64_t seed = 20;
  for (const auto& [lower, mode, upper, cell] :
       std::vector<std::tuple<double, double, double, Interval>>{{0, 0.2, 1, {0, 1}},
                                                                 {0, 0, 1, {0, 1}},
                                                                 {-2, 3, 3, {-2, 3}},
                                                                 {0, 0.2, 1, {0.1, 0.15}},
                                                                 {0, 0.2, 1, {0.15, 0.7}},
                                                                 {0, 0.2, 1, {0.98, 1}}}) {
    CAPTURE(mode);
    const auto law = ConditionedLaw::make(triangular(lower, mode, upper), cell);
    REQUIRE(law.has_value());
    const auto area_below = [&, lower = lower, mode = mode, upper = upper](double x) {
      // The size of the triangle left of x, drawn and cut.
      const double height = 2.0 / (upper - lower);
      if (x <= mode) return 0.5 * (x - lower) * height * (x - lower) / (mode - lower);
      return 1.0 - 0.5 * (upper - x) * height * (upper - x) / (upper - mode);
    };
    const auto below = [&, mode = mode, lower = lower](double x) {
      return mode == lower && x == lower ? 0.0 : area_below(x);
    };
    const double from = below(cell.lower), whole = below(cell.upper) - from;
    CHECK(test::kolmogorov(draws(*law, seed++), [&](double x) {
            return (below(x) - from) / whole;
          }) < test::kKolmogorovLimit);
  }
}

TEST_CASE("a discrete choice has its weights, and in a cell those of what is left") {
  const auto whole = choice({{0.5, 0.2}, {1.0, 0.8}, {2.0, 3.0}});
  for (const auto& [cell, shares] : std::vector<std::pair<Interval, std::vector<double>>>{
           {{0, 3, false}, {0.05, 0.2, 0.75}},
           {{0, 2, false}, {0.2, 0.8, 0}},
           {{1, 2, true}, {0, 0.8 / 3.8, 3.0 / 3.8}}}) {
    const auto law = ConditionedLaw::make(whole, cell);
    REQUIRE(law.has_value());
    std::vector<std::int64_t> counts(3);
    for (const double value : draws(*law, 40)) ++counts[value == 0.5 ? 0 : value == 1.0 ? 1 : 2];
    for (std::size_t i = 0; i < 3; ++i) {
      if (shares[i] == 0.0) CHECK(counts[i] == 0);
    }
    CHECK(test::chi_square_excess(counts, shares) < test::kChiSquareLimit);
  }
}

TEST_CASE("a law without mass in the cell is none") {
  CHECK_FALSE(ConditionedLaw::make(normal(0, 1), {40, 50, false}).has_value());
  CHECK_FALSE(ConditionedLaw::make(normal(0, 1), {-50, -40, false}).has_value());
  CHECK(ConditionedLaw::make(normal(0, 1), {36, 50, false}).has_value());
  CHECK_FALSE(ConditionedLaw::make(triangular(0, 0.2, 1), {1, 2, false}).has_value());
  CHECK_FALSE(ConditionedLaw::make(triangular(0, 0.2, 1), {-2, 0, false}).has_value());
  CHECK_FALSE(ConditionedLaw::make(choice({{1, 1}, {3, 1}}), {1.5, 3, false}).has_value());
  CHECK(ConditionedLaw::make(choice({{1, 1}, {3, 1}}), {1.5, 3, true}).has_value());
}

TEST_CASE("values rise with the number that they are made from, and keep to the cell") {
  for (const auto& law :
       {normal(0, 1), triangular(-1, 0, 1), choice({{-0.5, 1}, {0, 2}, {0.7, 1}})}) {
    for (const Interval cell : {Interval{-1, 1, false}, {-0.6, 0.1, false}, {-0.1, 0.9, false}}) {
      const auto conditioned = ConditionedLaw::make(law, cell);
      REQUIRE(conditioned.has_value());
      double last = cell.lower;
      for (int i = 0; i <= 1000; ++i) {
        const double value = conditioned->at(std::min(i / 1000.0, 1.0 - 0x1.0p-53));
        CHECK(value >= last);
        CHECK(value < cell.upper);
        last = value;
      }
    }
  }
}

}  // namespace
}  // namespace parallax::harness
