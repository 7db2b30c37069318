// A smaller calibration table: does it distinguish criteria that keep their error level from
// others?

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "harness/calibration/calibration.h"
#include "harness/confidence/criterion.h"

namespace parallax::harness {
namespace {

// At these few runs suffice, so that loops are short.
constexpr double kLevel = 0.9, kEpsilon = 0.2;

CalibrationOptions few(std::int64_t loops) {
  CalibrationOptions options;
  options.confidence_level = kLevel;
  options.epsilon = kEpsilon;
  options.loops = loops;
  options.protocol_loops = 0;
  return options;
}

CalibratedWorld world_of(SyntheticKind kind) {
  for (auto& world : calibrated_worlds()) {
    if (world.kind == kind) return world;
  }
  FAIL("no such world");
  return {};
}

TEST_CASE("every criterion that is judged keeps its word in every world, in a smaller table") {
  base::DiagnosticSink sink;
  const auto result =
      calibrate(few(400), calibrated_criteria(kLevel, kEpsilon), calibrated_worlds(), sink);
  REQUIRE(result.has_value());
  CHECK(result->is_within());
  CHECK(result->in_process.size() == 12 * 5 + 3 * 3);
  for (const auto& cell : result->in_process) {
    CAPTURE(cell.world);
    CAPTURE(cell.criterion);
    CHECK(cell.loops == 400);
    CHECK(cell.allowed.has_value() == !cell.criterion.starts_with("paper"));
    // The rule of the paper stops after two or three runs in this quiet world, whatever it says,
    // but never where a run was lost.
    const bool loses = cell.world == "losses" || cell.world == "crash-first";
    CHECK(
        (!cell.world.starts_with("three initial states") || !cell.criterion.starts_with("paper")));
    if (cell.criterion == "paper-literal" && !loses) CHECK(cell.share() > 0.3);
  }
  const auto markdown = calibration_markdown(*result);
  CHECK(markdown.find("| crash-first | 20 %, 10 % |") != std::string::npos);
  CHECK(markdown.find("**") == std::string::npos);
}

TEST_CASE("clean-runs is as often wrong as it says, not less: the table can tell") {
  const auto criteria = calibrated_criteria(kLevel, kEpsilon);
  const auto cell =
      in_process_cell(criteria[0], world_of(SyntheticKind::kByStart), few(4000), 4000);
  const double expected = std::pow(1.0 - kEpsilon, 11);  // after 11 clean runs
  CHECK(std::abs(cell.share() - expected) < 4.0 * std::sqrt(expected * (1 - expected) / 4000));
}

/// A faulty criterion: it ignores lost runs, or stops too early.
class WrongCriterion final : public ConfidenceCriterion {
 public:
  WrongCriterion(const CriterionSpec& spec, bool forgets_losses)
      : spec_(spec), right_(make_criterion(spec)), forgets_losses_(forgets_losses) {}
  Decision decide(const Tally& tally) const override {
    auto decision = right_->decide(tally);
    decision.stop = forgets_losses_ ? tally.clean() >= planned_runs(spec_)
                                    : 2 * tally.runs() >= planned_runs(spec_);
    return decision;
  }
  CriterionKind kind() const override { return spec_.kind; }

