#include "tools/suite/program_modules.h"

#include <elf.h>
#include <link.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "compiler/base/subprocess.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

/// The program itself comes first, and names the dynamic linker that loads it.
int take_linker(dl_phdr_info* info, std::size_t /*size*/, void* linker) {
  for (std::size_t i = 0; i < info->dlpi_phnum; ++i) {
    const auto& header = info->dlpi_phdr[i];
    if (header.p_type != PT_INTERP) continue;
    // NOLINTNEXTLINE: the loader says so
    *static_cast<std::string*>(linker) =
        reinterpret_cast<const char*>(info->dlpi_addr + header.p_vaddr);
  }
  return 1;
}

/// The paths in what the dynamic linker lists: "  libode.so.8 => /usr/lib/libode.so.8 (0x7f..)".
void add_listed(const std::string& text, std::vector<std::string>& out) {
  constexpr std::string_view kArrow = " => ";
  for (std::size_t at = 0; at < text.size();) {
    const auto end = std::min(text.find('\n', at), text.size());
    const auto line = std::string_view(text).substr(at, end - at);
    at = end + 1;
    const auto arrow = line.find(kArrow);
    if (arrow == line.npos) continue;
    auto path = line.substr(arrow + kArrow.size());
    path = path.substr(0, path.rfind(" ("));
    out.emplace_back(path);
  }
}

bool is_module(const fs::path& path) {
  const auto name = path.filename().string();
  return name.starts_with("parallax_") && name.ends_with(".so");
}

}  // namespace

std::vector<std::string> module_files_in(const std::vector<std::string>& folders) {
  std::vector<std::string> out;
  for (const auto& folder : folders) {
    std::error_code error;
    fs::directory_iterator at(folder, error);
    for (; !error && at != fs::directory_iterator(); at.increment(error)) {
      if (is_module(at->path())) out.push_back(at->path().string());
    }
  }
  std::string linker;
  ::dl_iterate_phdr(take_linker, &linker);
  const auto modules = out;
  for (const auto& module : modules) {
    if (linker.empty()) break;
    base::CaptureOptions options;
    options.without_input = true;
    add_listed(base::capture({linker, "--list", module}, options).out, out);
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

std::vector<std::string> module_files() {
  std::error_code error;
  const auto beside = fs::read_symlink("/proc/self/exe", error).parent_path();
  // As its run path says in a build and where it is installed.
  std::vector<std::string> folders = {(beside / "modules").string(), beside.string(),
                                      (beside / PARALLAX_MODULES_FROM_PROGRAM).string(),
                                      PARALLAX_MODULES};
  // The linker looks here first.
  const char* more = std::getenv("LD_LIBRARY_PATH");
  std::string_view rest = more == nullptr ? "" : more;
  while (!rest.empty()) {
    const auto end = std::min(rest.find_first_of(":;"), rest.size());
    if (end > 0) folders.emplace_back(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return module_files_in(folders);
}

}  // namespace parallax::tools
