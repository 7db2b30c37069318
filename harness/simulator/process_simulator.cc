#include "harness/simulator/process_simulator.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <thread>
#include <utility>

#include "compiler/base/clock_time.h"
#include "compiler/base/contract.h"
#include "compiler/base/subprocess.h"
#include "harness/simulator/error_tail.h"
#include "harness/simulator/protocol.h"
#include "harness/simulator/protocol_check.h"

namespace parallax::harness {
namespace {

using std::chrono::milliseconds;

constexpr auto kTermGrace = milliseconds(2000);
constexpr auto kStoppedGrace = milliseconds(500);  // when everything is to end soon
constexpr int kPollSliceMs = 100;                  // how late the stop flag may be seen
constexpr auto kMemorySlice = milliseconds(250);   // how late too much memory may be seen
constexpr auto kReapSlice = milliseconds(5);
constexpr std::size_t kErrorBytes = std::size_t{1} << 14U;
constexpr std::size_t kErrorLines = 50;

/// A child that has gone must be an error of write(), not a signal that ends the program.
void ignore_sigpipe() {
  static std::once_flag once;
  std::call_once(once, [] { ::signal(SIGPIPE, SIG_IGN); });
}

std::string ending_text(const siginfo_t& info) {
  if (info.si_code == CLD_EXITED) return fmt::format("exit status {}", info.si_status);
  return fmt::format("signal {} ({})", info.si_status, ::strsignal(info.si_status));
}

using Clock = ChildProcess::Clock;

constexpr double kActOverheadS = 5.0;  // beside the simulated time, when no act_timeout_s is given

std::string_view method_name(const RequestBody& body) {
  static constexpr std::string_view kNames[] = {"hello", "reset",    "act", "observe",
                                                "close", "describe", "?",   "perform"};
  return kNames[body.index()];
}

}  // namespace

bool is_refusal(const ErrorReply& error) {
  // The numbers are those of JSON-RPC for an unknown method and for wrong parameters.
  return error.code == "unsupported" || error.code == "invalid_params" || error.code == "-32601" ||
         error.code == "-32602";
}

ChildProcess::ChildProcess(const std::vector<std::string>& command, std::int64_t memory_mb,
                           const std::atomic<bool>* stop)
    : memory_mb_(memory_mb), stop_(stop) {
  ignore_sigpipe();
  start(command);
}

ChildProcess::~ChildProcess() { end(Clock::now()); }

void ChildProcess::start(const std::vector<std::string>& command) {
  base::Pipe input, output, errors;
  if (!input.valid() || !output.valid() || !errors.valid()) {
    start_error_ = fmt::format("no pipe: {}", std::strerror(errno));
    return;
  }
  base::SpawnOptions options;
  options.input = input.read.get();
  options.output = output.write.get();
  options.errors = errors.write.get();
  options.own_session = true;
  const auto child = base::spawn(command, options);
  if (child.pid < 0) {
    start_error_ = fmt::format("cannot start `{}`: {}", command[0], std::strerror(child.error));
    return;
  }
  pid_ = child.pid;
  if (memory_mb_ != 0) memory_.emplace(pid_);
  input_ = std::move(input.write);
  output_ = std::move(output.read);
  errors_ = std::move(errors.read);
  for (const auto* end : {&input_, &output_, &errors_}) ::fcntl(end->get(), F_SETFL, O_NONBLOCK);
}

void ChildProcess::drain_errors() {
  char chunk[4096];
  while (errors_.valid()) {
    const auto count = ::read(errors_.get(), chunk, sizeof chunk);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return;  // nothing there now
    if (count == 0) return errors_.close();
    error_text_.append(chunk, static_cast<std::size_t>(count));
    if (error_text_.size() > 2 * kErrorBytes) {
      error_text_.erase(0, error_text_.size() - kErrorBytes);
    }
  }
}

/// Waits for the child to be ready in `output_events`' sense, for its errors, or a slice of time.
bool ChildProcess::poll_once(short output_events, Clock::time_point deadline) {
  pollfd fds[2] = {{output_events == POLLOUT ? input_.get() : output_.get(), output_events, 0},
                   {errors_.get(), POLLIN, 0}};  // poll skips negative descriptors
  const int ready = ::poll(fds, 2, base::milliseconds_left(deadline, kPollSliceMs));
  if (ready > 0 && fds[1].revents != 0) drain_errors();
  return ready > 0 && fds[0].revents != 0;
}

bool ChildProcess::holds_too_much() {
  if (!memory_ || Clock::now() < memory_seen_ + kMemorySlice) return false;
  memory_seen_ = Clock::now();
  return memory_->bytes() > base::bytes_of_mb(memory_mb_);
}

bool ChildProcess::write_line(std::string_view line, Clock::time_point deadline) {
  std::string text(line);
  text += '\n';
  std::string_view rest = text;
  while (!rest.empty()) {
    const auto count = ::write(input_.get(), rest.data(), rest.size());
    if (count > 0) {
      rest.remove_prefix(static_cast<std::size_t>(count));
    } else if (errno == EAGAIN) {
      if (stopped() || Clock::now() >= deadline) return false;
      poll_once(POLLOUT, deadline);
    } else if (errno != EINTR) {
      return false;
    }
  }
  return true;
}

ChildProcess::Wait ChildProcess::read_line(std::string& line, Clock::time_point deadline,
                                           std::size_t max_bytes) {
  std::size_t scanned = 0;
  for (;;) {
    const auto newline = buffer_.find('\n', scanned);
    if (newline != std::string::npos && newline <= max_bytes) {
      line = buffer_.substr(0, newline);
      buffer_.erase(0, newline + 1);
      return Wait::kLine;
    }
    if (buffer_.size() > max_bytes) return Wait::kTooLong;
    scanned = buffer_.size();
    if (stopped()) return Wait::kStopped;
    if (holds_too_much()) return Wait::kTooMuchMemory;
    if (Clock::now() >= deadline) return Wait::kTimeout;
    if (!poll_once(POLLIN, deadline)) continue;
    char chunk[1 << 14];
    const auto count = ::read(output_.get(), chunk, sizeof chunk);
    if (count == 0) return Wait::kEnd;
    if (count > 0) buffer_.append(chunk, static_cast<std::size_t>(count));
  }
}

bool ChildProcess::has_hung_up() const {
  pollfd at{output_.get(), POLLIN, 0};
  return ::poll(&at, 1, 0) > 0 && (at.revents & (POLLHUP | POLLERR)) != 0;
}

bool ChildProcess::has_ended() const {
  siginfo_t info{};
  // Not reaped yet: as long as the leader is a zombie its group's number cannot be taken over.
  return ::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         info.si_pid != 0;
}

bool ChildProcess::wait_until_ended(Clock::time_point deadline) {
  for (;;) {
    if (errors_.valid()) drain_errors();
    if (has_ended()) return true;
    if (Clock::now() >= deadline) return false;
    std::this_thread::sleep_for(kReapSlice);
  }
}

std::string ChildProcess::end(Clock::time_point deadline) {
  if (pid_ < 0) return ending_;
  input_.close();
  if (!wait_until_ended(deadline)) {
    ::kill(-pid_, SIGTERM);
    wait_until_ended(Clock::now() + (stopped() ? kStoppedGrace : kTermGrace));
  }
  // Also when the leader has ended: what it has started may still run.
  ::kill(-pid_, SIGKILL);
  siginfo_t info{};
  while (::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED) != 0 && errno == EINTR) {
  }
  ending_ = ending_text(info);
  drain_errors();
  output_.close();
  errors_.close();
  pid_ = -1;
  return ending_;
}