 private:
  CriterionSpec spec_;
  std::unique_ptr<ConfidenceCriterion> right_;
  bool forgets_losses_;
};

TEST_CASE("a criterion that stops after half of its runs is found out where all of it is claimed") {
  auto wrong = calibrated_criteria(kLevel, kEpsilon)[0];
  wrong.make = [](const CriterionSpec& spec) {
    return std::make_unique<WrongCriterion>(spec, false);
  };
  for (const auto& world : calibrated_worlds()) {
    // Two traces that never go wrong together rarely both pass; one of them alone has its share.
    const bool together = world.family == Family::kAllTraces;
    if (together && world.kind != SyntheticKind::kOneSound) continue;
    CAPTURE(world.name);
    CHECK_FALSE(in_process_cell(wrong, world, few(400), 400).is_within());
  }
  base::DiagnosticSink sink;
  const auto result = calibrate(few(200), {wrong}, calibrated_worlds(), sink);
  REQUIRE(result.has_value());
  CHECK_FALSE(result->is_within());
  CHECK(calibration_markdown(*result).find("**") != std::string::npos);
}

TEST_CASE("a criterion that forgets lost runs is found out where runs are lost, and only there") {
  auto wrong = calibrated_criteria(kLevel, kEpsilon)[0];
  wrong.make = [](const CriterionSpec& spec) {
    return std::make_unique<WrongCriterion>(spec, true);
  };
  for (const auto kind :
       {SyntheticKind::kByStart, SyntheticKind::kLosing, SyntheticKind::kCrashFirst}) {
    CAPTURE(to_string(kind));
    CHECK(in_process_cell(wrong, world_of(kind), few(400), 400).is_within() ==
          (kind == SyntheticKind::kByStart));
  }
}

TEST_CASE("two traces together are claimed at the level of one, each by itself at less") {
  const auto criterion = calibrated_criteria(kLevel, kEpsilon)[0];
  std::map<std::string, double> shares;
  for (const auto& world : calibrated_worlds()) {
    if (world.family)
      shares[world.name] = in_process_cell(criterion, world, few(4000), 4000).share();
  }
  const double noise = 4.0 * std::sqrt(0.09 / 4000);
  // With a sound trace beside it the other decides: the whole error, and no more, is spent.
  const double expected = std::pow(1.0 - kEpsilon, 11);
  CHECK(std::abs(shares.at("two traces, one sound") - expected) < noise);
  CHECK(shares.at("two traces, all-traces") <= 0.1 + noise);
  CHECK(shares.at("two traces, one left out") <= 0.05 + noise);
  CHECK(shares.at("two traces, one left out") > 0.02);
  CHECK(shares.at("two traces, one left out, number not known") <= 0.1 + noise);
  // 0.17 is to be expected, of two traces that fail in different runs.
  CHECK(shares.at("two traces, per-trace") > 0.12);
}

TEST_CASE("three initial states in random orders err nearly as often as one, losses or not") {
  const auto criteria = calibrated_criteria(kLevel, kEpsilon);
  const auto states = world_of(SyntheticKind::kStates);
  const auto clean = in_process_cell(criteria[0], states, few(4000), 4000);
  // Eleven runs: three orders of all three states, and two of the next.
  const double order = 1.0 * 0.8 * 0.6;
  const double expected = order * order * order * (0.8 + 0.6 + 0.48) / 3.0;
  CHECK(std::abs(clean.share() - expected) < 4.0 * std::sqrt(0.09 / 4000));
  CHECK(clean.share() <= 0.1);
  for (const auto& criterion : criteria) {
    if (!criterion.is_judged) continue;
    const auto losing = world_of(SyntheticKind::kLosingStates);
    CHECK(in_process_cell(criterion, losing, few(2000), 2000).is_within());
  }
}

TEST_CASE("initial states of weights err as often as one, and the weights are heeded") {
  const auto criteria = calibrated_criteria(kLevel, kEpsilon);
  const auto weighted = world_of(SyntheticKind::kWeightedStates);
  const auto clean = in_process_cell(criteria[0], weighted, few(4000), 4000);
  // Eleven runs, each from a state by its weight.
  CHECK(std::abs(clean.share() - std::pow(1.0 - kEpsilon, 11)) < 4.0 * std::sqrt(0.09 / 4000));
  for (const auto& criterion : criteria) {
    if (!criterion.is_judged) continue;
    CHECK(in_process_cell(criterion, weighted, few(2000), 2000).is_within());
  }
}

TEST_CASE("the table in the documentation is what the command computes") {
  std::ifstream in(std::string(PARALLAX_SOURCE_DIR) + "/docs/internals/statistics.md");
  std::ostringstream text;
  text << in.rdbuf();
  // One row of it, which is quick to compute.
  CalibrationOptions options;
  base::DiagnosticSink sink;
  const auto criteria = calibrated_criteria(options.confidence_level, options.epsilon);
  const auto cell =
      in_process_cell(criteria[0], world_of(SyntheticKind::kNoisy), options, options.loops);
  std::ostringstream row;
  row.setf(std::ios::fixed);
  row.precision(2);
  row << "| noisy | 1 % | " << 100.0 * cell.share() << " %";
  CHECK_MESSAGE(text.str().find(row.str()) != std::string::npos, row.str());
}

TEST_CASE("each simulator goes wrong as often as it is told to") {
  constexpr int kRuns = 4000;
  constexpr double kP = 0.2;
  for (std::size_t i = 0; i < kSyntheticWords.size(); ++i) {
    const auto kind = static_cast<SyntheticKind>(i);
    if (kind == SyntheticKind::kSlow) continue;  // it takes its time
    SyntheticSimulator simulator({kind, kP, 7, {}, false});
    int wrong = 0, valid = 0;
    for (int run = 0; run < kRuns; ++run) {
      const double cells = has_states(kind) ? static_cast<double>(kSyntheticStates) : 1.0;
      const double x = kSyntheticStart_m + cells * (run + 0.5) / kRuns;
      if (simulator.reset({{"box.x", x}}, static_cast<std::uint64_t>(run)).status !=
          SimStatus::kOk) {
        continue;
      }
      ++valid;
      const bool of_second = kind == SyntheticKind::kOneSound || kind == SyntheticKind::kOneFailing;
      wrong +=
          simulator.act(of_second ? "push-right" : "push-left", {}, 1.0).status == SimStatus::kOk
              ? 0
              : 1;
    }
    CAPTURE(kSyntheticWords[i]);
    CHECK(valid == (kind == SyntheticKind::kRefusing ? kRuns / 2 : kRuns));
    CHECK(std::abs(wrong - kP * valid) < 4.9 * std::sqrt(valid * kP * (1 - kP)));
  }
}

}  // namespace
}  // namespace parallax::harness
