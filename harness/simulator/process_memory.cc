// The memory of a session of processes, for little on a machine that runs hundreds of them.
//
// The system has no list of a session's processes. From its leader one comes to all of them by
// their children, but for those whose parent has ended: they are found among all processes of the
// machine, and are watched from then on as the leader is. That search is linear in the machine's
// processes, and with a simulator in each of N workers the sum grows as N squared. So it comes
// seldom, and the more seldom the longer it takes. Where the system does not tell the children of
// a process, every look is a search.

#include "harness/simulator/process_memory.h"

#include <dirent.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace parallax::harness {
namespace {

constexpr auto kSearchPause = std::chrono::seconds(5);
constexpr int kSearchShare = 2000;  // a search takes at most this part of the time

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
struct CloseFolder {
  void operator()(DIR* folder) const { ::closedir(folder); }
};

/// A file of a process; none if the process has gone.
std::optional<std::string> file_of(pid_t process, const std::string& name) {
  const auto path = fmt::format("/proc/{}/{}", process, name);
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "re"));
  if (!file) return std::nullopt;
  std::string text;
  char chunk[1024];
  while (const auto count = std::fread(chunk, 1, sizeof chunk, file.get()))
    text.append(chunk, count);
  return text;
}

/// Calls `each` with the numbers that are names in a folder of proc(5).
template <typename Each>
void each_number(const std::string& folder, const Each& each) {
  const std::unique_ptr<DIR, CloseFolder> open(::opendir(folder.c_str()));
  if (!open) return;
  while (const auto* entry = ::readdir(open.get())) {
    const auto number = static_cast<pid_t>(std::strtol(entry->d_name, nullptr, 10));
    if (number > 0) each(number);
  }
}

std::uint64_t memory_of(pid_t process) {
  static const auto page_bytes = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  unsigned long long size = 0, resident = 0;
  const auto text = file_of(process, "statm");
  const bool read = text && std::sscanf(text->c_str(), "%llu %llu", &size, &resident) == 2;
  return read ? resident * page_bytes : 0;
}

}  // namespace

std::optional<std::vector<pid_t>> children_of(pid_t process) {
  std::vector<pid_t> out;
  bool told = false;
  each_number(fmt::format("/proc/{}/task", process), [&](pid_t thread) {
    const auto list = file_of(process, fmt::format("task/{}/children", thread));
    told = told || list.has_value();
    if (!list) return;
    for (const char* at = list->c_str(); *at != '\0';) {
      char* end = nullptr;
      const auto child = static_cast<pid_t>(std::strtol(at, &end, 10));
      if (end == at) break;
      out.push_back(child);
      at = *end == ' ' ? end + 1 : end;
    }
  });
  if (!told) return std::nullopt;
  return out;
}

void SessionMemory::search() {
  const auto begin = Clock::now();
  strays_.clear();
  each_number("/proc", [this](pid_t process) {
    if (process != leader_ && ::getsid(process) == leader_) strays_.insert(process);
  });
  next_search_ =
      Clock::now() + std::max<Clock::duration>(kSearchPause, kSearchShare * (Clock::now() - begin));
}

std::uint64_t SessionMemory::bytes() {
  if (Clock::now() >= next_search_) search();
  std::vector<pid_t> open(strays_.begin(), strays_.end());
  open.push_back(leader_);
  std::set<pid_t> seen;
  std::uint64_t sum = 0;
  while (!open.empty()) {
    const auto process = open.back();
    open.pop_back();
    if (::getsid(process) != leader_ || !seen.insert(process).second) continue;
    sum += memory_of(process);
    if (const auto children = children_of(process)) {
      open.insert(open.end(), children->begin(), children->end());
    } else {
      next_search_ = Clock::now();  // with every look
    }
  }
  return sum;
}

}  // namespace parallax::harness
