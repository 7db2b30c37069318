#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "harness/simulator/protocol.h"
#include "harness/simulator/simulator.h"

namespace parallax::harness {

struct ProcessOptions {
  std::vector<std::string> command;  // looked up in PATH; no shell
  double hello_timeout_s = 60.0;
  double reset_timeout_s = 10.0;
  double act_timeout_s = 0.0;  // 0: 5 s + simulated limit / min_real_time_factor
  double observe_timeout_s = 2.0;
  double close_timeout_s = 2.0;
  double min_real_time_factor = 1.0;
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

 private:
  class Link;
  bool ensure_started();
  void close();
  void lose(std::string reason);
  Outcome outcome_of(std::variant<ReplyBody, std::string> reply);

  ProcessOptions options_;
  std::unique_ptr<Link> link_;  // null: no child is running
  SimulatorInfo info_;
  std::string lost_reason_ = "it was not started";
  std::int64_t resets_ = 0;  // of this child
};

}  // namespace parallax::harness
