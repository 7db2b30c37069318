#include "compiler/base/file_io.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "compiler/base/codes/files.h"
#include "compiler/base/codes/texts.h"
#include "compiler/base/descriptor.h"
#include "compiler/base/open_texts.h"
#include "compiler/base/path_gate.h"
#include "compiler/base/utf8.h"

namespace parallax::base {
namespace {

/// Is the path a link to an open file of a process, such as /dev/stdout?
bool leads_to_open_file(std::filesystem::path path) {
  constexpr int kMostLinks = 40;
  for (int links = 0; links < kMostLinks; ++links) {
    std::error_code error;
    const auto folder = std::filesystem::weakly_canonical(path.parent_path() / ".", error);
    if (folder.native().starts_with("/proc/")) return true;
    const auto target = std::filesystem::read_symlink(path, error);
    if (error) return false;
    path = path.parent_path() / target;
  }
  return false;
}

}  // namespace

bool write_all(int fd, std::string_view text) {
  while (!text.empty()) {
    const auto written = ::write(fd, text.data(), text.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      return false;
    }
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

Result<std::string> read_file(const std::filesystem::path& path, DiagnosticSink& sink,
                              std::size_t limit) {
  if (const auto* edited = ReadOpenTexts::find(path)) {
    if (edited->size() > limit) return sink.error_about(codes::kFileTooLarge, path.string(), limit);
    return *edited;
  }
  struct ::stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    const auto code =
        errno == ENOENT || errno == ENOTDIR ? codes::kFileNotFound : codes::kFileUnreadable;
    return sink.error_about(code, path.string(), std::strerror(errno));
  }
  // Asked before opening: opening a FIFO would wait for a writer.
  if (!S_ISREG(status.st_mode)) {
    return sink.error_about(codes::kNotARegularFile, path.string());
  }
  const Descriptor fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!fd.valid()) {
    return sink.error_about(codes::kFileUnreadable, path.string(), std::strerror(errno));
  }
  std::string text;
  std::string chunk(std::size_t{1} << 16U, '\0');
  for (;;) {
    const auto count = ::read(fd.get(), chunk.data(), chunk.size());
    if (count < 0) {
      if (errno == EINTR) continue;
      return sink.error_about(codes::kFileUnreadable, path.string(), std::strerror(errno));
    }
    if (count == 0) return text;
    text.append(chunk, 0, static_cast<std::size_t>(count));
    if (text.size() > limit) {
      return sink.error_about(codes::kFileTooLarge, path.string(), limit);
    }
  }
}

Status check_file(const std::filesystem::path& path, const SourceRange& place, DiagnosticSink& sink,
                  bool or_folder) {
  struct ::stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    if (errno == ENOENT || errno == ENOTDIR) {
      return sink.error(codes::kFileNotFound, place, "no file `" + path.string() + "`");
    }
    return sink.error(codes::kFileUnreadable, place, std::strerror(errno));
  }
  if (or_folder && S_ISDIR(status.st_mode)) return Unit{};
  if (!S_ISREG(status.st_mode)) return sink.error(codes::kNotARegularFile, place);
  if (::access(path.c_str(), R_OK) != 0) {
    return sink.error(codes::kFileUnreadable, place, std::strerror(errno));
  }
  return Unit{};
}

Result<FileId> load_text(const std::filesystem::path& path, SourceFiles& files,
                         DiagnosticSink& sink) {
  files.note_input(path.string());  // also one that cannot be read: the answer depends on it
  auto text = read_file(path, sink);
  if (!text) return sink.already_reported();
  return register_text(path.string(), std::move(*text), files, sink);
}

Result<FileId> register_text(std::string name, std::string text, SourceFiles& files,
                             DiagnosticSink& sink) {
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  const auto bad = std::min(text.find('\0'), first_invalid_utf8(text));
  const bool invalid = bad != text.size();
  const auto id = files.add(std::move(name), std::move(text));
  if (invalid) {
    const auto at = static_cast<std::uint32_t>(bad);
    return sink.error(codes::kInvalidText, SourceRange{id, at, at + 1});
  }
  return id;
}

namespace {

Status write_pieces_atomically(const std::filesystem::path& path, const TextPieces& pieces,
                               DiagnosticSink& sink) {
  struct ::stat status {};
  // Renaming over a device or a pipe would replace it, and over /dev/stdout that link.
  if (::stat(path.c_str(), &status) == 0 &&
      (!S_ISREG(status.st_mode) || leads_to_open_file(path))) {
    return sink.error_about(codes::kNotARegularFile, path.string());
  }
  // The name must be unused: an existing file may be another's, or a link to one.
  std::filesystem::path temporary;
  int opened = -1;
  for (int attempt = 0; opened < 0 && attempt < 100; ++attempt) {
    temporary = path;
    temporary += "." + std::to_string(::getpid()) + "-" + std::to_string(attempt) + ".tmp";
    constexpr int kNew = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
    opened = ::open(temporary.c_str(), kNew, 0644);
    if (opened < 0 && errno != EEXIST) break;
  }
  if (opened < 0) {
    return sink.error_about(codes::kFileNotWritable, path.string(), std::strerror(errno));
  }
  const auto fail = [&]() -> Status {
    const int reason = errno;
    ::unlink(temporary.c_str());
    return sink.error_about(codes::kFileNotWritable, path.string(), std::strerror(reason));
  };
  {
    const Descriptor fd(opened);
    int reason = 0;
    pieces([&](std::string_view piece) {
      if (reason == 0 && !write_all(fd.get(), piece)) reason = errno;
    });
    if (reason == 0 && ::fsync(fd.get()) != 0) reason = errno;
    errno = reason;
    if (reason != 0) return fail();
  }
  if (::rename(temporary.c_str(), path.c_str()) != 0) return fail();
  return Unit{};
}

TextPieces one_piece(std::string_view text) {
  return [text](const std::function<void(std::string_view)>& take) { take(text); };
}

}  // namespace

Status write_file_atomically(const std::filesystem::path& path, std::string_view text,
                             DiagnosticSink& sink, TextForm form) {
  if (form == TextForm::kExact) return write_pieces_atomically(path, one_piece(text), sink);
  return write_pieces_atomically(path, one_piece(shown(text, form)), sink);
}

Status check_output(const std::filesystem::path& path, const SourceFiles& files,
                    DiagnosticSink& sink) {
  const auto& inputs = files.inputs();
  const bool is_input = std::any_of(inputs.begin(), inputs.end(), [&](const std::string& input) {
    std::error_code error;  // of a path that does not exist
    return std::filesystem::equivalent(path, input, error);
  });
  if (is_input) return sink.error_about(codes::kOutputIsInput, path.string());
  return Unit{};
}

Status write_output(const std::filesystem::path& path, std::string_view text,
                    const SourceFiles& files, DiagnosticSink& sink, TextForm form) {
  if (!check_output(path, files, sink)) return sink.already_reported();
  return write_file_atomically(path, text, sink, form);
}

Status write_output(const std::filesystem::path& path, const TextPieces& pieces,
                    const SourceFiles& files, DiagnosticSink& sink) {
  if (!check_output(path, files, sink)) return sink.already_reported();
  return write_pieces_atomically(path, pieces, sink);
}

Result<std::string> read_file_of(const std::filesystem::path& folder, std::string_view name,
                                 DiagnosticSink& sink, std::size_t limit) {
  const auto path = folder / name;
  if (!lies_below(path, folder)) {
    return sink.error_about(codes::kLoadOutside, path.string(), real_path(path).string());
  }
  return read_file(path, sink, limit);
}

}  // namespace parallax::base
