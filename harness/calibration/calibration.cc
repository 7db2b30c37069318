#include "harness/calibration/calibration.h"

#include <algorithm>
#include <cmath>

#include "harness/confidence/criterion.h"

namespace parallax::harness {

bool CalibrationCell::is_within() const {
  if (!allowed || loops == 0) return true;
  const double error = std::sqrt(*allowed * (1.0 - *allowed) / static_cast<double>(loops));
  return share() <= *allowed + 4.0 * error;
}

std::vector<CalibratedCriterion> calibrated_criteria(double confidence_level, double epsilon) {
  std::vector<CalibratedCriterion> out;
  const auto add = [&](std::string name, CriterionKind kind, bool is_judged) {
    auto& added = out.emplace_back();
    added.name = std::move(name);
    added.spec.kind = kind;
    added.spec.confidence_level = confidence_level;
    added.spec.epsilon = epsilon;
    added.is_judged = is_judged;
  };
  add("clean-runs", CriterionKind::kCleanRuns, true);
  add("anytime", CriterionKind::kAnytime, true);
  add("clopper-pearson", CriterionKind::kClopperPearson, true);
  add("paper-literal", CriterionKind::kPaper, false);
  add("paper-repaired", CriterionKind::kPaper, false);
  out.back().spec.paper = paper_repaired();
  return out;
}

std::vector<CalibratedWorld> calibrated_worlds() {
  std::vector<CalibratedWorld> out;
  const auto add = [&](SyntheticKind kind, std::string name,
                       std::optional<Family> family = std::nullopt, bool is_counted = true) {
    out.push_back({kind, family, is_counted, std::move(name)});
  };
  for (auto kind = SyntheticKind::kByStart; kind < SyntheticKind::kTwoTraces;) {
    add(kind, std::string(to_string(kind)));
    kind = static_cast<SyntheticKind>(static_cast<std::size_t>(kind) + 1);
  }
  add(SyntheticKind::kStates, "three initial states");
  add(SyntheticKind::kLosingStates, "three initial states, losses");
  add(SyntheticKind::kWeightedStates, "three initial states, weights");
  add(SyntheticKind::kTwoTraces, "two traces, all-traces", Family::kAllTraces);
  add(SyntheticKind::kOneSound, "two traces, one sound", Family::kAllTraces);
  add(SyntheticKind::kOneFailing, "two traces, one left out", Family::kAllTraces);
  add(SyntheticKind::kOneFailing, "two traces, one left out, number not known", Family::kAllTraces,
      false);
  add(SyntheticKind::kTwoTraces, "two traces, per-trace", Family::kPerTrace);
  return out;
}

double calibrated_probability(const CalibratedCriterion& criterion, const CalibratedWorld& world,
                              int trace) {
  const auto& spec = criterion.spec;
  if (trace == 1 && world.kind == SyntheticKind::kOneSound) return 0.0;
  if (world.kind != SyntheticKind::kOneFailing) return spec.epsilon;
  if (trace == 1) return 1.0;
  auto shared = spec;
  // The paper's rule plans no number of runs.
  if (spec.kind == CriterionKind::kPaper) shared.kind = CriterionKind::kCleanRuns;
  const auto planned = planned_runs(shared);
  shared.share =
      SpendingRule(world.is_counted ? std::optional<std::int64_t>(2) : std::nullopt).share(2);
  Tally tally(RegressionFrame{});
  for (std::int64_t run = 0; run < planned; ++run) tally.add_clean_of_many();
  return stated_bound(tally, shared).epsilon;
}

bool is_false_claim(const CalibratedCriterion& criterion, const CalibratedWorld& world,
                    const std::vector<CalibratedTrace>& traces) {
  const double epsilon = criterion.spec.epsilon;
  const auto failed = [](const CalibratedTrace& one) { return one.is_discrepancy; };
  // The paper's rule claims each trace at its own level.
  if (world.family != Family::kAllTraces || criterion.spec.kind == CriterionKind::kPaper) {
    return std::any_of(traces.begin(), traces.end(), [&](const CalibratedTrace& one) {
      return one.passed && one.probability >= epsilon;
    });
  }
  const bool leaves_out = std::any_of(traces.begin(), traces.end(), failed);
  double worst = 0.0;
  for (const auto& one : traces) {
    if (!failed(one)) worst = std::max(worst, (leaves_out ? one.shared : one.stated).epsilon);
  }
  // A criterion that is met says that it has excluded epsilon, whatever it has seen.
  const bool all_passed = std::all_of(traces.begin(), traces.end(),
                                      [](const CalibratedTrace& one) { return one.passed; });
  if (worst <= epsilon || all_passed) worst = epsilon;
  return std::any_of(traces.begin(), traces.end(), [&](const CalibratedTrace& one) {
    return !failed(one) && one.probability >= worst;
  });
}

bool is_measured(const CalibratedCriterion& criterion, const CalibratedWorld& world) {
  return !has_states(world.kind) || criterion.spec.kind != CriterionKind::kPaper;
}

std::optional<double> allowed_share(const CalibratedCriterion& criterion,
                                    const CalibratedWorld& world) {
  if (!criterion.is_judged) return std::nullopt;
  const double error = 1.0 - criterion.spec.confidence_level;
  const bool loses = world.kind == SyntheticKind::kLosing ||
                     world.kind == SyntheticKind::kCrashFirst ||
                     world.kind == SyntheticKind::kLosingStates;
  const bool states_less = loses && criterion.spec.kind == CriterionKind::kCleanRuns;
  return states_less || world.family == Family::kPerTrace ? 2.0 * error : error;
}

bool has_campaign(const CalibratedWorld& world) { return !world.family || world.is_counted; }

bool CalibrationResult::is_within() const {
  for (const auto* cells : {&in_process, &protocol}) {
    for (const auto& cell : *cells) {
      if (!cell.is_within()) return false;
    }
  }
  return true;
}

base::Result<CalibrationResult> calibrate(const CalibrationOptions& options,
                                          const std::vector<CalibratedCriterion>& criteria,
                                          const std::vector<CalibratedWorld>& worlds,
                                          base::DiagnosticSink& sink) {
  CalibrationResult out;
  out.options = options;
  const auto stopped = [&] { return options.stop != nullptr && options.stop->load(); };
  const auto take = [&](CalibrationCell cell, std::vector<CalibrationCell>& cells) {
    if (options.progress) options.progress(cell);
    cells.push_back(std::move(cell));
  };
  for (const auto& world : worlds) {
    for (const auto& criterion : criteria) {
      if (stopped() || options.loops == 0) break;
      if (!is_measured(criterion, world)) continue;
      take(in_process_cell(criterion, world, options, options.loops), out.in_process);
    }
  }
  for (const auto& world : worlds) {
    for (const auto& criterion : criteria) {
      if (stopped() || options.protocol_loops == 0 || !has_campaign(world)) break;
      if (!is_measured(criterion, world)) continue;
      auto cell = protocol_cell(criterion, world, options, options.protocol_loops, sink);
      if (!cell) return sink.already_reported();
      take(*std::move(cell), out.protocol);
    }
  }
  out.complete = !stopped();
  return out;
}

}  // namespace parallax::harness
