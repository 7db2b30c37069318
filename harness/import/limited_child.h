#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace parallax::harness {

/// kTooLong: it takes too long, or has too much to say. kStopped: the stop flag was raised.
enum class ChildEnd : std::uint8_t { kAnswered, kNotStarted, kTooLong, kCrashed, kStopped };

struct ChildAnswer {
  ChildEnd end = ChildEnd::kAnswered;
  std::string bytes;
};

/// Runs `work` in a process of its own, with 30 s and 3 GiB, and returns its answer. The process
/// prints nothing and leaves nothing behind, so a library that reads a hostile file does no harm
/// here. With `opens_files` false the process can open none. `work` should throw nothing; an
/// exception counts as a crash. The process ends with the calling thread, however that ends, and
/// when `stop` is raised.
ChildAnswer answer_of_child(const std::function<std::string()>& work, std::size_t most_bytes,
                            bool opens_files, const std::atomic<bool>* stop = nullptr);

}  // namespace parallax::harness
