// Trees of two borders over start parameters: the best of all, and no tree if there is no border.

#include "harness/cause/failure_rule.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace parallax::test {
namespace {

using harness::Border;
using harness::CauseRun;

/// A number from 0 to 1, the same on every machine.
double uniform(std::mt19937_64& bits) { return static_cast<double>(bits() >> 11U) * 0x1.0p-53; }

std::vector<CauseRun> starts(std::mt19937_64& bits, std::size_t runs, std::size_t parameters) {
  std::vector<CauseRun> out(runs);
  for (auto& run : out) {
    for (std::size_t p = 0; p < parameters; ++p) run.start.push_back(uniform(bits));
  }
  return out;
}

/// The weighted error of the best leaf, border, or tree of two levels, by trying every one.
double leaf_error(const std::vector<CauseRun>& all, const std::vector<CauseRun>& some) {
  double mass[2] = {0, 0}, count[2] = {0, 0};
  for (const auto& run : all) ++count[run.failed];
  for (const auto& run : some) mass[run.failed] += 0.5 / count[run.failed];
  return std::min(mass[0], mass[1]);
}

double least_error(const std::vector<CauseRun>& all, const std::vector<CauseRun>& some, int depth) {
  double best = leaf_error(all, some);
  if (depth == 0 || some.empty()) return best;
  for (std::size_t p = 0; p < some.front().start.size(); ++p) {
    for (const auto& at : some) {
      std::vector<CauseRun> below, above;
      for (const auto& run : some) {
        (run.start[p] > at.start[p] ? above : below).push_back(run);
      }
      best =
          std::min(best, least_error(all, below, depth - 1) + least_error(all, above, depth - 1));
    }
  }
  return best;
}

TEST_CASE("no tree is better than the one that is found") {
  std::mt19937_64 bits(1);
  for (int round = 0; round < 200; ++round) {
    auto runs = starts(bits, 4 + bits() % 9, 1 + bits() % 3);
    for (auto& run : runs) {
      // Values that occur several times as well.
      for (auto& value : run.start)
        value = round % 2 == 0 ? value : static_cast<double>(bits() % 4);
      run.failed = bits() % 2 == 0;
    }
    runs.front().failed = true;
    runs.back().failed = false;
    for (const int depth : {1, 2}) {
      const auto tree = harness::best_tree(runs, depth);
      CHECK(harness::tree_error(tree, runs) ==
            doctest::Approx(least_error(runs, runs, depth)).epsilon(1e-9));
    }
  }
}

TEST_CASE("a border is found, and said with few digits") {
  std::mt19937_64 bits(2);
  auto runs = starts(bits, 60, 12);
  for (auto& run : runs) run.failed = run.start[7] > 0.8;
  const auto rule = harness::failure_rule(runs);
  REQUIRE(rule);
  REQUIRE(rule->borders.size() == 1);
  CHECK(rule->borders[0].parameter == 7);
  CHECK(rule->borders[0].above);
  CHECK(rule->borders[0].value == doctest::Approx(0.8).epsilon(0.05));
  CHECK(rule->failures_inside == rule->failures);
  CHECK(rule->clean_inside == 0);
  CHECK(rule->accuracy > 0.9);
}

TEST_CASE("a corner of two parameters is found") {
  std::mt19937_64 bits(3);
  auto runs = starts(bits, 80, 10);
  for (auto& run : runs) run.failed = run.start[2] > 0.5 && run.start[5] <= 0.4;
  const auto rule = harness::failure_rule(runs);
  REQUIRE(rule);
  REQUIRE(rule->borders.size() == 2);
  auto borders = rule->borders;
  std::sort(borders.begin(), borders.end(),
            [](const auto& a, const auto& b) { return a.parameter < b.parameter; });
  CHECK(borders[0].parameter == 2);
  CHECK(borders[0].above);
  CHECK(borders[1].parameter == 5);
  CHECK_FALSE(borders[1].above);
}

TEST_CASE("one in ten labels that are wrong hides no border") {
  std::mt19937_64 bits(4);
  int found = 0;
  for (int round = 0; round < 20; ++round) {
    auto runs = starts(bits, 70, 10);
    for (auto& run : runs) {
      run.failed = (run.start[3] > 0.6) != (uniform(bits) < 0.1);
    }
    const auto rule = harness::failure_rule(runs);
    if (rule && std::any_of(rule->borders.begin(), rule->borders.end(),
                            [](const Border& border) { return border.parameter == 3; })) {
      ++found;
    }
  }
  CHECK(found >= 19);
}

TEST_CASE("in pure noise no border is claimed") {
  std::mt19937_64 bits(5);
  int claimed = 0;
  for (int round = 0; round < 150; ++round) {
    auto runs = starts(bits, 60, 12);
    const double rate = round % 2 == 0 ? 0.5 : 0.2;
    for (auto& run : runs) run.failed = uniform(bits) < rate;
    if (harness::failure_rule(runs)) ++claimed;
  }
  // Each is claimed with a chance of at most 0.001.
  CHECK(claimed <= 1);
}

TEST_CASE("few runs, runs of one kind and parameters that never change show nothing") {
  CHECK_FALSE(harness::failure_rule({}));
  std::vector<CauseRun> runs(20, CauseRun{{1.0, 2.0}, true});
  CHECK_FALSE(harness::failure_rule(runs));
  for (std::size_t i = 0; i < 10; ++i) runs[i].failed = false;
  CHECK_FALSE(harness::failure_rule(runs));
  runs = {{{0.0}, true}, {{0.1}, true}, {{0.9}, false}, {{1.0}, false}};
  CHECK_FALSE(harness::failure_rule(runs));
}

}  // namespace
}  // namespace parallax::test
