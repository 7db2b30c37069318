#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <set>
#include <vector>

namespace parallax::harness {

/// The children of a process, of all its threads; none where the system does not tell
/// (proc(5), `children`). Cost: linear in threads and children.
std::optional<std::vector<pid_t>> children_of(pid_t process);

/// Watches the memory that the processes of a session hold. What has left the session is not
/// counted. Address space is not looked at: runtimes reserve far more than they use.
class SessionMemory {
 public:
  explicit SessionMemory(pid_t leader) : leader_(leader) {}

  /// Bytes held just now: the resident sets of proc(5), what they share counted for each; 0 where
  /// the system does not tell. Cost: linear in the processes of the session; now and then in those
  /// of the machine.
  std::uint64_t bytes();

 private:
  using Clock = std::chrono::steady_clock;

  void search();

  pid_t leader_;
  std::set<pid_t> strays_;         // without a parent in the session
  Clock::time_point next_search_;  // of strays; the first one comes at once
};

}  // namespace parallax::harness
