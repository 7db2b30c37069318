#include "harness/campaign/sample_runner.h"

#include <fmt/format.h>

#include "compiler/base/utf8.h"
#include "harness/simulator/protocol.h"

namespace parallax::harness {
namespace {

/// One attempt at a start that is given. Fills what was seen as far as it came.
class Attempt {
 public:
  Attempt(const std::vector<ActionCall>& calls, Simulator& simulator, SampleRecord& record)
      : calls_(calls), simulator_(simulator), record_(record) {}

  /// kInvalidStart, kLost, kUnsupported, or kOk; none when abandoned.
  std::optional<SimStatus> run(const std::function<bool()>& abandoned) {
    record_.observations.clear();
    record_.outcomes.clear();
    record_.reason.clear();
    record_.digest.clear();
    const auto reset = simulator_.reset(record_.initial, record_.seed);
    if (reset.status == SimStatus::kFailed || reset.status == SimStatus::kTruncated) {
      return ended(SimStatus::kLost, "reset answered " + std::string(to_string(reset.status)));
    }
    if (reset.status != SimStatus::kOk) return ended(reset.status, reset.reason);
    if (const auto lost = observe()) return lost;
    for (const auto& call : calls_) {
      if (abandoned()) return std::nullopt;
      const auto outcome = simulator_.act(call.controller, call.arguments, call.time_limit_s);
      if (outcome.status == SimStatus::kInvalidStart) {
        return ended(SimStatus::kLost, "an action answered invalid_start");
      }
      if (outcome.status == SimStatus::kLost || outcome.status == SimStatus::kUnsupported) {
        return ended(outcome.status, outcome.reason);
      }
      record_.outcomes.push_back(
          {outcome.status, base::with_invalid_utf8_replaced(outcome.reason), outcome.sim_time_s});
      if (const auto lost = observe()) return lost;
    }
    record_.digest = digest_of(record_.observations.back());
    return SimStatus::kOk;
  }

 private:
  /// A process may write any bytes to its standard error; the journal holds text.
  SimStatus ended(SimStatus status, const std::string& reason) {
    record_.reason = base::with_invalid_utf8_replaced(reason);
    return status;
  }

  std::optional<SimStatus> observe() {
    auto state = simulator_.observe();
    if (const auto lost = state.find(kLostVariable); lost != state.end()) {
      const auto* reason = std::get_if<std::string>(&lost->second);
      return ended(SimStatus::kLost, reason != nullptr ? *reason : "lost while observing");
    }
    if (const auto name = first_not_finite(state); !name.empty()) {
      return ended(SimStatus::kLost, fmt::format("`{}` is not a finite number", name));
    }
    record_.observations.push_back(std::move(state));
    return std::nullopt;
  }

  static std::string digest_of(const State& state) {
    const auto found = state.find("digest");
    if (found == state.end()) return {};
    const auto* text = std::get_if<std::string>(&found->second);
    return text != nullptr ? *text : std::string();
  }

  const std::vector<ActionCall>& calls_;
  Simulator& simulator_;
  SampleRecord& record_;
};

/// A loss may be an accident of the machine: where the same start and seed give the same run, they
/// get a second chance.
std::optional<SimStatus> attempt_start(const std::vector<ActionCall>& calls, bool repeats_losses,
                                       Simulator& simulator, SampleRecord& record,
                                       const std::function<bool()>& abandoned) {
  Attempt attempt(calls, simulator, record);
  auto status = attempt.run(abandoned);
  if (status == SimStatus::kLost && repeats_losses && !abandoned()) {
    ++record.retries;
    status = attempt.run(abandoned);
  }
  if (status == SimStatus::kLost && abandoned()) return std::nullopt;
  return status;
}

SampleStatus sample_status(SimStatus status) {
  switch (status) {
    case SimStatus::kLost:
      return SampleStatus::kLost;
    case SimStatus::kInvalidStart:
      return SampleStatus::kRejected;
    case SimStatus::kUnsupported:
      return SampleStatus::kRefused;
    case SimStatus::kOk:
    case SimStatus::kFailed:
    case SimStatus::kTruncated:
      break;
  }
  return SampleStatus::kOk;
}

}  // namespace

std::string_view to_string(SampleStatus status) {
  switch (status) {
    case SampleStatus::kOk:
      return "ok";
    case SampleStatus::kLost:
      return "lost";
    case SampleStatus::kRejected:
      return "rejected";
    case SampleStatus::kRefused:
      break;
  }
  return "refused";
}

bool may_repeat_losses(const SimulatorInfo& simulator) {
  return simulator.seeds && simulator.determinism == "bitwise";
}

std::optional<SampleRecord> run_sample(const TracePlan& plan, std::int64_t sample,
                                       Simulator& simulator,
                                       const std::function<bool()>& abandoned) {
  SampleRecord record;
  record.trace = plan.trace.number;
  record.sample = sample;
  DrawKey key{plan.campaign_seed, plan.trace_key, DrawPhase::kCertify,
              static_cast<std::uint64_t>(sample), 0};
  for (;; ++record.attempt, ++key.attempt) {
    record.initial = plan.sampler.draw(key);
    record.seed = simulator_seed(key);
    const auto status =
        attempt_start(plan.calls, plan.repeats_losses, simulator, record, abandoned);
    if (!status) return std::nullopt;
    record.status = sample_status(*status);
    if (record.status != SampleStatus::kRejected) return record;
    if (++record.rejected >= plan.max_rejected_starts) return record;
    if (abandoned()) return std::nullopt;
  }
}

std::optional<SampleRecord> repeat_sample(const std::vector<ActionCall>& calls, bool repeats_losses,
                                          const SampleRecord& record, Simulator& simulator,
                                          const std::function<bool()>& abandoned) {
  SampleRecord again = record;
  again.phase = DrawPhase::kConfirm;
  again.retries = 0;
  const auto status = attempt_start(calls, repeats_losses, simulator, again, abandoned);
  if (!status) return std::nullopt;
  again.status = sample_status(*status);
  return again;
}

}  // namespace parallax::harness
