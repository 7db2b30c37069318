#include "harness/campaign/sample_runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>

#include "compiler/base/codes/scenarios.h"
#include "compiler/base/contract.h"
#include "compiler/base/suggest.h"
#include "compiler/base/utf8.h"
#include "harness/region/state_mapping.h"
#include "harness/simulator/protocol.h"
#include "harness/world/arguments.h"
#include "harness/world/step_length.h"

namespace parallax::harness {
namespace {

class SimulatorThrew : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Asks a simulator, which may be a user's own code. Broken promises of this program go on to main.
template <typename Request>
auto asked(const Request& request) {
  try {
    return request();
  } catch (const WorkerGone&) {
    throw;
  } catch (const base::ContractViolation&) {
    throw;
  } catch (const std::exception& thrown) {
    throw SimulatorThrew(thrown.what());
  } catch (...) {
    throw SimulatorThrew("something that is no std::exception");
  }
}

/// One attempt at a start that is given. Fills what was seen as far as it came.
class Attempt {
 public:
  Attempt(ActionSource& actions, Simulator& simulator, SampleRecord& record)
      : actions_(actions), simulator_(simulator), record_(record) {}

  /// kInvalidStart, kLost, kUnsupported, or kOk; none when abandoned.
  std::optional<SimStatus> run(const std::function<bool()>& abandoned) {
    record_.observations.clear();
    record_.outcomes.clear();
    record_.reason.clear();
    record_.digest.clear();
    try {
      return simulate(abandoned);
    } catch (const SimulatorThrew& thrown) {
      return ended(SimStatus::kLost, fmt::format("the simulator threw \"{}\"", thrown.what()));
    }
  }

 private:
  std::optional<SimStatus> simulate(const std::function<bool()>& abandoned) {
    announce();
    const auto reset = asked([&] { return simulator_.reset(record_.initial, record_.seed); });
    if (reset.status == SimStatus::kFailed || reset.status == SimStatus::kTruncated) {
      return ended(SimStatus::kLost, "reset answered " + std::string(to_string(reset.status)));
    }
    if (reset.status != SimStatus::kOk) return ended(reset.status, reset.reason);
    if (const auto lost = observe()) return lost;
    actions_.begin(record_);
    while (const auto* call = actions_.next(record_)) {
      if (abandoned()) return std::nullopt;
      const auto outcome = asked(
          [&] { return simulator_.act(call->controller, call->arguments, call->time_limit_s); });
      if (outcome.status == SimStatus::kInvalidStart) {
        return ended(SimStatus::kLost, "an action answered invalid_start");
      }
      if (outcome.status == SimStatus::kLost || outcome.status == SimStatus::kUnsupported) {
        return ended(outcome.status, outcome.reason);
      }
      record_.outcomes.push_back(
          {outcome.status, recorded_words(outcome.reason), outcome.sim_time_s,
           record_.path ? base::with_invalid_utf8_replaced(outcome.object) : std::string(),
           outcome.margins});
      if (const auto lost = observe()) return lost;
    }
    record_.digest = digest_of(record_);
    return SimStatus::kOk;
  }

  void announce() {
    const auto* calls = actions_.known();
    if (calls == nullptr) return;
    simulator_.announce([calls] {
      std::vector<AnnouncedAct> acts;
      for (const ActionCall& call : *calls) {
        acts.push_back({call.controller, call.arguments, call.time_limit_s});
      }
      return acts;
    });
  }

  /// A process may write any bytes to its standard error.
  SimStatus ended(SimStatus status, const std::string& reason) {
    record_.reason = recorded_words(reason);
    return status;
  }

  std::optional<SimStatus> observe() {
    auto state = asked([&] { return simulator_.observe(); });
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

  ActionSource& actions_;
  Simulator& simulator_;
  SampleRecord& record_;
};

/// Actions that are known from the start.
class CallList final : public ActionSource {
 public:
  explicit CallList(const std::vector<ActionCall>& calls) : calls_(calls) {}
  void begin(SampleRecord& /*record*/) override { next_ = 0; }
  const ActionCall* next(SampleRecord& /*record*/) override {
    return next_ < calls_.size() ? &calls_[next_++] : nullptr;
  }
  const std::vector<ActionCall>* known() const override { return &calls_; }

