#include <doctest/doctest.h>

#include "harness/confidence/criterion.h"
#include "harness/confidence/paper_rule.h"
#include "harness/confidence/rounding.h"
#include "harness/sampling/sampler.h"

namespace parallax::harness {
namespace {

Tally tally_of(std::int64_t clean, std::int64_t lost = 0, std::int64_t rejected = 0) {
  Tally tally({{"x"}, {{3, 4}}, {"y"}, {Interval{0, 1}}, {"Holding(box)", "Open(door)"}});
  for (std::int64_t run = 0; run < clean; ++run) {
    const CounterRng rng({.sample = static_cast<std::uint64_t>(run)});
    tally.add_clean(std::vector<double>{3 + rng.uniform(0)}, std::vector<double>{0.5});
  }
  for (std::int64_t i = 0; i < lost; ++i) tally.add_lost();
  tally.add_rejected(rejected);
  return tally;
}

TEST_CASE("claim: the sentence of a finished clean-runs trace") {
  CHECK(
      claim(tally_of(90), {}, Comparison::kEveryStep) ==
      "with 99 % confidence, fewer than 5 % of start states drawn uniformly from the start region "
      "give a discrepancy at any step (90 clean runs of 90), supposing that no run affects "
      "another");
}

TEST_CASE("claim: before the end, and with the paper's rule, it is the bound of the runs made") {
  CriterionSpec spec;
  CHECK(claim(tally_of(7), spec, Comparison::kEveryStep) ==
        "with 99 % confidence, fewer than 48.3 % of start states drawn uniformly from the start "
        "region give a discrepancy at any step (7 clean runs of 7), supposing that no run affects "
        "another");
  spec.kind = CriterionKind::kPaper;
  CHECK(claim(tally_of(90), spec, Comparison::kEveryStep).find("fewer than 4.99 % of") !=
        std::string::npos);
  CHECK(claim(tally_of(1), spec, Comparison::kEveryStep).find("fewer than 99 % of") !=
        std::string::npos);
}

TEST_CASE("claim: rejected starts narrow it to valid ones, lost runs widen it and are counted") {
  CHECK(claim(tally_of(90, 0, 3), {}, Comparison::kEveryStep).find("of valid start states drawn") !=
        std::string::npos);
  const auto sentence = claim(tally_of(175, 1), {}, Comparison::kEveryStep);
  CHECK(
      sentence ==
      "with 98 % confidence, fewer than 5 % of start states drawn uniformly from the start region "
      "give a discrepancy at any step (175 clean runs of 176, 1 lost run counted as a failure), "
      "supposing that no run affects another");
}

TEST_CASE("claim: nothing is claimed without clean runs or after a discrepancy") {
  CHECK(claim(tally_of(0), {}, Comparison::kEveryStep) == "nothing is claimed (0 clean runs of 0)");
  CHECK(claim(tally_of(0, 2), {}, Comparison::kEveryStep) ==
        "nothing is claimed (0 clean runs of 2, 2 lost runs counted as failures)");
  auto tally = tally_of(3);
  tally.add_mismatch();
  CHECK(claim(tally, {}, Comparison::kEveryStep) == "1 of 4 runs gave a discrepancy");
}

TEST_CASE("claim: what is never drawn is left out of the region that it is about") {
  const DrawnStarts uniform{{}, "its rim (`inset_m`: 0.05)"};
  CHECK(claim(tally_of(90), {}, Comparison::kEveryStep, uniform)
            .find("drawn uniformly from the start region without its rim (`inset_m`: 0.05) give") !=
        std::string::npos);
  const DrawnStarts by_law{"x normal", "its rim (`inset_m`: 0.05)"};
  CHECK(drawn_from("its region", by_law) ==
        "drawn from its region without its rim (`inset_m`: 0.05) by the scenario's law (x normal)");
}

TEST_CASE("claim: it is about what was compared") {
  CHECK(claim(tally_of(90), {}, Comparison::kFinal)
            .find("give a discrepancy in the last state (90") != std::string::npos);
}

TEST_CASE("claim: figures are rounded away from more than was shown") {
  CHECK(percent_up(0.05) == "5 %");
  CHECK(percent_up(0.049881) == "4.99 %");
  CHECK(percent_up(0.482053) == "48.3 %");
  CHECK(percent_up(0.0010001) == "0.101 %");
  CHECK(percent_up(0.9999) == "99.99 %");
  CHECK(percent_up(0.1) == "10 %");
  CHECK(percent_up(0.0) == "0 %");
}

TEST_CASE("caveats: rejected starts with their rate, lost runs, what the paper's figure omits") {
  const CriterionSpec spec;
  const auto caveats_of = [&](const Tally& tally) {
    return caveats(tally, spec, paper_stopped_at(tally, spec.paper, spec.confidence_level));
  };
  const auto found = caveats_of(tally_of(95, 2, 3));
  REQUIRE(found.size() == 2);
  CHECK(found[0] ==
        "the claim is about start states that are valid: 3 of 100 drawn were rejected (3 %)");
  CHECK(found[1] ==
        "2 runs were lost (crash, hang or invalid numbers), counted as discrepancies; the stated "
        "confidence is 98 % instead of 99 %, as the runs may end with either of two bounds");
  CriterionSpec paper;
  paper.kind = CriterionKind::kPaper;
  CHECK(caveats(tally_of(95, 2, 3), paper, 40).back() ==
        "the paper's rule says nothing of Holding(box), Open(door)");
  CHECK(caveats_of(tally_of(1)).empty());
}

TEST_CASE("caveats: many fluents without evidence are counted by their symbols") {
  std::vector<std::string> fluents;
  for (const std::string room : {"a", "b", "c", "d"}) {
    fluents.push_back("Lit(" + room + ")");
    fluents.push_back("Open(" + room + ",door)");
  }
  Tally tally({{"x"}, {{3, 4}}, {"y"}, {Interval{0, 1}}, fluents});
  tally.add_clean(std::vector<double>{3.5}, std::vector<double>{0.5});
  CHECK(caveats(tally, {}, 1).empty());
  CriterionSpec paper;
  paper.kind = CriterionKind::kPaper;
  const auto found = caveats(tally, paper, 1);
  REQUIRE(found.size() == 1);
  CHECK(found[0] == "the paper's rule says nothing of 8 fluents: 4 Lit, 4 Open");
}

}  // namespace
}  // namespace parallax::harness
