#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "compiler/base/diagnostic.h"
#include "harness/recording/recording.h"

namespace parallax::harness {

inline constexpr std::string_view kRecordingsFolder = "recordings";  // in a run folder

/// "recordings/1.4.rec"
std::string recording_name(std::int64_t trace, std::int64_t sample);
/// Trace and sample of "1.4.rec"; none for any other name.
std::optional<std::pair<std::int64_t, std::int64_t>> recording_id(std::string_view file_name);

/// Writes RUN_DIR/recordings/1.4.rec, and the folder where it is missing. Returns why that failed;
/// empty: it did not. The file appears under its name when it is whole; it is not synced, as a
/// simulation that is on record can be repeated.
std::string write_recording(const std::filesystem::path& run_dir, const Recording& recording);

/// The recording of a simulation. Without a sink: none, and `why` says so, where it is missing or
/// broken; for those who can do without.
std::optional<Recording> find_recording(const std::filesystem::path& run_dir, std::int64_t trace,
                                        std::int64_t sample, std::string& why);
/// Reports kNoRecording and kBadRecording; `make` is the command that makes one.
base::Result<Recording> read_recording(const std::filesystem::path& run_dir, std::int64_t trace,
                                       std::int64_t sample, const std::string& make,
                                       base::DiagnosticSink& sink);

}  // namespace parallax::harness
