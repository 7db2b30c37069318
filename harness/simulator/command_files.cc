#include "harness/simulator/command_files.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

#include "compiler/base/file_io.h"
#include "compiler/base/sha256.h"

namespace parallax::harness {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostBytes = std::size_t{1} << 30U;

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

/// Looks for the program in the folders of PATH; an empty one is the current folder.
void look_up(const std::string& program, CommandFiles& out) {
  const char* path = std::getenv("PATH");
  std::string_view folders = path == nullptr ? "/bin:/usr/bin" : path;
  for (;;) {
    const auto end = folders.find(':');
    const fs::path folder(folders.substr(0, end));
    const auto candidate = (folder.empty() ? fs::path(".") : folder) / program;
    if (is_file(candidate) && ::access(candidate.c_str(), X_OK) == 0) {
      out.found.push_back(candidate.string());
      return;
    }
    out.absent.push_back(candidate.string());
    if (end == std::string_view::npos) return;
    folders.remove_prefix(end + 1);
  }
}

/// Does an interpreter run this argument? Logs and other data that a simulator is told to write
/// change from run to run.
bool is_program_text(const std::string& path) {
  static constexpr std::array<std::string_view, 9> kEndings = {".py", ".sh",  ".pl", ".rb", ".js",
                                                               ".jl", ".lua", ".R",  ".m"};
  const auto ending = fs::path(path).extension().string();
  if (std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end()) return true;
  return ::access(path.c_str(), X_OK) == 0;
}

}  // namespace

CommandFiles files_of_command(const std::vector<std::string>& command) {
  CommandFiles out;
  for (std::size_t i = 0; i < command.size(); ++i) {
    if (i == 0 && command[i].find('/') == std::string::npos) {
      look_up(command[i], out);
    } else if (is_file(command[i]) && (i == 0 || is_program_text(command[i]))) {
      out.found.push_back(command[i]);
    } else if (i == 0) {
      out.absent.push_back(command[i]);
    }
  }
  return out;
}

std::string hash_of_command(const std::vector<std::string>& command) {
  if (command.empty()) return {};
  std::string all;
  for (const auto& file : files_of_command(command).found) {
    base::DiagnosticSink unread;
    const auto text = base::read_file(file, unread, kMostBytes);
    all += text ? base::sha256_hex(*text) : std::string("unreadable");
    all += '\n';
  }
  return base::sha256_hex(all);
}

}  // namespace parallax::harness