 private:
  const std::vector<ActionCall>& calls_;
  std::size_t next_ = 0;
};

/// The controller's name for an argument of the plan; none if it is not taken.
std::optional<std::string> taken_as(const ActionBinding& binding, const std::string& name) {
  if (!binding.from_plan) return name;
  for (const auto& [from, to] : *binding.from_plan) {
    if (name == from) return to;
    if (name.starts_with(from + ".")) return to + name.substr(from.size());
  }
  return std::nullopt;
}

/// An event of the trace, taken apart, and what the plan says of it.
struct PlannedOccurrence {
  GroundFluent event;
  const PlannedEvent& planned;
};

ActionCall call_for(const ActionBinding& binding, const PlannedOccurrence& at) {
  ActionCall call{with_arguments(binding.controller, at.event), binding.arguments,
                  binding.time_limit_s};
  for (auto& [name, value] : call.arguments) {
    if (auto* text = std::get_if<std::string>(&value)) *text = with_arguments(*text, at.event);
  }
  for (const auto& [name, value] : at.planned.arguments) {
    if (const auto taken = taken_as(binding, name)) call.arguments[*taken] = value;
  }
  return call;
}

/// Reports required arguments of the built-in simulator's controller that are missing. Returns
/// false if it reported any.
bool check_required(const ActionBinding& binding, const PlannedOccurrence& at,
                    const ActionCall& call, const ControllerSpec& controller,
                    base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  for (const auto& argument : controller.arguments) {
    if (!argument.required || call.arguments.contains(std::string(argument.name))) continue;
    sink.error(codes::kMissingArgument, binding.source, at.event.text, call.controller,
               argument.name);
  }
  return sink.error_count() == errors_before;
}

/// Values that the plan gave, and what they make of those of the scenario.
class ValueChecker {
 public:
  explicit ValueChecker(const WorldSpec& world) : world_(world), layout_(lay_out(world)) {}

  void check(const ActionBinding& binding, const PlannedOccurrence& at, const ActionCall& call,
             const ControllerSpec& controller, base::DiagnosticSink& sink) const {
    const auto report = [&](const std::string& name, const std::string& fault) {
      if (comes_from_plan(binding, at, name))
        return report_plan_value(binding, at, call, controller, name, fault, sink);
      const auto own = binding.argument_sources.find(name);
      const auto place = own == binding.argument_sources.end() ? binding.source : own->second;
      auto error = sink.error(codes::kBadWorld, place,
                              fmt::format("actions/{}/{}", binding.event, name), fault);
      const auto& source = at.planned.source;
      error.note(source.empty() ? fmt::format("for the event `{}`", at.event.text)
                                : fmt::format("for the event `{}` of {}", at.event.text, source));
    };
    for (const auto& [name, value] : call.arguments) {
      const auto* argument = find_argument(controller, name);
      const auto fault =
          argument == nullptr ? std::string("is none that it takes") : fault_of(*argument, value);
      if (!fault.empty()) return report(name, fault);
    }
    if (const auto fault = wrong_call(controller, call.arguments, world_, layout_)) {
      return report(fault->name, fault->text);
    }
    check_steps(binding, at, call, controller, sink);
  }

 private:
  static bool comes_from_plan(const ActionBinding& binding, const PlannedOccurrence& at,
                              const std::string& name) {
    const auto& given = at.planned.arguments;
    return !at.planned.source.empty() &&
           std::any_of(given.begin(), given.end(),
                       [&](const auto& one) { return taken_as(binding, one.first) == name; });
  }

  /// Speeds that the plan gives; those of the scenario were looked at when it was read.
  void check_steps(const ActionBinding& binding, const PlannedOccurrence& at,
                   const ActionCall& call, const ControllerSpec& controller,
                   base::DiagnosticSink& sink) const {
    const bool gives_speed = std::any_of(
        controller.arguments.begin(), controller.arguments.end(), [&](const ArgumentSpec& one) {
          return is_speed(one) && comes_from_plan(binding, at, std::string(one.name));
        });
    if (!gives_speed) return;  // traces are many
    for (const LongStep& one : long_steps(controller, call.arguments, world_, layout_)) {
      if (!comes_from_plan(binding, at, one.argument)) continue;
      sink.warning(codes::kLongStep, binding.source,
                   fmt::format("`{}` of `{}`, by the plan", one.argument, at.event.text),
                   one.speed_m_s, 1e3 * one.step_m, 1e3 * world_.solver.timestep_s, one.thin_body,
                   1e3 * one.thickness_m);
    }
  }