std::string ChildProcess::error_tail() const {
  std::string_view text = error_text_;
  while (!text.empty() && text.back() == '\n') text.remove_suffix(1);
  std::size_t begin = text.size();
  for (std::size_t lines = 0; lines < kErrorLines && begin != std::string_view::npos; ++lines) {
    begin = begin == 0 ? std::string_view::npos : text.rfind('\n', begin - 1);
  }
  return std::string(begin == std::string_view::npos ? text : text.substr(begin + 1));
}

/// The link to one child, from its start to its loss.
class ProcessSimulator::Link {
 public:
  explicit Link(const ProcessOptions& options)
      : memory_mb_(options.memory_mb), child_(options.command, options.memory_mb, options.stop) {}

  const std::string& start_error() const { return child_.start_error(); }

  /// The reply, or why there is none.
  std::variant<ReplyBody, std::string> ask(RequestBody body, double timeout_s) {
    const Request request{next_id_++, std::move(body)};
    const auto name = method_name(request.body);
    const auto deadline = base::from_now(timeout_s);
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
      case ChildProcess::Wait::kTooMuchMemory:
        return fmt::format("more than {} MiB of memory during `{}`", memory_mb_, name);
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
    const auto ending = child_.end(base::from_now(grace_s));
    reason += fmt::format(" ({})", ending);
    return reason + error_tail_words(child_.error_tail());
  }

