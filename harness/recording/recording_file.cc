#include "harness/recording/recording_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <variant>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/descriptor.h"
#include "compiler/base/file_io.h"
#include "compiler/base/whole_number.h"
#include "harness/recording/recording_format.h"

namespace parallax::harness {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSuffix = ".rec";
constexpr std::size_t kLargestFile = std::size_t{24} << 20U;

/// A folder that really lies in the run folder: a link would lead elsewhere.
std::string make_folder(const fs::path& folder) {
  if (::mkdir(folder.c_str(), 0755) == 0) return {};
  if (errno != EEXIST) return std::strerror(errno);
  std::error_code error;
  if (fs::is_directory(fs::symlink_status(folder, error))) return {};
  return "it is no folder";
}

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(fs::symlink_status(path, error));
}

}  // namespace

std::string recording_name(std::int64_t trace, std::int64_t sample) {
  return fmt::format("{}/{}.{}{}", kRecordingsFolder, trace, sample, kSuffix);
}

std::optional<std::pair<std::int64_t, std::int64_t>> recording_id(std::string_view file_name) {
  if (!file_name.ends_with(kSuffix)) return std::nullopt;
  const auto id = file_name.substr(0, file_name.size() - kSuffix.size());
  const auto dot = id.find('.');
  if (dot == std::string_view::npos) return std::nullopt;
  const auto trace = base::whole_number<std::int64_t>(id.substr(0, dot));
  const auto sample = base::whole_number<std::int64_t>(id.substr(dot + 1));
  if (!trace || !sample || *trace < 1 || *sample < 1) return std::nullopt;
  if (file_name != fmt::format("{}.{}{}", *trace, *sample, kSuffix)) return std::nullopt;
  return std::pair(*trace, *sample);
}

std::string write_recording(const fs::path& run_dir, const Recording& recording) {
  if (auto error = make_folder(run_dir / kRecordingsFolder); !error.empty()) return error;
  const auto path = run_dir / recording_name(recording.trace, recording.sample);
  auto temporary = path;
  temporary += fmt::format(".{}.tmp", ::getpid());
  ::unlink(temporary.c_str());  // of an earlier process of this number
  constexpr int kNew = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
  const base::Descriptor fd(::open(temporary.c_str(), kNew, 0644));
  if (fd.get() < 0) return std::strerror(errno);
  if (!base::write_all(fd.get(), encode(recording)) ||
      ::rename(temporary.c_str(), path.c_str()) != 0) {
    std::string why = std::strerror(errno);
    ::unlink(temporary.c_str());
    return why;
  }
  return {};
}

std::optional<Recording> find_recording(const fs::path& run_dir, std::int64_t trace,
                                        std::int64_t sample, std::string& why) {
  const auto name = recording_name(trace, sample);
  why = "there is none";
  if (!is_there(run_dir / name)) return std::nullopt;
  base::DiagnosticSink unread;
  const auto bytes = base::read_file_of(run_dir, name, unread, kLargestFile);
  why = "the file cannot be read";
  if (!bytes) return std::nullopt;
  auto decoded = decode_recording(*bytes);
  if (const auto* bad = std::get_if<BadRecording>(&decoded)) {
    why = fmt::format("byte {}: {}", bad->byte, bad->why);
    return std::nullopt;
  }
  auto& recording = std::get<Recording>(decoded);
  if (recording.trace == trace && recording.sample == sample) return std::move(recording);
  why = fmt::format("it is that of simulation {}.{}", recording.trace, recording.sample);
  return std::nullopt;
}

base::Result<Recording> read_recording(const fs::path& run_dir, std::int64_t trace,
                                       std::int64_t sample, const std::string& make,
                                       base::DiagnosticSink& sink) {
  const auto name = recording_name(trace, sample);
  if (!is_there(run_dir / name)) {
    return sink
        .error_about(codes::kNoRecording, run_dir.string(), fmt::format("{}.{}", trace, sample))
        .help(fmt::format("Make it: `{}`", make));
  }
  std::string why;
  if (auto found = find_recording(run_dir, trace, sample, why)) return *std::move(found);
  return sink.error_about(codes::kBadRecording, (run_dir / name).string(), why)
      .help(fmt::format("Make it again: `{}`", make));
}

}  // namespace parallax::harness
