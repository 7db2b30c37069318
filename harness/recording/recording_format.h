#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <variant>

#include "harness/recording/recording.h"

namespace parallax::harness {

/// A recording as the bytes of its file (docs/recording.md).
std::string encode(const Recording& recording);

/// What is wrong with a file, and at which byte.
struct BadRecording {
  std::size_t byte = 0;
  std::string why;  // "the file ends within its head"
};

/// Takes nothing for granted: whatever the bytes are, there is an answer, in time and memory that
/// are linear in their number. Frames of what it returns are whole.
std::variant<Recording, BadRecording> decode_recording(std::string_view bytes);

}  // namespace parallax::harness
