#pragma once

#include <bit>
#include <chrono>
#include <cstdint>
#include <utility>

#include "compiler/base/hash.h"

// Helpers that the steps of all engines share.

namespace parallax::harness {

/// No scene comes near this, in m, m/s or rad/s. Beyond it the state is on its way to infinity,
/// where an engine may abort the process on an assertion of its own.
inline constexpr double kLargestSane = 1e6;

/// Hash over the numbers of a state; bits count, so that -0.0 is not 0.0.
class StateDigest {
 public:
  void restart() { hash_ = base::kFnvStart; }
  void fold(double value) {
    hash_ = base::fnv1a64_word(hash_, std::bit_cast<std::uint64_t>(value));
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0;
};

/// While one exists, messages that the engine has for this thread are counted into `count` instead
/// of printed. The hooks of engines carry no context, so the thread that steps names the counter.
class MessageCounter {
 public:
  explicit MessageCounter(std::int64_t& count) : previous_(std::exchange(t_count_, &count)) {}
  ~MessageCounter() { t_count_ = previous_; }
  MessageCounter(const MessageCounter&) = delete;
  MessageCounter& operator=(const MessageCounter&) = delete;

  /// For the hook.
  static void add_one() {
    if (t_count_ != nullptr) ++*t_count_;
  }

 private:
  static inline thread_local std::int64_t* t_count_ = nullptr;
  std::int64_t* previous_;
};

/// Adds up the times of the stages of a step, if it is on.
class LapTimer {
 public:
  explicit LapTimer(bool on) : on_(on) {
    if (on_) start_ = Clock::now();
  }
  /// The time since the last lap, or since construction [s].
  void add_lap_to(double& seconds) {
    if (!on_) return;
    const Clock::time_point now = Clock::now();
    seconds += std::chrono::duration<double>(now - start_).count();
    start_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;
  bool on_;
  Clock::time_point start_;
};

}  // namespace parallax::harness
