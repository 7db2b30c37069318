#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "compiler/base/diagnostic.h"
#include "compiler/base/shown_text.h"

namespace parallax::base {

/// Reads a regular file of at most `limit` bytes. Missing: kFileNotFound (a usage error); a folder,
/// FIFO or device: kNotARegularFile; too large: kFileTooLarge; unreadable: kFileUnreadable.
Result<std::string> read_file(const std::filesystem::path& path, DiagnosticSink& sink,
                              std::size_t limit = std::size_t{64} << 20U);

/// Checks a path that a text names at `place`: it must be a readable regular file. With `or_folder`
/// a folder is accepted too. Reports at `place` the errors that read_file would report.
Status check_file(const std::filesystem::path& path, const SourceRange& place, DiagnosticSink& sink,
                  bool or_folder = false);

/// Reads and registers the file under the name that the user wrote; refuses NUL bytes and invalid
/// UTF-8 with a located kInvalidText.
Result<FileId> load_text(const std::filesystem::path& path, SourceFiles& files,
                         DiagnosticSink& sink);

/// The same for a text that was read already, say from standard input.
Result<FileId> register_text(std::string name, std::string text, SourceFiles& files,
                             DiagnosticSink& sink);

/// Writes to a temporary neighbour of a new name, syncs, renames. Reports kFileNotWritable, and
/// kNotARegularFile for an existing folder, device or pipe. Files that people open have another
/// form than kExact; tests/tools/output_gate_test.cc knows who writes exact ones.
Status write_file_atomically(const std::filesystem::path& path, std::string_view text,
                             DiagnosticSink& sink, TextForm form = TextForm::kExact);

/// Reports kOutputIsInput if writing `path` would replace a file that was read into `files`.
Status check_output(const std::filesystem::path& path, const SourceFiles& files,
                    DiagnosticSink& sink);

/// Calls write_file_atomically for an output that a command was asked for, after check_output.
Status write_output(const std::filesystem::path& path, std::string_view text,
                    const SourceFiles& files, DiagnosticSink& sink,
                    TextForm form = TextForm::kLines);

/// Hands a text over piece by piece, as it is made.
using TextPieces = std::function<void(const std::function<void(std::string_view)>&)>;
/// The same for a text that is never held as a whole; it is written byte by byte.
Status write_output(const std::filesystem::path& path, const TextPieces& pieces,
                    const SourceFiles& files, DiagnosticSink& sink);

/// Reads FOLDER/NAME, which must really lie there: a link that leads out is refused (kLoadOutside).
Result<std::string> read_file_of(const std::filesystem::path& folder, std::string_view name,
                                 DiagnosticSink& sink, std::size_t limit = std::size_t{64} << 20U);

/// Writes the whole text to an open descriptor, going on after signals. False, with `errno`, if it
/// cannot be written.
bool write_all(int fd, std::string_view text);

}  // namespace parallax::base
