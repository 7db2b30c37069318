#pragma once

#include <cstdio>
#include <filesystem>
#include <string>

namespace parallax::test {

/// Path of Chromium; empty where there is none.
inline std::string browser() {
  for (const auto* path : {"/usr/bin/chromium", "/usr/bin/chromium-browser"}) {
    if (std::filesystem::exists(path)) return path;
  }
  return {};
}

/// False, having said so, where there is no browser.
inline bool has_browser() {
  if (!browser().empty()) return true;
  std::puts("SKIPPED: no Chromium; `tools/setup --browser` installs it");
  return false;
}

}  // namespace parallax::test
