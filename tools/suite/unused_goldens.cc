#include "tools/suite/unused_goldens.h"

#include <algorithm>
#include <fstream>
#include <set>
#include <system_error>

#include "compiler/base/path_gate.h"
#include "tools/suite/trace_case.h"

namespace parallax::tools {

namespace fs = std::filesystem;

namespace {

/// The last bytes of a file: its last line, if that is a short one.
std::string end_of(const fs::path& path) {
  constexpr std::streamoff kBytes = 256;
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  const auto size = static_cast<std::streamoff>(in.tellg());
  if (!in || size <= 0) return {};
  const auto count = std::min(size, kBytes);
  std::string out(static_cast<std::size_t>(count), '\0');
  in.seekg(size - count);
  in.read(out.data(), count);
  if (!in) return {};
  return out;
}

/// Does the file end like a list of traces, by a line that counts them?
bool is_golden(const fs::path& path) {
  const auto end = end_of(path);
  return end.find('\n') != std::string::npos && listed_traces(end).has_value();
}

}  // namespace

std::vector<std::string> unused_goldens(const std::vector<std::string>& paths,
                                        const std::vector<SuiteCase>& cases, const fs::path& out) {
  std::set<fs::path> used;
  for (const auto& one : cases) {
    const auto* traces = std::get_if<harness::ManifestCase>(&one.check);
    if (traces == nullptr || !traces->expect.golden) continue;
    used.insert(base::real_path(traces->expect.golden->text));
  }
  const auto results = base::real_path(out);
  std::set<std::string> unused;
  for (const auto& path : paths) {
    std::error_code error;
    if (!fs::is_directory(path, error)) continue;
    fs::recursive_directory_iterator at(path, fs::directory_options::skip_permission_denied, error);
    for (; !error && at != fs::recursive_directory_iterator(); at.increment(error)) {
      std::error_code unread;
      const auto status = at->symlink_status(unread);
      const bool is_hidden = at->path().filename().string().starts_with('.');
      if (fs::is_directory(status)) {
        if (is_hidden || base::real_path(at->path()) == results) at.disable_recursion_pending();
        continue;
      }
      if (is_hidden || !fs::is_regular_file(status) || !is_golden(at->path())) continue;
      if (!used.contains(base::real_path(at->path()))) {
        unused.insert(at->path().lexically_normal().string());
      }
    }
  }
  return {unused.begin(), unused.end()};
}

}  // namespace parallax::tools
