#include "harness/simulator/process_simulator.h"

#include <fmt/format.h>

#include <utility>

#include "compiler/base/contract.h"
#include "harness/simulator/child_process.h"
#include "harness/simulator/protocol.h"

namespace parallax::harness {
namespace {

using Clock = ChildProcess::Clock;

constexpr double kActOverheadS = 5.0;  // beside the simulated time, when no act_timeout_s is given

Clock::time_point after(double seconds) {
  return Clock::now() +
         std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

std::string_view method_name(const RequestBody& body) {
  static constexpr std::string_view kNames[] = {"hello", "reset", "act", "observe", "close", "?"};
  return kNames[body.index()];
}

/// The other side understood us and says no: the scenario's fault, not a loss.
bool is_refusal(const ErrorReply& error) {
  return error.code == "unsupported" || error.code == "invalid_params";
}

}  // namespace

/// The link to one child, from its start to its loss.
class ProcessSimulator::Link {
 public:
  explicit Link(const ProcessOptions& options) : child_(options.command, options.stop) {}

  const std::string& start_error() const { return child_.start_error(); }

  /// The reply, or why there is none.
  std::variant<ReplyBody, std::string> ask(RequestBody body, double timeout_s) {
    const Request request{next_id_++, std::move(body)};
    const auto name = method_name(request.body);
    const auto deadline = after(timeout_s);
    if (!child_.write_line(encode_request(request), deadline)) {
      return fmt::format("it did not take `{}`", name);
    }
    std::string line;
    switch (child_.read_line(line, deadline, kMaxLineBytes)) {
      case ChildProcess::Wait::kLine:
        break;
      case ChildProcess::Wait::kTimeout:
        return fmt::format("no reply to `{}` within {} s", name, timeout_s);
      case ChildProcess::Wait::kEnd:
        return fmt::format("it ended during `{}`", name);
      case ChildProcess::Wait::kTooLong:
        return fmt::format("its reply to `{}` is longer than {} bytes", name, kMaxLineBytes);
      case ChildProcess::Wait::kStopped:
        return std::string("interrupted");
    }
    auto reply = decode_reply(line, request);
    if (const auto* malformed = std::get_if<Malformed>(&reply)) {
      return fmt::format("malformed reply to `{}`: {}", name, malformed->message);
    }
    return std::get<ReplyBody>(std::move(reply));
  }

  /// Ends the child and completes the reason of its loss.
  std::string lose(std::string reason, double grace_s) {
    // A child that has closed its output is usually about to end by itself: its own exit status
    // tells more than our signal.
    const auto ending = child_.end(after(grace_s));
    reason += fmt::format(" ({})", ending);
    const auto tail = child_.error_tail();
    if (!tail.empty()) reason += "; the end of its standard error:\n" + tail;
    return reason;
  }

  void close(double timeout_s) {
    const auto reply = ask(CloseRequest{}, timeout_s);
    child_.end(after(std::holds_alternative<ReplyBody>(reply) ? timeout_s : 0.0));
  }

 private:
  ChildProcess child_;
  std::int64_t next_id_ = 1;
};

ProcessSimulator::ProcessSimulator(ProcessOptions options) : options_(std::move(options)) {
  PARALLAX_REQUIRE(!options_.command.empty(), "a command with at least one word");
}

ProcessSimulator::~ProcessSimulator() { close(); }

void ProcessSimulator::close() {
  if (link_) link_->close(options_.close_timeout_s);
  link_.reset();
}

void ProcessSimulator::lose(std::string reason) {
  constexpr double kEndGraceS = 0.2;
  lost_reason_ = link_->lose(std::move(reason), kEndGraceS);
  link_.reset();
}

bool ProcessSimulator::ensure_started() {
  if (link_) return true;
  auto link = std::make_unique<Link>(options_);
  resets_ = 0;
  if (!link->start_error().empty()) {
    lost_reason_ = link->start_error();
    return false;
  }
  link_ = std::move(link);
  auto reply = link_->ask(HelloRequest{}, options_.hello_timeout_s);
  if (auto* reason = std::get_if<std::string>(&reply)) {
    lose(std::move(*reason));
    return false;
  }
  auto& body = std::get<ReplyBody>(reply);
  if (auto* hello = std::get_if<HelloReply>(&body)) {
    info_ = std::move(hello->info);
    return true;
  }
  lose(fmt::format("it refused `hello`: {}", std::get<ErrorReply>(body).message));
  return false;
}

SimulatorInfo ProcessSimulator::info() {
  if (ensure_started()) return info_;
  SimulatorInfo failed;
  failed.version = lost_reason_;
  return failed;
}

Outcome ProcessSimulator::outcome_of(std::variant<ReplyBody, std::string> reply) {
  if (auto* reason = std::get_if<std::string>(&reply)) {
    lose(std::move(*reason));
    return {SimStatus::kLost, lost_reason_, 0.0, {}};
  }
  auto& body = std::get<ReplyBody>(reply);
  if (auto* outcome = std::get_if<OutcomeReply>(&body)) return std::move(outcome->outcome);
  const auto& error = std::get<ErrorReply>(body);
  if (is_refusal(error)) return {SimStatus::kUnsupported, error.message, 0.0, {}};
  lose(fmt::format("{}: {}", error.code, error.message));
  return {SimStatus::kLost, lost_reason_, 0.0, {}};
}

Outcome ProcessSimulator::reset(const State& initial, std::uint64_t seed) {
  if (options_.recycle_after > 0 && resets_ >= options_.recycle_after) close();
  if (!ensure_started()) return {SimStatus::kLost, lost_reason_, 0.0, {}};
  ++resets_;
  return outcome_of(link_->ask(ResetRequest{initial, seed}, options_.reset_timeout_s));
}

Outcome ProcessSimulator::act(std::string_view action, const State& arguments,
                              double sim_time_limit_s) {
  if (!link_) return {SimStatus::kLost, lost_reason_, 0.0, {}};
  const double timeout_s = options_.act_timeout_s > 0.0
                               ? options_.act_timeout_s
                               : kActOverheadS + sim_time_limit_s / options_.min_real_time_factor;
  return outcome_of(
      link_->ask(ActRequest{std::string(action), arguments, sim_time_limit_s}, timeout_s));
}

State ProcessSimulator::observe() {
  const auto lost = [&] { return State{{std::string(kLostVariable), lost_reason_}}; };
  if (!link_) return lost();
  auto reply = link_->ask(ObserveRequest{}, options_.observe_timeout_s);
  if (auto* body = std::get_if<ReplyBody>(&reply)) {
    if (auto* observed = std::get_if<ObserveReply>(body)) return std::move(observed->state);
    const auto& error = std::get<ErrorReply>(*body);
    lose(fmt::format("{}: {}", error.code, error.message));
  } else {
    lose(std::move(std::get<std::string>(reply)));
  }
  return lost();
}

}  // namespace parallax::harness
