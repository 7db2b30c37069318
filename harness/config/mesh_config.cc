#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>
#include <system_error>
#include <tuple>

#include "compiler/base/codes/scenarios.h"
#include "compiler/base/file_io.h"
#include "harness/config/sections.h"
#include "harness/import/mesh.h"

namespace parallax::harness {
namespace {

constexpr NumberBounds kScaling{0.0, 1e6, true, false};
constexpr std::size_t kMaxMeshes = 500;  // different ones, of one world

struct WantedMesh {
  base::SourceRange range;
  std::string file;
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
};

YamlNode scalar_at(const base::SourceRange& range, double value) {
  return {YamlNode::Kind::kScalar, range, fmt::format("{}", value), false, {}, {}};
}

class MeshAdder {
 public:
  MeshAdder(const base::PathGate& gate, base::SourceFiles& files, base::DiagnosticSink& sink,
            const std::atomic<bool>* stop)
      : gate_(gate), files_(files), sink_(sink), stop_(stop) {}

  /// All forms of a body.
  void replace_in(YamlNode& body) {
    if (!body.is_map()) return;
    replace(body);
    for (YamlEntry& entry : body.entries) {
      if (entry.key != Key::kShapes || !entry.value.is_list()) continue;
      for (YamlNode& shape : entry.value.items) replace(shape);
    }
  }

  void tell_what_is_lost() {
    for (const auto& [what, lost] : lost_) {
      sink_.warning(codes::kNotTakenOver, lost.range, lost.count, what, lost.first);
    }
  }

 private:
  struct Lost {
    base::SourceRange range;
    std::size_t count = 0;
    std::string first;
  };

  void replace(YamlNode& shape) {
    if (!shape.is_map()) return;
    for (YamlEntry& entry : shape.entries) {
      if (entry.key != Key::kMesh) continue;
      const auto wanted = read(entry);
      const auto* made = wanted ? made_of(*wanted) : nullptr;
      if (made == nullptr) continue;
      entry.key = Key::kHull;
      YamlNode list{YamlNode::Kind::kList, entry.value.range, {}, false, {}, {}};
      for (const auto& corner : made->corners) {
        auto& item = list.items.emplace_back(
            YamlNode{YamlNode::Kind::kList, entry.value.range, {}, false, {}, {}});
        for (const double x : {corner.x(), corner.y(), corner.z()}) {
          item.items.push_back(scalar_at(entry.value.range, x));
        }
      }
      entry.value = std::move(list);
    }
  }

  std::optional<WantedMesh> read(const YamlEntry& entry) {
    const auto errors_before = sink_.error_count();
    WantedMesh out{entry.value.range, {}};
    const YamlNode* file = &entry.value;
    if (entry.value.is_map()) {
      YamlFields fields(entry.value, key_text(Key::kMesh), sink_);
      fields.only({Key::kFile, Key::kScale});
      file = fields.require(Key::kFile);
      const auto* scale = fields.find(Key::kScale);
      if (scale != nullptr && scale->is_list()) {
        read_vector(fields, Key::kScale, out.scale);
      } else if (scale != nullptr) {
        double all = 1.0;
        fields.number(Key::kScale, kScaling, all);
        out.scale = Eigen::Vector3d::Constant(all);
      }
      if ((out.scale.array() == 0.0).any()) fault(*scale, "`scale` takes away a direction");
    }
    if (file != nullptr) {
      out.range = file->range;
      if (const auto text = read_text(*file, key_text(Key::kFile), sink_)) out.file = *text;
    }
    if (sink_.error_count() != errors_before) return std::nullopt;
    return out;
  }

  void fault(const YamlNode& at, const std::string& text) {
    sink_.error(codes::kBadImport, at.range, text);
  }

  const MeshCorners* made_of(const WantedMesh& wanted) {
    const auto fault = [&](const std::string& text) -> const MeshCorners* {
      sink_.error(codes::kBadImport, wanted.range, text);
      return nullptr;
    };
    const auto path = path_beside(wanted.range, wanted.file, files_);
    if (!gate_.check(path, wanted.range, sink_)) return nullptr;
    if (!is_mesh_format(path)) {
      return fault(fmt::format("`{}` is none of STL, OBJ, DAE and PLY", wanted.file));
    }
    if (!reads_meshes()) {
      sink_.error(codes::kImportUnavailable, wanted.range, Key::kMesh,
                  "libassimp-dev and libqhull-dev");
      return nullptr;
    }
    const auto key = std::tuple(base::real_path(path).string(), wanted.scale.x(), wanted.scale.y(),
                                wanted.scale.z());
    auto found = known_.find(key);
    if (found == known_.end()) {
      if (known_.size() == kMaxMeshes) {
        return fault(fmt::format("the world has more than {} meshes", kMaxMeshes));
      }
      files_.note_input(path.string());
      if (!base::check_file(path, wanted.range, sink_)) return nullptr;
      std::error_code error;
      if (std::filesystem::file_size(path, error) > kMaxMeshBytes || error) {
        return fault(fmt::format("`{}` is longer than {} MiB", wanted.file, kMaxMeshBytes >> 20));
      }
      std::ifstream in(path, std::ios::binary);
      std::ostringstream text;
      text << in.rdbuf();
      auto extension = path.extension().string().substr(1);
      std::transform(extension.begin(), extension.end(), extension.begin(),
                     [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
      found = known_.emplace(key, mesh_corners(text.str(), extension, wanted.scale, stop_)).first;
      note_loss(wanted, path.filename().string(), found->second);
    }
    if (found->second.fault) {
      if (tell_if_stopped(stop_, wanted.range, sink_)) return nullptr;
      return fault(fmt::format("the mesh `{}` {}", wanted.file, *found->second.fault));
    }
    return &found->second;
  }

  void note_loss(const WantedMesh& wanted, const std::string& name, const MeshCorners& made) {
    if (made.fault) return;
    for (const MeshLoss& loss : losses_of(made, name)) {
      ++lost_.emplace(loss.what, Lost{wanted.range, 0, loss.of}).first->second.count;
    }
  }

  const base::PathGate& gate_;
  base::SourceFiles& files_;
  base::DiagnosticSink& sink_;
  const std::atomic<bool>* stop_;
  std::map<std::tuple<std::string, double, double, double>, MeshCorners> known_;
  std::map<std::string, Lost> lost_;
};

}  // namespace

bool add_meshes(YamlNode& root, const base::PathGate& gate, base::SourceFiles& files,
                base::DiagnosticSink& sink, const std::atomic<bool>* stop) {
  const auto errors_before = sink.error_count();
  MeshAdder adder(gate, files, sink, stop);
  if (!root.is_map()) return true;
  for (YamlEntry& world : root.entries) {
    if (world.key != Key::kWorld || !world.value.is_map()) continue;
    for (YamlEntry& bodies : world.value.entries) {
      if (bodies.key != Key::kBodies || !bodies.value.is_map()) continue;
      for (YamlEntry& body : bodies.value.entries) adder.replace_in(body.value);
    }
  }
  adder.tell_what_is_lost();
  return sink.error_count() == errors_before;
}

}  // namespace parallax::harness
