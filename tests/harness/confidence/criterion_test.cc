#include "harness/confidence/criterion.h"

#include <doctest/doctest.h>

#include "harness/confidence/clean_runs.h"
#include "harness/sampling/sampler.h"

namespace parallax::harness {
namespace {

Tally empty_tally() { return Tally({{}, {}, {}, {}, {"Holding"}}); }

void add_clean(Tally& tally, std::int64_t count) {
  for (std::int64_t i = 0; i < count; ++i) tally.add_clean({}, {});
}

Tally constant_goal(std::int64_t runs) {
  Tally tally({{"x1", "x2"}, {{3, 4}, {3, 4}}, {"y"}, {Interval{0, 1}}, {}});
  for (std::int64_t run = 0; run < runs; ++run) {
    const CounterRng rng({.campaign_seed = 1, .sample = static_cast<std::uint64_t>(run)});
    const std::vector<double> x = {3 + rng.uniform(0), 3 + rng.uniform(1)};
    tally.add_clean(x, std::vector<double>{0.5});
  }
  return tally;
}

TEST_CASE("clean-runs: stops at 90 clean runs for 99 % and 5 %, not one earlier") {
  const auto criterion = make_criterion({});
  CHECK(criterion->kind() == CriterionKind::kCleanRuns);
  CHECK(criterion->is_anytime_valid());
  auto tally = empty_tally();
  add_clean(tally, 89);
  CHECK_FALSE(criterion->decide(tally).stop);
  CHECK(criterion->decide(tally).runs_needed == 90);
  CHECK(criterion->decide(tally).why == "89 of 90 runs");
  add_clean(tally, 1);
  CHECK(criterion->decide(tally).stop);
  const auto bound = certified_bound(tally, 0.99);
  CHECK(bound.epsilon == doctest::Approx(0.049881).epsilon(1e-5));
  CHECK(bound.confidence_level == 0.99);
}

TEST_CASE("clean-runs: lost runs count as failures, so it takes the mixture's number of runs") {
  const auto criterion = make_criterion({});
  auto tally = empty_tally();
  add_clean(tally, 100);
  tally.add_lost();
  CHECK_FALSE(criterion->decide(tally).stop);
  CHECK(criterion->decide(tally).runs_needed == 176);
  add_clean(tally, 74);
  CHECK_FALSE(criterion->decide(tally).stop);
  add_clean(tally, 1);
  CHECK(tally.runs() == 176);
  CHECK(criterion->decide(tally).stop);
  const auto bound = certified_bound(tally, 0.99);
  CHECK(bound.epsilon <= 0.05);
  CHECK(bound.epsilon == mixture_upper(1, 176, 0.99));
  CHECK(bound.confidence_level == doctest::Approx(0.98));
  tally.add_lost();
  CHECK_FALSE(criterion->decide(tally).stop);
}

TEST_CASE("clean-runs: rejected starts are no runs, and a mismatch ends all hope") {
  const auto criterion = make_criterion({});
  auto tally = empty_tally();
  tally.add_rejected(50);
  add_clean(tally, 90);
  CHECK(tally.runs() == 90);
  CHECK(criterion->decide(tally).stop);
  tally.add_mismatch();
  add_clean(tally, 5000);
  CHECK_FALSE(criterion->decide(tally).stop);
  CHECK(criterion->decide(tally).why == "a run gave a discrepancy");
}

TEST_CASE("paper: stops when the rule holds and states the certified bound beside it") {
  CriterionSpec spec;
  spec.kind = CriterionKind::kPaper;
  const auto criterion = make_criterion(spec);
  CHECK(criterion->kind() == CriterionKind::kPaper);
  CHECK_FALSE(criterion->is_anytime_valid());
  CHECK_FALSE(criterion->decide(constant_goal(2)).stop);
  const auto decision = criterion->decide(constant_goal(4));
  CHECK(decision.stop);
  REQUIRE(decision.paper);
  CHECK(decision.paper->intervals.size() == 1);
  CHECK(certified_bound(constant_goal(4), 0.99).epsilon == bound_after(4, 0.99));
  CHECK_FALSE(decision.runs_needed.has_value());
  auto broken = constant_goal(4);
  broken.add_mismatch();
  CHECK_FALSE(criterion->decide(broken).stop);
  auto lossy = constant_goal(4);
  lossy.add_lost();
  CHECK_FALSE(criterion->decide(lossy).stop);
  CHECK(criterion->decide(lossy).why == "a run was lost");
  auto open = constant_goal(4);
  open.add_clean_elsewhere();
  CHECK(open.clean() == 5);
  CHECK_FALSE(criterion->decide(open).stop);
  CHECK(criterion->decide(open).why == "a run ended in another state that the model admits");
  CHECK_FALSE(paper_stopped_at(open, spec.paper, 0.99).has_value());
}

TEST_CASE("paper: the first stop is the one of a criterion that looks after every run") {
  CriterionSpec spec;
  spec.kind = CriterionKind::kPaper;
  const auto criterion = make_criterion(spec);
  const auto whole = constant_goal(20);
  std::int64_t first = 0;
  for (std::int64_t runs = 1; runs <= 20 && first == 0; ++runs) {
    if (criterion->decide(constant_goal(runs)).stop) first = runs;
  }
  CHECK(first > 2);
  CHECK(paper_stopped_at(whole, spec.paper, spec.confidence_level) == first);
  CHECK_FALSE(paper_stopped_at(constant_goal(2), spec.paper, spec.confidence_level).has_value());
}

TEST_CASE("criteria: figures outside their range are the caller's fault") {
  CriterionSpec spec;
  spec.confidence_level = 1.0;
  CHECK_THROWS_AS(make_criterion(spec), base::ContractViolation);
  spec.kind = CriterionKind::kPaper;
  CHECK_THROWS_AS(make_criterion(spec), base::ContractViolation);
  spec = {};
  spec.epsilon = 0.0;
  CHECK_THROWS_AS(make_criterion(spec), base::ContractViolation);
}

TEST_CASE("tally: rows must fit the frame") {
  auto tally = constant_goal(1);
  CHECK_THROWS_AS(tally.add_clean(std::vector<double>{1.0}, std::vector<double>{0.5}),
                  base::ContractViolation);
}

}  // namespace
}  // namespace parallax::harness
