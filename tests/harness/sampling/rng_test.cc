#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "harness/sampling/sampler.h"

namespace parallax::harness {
namespace {

constexpr std::uint64_t kGamma = 0x9e3779b97f4a7c15ULL;

/// A normal deviate exceeds this in size with probability below 1e-6.
constexpr double kRareDeviate = 4.9;

/// Values of chi-square with `dof` beyond which lies less than 1e-6 on both sides together, by the
/// cube-root approximation of Wilson and Hilferty 1931.
std::pair<double, double> chi_square_band(double dof) {
  const auto at = [&](double z) {
    return dof * std::pow(1 - 2 / (9 * dof) + z * std::sqrt(2 / (9 * dof)), 3);
  };
  return {at(-kRareDeviate), at(kRareDeviate)};
}

TEST_CASE("rng: mix64 over a counter is splitmix64, published values") {
  const std::array<std::uint64_t, 3> from_zero = {0xe220a8397b1dcdafULL, 0x6e789e6aa1b965f4ULL,
                                                  0x06c45d188009454fULL};
  for (std::uint64_t k = 0; k < from_zero.size(); ++k) {
    CHECK(mix64((k + 1) * kGamma) == from_zero[k]);
  }
  const std::array<std::uint64_t, 5> from_1234567 = {6457827717110365317ULL, 3203168211198807973ULL,
                                                     9817491932198370423ULL, 4593380528125082431ULL,
                                                     16408922859458223821ULL};
  for (std::uint64_t k = 0; k < from_1234567.size(); ++k) {
    CHECK(mix64(1234567 + (k + 1) * kGamma) == from_1234567[k]);
  }
}

TEST_CASE("rng: a draw can be repeated alone, and every part of its key matters") {
  const DrawKey key{1, 2, DrawPhase::kCertify, 3, 4};
  CHECK(CounterRng(key).bits(7) == CounterRng(key).bits(7));
  std::set<std::uint64_t> seen = {CounterRng(key).bits(7), CounterRng(key).bits(8)};
  for (const DrawKey& other :
       {DrawKey{2, 2, DrawPhase::kCertify, 3, 4}, DrawKey{1, 3, DrawPhase::kCertify, 3, 4},
        DrawKey{1, 2, DrawPhase::kSearch, 3, 4}, DrawKey{1, 2, DrawPhase::kCertify, 4, 4},
        DrawKey{1, 2, DrawPhase::kCertify, 3, 5}, DrawKey{2, 1, DrawPhase::kCertify, 3, 4},
        DrawKey{1, 2, DrawPhase::kCertify, 4, 3}}) {
    CHECK(seen.insert(CounterRng(other).bits(7)).second);
    CHECK(simulator_seed(other) != simulator_seed(key));
  }
}

TEST_CASE("rng: simulator seeds fit into 53 bits, use them all, and hardly ever collide") {
  std::uint64_t all_ones = 0;
  std::set<std::uint64_t> seeds;
  for (std::uint64_t sample = 0; sample < 20000; ++sample) {
    const auto seed = simulator_seed({.campaign_seed = 1, .sample = sample});
    CHECK(seed < (1ULL << 53));
    all_ones |= seed;
    seeds.insert(seed);
  }
  CHECK(all_ones == (1ULL << 53) - 1);
  CHECK(seeds.size() == 20000);  // a collision among random seeds: chance 2e-8
}

TEST_CASE("rng: uniform over [0, 1), along dimensions and along samples") {
  // Fixed keys; the chance that a true uniform generator fails is below 1e-6 for each stream.
  constexpr std::size_t kBins = 1000, kDraws = 400000;
  const auto [low, high] = chi_square_band(kBins - 1.0);
  for (const bool along_dimensions : {true, false}) {
    std::vector<double> counts(kBins, 0.0);
    for (std::uint64_t k = 0; k < kDraws; ++k) {
      const DrawKey key{.campaign_seed = 42, .sample = along_dimensions ? 0 : k};
      const double u = CounterRng(key).uniform(along_dimensions ? k : 0);
      REQUIRE(u >= 0.0);
      REQUIRE(u < 1.0);
      counts[static_cast<std::size_t>(u * kBins)] += 1.0;
    }
    double chi_square = 0.0;
    const double expected = static_cast<double>(kDraws) / kBins;
    for (const double count : counts)
      chi_square += (count - expected) * (count - expected) / expected;
    CHECK(chi_square > low);
    CHECK(chi_square < high);
  }
}

TEST_CASE("rng: neighbouring keys are uncorrelated in every part of the key") {
  // 5 correlations of 100 000 pairs; each is normal with standard deviation 1/sqrt(pairs), so the
  // chance that a true generator fails is below 5e-6 for another seed.
  constexpr std::uint64_t kPairs = 100000;
  const auto correlation = [](auto first, auto second) {
    double sum = 0.0;
    for (std::uint64_t k = 0; k < kPairs; ++k) sum += (first(k) - 0.5) * (second(k) - 0.5);
    return 12.0 * sum / std::sqrt(static_cast<double>(kPairs));
  };
  const auto at = [](DrawKey key, std::uint64_t dimension = 0) {
    return CounterRng(key).uniform(dimension);
  };
  const auto by_sample = [&](std::uint64_t k) { return at({.campaign_seed = 7, .sample = k}); };
  CHECK(std::abs(correlation(by_sample, [&](std::uint64_t k) {
          return at({.campaign_seed = 7, .sample = k + 1});
        })) < kRareDeviate);
  CHECK(std::abs(correlation(by_sample, [&](std::uint64_t k) {
          return at({.campaign_seed = 8, .sample = k});
        })) < kRareDeviate);
  CHECK(std::abs(correlation(by_sample, [&](std::uint64_t k) {
          return at({.campaign_seed = 7, .sample = k, .attempt = 1});
        })) < kRareDeviate);
  CHECK(std::abs(correlation(by_sample, [&](std::uint64_t k) {
          return at({.campaign_seed = 7, .sample = k}, 1);
        })) < kRareDeviate);
  CHECK(std::abs(correlation(by_sample, [&](std::uint64_t k) {
          return at({.campaign_seed = 7, .phase = DrawPhase::kSearch, .sample = k});
        })) < kRareDeviate);
}

TEST_CASE("rng: pairs of coordinates of one draw fill the square evenly") {
  // Chance of failing for another seed: below 1e-6.
  constexpr std::size_t kSide = 20, kDraws = 200000;
  std::vector<double> counts(kSide * kSide, 0.0);
  for (std::uint64_t k = 0; k < kDraws; ++k) {
    const CounterRng rng({.campaign_seed = 5, .trace_key = 9, .sample = k});
    const auto i = static_cast<std::size_t>(rng.uniform(0) * kSide);
    const auto j = static_cast<std::size_t>(rng.uniform(1) * kSide);
    counts[i * kSide + j] += 1.0;
  }
  const double expected = static_cast<double>(kDraws) / (kSide * kSide);
  double chi_square = 0.0;
  for (const double count : counts)
    chi_square += (count - expected) * (count - expected) / expected;
  const auto [low, high] = chi_square_band(kSide * kSide - 1.0);
  CHECK(chi_square > low);
  CHECK(chi_square < high);
}

}  // namespace
}  // namespace parallax::harness
