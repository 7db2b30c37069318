#include "harness/import/limited_child.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <optional>

namespace parallax::harness {
namespace {

constexpr rlim_t kMostSeconds = 30, kMostBytes = rlim_t{3} << 30;

void write_or_end(int fd, const char* bytes, std::size_t size) {
  while (size > 0) {
    const auto done = ::write(fd, bytes, size);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) ::_exit(1);
    bytes += done;
    size -= static_cast<std::size_t>(done);
  }
}

/// In the child.
[[noreturn]] void work_and_end(int fd, const std::function<std::string()>& work, bool opens_files) {
  const rlimit time{kMostSeconds, kMostSeconds}, memory{kMostBytes, kMostBytes}, none{0, 0};
  ::setrlimit(RLIMIT_CPU, &time);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  ::setrlimit(RLIMIT_AS, &memory);  // sanitizers map far more than they use
#endif
  ::setrlimit(RLIMIT_CORE, &none);
  ::setrlimit(RLIMIT_FSIZE, &none);
  const int nowhere = ::open("/dev/null", O_RDWR);
  for (int stream = 0; stream < 3; ++stream) ::dup2(nowhere, stream);
  if (!opens_files && ::setrlimit(RLIMIT_NOFILE, &none) != 0) ::_exit(1);
  for (const int one : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGXCPU, SIGTERM, SIGINT}) {
    ::signal(one, SIG_DFL);
  }
  try {
    const std::string answer = work();
    write_or_end(fd, answer.data(), answer.size());
  } catch (...) {
    ::_exit(1);
  }
  ::_exit(0);
}

/// All that comes until the other side closes; none where it is too much or comes too late.
std::optional<std::string> read_all(int fd, std::size_t most_bytes) {
  std::string out;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(4 * kMostSeconds);
  char buffer[65536];
  while (out.size() <= most_bytes) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        end - std::chrono::steady_clock::now());
    pollfd wait{fd, POLLIN, 0};
    const int ready = left.count() <= 0 ? 0 : ::poll(&wait, 1, static_cast<int>(left.count()));
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0) return std::nullopt;
    const auto count = ::read(fd, buffer, sizeof(buffer));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return out;
    out.append(buffer, static_cast<std::size_t>(count));
  }
  return std::nullopt;
}

}  // namespace

ChildAnswer answer_of_child(const std::function<std::string()>& work, std::size_t most_bytes,
                            bool opens_files) {
  int ends[2] = {-1, -1};
  if (::pipe2(ends, O_CLOEXEC) != 0) return {ChildEnd::kNotStarted, {}};
  const pid_t child = ::fork();
  if (child == 0) work_and_end(ends[1], work, opens_files);
  ::close(ends[1]);
  if (child < 0) {
    ::close(ends[0]);
    return {ChildEnd::kNotStarted, {}};
  }
  auto bytes = read_all(ends[0], most_bytes);
  ::close(ends[0]);
  if (!bytes) ::kill(child, SIGKILL);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!bytes || (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)) {
    return {ChildEnd::kTooLong, {}};
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return {ChildEnd::kCrashed, {}};
  return {ChildEnd::kAnswered, *std::move(bytes)};
}

}  // namespace parallax::harness
