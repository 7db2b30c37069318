#pragma once

#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "compiler/base/descriptor.h"
#include "harness/simulator/pose_intake.h"
#include "harness/simulator/process_limits.h"
#include "harness/simulator/process_memory.h"
#include "harness/simulator/protocol.h"
#include "harness/simulator/simulator.h"

namespace parallax::harness {

/// One child process with pipes on its three standard descriptors, in a session of its own, so
/// that it can be ended together with everything it has started. Its other descriptors are closed.
/// The system kills it when the thread that made this object ends, however that comes about, so
/// that no child is left behind by a program that was killed; what the child has started itself
/// has to notice the end of its input.
class ChildProcess {
 public:
  using Clock = std::chrono::steady_clock;

  /// Starts `command` (first word looked up in PATH, no shell). When that fails `start_error` says
  /// why and nothing else may be called. `memory_mb` bounds what its session holds; 0: nothing
  /// does.
  ChildProcess(const std::vector<std::string>& command, std::int64_t memory_mb,
               const std::atomic<bool>* stop);
  ~ChildProcess();  // ends the process group
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  const std::string& start_error() const { return start_error_; }

  enum class Wait { kLine, kTimeout, kEnd, kTooLong, kTooMuchMemory, kStopped };
  /// Writes `line` and a newline. False when the child does not take it before `deadline`.
  bool write_line(std::string_view line, Clock::time_point deadline);
  /// Waits for one line of standard output; `line` is set for kLine only, without its newline.
  Wait read_line(std::string& line, Clock::time_point deadline, std::size_t max_bytes);

  /// Nobody can write to its standard output any more, as far as is known; asks and waits for
  /// nothing.
  bool has_hung_up() const;

  /// Closes the child's input, waits until it ends or `deadline`, then ends the group: TERM, two
  /// seconds, KILL. Returns how it ended: "exit status 3", "signal 9 (Killed)". Idempotent.
  std::string end(Clock::time_point deadline);
  /// The last lines of its standard error, at most 50, without the final newline.
  std::string error_tail() const;

 private:
  void start(const std::vector<std::string>& command);
  bool has_ended() const;
  bool wait_until_ended(Clock::time_point deadline);
  void drain_errors();
  bool poll_once(short output_events, Clock::time_point deadline);
  bool holds_too_much();
  bool stopped() const { return stop_ != nullptr && stop_->load(); }

  pid_t pid_ = -1;  // also the process group
  base::Descriptor input_, output_, errors_;
  std::int64_t memory_mb_;
  Clock::time_point memory_seen_ = Clock::now();
  std::optional<SessionMemory> memory_;  // none: nothing bounds it, or there is no process
  const std::atomic<bool>* stop_;
  std::string start_error_;
  std::string buffer_;      // read from standard output, not yet returned
  std::string error_text_;  // the end of standard error
  std::string ending_;
};

struct ProcessOptions : ProcessLimits {
  std::vector<std::string> command;         // looked up in PATH; no shell
  std::int64_t recycle_after = 0;           // resets after which the child is replaced; 0: never
  const std::atomic<bool>* stop = nullptr;  // waiting ends early, as a loss, when it is raised
};

/// A simulator in a child process that speaks newline-delimited JSON on its standard input and
/// output (protocol.h). The child gets a session of its own, no descriptor but the
/// three standard ones, and is watched by the clock of the wall.
///
/// On a timeout, the end of its output or a malformed line the child's process group is ended
/// (TERM, 2 s, KILL) and the request answers kLost with the reason, the exit status or signal and
/// the end of what it wrote to standard error. The next reset starts a new child. `observe` has no
/// status: a loss there is a state whose only variable is "lost" (kLostVariable).
class ProcessSimulator final : public Simulator {
 public:
  explicit ProcessSimulator(ProcessOptions options);
  ~ProcessSimulator() override;
  ProcessSimulator(const ProcessSimulator&) = delete;
  ProcessSimulator& operator=(const ProcessSimulator&) = delete;

  /// Starts the child if need be. When that fails the name is empty and `version` says why.
  SimulatorInfo info() override;
  Outcome reset(const State& initial, std::uint64_t seed) override;
  Outcome act(std::string_view action, const State& arguments, double sim_time_limit_s) override;
  State observe() override;
  void record_motion(double interval_s) override { record_interval_s_ = interval_s; }
  /// If it can `perform`, the next reset asks for all of it in one request, and what is asked for
  /// afterwards is answered from that. What one can that is not running is known at the reset.
  void announce(const AnnouncedActs& acts) override {
    if (link_ == nullptr || info_.can("perform")) announced_ = acts();
  }

 private:
  class Link;
  using PerformedRequest = std::variant<ResetRequest, ActRequest, ObserveRequest>;
  struct AnsweredAhead {
    PerformedRequest asked;
    SingleReply reply;
  };
  bool ensure_started();
  bool ask_for_description();
  void close();
  void lose(std::string reason);
  Outcome outcome_of(std::variant<ReplyBody, std::string> reply);
  double act_timeout_s(double sim_time_limit_s) const;
  Outcome perform(ResetRequest reset, std::vector<AnnouncedAct> acts);
  /// The answer that is there already; none, and a loss, where something else was asked.
  std::optional<ReplyBody> answered_ahead(const PerformedRequest& asked);

  ProcessOptions options_;
  std::unique_ptr<Link> link_;  // null: no child is running
  SimulatorInfo info_;
  std::string lost_reason_ = "it was not started";
  std::int64_t resets_ = 0;  // of this child
  double record_interval_s_ = 0.0;
  PoseIntake poses_;
  std::vector<AnnouncedAct> announced_;
  std::deque<AnsweredAhead> ahead_;
};

}  // namespace parallax::harness
