#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>

#include "harness/simulator/simulator.h"

namespace parallax::harness {

/// Options for workers that are asked from another machine: they first say who they are, and show
/// that they are alive.
struct ServeOptions {
  std::string greeting = {};  // a first line, which nobody asked for; empty: none
  /// Above 0: the interval of beats (beat_line) while a request is under way [s].
  double beat_s = 0.0;
  /// Raised when whoever asked is gone before the answer. Raised by anybody else, say a batch
  /// system that cancels the job, it ends the serving without an answer: one of a simulator that
  /// was cut off amid its work would be about us, and not about the simulation.
  std::atomic<bool>* stop = nullptr;
};

/// The line that is written while the request of this number is under way.
std::string beat_line(std::int64_t id);
/// Is the line one of these? It carries no further information.
bool is_beat(std::string_view line);

/// Answers protocol requests (protocol.h) read from `in_fd` on `out_fd`, one at a time, until
/// `close`, end of file, or a line longer than 1 MiB. Writes nothing else to `out_fd` than what
/// `options` ask for. A malformed request gets an error reply and the next line is read.
/// Returns 0 after close or end of file, 1 when the line was too long or the descriptors failed
/// (a peer that has gone: ignore SIGPIPE).
int serve(Simulator& simulator, int in_fd, int out_fd, const ServeOptions& options = {});

}  // namespace parallax::harness
