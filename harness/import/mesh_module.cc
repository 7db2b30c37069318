#include "harness/import/mesh_module.h"

#include <fmt/format.h>

#include <cstring>
#include <string_view>
#include <utility>

#include "compiler/base/loaded_module.h"
#include "harness/import/limited_child.h"

namespace parallax::harness {
namespace {

constexpr std::size_t kMostAnswer = 1 << 16;

const MeshFunctions* functions() {
  static const MeshFunctions* const kLoaded = []() -> const MeshFunctions* {
    void* const get = base::symbol_of_module(kMeshModule, PARALLAX_MODULES, kMeshFunctions);
    return get == nullptr ? nullptr
                          : reinterpret_cast<GetMeshFunctions*>(get)(PARALLAX_IMPORT_VERSION);
  }();
  return kLoaded;
}

MeshCorners faulty(std::string why) {
  MeshCorners out;
  out.fault = std::move(why);
  return out;
}

/// The head of an answer in the pipe: numbers. The fault or the corners follow.
struct AnswerHead {
  std::uint64_t fault_bytes = 0, corners = 0, faces = 0, hull_corners = 0;
  double off = 0.0, volume = 0.0, hull_volume = 0.0;
  std::uint64_t is_open = 0;
};

std::string answer_of(const MeshCorners& said) {
  const std::string fault = said.fault.value_or("").substr(0, 1000);
  const AnswerHead head{
      fault.size(), said.corners.size(), said.faces,       said.hull_corners,
      said.off,     said.volume,         said.hull_volume, said.is_open ? 1U : 0U};
  std::string bytes(reinterpret_cast<const char*>(&head), sizeof(head));
  bytes += fault;
  if (fault.empty() && !said.corners.empty()) {
    bytes.append(reinterpret_cast<const char*>(said.corners.front().data()),
                 said.corners.size() * sizeof(Eigen::Vector3d));
  }
  return bytes;
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
  out.is_open = head.is_open != 0;
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
                         const Eigen::Vector3d& scale, const std::atomic<bool>* stop) {
  if (!reads_meshes()) return faulty("cannot be read: the module for meshes is not there");
  const auto work = [&] {
    try {
      return answer_of(functions()->read(text, extension, scale));
    } catch (const std::exception&) {
      return answer_of(faulty("cannot be read: it asks for too much memory, or is damaged"));
    }
  };
  const ChildAnswer answer = answer_of_child(work, kMostAnswer, true, stop);
  switch (answer.end) {
    case ChildEnd::kAnswered:
      return parsed(answer.bytes);
    case ChildEnd::kNotStarted:
      return faulty("cannot be read: no process can be started");
    case ChildEnd::kTooLong:
      return faulty("cannot be read: it takes too long");
    case ChildEnd::kStopped:
      return faulty("was not read to its end: the program is to end");
    case ChildEnd::kCrashed:
      break;
  }
  return faulty("cannot be read: the reader of meshes crashed on it");
}

std::vector<MeshLoss> losses_of(const MeshCorners& made, const std::string& name) {
  constexpr double kFuller = 1.05, kOff_m = 0.001;  // that is worth a word
  std::vector<MeshLoss> out;
  if (made.volume > 0.0 && made.hull_volume > kFuller * made.volume) {
    out.push_back(
        {"hollows of meshes, which become their convex hull",
         fmt::format("{}: {:.2f} times its volume", name, made.hull_volume / made.volume)});
  }
  if (made.is_open) {
    out.push_back({"meshes that are not closed, which become their convex hull, a solid",
                   fmt::format("{}: a hull of {:.3g} m3", name, made.hull_volume)});
  }
  if (made.off > kOff_m) {
    out.push_back({fmt::format("corners of hulls that have more than {}", kMaxMeshCorners),
                   fmt::format("{}: up to {:.1f} mm of {} corners", name, 1000.0 * made.off,
                               made.hull_corners)});
  }
  return out;
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
