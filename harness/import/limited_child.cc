#include "harness/import/limited_child.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <utility>

#include "compiler/base/clock_time.h"

namespace parallax::harness {
namespace {

constexpr rlim_t kMostSeconds = 30, kMostBytes = rlim_t{3} << 30;
constexpr double kMostWait_s = 4.0 * kMostSeconds;
constexpr int kStopSliceMs = 50;  // how late a raised flag may be seen

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
[[noreturn]] void work_and_end(pid_t parent, int fd, const std::function<std::string()>& work,
                               bool opens_files) {
  // Nobody waits for an answer once the parent is gone, which may have been before this was asked.
  if (::prctl(PR_SET_PDEATHSIG, SIGKILL) != 0 || ::getppid() != parent) ::_exit(1);
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

/// All that comes until the other side closes; kTooLong where it is too much or comes too late.
ChildAnswer read_all(int fd, std::size_t most_bytes, const std::atomic<bool>* stop) {
  std::string out;
  const auto deadline = base::from_now(kMostWait_s);
  char buffer[65536];
  while (out.size() <= most_bytes) {
    if (stop != nullptr && stop->load()) return {ChildEnd::kStopped, {}};
    pollfd wait{fd, POLLIN, 0};
    const int left_ms = base::milliseconds_left(deadline, kStopSliceMs);
    const int ready = left_ms == 0 ? 0 : ::poll(&wait, 1, left_ms);
    if (ready < 0 && errno == EINTR) continue;
    if (ready < 0 || left_ms == 0) return {ChildEnd::kTooLong, {}};
    if (ready == 0) continue;
    const auto count = ::read(fd, buffer, sizeof(buffer));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return {ChildEnd::kAnswered, std::move(out)};
    out.append(buffer, static_cast<std::size_t>(count));
  }
  return {ChildEnd::kTooLong, {}};
}

}  // namespace

ChildAnswer answer_of_child(const std::function<std::string()>& work, std::size_t most_bytes,
                            bool opens_files, const std::atomic<bool>* stop) {
  int ends[2] = {-1, -1};
  if (::pipe2(ends, O_CLOEXEC) != 0) return {ChildEnd::kNotStarted, {}};
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child == 0) work_and_end(parent, ends[1], work, opens_files);
  ::close(ends[1]);
  if (child < 0) {
    ::close(ends[0]);
    return {ChildEnd::kNotStarted, {}};
  }
  auto answer = read_all(ends[0], most_bytes, stop);
  ::close(ends[0]);
  if (answer.end != ChildEnd::kAnswered) ::kill(child, SIGKILL);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (answer.end != ChildEnd::kAnswered) return answer;
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) return {ChildEnd::kTooLong, {}};
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return {ChildEnd::kCrashed, {}};
  return answer;
}

}  // namespace parallax::harness
