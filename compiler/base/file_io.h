#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "compiler/base/diagnostic.h"

namespace parallax::base {

/// Reads a regular file of at most `limit` bytes. Missing: kFileNotFound (a usage error); a folder,
/// FIFO or device: kNotARegularFile; too large: kFileTooLarge; unreadable: kFileUnreadable.
Result<std::string> read_file(const std::filesystem::path& path, DiagnosticSink& sink,
                              std::size_t limit = std::size_t{64} << 20U);

/// Reads and registers the file under the name that the user wrote; refuses NUL bytes and invalid
/// UTF-8 with a located kInvalidText.
Result<FileId> load_text(const std::filesystem::path& path, SourceFiles& files,
                         DiagnosticSink& sink);

/// The same for a text that was read already, say from standard input.
Result<FileId> register_text(std::string name, std::string text, SourceFiles& files,
                             DiagnosticSink& sink);

/// Writes to a temporary neighbour, syncs, renames. Reports kFileNotWritable, and kNotARegularFile
/// for an existing folder, device or pipe.
Status write_file_atomically(const std::filesystem::path& path, std::string_view text,
                             DiagnosticSink& sink);

/// Writes the whole text to an open descriptor, going on after signals. False, with `errno`, if it
/// cannot be written.
bool write_all(int fd, std::string_view text);

}  // namespace parallax::base
