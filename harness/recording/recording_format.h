#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <variant>

#include "harness/recording/recording.h"

namespace parallax::harness {

/// A recording as the bytes of its file (docs/reference/formats.md).
std::string encode(const Recording& recording);

/// The fault in a file, and the byte at which it is.
struct BadRecording {
  std::size_t byte = 0;
  std::string why;  // "the file ends within its head"
};

/// Decodes any bytes safely, in time and memory that are linear in their number. The frames of a
/// returned recording are complete.
std::variant<Recording, BadRecording> decode_recording(std::string_view bytes);

}  // namespace parallax::harness
