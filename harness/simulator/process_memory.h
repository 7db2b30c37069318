#pragma once

#include <sys/types.h>

#include <cstdint>

namespace parallax::harness {

/// The memory in bytes that the processes of a session hold just now (the resident sets of proc(5),
/// what they share counted for each); 0 where the system does not tell. What has left the session
/// is not counted. Address space is not looked at: runtimes reserve far more than they use.
std::uint64_t memory_of_session(pid_t leader);

}  // namespace parallax::harness
