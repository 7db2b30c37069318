#include "harness/import/plain_path.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>
#include <system_error>

namespace parallax::harness {

namespace fs = std::filesystem;

bool is_plain_path(const std::string& path) {
  if (path.empty() || path.front() == '/' || path.find_first_of("\\:&<>%?*\"'") != path.npos) {
    return false;
  }
  for (const auto& part : fs::path(path)) {
    if (part.empty() || part.string().front() == '.') return false;
  }
  return true;
}

bool leads_through_link(const fs::path& root, const fs::path& path) {
  std::error_code error;
  for (fs::path at = path; at != root && at.has_relative_path(); at = at.parent_path()) {
    if (fs::is_symlink(fs::symlink_status(at, error))) return true;
  }
  return false;
}

std::optional<std::string> read_bounded(const fs::path& path, std::size_t most_bytes,
                                        std::string& bytes) {
  std::error_code error;
  const auto status = fs::symlink_status(path, error);
  const auto shown = path.filename().string();
  if (!fs::is_regular_file(status)) return fmt::format("there is no regular file `{}`", shown);
  if (fs::file_size(path, error) > most_bytes) return fmt::format("`{}` is too long", shown);
  std::ifstream in(path, std::ios::binary);
  std::ostringstream all;
  all << in.rdbuf();
  if (!in) return fmt::format("`{}` cannot be read", shown);
  bytes = all.str();
  if (bytes.size() > most_bytes) return fmt::format("`{}` is too long", shown);
  return std::nullopt;
}

}  // namespace parallax::harness
