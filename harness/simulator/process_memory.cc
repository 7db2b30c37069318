#include "harness/simulator/process_memory.h"

#include <dirent.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <string>

namespace parallax::harness {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
struct CloseFolder {
  void operator()(DIR* folder) const { ::closedir(folder); }
};

/// The first bytes of a file of a process; empty if the process has gone.
std::string start_of(const char* process, const char* name) {
  const auto path = fmt::format("/proc/{}/{}", process, name);
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "re"));
  if (!file) return {};
  char text[1024];
  return {text, std::fread(text, 1, sizeof text, file.get())};
}

/// The session of a process, -1 if it has gone. Its name stands in parentheses and may hold any
/// character, a closing parenthesis too: state, parent, group and session follow the last one.
pid_t session_of(const char* process) {
  const auto stat = start_of(process, "stat");
  const auto name_end = stat.rfind(')');
  char state = 0;
  int parent = 0, group = 0, session = -1;
  if (name_end == std::string::npos || std::sscanf(stat.c_str() + name_end + 1, " %c %d %d %d",
                                                   &state, &parent, &group, &session) != 4) {
    return -1;
  }
  return session;
}

}  // namespace

std::uint64_t memory_of_session(pid_t leader) {
  const std::unique_ptr<DIR, CloseFolder> processes(::opendir("/proc"));
  if (!processes) return 0;
  const auto page_bytes = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  std::uint64_t bytes = 0;
  while (const auto* entry = ::readdir(processes.get())) {
    const char* name = entry->d_name;
    if (name[0] < '1' || name[0] > '9' || session_of(name) != leader) continue;
    unsigned long long size = 0, resident = 0;
    if (std::sscanf(start_of(name, "statm").c_str(), "%llu %llu", &size, &resident) == 2) {
      bytes += resident * page_bytes;
    }
  }
  return bytes;
}

}  // namespace parallax::harness