  /// The plan's perform is at fault, not the scenario.
  void report_plan_value(const ActionBinding& binding, const PlannedOccurrence& at,
                         const ActionCall& call, const ControllerSpec& controller,
                         const std::string& name, const std::string& fault,
                         base::DiagnosticSink& sink) const {
    auto error = sink.error_about(codes::kBadWorld, at.planned.source,
                                  fmt::format("`{}` of `{}`", name, at.event.text), fault);
    error.note(binding.source, fmt::format("the plan's value goes to `{}` here", call.controller));
    error.help(
        "Correct the value in the plan, or take another one with `from_plan` of the action.");
    const auto* argument = find_argument(controller, name);
    const auto* text = std::get_if<std::string>(&call.arguments.at(name));
    if (argument == nullptr || text == nullptr) return;
    const auto near = base::nearest_name(*text, names_for(*argument, world_, layout_));
    if (near) error.fix(fmt::format("replace `{}` with `{}`", *text, *near));
  }

  std::string fault_of(const ArgumentSpec& argument, const Value& value) const {
    if (is_name(argument)) {
      const auto* text = std::get_if<std::string>(&value);
      return text == nullptr ? "is not a name" : wrong_name(argument, *text, world_, layout_);
    }
    const auto number = as_number(value);
    return number ? wrong_number(argument, *number) : "is not a number";
  }

