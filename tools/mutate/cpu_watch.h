#pragma once

#include <atomic>
#include <ctime>
#include <mutex>
#include <thread>
#include <vector>

namespace parallax::tools {

/// Ends what a thread computes when it has used its processor time: raises a flag for it. The wall
/// clock would make answers depend on what else a machine does.
class CpuWatch {
 public:
  /// `stop` raises all flags.
  CpuWatch(std::size_t threads, const std::atomic<bool>& stop);
  ~CpuWatch();
  CpuWatch(const CpuWatch&) = delete;
  CpuWatch& operator=(const CpuWatch&) = delete;

  /// The calling thread, which is number `thread`, begins something that may take so long.
  void begin(std::size_t thread, double seconds);
  void end(std::size_t thread);
  std::atomic<bool>& flag(std::size_t thread) { return threads_[thread].flag; }

 private:
  struct Watched {
    std::atomic<bool> flag{false};
    bool active = false;
    clockid_t clock{};
    double until_s = 0.0;
  };
  void watch(const std::atomic<bool>& stop);

  std::mutex mutex_;
  std::vector<Watched> threads_;
  std::atomic<bool> done_{false};
  std::thread thread_;
};

}  // namespace parallax::tools
