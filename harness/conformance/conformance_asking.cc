#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "harness/conformance/conformance_run.h"
#include "harness/simulator/protocol_check.h"

// Asking the simulator, and what is noted of its answers.

namespace parallax::harness {
namespace {

constexpr int kLossesToGiveUp = 3;
constexpr double kActOverhead_s = 5.0;

}  // namespace

void Conformance::find(bool is_fault, std::string text) {
  if (stopped() || !said_.insert(text).second) return;
  report_.findings.push_back({now_, is_fault, std::move(text)});
}

void Conformance::note(CheckKind kind, bool was_made, std::string what) {
  report_.checks.push_back({kind, was_made, std::move(what)});
}

void Conformance::lost(const std::string& trouble) {
  fault(trouble);
  ++losses_;
}

bool Conformance::given_up() const { return losses_ >= kLossesToGiveUp || stopped(); }

/// A process that has said hello. The faults of the handshake are those of the first one.
bool Conformance::connect() {
  if (probe_ && probe_->is_alive()) return true;
  if (given_up()) return false;
  probe_ = std::make_unique<ProtocolProbe>(options_.process);
  reset_before_ = false;
  if (!probe_->is_alive()) {
    losses_ = kLossesToGiveUp;
    fault("it does not start: " + probe_->trouble());
    return false;
  }
  const auto reply = ask(HelloRequest{}, options_.process.hello_timeout_s);
  if (!reply) return false;
  hello_wall_s_ = probe_->wall_s();
  const auto* hello = std::get_if<HelloReply>(&*reply);
  if (hello == nullptr) {
    const auto* error = std::get_if<ErrorReply>(&*reply);
    lost("it refused `hello`: " + (error != nullptr ? error->message : std::string()));
    probe_.reset();
    return false;
  }
  if (connected_once_) return true;
  report_.info = hello->info;
  if (report_.info.can("describe")) {
    const auto before = info_faults(hello->info);
    const auto described = ask(DescribeRequest{}, options_.process.hello_timeout_s);
    if (!described) return false;
    if (const auto* world = std::get_if<DescribeReply>(&*described)) {
      report_.info.parameters = world->info.parameters;
      report_.info.actions = world->info.actions;
      report_.info.instant_actions = world->info.instant_actions;
      report_.info.arguments = world->info.arguments;
      // Faults of lists that the description replaces; other faults are reported with it.
      const auto after = info_faults(report_.info);
      for (const auto& text : before) {
        if (std::find(after.begin(), after.end(), text) == after.end()) fault(text);
      }
    } else {
      fault("it says that it can `describe` and refuses it");
    }
  }
  connected_once_ = true;
  return true;
}

std::optional<ReplyBody> Conformance::ask(RequestBody body, double timeout_s, bool unknown_field) {
  auto reply = probe_->ask(std::move(body), timeout_s, unknown_field);
  if (!reply) lost(probe_->trouble());
  return reply;
}

std::optional<Outcome> Conformance::outcome_of(RequestBody body, double timeout_s,
                                               bool unknown_field) {
  if (!connect()) return std::nullopt;
  auto reply = ask(std::move(body), timeout_s, unknown_field);
  if (!reply) return std::nullopt;
  if (auto* done = std::get_if<OutcomeReply>(&*reply)) return std::move(done->outcome);
  const auto& error = std::get<ErrorReply>(*reply);
  if (is_refusal(error)) return Outcome{SimStatus::kUnsupported, error.message, 0.0, {}};
  return Outcome{SimStatus::kLost, fmt::format("{}: {}", error.code, error.message), 0.0, {}};
}

std::optional<Outcome> Conformance::reset(const State& start, std::uint64_t seed) {
  if (!connect()) return std::nullopt;
  const bool is_first = !std::exchange(reset_before_, true);
  auto outcome = outcome_of(ResetRequest{start, seed}, options_.process.reset_timeout_s);
  if (outcome) {
    (is_first ? first_reset_walls_s_ : later_reset_walls_s_).push_back(probe_->wall_s());
  } else if (is_first && probe_ && probe_->wall_s() >= options_.process.reset_timeout_s) {
    warn(
        "the first `reset` of a process was not answered in time: what takes long at the start "
        "belongs before the reply to `hello`; --start-limit and `reset_timeout_s` give more time");
  }
  return outcome;
}

double Conformance::act_timeout_s(double limit_s) const {
  double factor = options_.process.min_real_time_factor;
  if (report_.info.min_real_time_factor > 0.0) {
    factor = std::min(factor, report_.info.min_real_time_factor);
  }
  const auto own = options_.process.act_timeout_s;
  return own > 0.0 ? own : kActOverhead_s + limit_s / factor;
}

std::optional<Outcome> Conformance::act(const TriedAction& action, double limit_s) {
  auto outcome =
      outcome_of(ActRequest{action.controller, action.arguments, limit_s}, act_timeout_s(limit_s));
  if (!outcome) return outcome;
  if (!outcome->margins.empty()) has_margins_ = true;
  if (std::isfinite(outcome->sim_time_s)) {
    most_sim_time_said_s_ = std::max(most_sim_time_said_s_, outcome->sim_time_s);
  }
  if (auto wrong = outcome_fault(action.controller, *outcome, limit_s, report_.info);
      !wrong.empty()) {
    fault(std::move(wrong));
  }
  return outcome;
}

std::optional<State> Conformance::observe() {
  if (!connect()) return std::nullopt;
  auto reply = ask(ObserveRequest{}, options_.process.observe_timeout_s);
  if (!reply) return std::nullopt;
  if (auto* observed = std::get_if<ObserveReply>(&*reply)) {
    seen_.push_back(observed->state);
    return std::move(observed->state);
  }
  const auto& error = std::get<ErrorReply>(*reply);
  fault(fmt::format("`observe` gave the error {}: {}", error.code, error.message));
  return std::nullopt;
}

std::optional<RunRecord> Conformance::record(const State& start, std::uint64_t seed) {
  RunRecord run;
  const auto begun = reset(start, seed);
  if (!begun) return std::nullopt;
  if (!is_ready(*begun)) {
    fault(fmt::format("a start that was fine before is {}: {}", to_string(begun->status),
                      begun->reason));
    return std::nullopt;
  }
  auto state = observe();
  if (!state) return std::nullopt;
  run.outcomes.push_back(*begun);
  run.states.push_back(*std::move(state));
  for (const auto& action : actions_) {
    const auto done = act(action, action.time_limit_s);
    if (!done) return std::nullopt;
    if (done->status == SimStatus::kLost) {
      fault(fmt::format("`{}` was lost: {}", action.controller, done->reason));
      return std::nullopt;
    }
    acted_wall_s_ += probe_->wall_s();
    acted_sim_s_ += done->sim_time_s;
    state = observe();
    if (!state) return std::nullopt;
    run.outcomes.push_back(*done);
    run.states.push_back(*std::move(state));
  }
  return run;
}

std::optional<RunRecord> Conformance::performed(const State& start, std::uint64_t seed) {
  if (!connect()) return std::nullopt;
  PerformRequest asked;
  double timeout_s = options_.process.reset_timeout_s + options_.process.observe_timeout_s;
  asked.requests.emplace_back(ResetRequest{start, seed});
  asked.requests.emplace_back(ObserveRequest{});
  for (const auto& action : actions_) {
    timeout_s += act_timeout_s(action.time_limit_s) + options_.process.observe_timeout_s;
    asked.requests.emplace_back(
        ActRequest{action.controller, action.arguments, action.time_limit_s});
    asked.requests.emplace_back(ObserveRequest{});
  }
  const auto reply = ask(asked, timeout_s);
  if (!reply) return std::nullopt;
  const auto* done = std::get_if<PerformReply>(&*reply);
  if (done == nullptr) {
    fault("it says that it can `perform` and refuses it");
    return std::nullopt;
  }
  RunRecord run;
  for (const auto& one : done->replies) {
    if (const auto* outcome = std::get_if<OutcomeReply>(&one)) {
      run.outcomes.push_back(outcome->outcome);
    } else if (const auto* state = std::get_if<ObserveReply>(&one)) {
      run.states.push_back(state->state);
    } else {
      fault("a `perform` of what was fine before gave the error " + std::get<ErrorReply>(one).code);
      return std::nullopt;
    }
  }
  if (done->replies.size() == asked.requests.size()) return run;
  fault("a `perform` of what was fine before breaks off");
  return std::nullopt;
}

}  // namespace parallax::harness
