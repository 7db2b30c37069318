#include "harness/import/way_within.h"

#include <algorithm>

#include "harness/import/plain_path.h"

namespace parallax::harness {

namespace fs = std::filesystem;

std::optional<std::pair<fs::path, fs::path>> way_within(const fs::path& folder,
                                                        const std::string& name,
                                                        const std::vector<fs::path>& roots) {
  fs::path way, down;
  for (const fs::path& part : fs::path(name)) {
    if (part == ".") continue;
    way /= part;
    if (part != "..") down /= part;
  }
  if (way.is_absolute() || !is_plain_path(down.string())) return std::nullopt;
  const fs::path path = (folder / way).lexically_normal();
  for (const fs::path& root : roots) {
    const fs::path above = root.lexically_normal();
    const auto [left, rest] = std::mismatch(above.begin(), above.end(), path.begin(), path.end());
    if (left == above.end() && rest != path.end()) return std::pair(path, above);
  }
  return std::nullopt;
}

}  // namespace parallax::harness
