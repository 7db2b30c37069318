#pragma once

#include <atomic>
#include <mutex>
#include <thread>
#include <vector>

namespace parallax::tools {

/// Ends the computation of a thread when its processor time is used up, by raising a flag. With the
/// wall clock, results would depend on other work on the machine.
class CpuWatch {
 public:
  /// `stop` raises all flags.
  CpuWatch(std::size_t threads, const std::atomic<bool>& stop);
  ~CpuWatch();
  CpuWatch(const CpuWatch&) = delete;
  CpuWatch& operator=(const CpuWatch&) = delete;

  /// The calling thread, number `thread`, begins a computation that may take `seconds` of processor
  /// time.
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
