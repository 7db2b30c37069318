// Runs that go on until all items were shown: bounds for items that were not shown, and rates, in
// worlds with known probabilities, under stopping rules that spoil bounds which do not allow for
// them.
#include "harness/confidence/item_bounds.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "harness/confidence/clean_runs.h"
#include "harness/sampling/sampler.h"

namespace parallax::harness {
namespace {

constexpr double kConfidence = 0.99, kEpsilon = 0.05;
constexpr int kCampaigns = 4000;

CounterRng stream(int campaign) {
  return CounterRng(DrawKey{7, 11, DrawPhase::kCertify, static_cast<std::uint64_t>(campaign), 0});
}

/// Above it a share of `expected` comes in 4000 campaigns with less than 1e-6.
double too_many(double expected) {
  return expected + 5.0 * std::sqrt(expected * (1.0 - expected) / kCampaigns);
}

TEST_CASE("item bounds: what one of many never showed is bounded for all of them together") {
  // Ten things, each exactly as rare as is to be excluded; the runs end when all were shown, or
  // those that were not are claimed to be rarer.
  constexpr int kItems = 10;
  int wrong = 0, naive_wrong = 0;
  for (int campaign = 0; campaign < kCampaigns; ++campaign) {
    const auto rng = stream(campaign);
    std::uint64_t draw = 0;
    ItemBounds bounds(kItems, kConfidence, kEpsilon);
    std::vector<bool> shown(kItems, false);
    const auto left = [&] { return std::find(shown.begin(), shown.end(), false) != shown.end(); };
    const auto naive_needed = runs_needed(kConfidence, kEpsilon);
    while (left() && !bounds.is_rare()) {
      for (std::size_t i = 0; i < kItems; ++i) {
        if (rng.uniform(draw++) < kEpsilon) shown[i] = true;
      }
      bounds.add_run();
      // Each item by itself, as if it were the only one.
      if (bounds.runs() == naive_needed && left()) ++naive_wrong;
    }
    if (!left()) continue;
    CHECK(bounds.bound().epsilon <= kEpsilon);
    ++wrong;
  }
  CHECK(wrong < kCampaigns * too_many(1.0 - kConfidence));
  CHECK(wrong > 0);  // it is not merely conservative: it may err in 1 %
  // The bound for a single item, claimed of all ten: wrong ten times as often.
  CHECK(naive_wrong > kCampaigns * 0.07);
}

TEST_CASE("item bounds: no moment of stopping makes them false more often") {
  // Somebody stops at the first moment at which some bound is false, if there is one.
  const std::vector<double> rates = {0.3, 0.1, 0.05, 0.05, 0.03, 0.02};
  int wrong = 0;
  for (int campaign = 0; campaign < kCampaigns; ++campaign) {
    const auto rng = stream(campaign);
    std::uint64_t draw = 0;
    ItemBounds bounds(std::ssize(rates), kConfidence, kEpsilon);
    std::vector<bool> shown(rates.size(), false);
    bool is_false = false;
    for (int run = 0; run < 400 && !is_false; ++run) {
      for (std::size_t i = 0; i < rates.size(); ++i) {
        if (rng.uniform(draw++) < rates[i]) shown[i] = true;
      }
      bounds.add_run();
      const double bound = bounds.bound().epsilon;
      for (std::size_t i = 0; i < rates.size(); ++i) {
        is_false = is_false || (!shown[i] && bound <= rates[i]);
      }
    }
    if (is_false) ++wrong;
  }
  CHECK(wrong < kCampaigns * too_many(1.0 - kConfidence));
}

TEST_CASE("item bounds: a simulator that is lost whenever something would show does not hide it") {
  constexpr int kItems = 5, kFew = 1000;
  int wrong = 0;
  for (int campaign = 0; campaign < kFew; ++campaign) {
    const auto rng = stream(campaign);
    ItemBounds bounds(kItems, kConfidence, kEpsilon);
    auto needed = bounds.runs_needed();
    for (int run = 0; run < 400; ++run) {
      if (rng.uniform(static_cast<std::uint64_t>(run)) < kEpsilon) {
        bounds.add_lost();
        needed = bounds.runs_needed();
      } else {
        bounds.add_run();
      }
      if (bounds.runs() + bounds.lost() < needed) continue;
      ++wrong;
      break;
    }
  }
  CHECK(wrong <= kFew * (0.02 + 5.0 * std::sqrt(0.02 * 0.98 / kFew)));
  ItemBounds lost(kItems, kConfidence, kEpsilon);
  lost.add_lost();
  CHECK(lost.bound().confidence_level == doctest::Approx(0.98));
  CHECK(lost.bound().epsilon == 1.0);
}

TEST_CASE("item bounds: one thing has the bound of clean runs; more of them need more runs") {
  ItemBounds one(1, kConfidence, kEpsilon);
  CHECK(one.runs_needed() == 90);
  for (int i = 0; i < 89; ++i) one.add_run();
  CHECK_FALSE(one.is_rare());
  one.add_run();
  CHECK(one.is_rare());
  CHECK(one.bound().epsilon == doctest::Approx(bound_after(90, kConfidence)));
  CHECK(one.bound().confidence_level == kConfidence);
  // ln(0.01 / 10) / ln(0.95) = 134.7
  CHECK(ItemBounds(10, kConfidence, kEpsilon).runs_needed() == 135);
}

TEST_CASE("a rate in a number of runs that was fixed is none of when the runs end") {
  // The runs go on until enough is counted, but are twenty at least.
  constexpr double kRate = 0.02;
  constexpr int kPlanned = 20;
  double fixed_sum = 0.0, naive_sum = 0.0;
  for (int campaign = 0; campaign < kCampaigns; ++campaign) {
    const auto rng = stream(campaign);
    FixedCount counted(kPlanned);
    int all = 0, runs = 0, in_fixed = 0;
    while (runs < kPlanned || (all == 0 && runs < 100'000)) {
      const bool comes = rng.uniform(static_cast<std::uint64_t>(runs++)) < kRate;
      const bool counts = counted.next();
      if (comes) ++all;
      if (comes && counts) ++in_fixed;
    }
    CHECK(counted.counted() == kPlanned);
    CHECK(counted.goes_on() == (runs > kPlanned));
    fixed_sum += static_cast<double>(in_fixed) / kPlanned;
    naive_sum += static_cast<double>(all) / runs;
  }
  const double deviation = std::sqrt(kRate * (1.0 - kRate) / kPlanned / kCampaigns);
  CHECK(std::abs(fixed_sum / kCampaigns - kRate) < 5.0 * deviation);
  // Counted in all runs it would be too high: the last one is one in which it came.
  CHECK(naive_sum / kCampaigns > kRate + 10.0 * deviation);
}

}  // namespace
}  // namespace parallax::harness
