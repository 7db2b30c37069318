#include "harness/calibration/calibration.h"

#include <cmath>

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
  for (std::size_t i = 0; i + 1 < kSyntheticWords.size(); ++i) {
    out.push_back(
        {static_cast<SyntheticKind>(i), std::nullopt, true, std::string(kSyntheticWords[i])});
  }
  const auto two = SyntheticKind::kTwoTraces;
  out.push_back({two, Family::kAllTraces, true, "two traces, all-traces"});
  out.push_back({two, Family::kAllTraces, false, "two traces, number not known"});
  out.push_back({two, Family::kPerTrace, true, "two traces, per-trace"});
  return out;
}

std::optional<double> allowed_share(const CalibratedCriterion& criterion,
                                    const CalibratedWorld& world) {
  if (!criterion.is_judged) return std::nullopt;
  const double error = 1.0 - criterion.spec.confidence_level;
  const bool loses =
      world.kind == SyntheticKind::kLosing || world.kind == SyntheticKind::kCrashFirst;
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
      take(in_process_cell(criterion, world, options, options.loops), out.in_process);
    }
  }
  for (const auto& world : worlds) {
    for (const auto& criterion : criteria) {
      if (stopped() || options.protocol_loops == 0 || !has_campaign(world)) break;
      auto cell = protocol_cell(criterion, world, options, options.protocol_loops, sink);
      if (!cell) return sink.already_reported();
      take(*std::move(cell), out.protocol);
    }
  }
  out.complete = !stopped();
  return out;
}

}  // namespace parallax::harness
