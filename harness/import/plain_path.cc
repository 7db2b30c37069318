#include "harness/import/plain_path.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>
#include <string_view>
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

std::optional<PackagePart> package_part(const std::string& uri) {
  for (const std::string_view scheme : {"model://", "package://"}) {
    if (!uri.starts_with(scheme)) continue;
    const auto slash = uri.find('/', scheme.size());
    if (slash == uri.npos) return PackagePart{uri.substr(scheme.size()), {}};
    return PackagePart{uri.substr(scheme.size(), slash - scheme.size()), uri.substr(slash + 1)};
  }
  constexpr std::string_view kServer = "https://";
  if (!uri.starts_with(kServer)) return std::nullopt;
  std::vector<std::string> parts;
  std::istringstream way(uri.substr(kServer.size()));
  for (std::string one; std::getline(way, one, '/');) parts.push_back(one);
  if (parts.size() < 5 || parts[3] != "models") return std::nullopt;
  std::size_t next = 5;
  const auto is_version = [](const std::string& text) {
    return text == "tip" || (!text.empty() && text.find_first_not_of("0123456789") == text.npos);
  };
  if (next < parts.size() && is_version(parts[next])) ++next;
  if (next < parts.size() && parts[next] == "files") ++next;
  PackagePart out{parts[4], {}};
  for (; next < parts.size(); ++next) out.rest += (out.rest.empty() ? "" : "/") + parts[next];
  return out;
}

std::vector<PackagePlace> package_places(const std::string& package,
                                         const std::vector<fs::path>& folders,
                                         const std::map<std::string, fs::path>& packages) {
  std::vector<PackagePlace> out;
  for (const fs::path& folder : folders) out.push_back({folder, folder / package});
  if (const auto own = packages.find(package); own != packages.end()) {
    out.push_back({own->second, own->second});
  }
  return out;
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
