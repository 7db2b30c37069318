#pragma once

#include "harness/simulator/simulator.h"

namespace parallax::harness {

/// Answers protocol requests (protocol.h) read from `in_fd` on `out_fd`, one at a time, until
/// `close`, end of file, or a line longer than 1 MiB. Writes nothing else to `out_fd`. A malformed
/// request gets an error reply and the next line is read.
/// Returns 0 after close or end of file, 1 when the line was too long or the descriptors failed
/// (a peer that has gone: ignore SIGPIPE).
int serve(Simulator& simulator, int in_fd, int out_fd);

}  // namespace parallax::harness