  void close(double timeout_s) {
    const auto reply = ask(CloseRequest{}, timeout_s);
    child_.end(base::from_now(std::holds_alternative<ReplyBody>(reply) ? timeout_s : 0.0));
  }

 private:
  std::int64_t memory_mb_;
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
  ahead_.clear();
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
    // A description replaces lists of the handshake, which have to be right as well.
    auto faults = info_faults(info_);
    if (faults.empty() && info_.can("describe")) {
      if (!ask_for_description()) return false;
      faults = info_faults(info_);
    }
    if (faults.empty()) return true;
    lose(
        fmt::format("what it says of itself breaks the protocol, and `parallax adapter-check` "
                    "tells all of it: {}",
                    fmt::join(faults, "; ")));
    return false;
  }
  lose(fmt::format("it refused `hello`: {}", std::get<ErrorReply>(body).message));
  return false;
}

bool ProcessSimulator::ask_for_description() {
  auto reply = link_->ask(DescribeRequest{}, options_.hello_timeout_s);
  if (auto* reason = std::get_if<std::string>(&reply)) {
    lose(std::move(*reason));
    return false;
  }
  auto& body = std::get<ReplyBody>(reply);
  if (auto* described = std::get_if<DescribeReply>(&body)) {
    info_.parameters = std::move(described->info.parameters);
    info_.actions = std::move(described->info.actions);
    info_.instant_actions = std::move(described->info.instant_actions);
    info_.arguments = std::move(described->info.arguments);
    return true;
  }
  lose(fmt::format("it refused `describe`: {}", std::get<ErrorReply>(body).message));
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
  if (auto* done = std::get_if<OutcomeReply>(&body)) {
    poses_.take(*done);
    return std::move(done->outcome);
  }
  const auto& error = std::get<ErrorReply>(body);
  if (is_refusal(error)) return {SimStatus::kUnsupported, error.message, 0.0, {}};
  lose(fmt::format("{}: {}", error.code, error.message));
  return {SimStatus::kLost, lost_reason_, 0.0, {}};
}

Outcome ProcessSimulator::reset(const State& initial, std::uint64_t seed) {
  if (options_.recycle_after > 0 && resets_ >= options_.recycle_after) close();
  if (!ensure_started()) return {SimStatus::kLost, lost_reason_, 0.0, {}};
  ++resets_;
  const double interval_s = info_.scene ? record_interval_s_ : 0.0;
  poses_.begin(info_.scene ? &*info_.scene : nullptr, interval_s);
  ahead_.clear();
  auto acts = std::exchange(announced_, {});
  if (!acts.empty() && info_.can("perform")) {
    return perform({initial, seed, interval_s}, std::move(acts));
  }
  return outcome_of(link_->ask(ResetRequest{initial, seed, interval_s}, options_.reset_timeout_s));
}

