#include "harness/import/mesh_module.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <string_view>
#include <utility>

namespace parallax::harness {
namespace {

constexpr rlim_t kMostSeconds = 30, kMostBytes = rlim_t{3} << 30;
constexpr std::size_t kMostAnswer = 1 << 16;

/// Beside the program, as its run path says, or where it is installed. It stays loaded.
const MeshFunctions* functions() {
  static const MeshFunctions* const kLoaded = []() -> const MeshFunctions* {
    const std::string installed = std::string(PARALLAX_MODULES) + "/" + kMeshModule;
    for (const auto& file : {std::string(kMeshModule), installed}) {
      void* module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
      if (module == nullptr) continue;
      if (void* get = ::dlsym(module, kMeshFunctions)) {
        return reinterpret_cast<GetMeshFunctions*>(get)(PARALLAX_IMPORT_VERSION);
      }
    }
    return nullptr;
  }();
  return kLoaded;
}

MeshCorners faulty(std::string why) {
  MeshCorners out;
  out.fault = std::move(why);
  return out;
}

/// What goes through the pipe: numbers, then the fault or the corners.
struct AnswerHead {
  std::uint64_t fault_bytes = 0, corners = 0, faces = 0, hull_corners = 0;
  double off = 0.0, volume = 0.0, hull_volume = 0.0;
};

void write_all(int fd, const void* data, std::size_t size) {
  const auto* bytes = static_cast<const char*>(data);
  while (size > 0) {
    const auto done = ::write(fd, bytes, size);
    if (done <= 0) ::_exit(1);
    bytes += done;
    size -= static_cast<std::size_t>(done);
  }
}

[[noreturn]] void answer_and_end(int fd, const MeshCorners& said) {
  const std::string fault = said.fault.value_or("").substr(0, 1000);
  const AnswerHead head{fault.size(), said.corners.size(), said.faces,      said.hull_corners,
                        said.off,     said.volume,         said.hull_volume};
  write_all(fd, &head, sizeof(head));
  write_all(fd, fault.data(), fault.size());
  if (fault.empty())
    write_all(fd, said.corners.data(), said.corners.size() * sizeof(Eigen::Vector3d));
  ::_exit(0);
}

/// In the child: nothing is said on its streams, and nothing lasts.
[[noreturn]] void read_in_child(int fd, const std::string& text, const std::string& extension,
                                const Eigen::Vector3d& scale) {
  const rlimit time{kMostSeconds, kMostSeconds}, memory{kMostBytes, kMostBytes}, none{0, 0};
  ::setrlimit(RLIMIT_CPU, &time);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  ::setrlimit(RLIMIT_AS, &memory);  // sanitizers map far more than they use
#endif
  ::setrlimit(RLIMIT_CORE, &none);
  ::setrlimit(RLIMIT_FSIZE, &none);
  const int nowhere = ::open("/dev/null", O_RDWR);
  for (int stream = 0; stream < 3; ++stream) ::dup2(nowhere, stream);
  for (const int one : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGXCPU, SIGTERM, SIGINT}) {
    ::signal(one, SIG_DFL);
  }
  try {
    answer_and_end(fd, functions()->read(text, extension, scale));
  } catch (const std::exception&) {
    answer_and_end(fd, faulty("cannot be read: it asks for too much memory, or is damaged"));
  }
}

/// All that comes until the other side closes; none where it comes too late.
std::optional<std::string> read_all(int fd) {
  std::string out;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(4 * kMostSeconds);
  char buffer[4096];
  while (out.size() <= kMostAnswer) {
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

MeshCorners parsed(const std::string& bytes) {
  const auto damaged = faulty("cannot be read: the reader of meshes broke off");
  AnswerHead head;
  if (bytes.size() < sizeof(head)) return damaged;
  std::memcpy(&head, bytes.data(), sizeof(head));
  const auto rest = bytes.substr(sizeof(head));
  if (head.fault_bytes > 0) return faulty(rest.substr(0, head.fault_bytes));
  if (head.corners > kMaxMeshCorners || rest.size() != head.corners * sizeof(Eigen::Vector3d)) {
    return damaged;
  }
  MeshCorners out;
  out.faces = head.faces;
  out.hull_corners = head.hull_corners;
  out.off = head.off;
  out.volume = head.volume;
  out.hull_volume = head.hull_volume;
  out.corners.resize(head.corners);
  if (!rest.empty()) std::memcpy(out.corners.front().data(), rest.data(), rest.size());
  return out;
}

}  // namespace

bool is_mesh_format(const std::filesystem::path& path) {
  const auto extension = path.extension().string();
  for (const std::string_view one :
       {".stl", ".obj", ".dae", ".ply", ".STL", ".OBJ", ".DAE", ".PLY"}) {
    if (extension == one) return true;
  }
  return false;
}

bool reads_meshes() { return functions() != nullptr; }

MeshCorners mesh_corners(const std::string& text, const std::string& extension,
                         const Eigen::Vector3d& scale) {
  if (!reads_meshes()) return faulty("cannot be read: the module for meshes is not there");
  int ends[2] = {-1, -1};
  if (::pipe2(ends, O_CLOEXEC) != 0) return faulty("cannot be read: there is no pipe left");
  const pid_t child = ::fork();
  if (child == 0) read_in_child(ends[1], text, extension, scale);
  ::close(ends[1]);
  if (child < 0) {
    ::close(ends[0]);
    return faulty("cannot be read: no process can be started");
  }
  const auto bytes = read_all(ends[0]);
  ::close(ends[0]);
  if (!bytes) ::kill(child, SIGKILL);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!bytes || (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)) {
    return faulty("cannot be read: it takes too long");
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    return faulty("cannot be read: the reader of meshes crashed on it");
  }
  return parsed(*bytes);
}

MadeHull hull_of(const std::vector<Eigen::Vector3d>& points) {
  MadeHull out;
  if (!reads_meshes()) {
    out.fault = "cannot be made: the module for meshes is not there";
    return out;
  }
  HullFaces made = functions()->hull(points);
  out.fault = made.fault;
  if (out.fault) return out;
  std::string why;
  auto hull = hull_with(std::move(made.corners), made.faces, out.middle, why);
  if (!hull) {
    out.fault = std::move(why);
  } else {
    out.hull = std::make_shared<const ConvexHull>(std::move(*hull));
  }
  return out;
}

}  // namespace parallax::harness
