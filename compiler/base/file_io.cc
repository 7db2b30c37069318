#include "compiler/base/file_io.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "compiler/base/descriptor.h"
#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/utf8.h"

namespace parallax::base {
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
  struct ::stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    const auto code = errno == ENOENT || errno == ENOTDIR ? DiagnosticCode::kFileNotFound
                                                          : DiagnosticCode::kFileUnreadable;
    return sink.error_about(code, path.string(), std::strerror(errno));
  }
  // Asked before opening: opening a FIFO would wait for a writer.
  if (!S_ISREG(status.st_mode)) {
    return sink.error_about(DiagnosticCode::kNotARegularFile, path.string());
  }
  const Descriptor fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!fd.valid()) {
    return sink.error_about(DiagnosticCode::kFileUnreadable, path.string(), std::strerror(errno));
  }
  std::string text;
  std::string chunk(std::size_t{1} << 16U, '\0');
  for (;;) {
    const auto count = ::read(fd.get(), chunk.data(), chunk.size());
    if (count < 0) {
      if (errno == EINTR) continue;
      return sink.error_about(DiagnosticCode::kFileUnreadable, path.string(), std::strerror(errno));
    }
    if (count == 0) return text;
    text.append(chunk, 0, static_cast<std::size_t>(count));
    if (text.size() > limit) {
      return sink.error_about(DiagnosticCode::kFileTooLarge, path.string(), limit);
    }
  }
}

Result<FileId> load_text(const std::filesystem::path& path, SourceFiles& files,
                         DiagnosticSink& sink) {
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
    return sink.error(DiagnosticCode::kInvalidText, SourceRange{id, at, at + 1});
  }
  return id;
}

Status write_file_atomically(const std::filesystem::path& path, std::string_view text,
                             DiagnosticSink& sink) {
  struct ::stat status {};
  // Renaming over a device or a pipe would replace it.
  if (::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode)) {
    return sink.error_about(DiagnosticCode::kNotARegularFile, path.string());
  }
  auto temporary = path;
  temporary += ".tmp";
  const auto fail = [&]() -> Status {
    const int reason = errno;
    ::unlink(temporary.c_str());
    return sink.error_about(DiagnosticCode::kFileNotWritable, path.string(), std::strerror(reason));
  };
  {
    const Descriptor fd(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
    if (!fd.valid() || !write_all(fd.get(), text) || ::fsync(fd.get()) != 0) return fail();
  }
  if (::rename(temporary.c_str(), path.c_str()) != 0) return fail();
  return Unit{};
}

}  // namespace parallax::base
