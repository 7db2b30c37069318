#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "harness/cluster/program_identity.h"
#include "harness/simulator/process_simulator.h"
#include "harness/simulator/protocol.h"

namespace parallax::harness {

/// Lines that stood before the handshake of a worker: a shell's greeting, a batch system's remarks.
struct Banner {
  std::size_t lines = 0;
  std::string first;
};
inline constexpr std::size_t kMostBannerLines = 200;
inline constexpr std::size_t kMostBannerBytes = std::size_t{64} << 10U;

/// One worker that was started through a command, from its start to its loss. Time is measured here
/// alone: no clock of another machine has a part in anything.
class WorkerLink {
 public:
  struct Limits {
    double start_s = 120.0;   // until it has said who it is
    double silence_s = 30.0;  // without a sign of life while it is asked something
  };

  /// `interrupted`, which outlives the link, ends every wait.
  WorkerLink(const std::vector<std::string>& command, Limits limits,
             const std::atomic<bool>& interrupted);

  /// Waits until it has said who it is: that, or why it has not.
  std::variant<ProgramIdentity, std::string> greet();
  const Banner& banner() const { return banner_; }

  /// Its reply, or why there is none; then it is of no use any more.
  std::variant<ReplyBody, std::string> ask(RequestBody body);
  /// Not known to be gone. To be asked while it is asked nothing else.
  bool is_alive() const { return !child_.has_hung_up(); }

  /// Ends it, and completes the reason of its loss.
  std::string lose(std::string reason);

 private:
  ChildProcess child_;
  Limits limits_;
  Banner banner_;
  std::int64_t next_id_ = 1;
};

}  // namespace parallax::harness
