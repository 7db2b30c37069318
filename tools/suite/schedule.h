#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

namespace parallax::tools {

/// A case that waits for its turn.
struct Task {
  std::size_t index = 0;         // of the case
  std::optional<double> wall_s;  // that it took last time
  std::int64_t memory_mb = 0;    // that it needs
};

/// Hands out tasks to threads: those with unknown time first, then the longest first, so that no
/// long one is left for the end; only as many at once as the memory holds.
class Schedule {
 public:
  /// `memory_mb` 0: as many as there are threads.
  Schedule(std::vector<Task> tasks, std::int64_t memory_mb);

  /// The next task, when there is room for it; nothing when none is left. One that needs more than
  /// all the memory runs alone.
  std::optional<std::size_t> take();
  void done(std::size_t index);

 private:
  std::vector<Task> tasks_;  // waiting, in order
  std::vector<Task> running_;
  std::int64_t memory_mb_;
  std::int64_t used_mb_ = 0;
  std::mutex mutex_;
  std::condition_variable changed_;
};

}  // namespace parallax::tools
