#include "harness/campaign/repetition.h"

#include <fmt/format.h>

#include <utility>

#include "harness/campaign/sample_runner.h"
#include "harness/campaign/trial.h"

namespace parallax::harness {

namespace {

using Was = Repetition::Outcome;

Repetition judged(const CleanSample& sample, SampleRecord again, bool is_fresh, bool is_clean) {
  Repetition out;
  out.is_fresh = is_fresh;
  if (again.status == SampleStatus::kLost) {
    out.outcome = Was::kLost;
    out.detail = again.reason;
    return out;
  }
  if (again.status != SampleStatus::kOk) {
    out.outcome = Was::kRefused;
    out.detail = again.reason;
    return out;
  }
  const auto difference = first_difference(sample.record, again);
  out.outcome = !is_clean ? Was::kNotClean : difference ? Was::kOtherBits : Was::kSame;
  if (difference) {
    out.detail = fmt::format("first at timepoint {} in {}: {}, now {}", difference->timepoint,
                             difference->variable, difference->a, difference->b);
  }
  return out;
}

std::string_view where(const Repetition& one) {
  return one.is_fresh ? "in a simulator that was started for it" : "after the others";
}

}  // namespace

RepetitionResult repeat_clean(const CleanSample& sample, SimulatorBench& bench) {
  RepetitionResult out;
  out.trace = sample.record.trace;
  out.sample = sample.record.sample;
  for (const bool is_fresh : {false, true}) {
    auto again = is_fresh ? bench.repeat_fresh(sample.maker, sample.record)
                          : bench.repeat(sample.maker, sample.record);
    if (!again) return out;
    std::optional<bool> is_clean = false;
    if (again->status == SampleStatus::kOk) is_clean = sample.is_clean(*again);
    if (!is_clean) return out;
    out.repetitions.push_back(judged(sample, *std::move(again), is_fresh, *is_clean));
  }
  return out;
}

std::vector<std::string> repetition_doubts(const RepetitionResult& result,
                                           const SimulatorInfo& simulator) {
  std::vector<std::string> out;
  for (const auto& one : result.repetitions) {
    const auto name = fmt::format(
        "simulation {}.{} was clean and, repeated {} with the same start "
        "and seed,",
        result.trace, result.sample, where(one));
    const auto detail = one.detail.empty() ? std::string() : fmt::format(" ({})", one.detail);
    switch (one.outcome) {
      case Was::kSame:
        break;
      case Was::kOtherBits:
        if (!may_repeat_losses(simulator)) break;
        out.push_back(
            fmt::format("{} is clean but not the same{}: the simulator says that it is "
                        "deterministic, and runs may affect each other",
                        name, detail));
        break;
      case Was::kNotClean:
        out.push_back(fmt::format("{} is not{}", name, detail));
        break;
      case Was::kLost:
        out.push_back(fmt::format("{} was lost{}", name, detail));
        break;
      case Was::kRefused:
        out.push_back(fmt::format("{} was refused{}", name, detail));
        break;
    }
  }
  return out;
}

void apply_repetition(CampaignResult& result) {
  const auto doubts = repetition_doubts(result.repetition, result.simulator);
  const bool holds = result.repetition.holds();
  for (auto& trace : result.traces) {
    if (trace.verdict == CampaignVerdict::kDiscrepancy) continue;
    trace.caveats.insert(trace.caveats.begin(), doubts.begin(), doubts.end());
    if (holds) continue;
    trace.claim = "nothing is claimed: a clean simulation is not clean when it is repeated";
    trace.certified_epsilon = 1.0;
    trace.stated.epsilon = 1.0;
    trace.shared.epsilon = 1.0;
    trace.verdict = CampaignVerdict::kInconclusive;
  }
}

}  // namespace parallax::harness
