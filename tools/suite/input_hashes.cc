#include "tools/suite/input_hashes.h"

#include <link.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "compiler/base/file_io.h"
#include "compiler/base/path_gate.h"
#include "compiler/base/sha256.h"
#include "tools/suite/program_modules.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

std::string hash_of_folder(const fs::path& path) {
  std::vector<std::string> names;
  std::error_code error;
  fs::directory_iterator at(path, error);
  for (; !error && at != fs::directory_iterator(); at.increment(error)) {
    names.push_back(at->path().filename().string());
  }
  std::sort(names.begin(), names.end());
  std::string text;
  for (const auto& name : names) text += name + '\0';
  return base::sha256_hex(text);
}

std::string hash_of_content(const fs::path& path) {
  constexpr std::size_t kMostBytes = std::size_t{1} << 31U;  // more than any reader takes
  std::error_code error;
  if (!fs::exists(path, error)) return {};
  if (fs::is_directory(path, error)) return hash_of_folder(path);
  base::DiagnosticSink unread;
  const auto text = base::read_file(path, unread, kMostBytes);
  return base::sha256_hex(text ? *text : "unreadable");
}

/// The target of the links on a path, relative to its folder; empty: there are none.
std::string way_of_links(const fs::path& path) {
  std::error_code error;
  const auto named = fs::absolute(path, error).lexically_normal();
  const auto real = base::real_path(path);
  return real == named ? std::string() : real.lexically_relative(named.parent_path()).string();
}

std::string hash_of_path(const fs::path& path) {
  const auto folder = path.parent_path();
  if (path.filename() == base::kRootMarker && !base::is_marked_root(folder)) return {};
  auto out = hash_of_content(path);
  if (out.empty()) return out;
  if (const auto way = way_of_links(path); !way.empty()) out += " by " + way;
  return out;
}

int add_library(dl_phdr_info* info, std::size_t /*size*/, void* paths) {
  // The program itself has no name here, and the kernel's page has no file.
  const std::string name = info->dlpi_name == nullptr ? "" : info->dlpi_name;
  if (name.starts_with('/')) static_cast<std::vector<std::string>*>(paths)->push_back(name);
  return 0;
}

}  // namespace

const std::string& InputHashes::of(const std::string& path) {
  const auto [at, is_new] = known_.try_emplace(path);
  if (is_new) at->second = hash_of_path(path);
  return at->second;
}

bool InputHashes::unchanged(const std::vector<InputFile>& inputs) {
  return std::all_of(inputs.begin(), inputs.end(),
                     [&](const InputFile& input) { return of(input.path) == input.sha256; });
}

const std::string& program_hash() {
  static const std::string hash = [] {
    std::vector<std::string> paths;
    ::dl_iterate_phdr(add_library, &paths);
    const auto modules = module_files();
    paths.insert(paths.end(), modules.begin(), modules.end());
    std::sort(paths.begin(), paths.end());
    paths.erase(std::unique(paths.begin(), paths.end()), paths.end());
    std::string all = hash_of_content("/proc/self/exe");
    for (const auto& path : paths) all += hash_of_content(path);
    return base::sha256_hex(all);
  }();
  return hash;
}

}  // namespace parallax::tools
