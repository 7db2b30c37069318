#include "tools/mutate/cpu_watch.h"

#include <pthread.h>

#include <chrono>

namespace parallax::tools {
namespace {

double seconds_of(clockid_t clock) {
  timespec now{};
  if (clock_gettime(clock, &now) != 0) return 0.0;
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

}  // namespace

CpuWatch::CpuWatch(std::size_t threads, const std::atomic<bool>& stop)
    : threads_(threads), thread_([this, &stop] { watch(stop); }) {}

CpuWatch::~CpuWatch() {
  done_.store(true);
  thread_.join();
}

void CpuWatch::begin(std::size_t thread, double seconds) {
  const std::lock_guard lock(mutex_);
  auto& one = threads_[thread];
  one.active = pthread_getcpuclockid(pthread_self(), &one.clock) == 0;
  one.until_s = one.active ? seconds_of(one.clock) + seconds : 0.0;
  one.flag.store(false);
}

void CpuWatch::end(std::size_t thread) {
  const std::lock_guard lock(mutex_);
  threads_[thread].active = false;
}

void CpuWatch::watch(const std::atomic<bool>& stop) {
  constexpr auto kLookEvery = std::chrono::milliseconds(50);
  while (!done_.load()) {
    {
      const std::lock_guard lock(mutex_);
      for (auto& one : threads_) {
        if (!one.active) continue;
        if (stop.load() || seconds_of(one.clock) > one.until_s) one.flag.store(true);
      }
    }
    std::this_thread::sleep_for(kLookEvery);
  }
}

}  // namespace parallax::tools