  const WorldSpec& world_;
  WorldLayout layout_;
};

const ActionBinding* action_of(const Scenario& scenario, const GroundFluent& event) {
  const auto found =
      std::find_if(scenario.actions.begin(), scenario.actions.end(),
                   [&](const ActionBinding& action) { return action.event == event.symbol; });
  return found == scenario.actions.end() ? nullptr : &*found;
}

}  // namespace

/// A loss may be an accident of the machine: where the same start and seed give the same run, they
/// get a second chance. What a simulator took back comes of them, and would come again.
std::optional<SimStatus> simulate_start(ActionSource& actions, bool repeats_losses,
                                        Simulator& simulator, SampleRecord& record,
                                        const std::function<bool()>& abandoned) {
  Attempt attempt(actions, simulator, record);
  auto status = attempt.run(abandoned);
  if (status == SimStatus::kLost && repeats_losses && !is_of_the_solver(record) && !abandoned()) {
    ++record.retries;
    status = attempt.run(abandoned);
  }
  if (status == SimStatus::kLost && abandoned()) return std::nullopt;
  return status;
}

namespace {

DrawKey search_key(std::uint64_t campaign_seed, std::uint64_t trace_key, std::int64_t sample) {
  return {campaign_seed, trace_key, DrawPhase::kSearch, static_cast<std::uint64_t>(sample), 0};
}

}  // namespace

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

std::optional<ActionCall> call_of(const Scenario& scenario, const GroundFluent& event,
                                  const State& planned) {
  const auto* binding = action_of(scenario, event);
  if (binding == nullptr) return std::nullopt;
  const PlannedEvent said{{}, planned};
  return call_for(*binding, {event, said});
}

bool may_repeat_losses(const SimulatorInfo& simulator) {
  return simulator.seeds && simulator.determinism == "bitwise";
}

std::string wrong_draw(const SampleRecord& record, const Sampler& sampler,
                       std::uint64_t campaign_seed, std::uint64_t trace_key) {
  if (record.searched) {
    // Its start is compared when the search proposes it again.
    const bool same =
        record.seed == simulator_seed(search_key(campaign_seed, trace_key, record.sample));
    return same ? "" : "its seed is not that of its number";
  }
  DrawKey key{campaign_seed, trace_key, DrawPhase::kCertify,
              static_cast<std::uint64_t>(record.sample),
              static_cast<std::uint64_t>(record.attempt)};
  if (record.initial != sampler.draw(key)) return "its start is not that of its number";
  if (sampler.law() != nullptr) {
    std::int64_t redrawn = 0;
    // No journal has more attempts than that many were allowed, which a forged one might.
    constexpr std::int64_t kMostAttempts = 1'000'000;
    if (record.attempt > kMostAttempts) return "it has too many attempts";
    for (key.attempt = 0; key.attempt <= static_cast<std::uint64_t>(record.attempt);
         ++key.attempt) {
      redrawn += sampler.draw_counting(key, nullptr).refused;
    }
    key.attempt = static_cast<std::uint64_t>(record.attempt);
    if (record.redrawn != redrawn)
      return "its count of refused candidates is not that of its number";
  }
  if (record.seed != simulator_seed(key)) return "its seed is not that of its number";
  return {};
}

std::optional<SampleRecord> run_sample(const TracePlan& plan, std::int64_t sample,
                                       Simulator& simulator,
                                       const std::function<bool()>& abandoned) {
  SampleRecord record;
  record.trace = plan.trace->number;
  record.sample = sample;
  record.start_state = plan.start_state;
  DrawKey key{plan.campaign_seed, plan.trace_key, DrawPhase::kCertify,
              static_cast<std::uint64_t>(sample), 0};
  CallList calls(plan.calls);
  for (;; ++record.attempt, ++key.attempt) {
    auto drawn = plan.sampler.draw_counting(key, nullptr);
    record.initial = std::move(drawn.start);
    record.redrawn += drawn.refused;
    record.seed = simulator_seed(key);
    const auto status = simulate_start(calls, plan.repeats_losses, simulator, record, abandoned);
    if (!status) return std::nullopt;
    record.status = sample_status(*status);
    if (record.status != SampleStatus::kRejected) return record;
    if (++record.rejected >= plan.max_rejected_starts) return record;
    if (abandoned()) return std::nullopt;
  }
}

std::optional<SampleRecord> run_chosen(const TracePlan& plan, std::int64_t sample, State start,
                                       Simulator& simulator,
                                       const std::function<bool()>& abandoned) {
  SampleRecord record;
  record.trace = plan.trace->number;
  record.sample = sample;
  record.start_state = plan.start_state;
  record.searched = true;
  record.initial = std::move(start);
  record.seed = simulator_seed(search_key(plan.campaign_seed, plan.trace_key, sample));
  CallList calls(plan.calls);
  const auto status = simulate_start(calls, plan.repeats_losses, simulator, record, abandoned);
  if (!status) return std::nullopt;
  record.status = sample_status(*status);
  return record;
}

std::optional<SampleRecord> TraceSamples::make(std::int64_t sample, Simulator& simulator,
                                               const std::function<bool()>& abandoned) const {
  auto record = run_sample(*plan_, sample, simulator, abandoned);
  if (record) record->visit = visits_;
  return record;
}

std::optional<SampleRecord> TraceSamples::repeat(const SampleRecord& record, Simulator& simulator,
                                                 const std::function<bool()>& abandoned) const {
  return repeat_sample(plan_->calls, plan_->repeats_losses, record, simulator, abandoned);
}

std::optional<SampleRecord> repeat_sample(const std::vector<ActionCall>& calls, bool repeats_losses,
                                          const SampleRecord& record, Simulator& simulator,
                                          const std::function<bool()>& abandoned) {
  SampleRecord again = record;
  again.phase = DrawPhase::kConfirm;
  again.retries = 0;
  CallList again_calls(calls);
  const auto status = simulate_start(again_calls, repeats_losses, simulator, again, abandoned);
  if (!status) return std::nullopt;
  again.status = sample_status(*status);
  return again;
}

base::Result<std::vector<ActionCall>> action_calls(const Scenario& scenario,
                                                   const CampaignTrace& trace,
                                                   base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  const bool built_in = scenario.simulator.is_built_in();
  const ValueChecker values(scenario.world);
  std::vector<ActionCall> calls;
  for (std::size_t t = 0; t < trace.event_count(); ++t) {
    const PlannedOccurrence at{ground_fluent(trace.event(t)), trace.plan[t]};
    const auto* binding = action_of(scenario, at.event);
    if (binding == nullptr) {
      sink.error(codes::kEventWithoutAction, scenario.actions_source, at.event.symbol);
      continue;
    }
    calls.push_back(call_for(*binding, at));
    const auto& call = calls.back();
    // Unknown controllers were reported when the scenario was checked against the simulator.
    const auto* controller = built_in ? find_controller(call.controller) : nullptr;
    if (controller == nullptr) continue;
    if (check_required(*binding, at, call, *controller, sink)) {
      values.check(*binding, at, call, *controller, sink);
    }
  }
  if (sink.error_count() != errors_before) return sink.already_reported();
  return calls;
}

}  // namespace parallax::harness