double ProcessSimulator::act_timeout_s(double sim_time_limit_s) const {
  if (options_.act_timeout_s > 0.0) return options_.act_timeout_s;
  // The slower of the factors that the scenario and the simulator give.
  double factor = options_.min_real_time_factor;
  if (info_.min_real_time_factor > 0.0) factor = std::min(factor, info_.min_real_time_factor);
  return kActOverheadS + sim_time_limit_s / factor;
}

Outcome ProcessSimulator::perform(ResetRequest reset, std::vector<AnnouncedAct> acts) {
  PerformRequest asked;
  asked.requests.emplace_back(std::move(reset));
  asked.requests.emplace_back(ObserveRequest{});
  double timeout_s = options_.reset_timeout_s + options_.observe_timeout_s;
  for (AnnouncedAct& one : acts) {
    timeout_s += act_timeout_s(one.sim_time_limit_s) + options_.observe_timeout_s;
    asked.requests.emplace_back(
        ActRequest{std::move(one.action), std::move(one.arguments), one.sim_time_limit_s});
    asked.requests.emplace_back(ObserveRequest{});
  }
  auto reply = link_->ask(asked, timeout_s);
  auto* body = std::get_if<ReplyBody>(&reply);
  auto* performed = body == nullptr ? nullptr : std::get_if<PerformReply>(body);
  if (performed == nullptr) return outcome_of(std::move(reply));
  for (std::size_t i = 0; i < performed->replies.size(); ++i) {
    ahead_.push_back({std::move(asked.requests[i]), std::move(performed->replies[i])});
  }
  auto first = std::move(ahead_.front().reply);
  ahead_.pop_front();
  return outcome_of(
      std::visit([](auto&& one) { return ReplyBody(std::move(one)); }, std::move(first)));
}

std::optional<ReplyBody> ProcessSimulator::answered_ahead(const PerformedRequest& asked) {
  auto& front = ahead_.front();
  const auto* act = std::get_if<ActRequest>(&asked);
  const auto* known = std::get_if<ActRequest>(&front.asked);
  const bool same =
      front.asked.index() == asked.index() &&
      (act == nullptr || (act->action == known->action && act->arguments == known->arguments &&
                          act->sim_time_limit_s == known->sim_time_limit_s));
  if (!same) {
    lose("something else was announced than is asked for");
    return std::nullopt;
  }
  auto reply =
      std::visit([](auto&& one) { return ReplyBody(std::move(one)); }, std::move(front.reply));
  ahead_.pop_front();
  return reply;
}

Outcome ProcessSimulator::act(std::string_view action, const State& arguments,
                              double sim_time_limit_s) {
  if (!link_) return {SimStatus::kLost, lost_reason_, 0.0, {}};
  ActRequest asked{std::string(action), arguments, sim_time_limit_s};
  std::variant<ReplyBody, std::string> reply;
  if (!ahead_.empty()) {
    auto known = answered_ahead(asked);
    if (!known) return {SimStatus::kLost, lost_reason_, 0.0, {}};
    reply = *std::move(known);
  } else {
    reply = link_->ask(std::move(asked), act_timeout_s(sim_time_limit_s));
  }
  auto outcome = outcome_of(std::move(reply));
  if (outcome.status == SimStatus::kLost || outcome.status == SimStatus::kUnsupported) {
    return outcome;
  }
  auto fault = outcome_fault(action, outcome, sim_time_limit_s, info_);
  if (fault.empty()) return outcome;
  lose(std::move(fault));
  return {SimStatus::kLost, lost_reason_, 0.0, {}};
}

State ProcessSimulator::observe() {
  const auto lost = [&] { return State{{std::string(kLostVariable), lost_reason_}}; };
  if (!link_) return lost();
  const bool is_there = !ahead_.empty();
  auto known = is_there ? answered_ahead(ObserveRequest{}) : std::nullopt;
  if (is_there && !known) return lost();
  auto reply = known ? std::variant<ReplyBody, std::string>(*std::move(known))
                     : link_->ask(ObserveRequest{}, options_.observe_timeout_s);
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
