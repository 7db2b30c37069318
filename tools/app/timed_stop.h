#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "compiler/base/clock_time.h"

namespace parallax::tools {

/// A flag that is raised when the time is over, or another flag is.
class TimedStop {
 public:
  TimedStop(double seconds, const std::atomic<bool>& other)
      : end_(base::from_now(seconds)), thread_([this, &other] { watch(other); }) {}
  ~TimedStop() {
    {
      const std::lock_guard lock(mutex_);
      done_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  TimedStop(const TimedStop&) = delete;
  TimedStop& operator=(const TimedStop&) = delete;

  std::atomic<bool>& flag() { return flag_; }

 private:
  void watch(const std::atomic<bool>& other) {
    constexpr auto kSlice = std::chrono::milliseconds(20);
    std::unique_lock lock(mutex_);
    while (!done_ && base::SteadyClock::now() < end_ && !other.load()) {
      changed_.wait_until(lock, std::min(end_, base::SteadyClock::now() + kSlice));
    }
    if (!done_) flag_.store(true);
  }

  std::atomic<bool> flag_{false};
  base::SteadyClock::time_point end_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool done_ = false;
  std::thread thread_;
};

}  // namespace parallax::tools
