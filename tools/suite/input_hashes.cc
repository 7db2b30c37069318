#include "tools/suite/input_hashes.h"

#include <link.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "compiler/base/file_io.h"
#include "compiler/base/sha256.h"

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

std::string hash_of_path(const std::string& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return hash_of_folder(path);
  base::DiagnosticSink unread;
  const auto text = base::read_file(path, unread);
  return text ? base::sha256_hex(*text) : "";
}

int add_library(dl_phdr_info* info, std::size_t /*size*/, void* paths) {
  // The program itself has no name, and the kernel's page no file.
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
    std::sort(paths.begin(), paths.end());
    std::string all = hash_of_path("/proc/self/exe");
    for (const auto& path : paths) all += hash_of_path(path);
    return base::sha256_hex(all);
  }();
  return hash;
}

}  // namespace parallax::tools
