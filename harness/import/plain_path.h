#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace parallax::harness {

// Names of files in files of strangers.

/// A way down from a folder: plain names, no `..`, nothing hidden, no other scheme.
bool is_plain_path(const std::string& path);

/// Is anything on the way from `root` down to `path` a link? Links could lead out.
bool leads_through_link(const std::filesystem::path& root, const std::filesystem::path& path);

/// Reads all bytes of a regular file. Returns the fault if that fails: "there is no regular file
/// `x`".
std::optional<std::string> read_bounded(const std::filesystem::path& path, std::size_t most_bytes,
                                        std::string& bytes);

}  // namespace parallax::harness
