#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <span>
#include <system_error>

#include "compiler/base/codes/files.h"
#include "compiler/base/codes/scenarios.h"
#include "compiler/base/file_io.h"
#include "harness/config/import_nodes.h"
#include "harness/config/sections.h"
#include "harness/import/import.h"
#include "harness/import/mesh.h"
#include "harness/import/plain_path.h"
#include "harness/import/way_within.h"
#include "harness/world/structure_check.h"

namespace parallax::harness {
namespace {

// An imported world becomes the tree that a scenario would have for it, so that one reader and one
// set of checks serve both, and a scenario may lay its own keys over it.

/// Texts under `bodies` that say `material`, and the floor's.
std::set<std::string> materials_in(const YamlNode& world) {
  std::set<std::string> out;
  if (const auto* floor = world.find(Key::kFloorMaterial)) out.insert(floor->value.text);
  if (const auto* bodies = world.find(Key::kBodies)) {
    for (const auto& body : bodies->value.entries) {
      if (const auto* material = body.value.find(Key::kMaterial)) out.insert(material->value.text);
    }
  }
  return out;
}

/// Keys by which what is laid over an imported thing is one of its own. A `mesh` may be one, too.
constexpr std::array<std::string_view, 8> kOwnBodyKeys = {
    Key::kSizeM, Key::kSphere, Key::kCylinder, Key::kCapsule,
    Key::kHull,  Key::kMesh,   Key::kShapes,   Key::kRing};
constexpr std::array<std::string_view, 2> kOwnJointKeys = {Key::kType, Key::kChild};

/// Two things of one name, one of the file and one of the scenario, would become one unseen.
void refuse_mergers(const YamlNode& imported, const YamlNode& world, std::string_view section,
                    std::string_view kind, std::span<const std::string_view> own_keys,
                    base::DiagnosticSink& sink) {
  const auto* over = world.find(section);
  const auto* under = imported.find(section);
  if (over == nullptr || under == nullptr) return;
  for (const YamlEntry& entry : over->value.entries) {
    const auto* below = under->value.find(entry.key);
    if (below == nullptr) continue;
    const auto own = std::find_if(own_keys.begin(), own_keys.end(), [&](std::string_view key) {
      return entry.value.find(key) != nullptr;
    });
    if (own == own_keys.end()) continue;
    // Several files may lay their keys over it: the place is in the one with this key.
    const auto& key_range = entry.value.find(*own)->key_range;
    sink.error(codes::kBadImport,
               key_range.file == entry.key_range.file ? entry.key_range : key_range,
               fmt::format("it has a {0} `{1}` too, and the {0} here is another, for it has `{2}`",
                           kind, entry.key, *own))
        .note(below->key_range, fmt::format("the {} of the file", kind))
        .help(
            "Give one of the two another name; docs/guide/worlds.md says which keys can be laid "
            "over "
            "what is imported.");
  }
}

struct ImportFormat {
  std::string_view key, package;
  bool (*is_there)();
  ImportedWorld (*read)(const ImportInput& input);
};
constexpr std::array<ImportFormat, 3> kFormats = {
    {{Key::kSdf, "libsdformat-dev", &reads_sdf, &import_sdf},
     {Key::kUrdf, "liburdfdom-dev", &reads_urdf, &import_urdf},
     {Key::kMjcf, "libmujoco-dev", &reads_mjcf, &import_mjcf}}};

class WorldImporter {
 public:
  WorldImporter(YamlNode& world, const base::PathGate& gate, base::SourceFiles& files,
                base::DiagnosticSink& sink, const std::atomic<bool>* stop)
      : world_(world), gate_(gate), files_(files), sink_(sink) {
    input_.stop = stop;
  }

  bool run() {
    const auto errors_before = sink_.error_count();
    const YamlEntry* found = nullptr;
    for (const ImportFormat& format : kFormats) {
      const auto* other = world_.find(format.key);
      if (other == nullptr) continue;
      if (found != nullptr) {
        sink_
            .error(codes::kUnknownKey, other->key_range, format.key,
                   fmt::format("`{}`, which has `{}`", Key::kWorld, format_->key))
            .note(found->key_range, fmt::format("`{}` is here", format_->key))
            .help(
                "A world takes over one file; put both into one, or describe one of them in the "
                "scenario itself.");
        return false;
      }
      found = other;
      format_ = &format;
    }
    if (found == nullptr) return refuse_models();
    const YamlEntry entry = *found;
    read_request(entry);
    read_folders();
    if (sink_.error_count() != errors_before) return false;
    if (!is_there(entry)) return false;
    const auto path = path_beside(file_range_, file_text_, files_);
    if (!gate_.check(path, file_range_, sink_)) return false;
    if (!base::check_file(path, file_range_, sink_)) return false;
    const auto loaded = base::load_text(path, files_, sink_);
    if (!loaded) return false;
    file_ = *loaded;
    input_.text = std::string(files_[file_].text());
    input_.folder = base::real_path(path).parent_path();
    input_.admits = [&](const std::filesystem::path& one) { return gate_.admits(one); };
    input_.find_mesh = [&](const std::string& uri, const std::string& from) {
      return mesh_file(uri, from.empty() ? path : std::filesystem::path(from));
    };
    const ImportedWorld made = format_->read(input_);
    for (const auto* places : {&made.files, &made.absent}) {
      for (const std::string& one : *places) files_.note_input(one);
    }
    if (made.fault) {
      if (tell_if_stopped(input_.stop, file_range_, sink_)) return false;
      sink_.error(codes::kBadImport, range_at(made.fault->offset), made.fault->message);
      return false;
    }
    for (const LeftOut& kind : made.left_out) {
      sink_.warning(codes::kNotTakenOver, range_at(kind.offset), kind.count, kind.what, kind.first);
    }
    lay_under(made);
    return sink_.error_count() == errors_before;
  }

 private:
  void read_request(const YamlEntry& entry) {
    if (!entry.value.is_map()) {
      set_file(entry.value, entry.key);
      return;
    }
    YamlFields fields(entry.value, key_text(entry.key), sink_);
    if (format_->key == Key::kUrdf) {
      fields.only({Key::kFile, Key::kAtM, Key::kYawRad, Key::kFixed, Key::kPositions});
    } else if (const auto* fixed = entry.value.find(Key::kFixed)) {
      refuse_fixed(*fixed);
    } else {
      fields.only({Key::kFile, Key::kAtM, Key::kYawRad, Key::kPositions});
    }
    if (const auto* file = fields.require(Key::kFile)) set_file(*file, Key::kFile);
    read_vector(fields, Key::kAtM, input_.p_WI);
    fields.angle(Key::kYawRad, input_.yaw_rad);
    fields.boolean(Key::kFixed, input_.fixed);
    read_positions(fields);
  }

  void read_positions(const YamlFields& fields) {
    constexpr double kMost = 1e3;
    const auto* positions = fields.find(Key::kPositions);
    if (positions == nullptr) return;
    const YamlFields all(*positions, key_text(Key::kPositions), sink_);
    for (const YamlEntry& entry : positions->entries) {
      const auto value = read_number(entry.value, key_text(entry.key),
                                     NumberBounds{-kMost, kMost, false, false}, sink_);
      if (value) input_.positions[entry.key] = *value;
    }
  }

  /// Folders of models mean nothing where nothing is taken over.
  bool refuse_models() {
    for (const auto key : {Key::kModels, Key::kPackages}) {
      const auto* models = world_.find(key);
      if (models == nullptr) continue;
      sink_
          .error(codes::kUnknownKey, models->key_range, models->key,
                 fmt::format("`{}` that takes no file over", Key::kWorld))
          .help(fmt::format("Name the file to take over with `{}`, `{}` or `{}`.", Key::kSdf,
                            Key::kUrdf, Key::kMjcf));
      return false;
    }
    return true;
  }

  void refuse_fixed(const YamlEntry& fixed) {
    const bool is_sdf = format_->key == Key::kSdf;
    sink_
        .error(codes::kUnknownKey, fixed.key_range, fixed.key,
               fmt::format("`{}`: only a robot in URDF is held so", format_->key))
        .help(is_sdf ? "Remove it; in SDF a model that is `<static>`, or a joint whose parent is "
                       "`world`, stands fast."
                     : "Remove it; in MJCF a body without a joint stands fast in the world.");
  }

  void set_file(const YamlNode& node, std::string_view key) {
    file_range_ = node.range;
    if (const auto text = read_text(node, key_text(key), sink_)) file_text_ = *text;
  }

  void read_folders() {
    if (const auto* models = world_.find(Key::kModels)) {
      for (const auto& one : located_texts(models->value, Key::kModels, sink_)) {
        if (auto folder = folder_at(one.text, one.source)) input_.folders.push_back(*folder);
      }
    }
    const auto* packages = world_.find(Key::kPackages);
    if (packages == nullptr) return;
    const YamlFields all(packages->value, key_text(Key::kPackages), sink_);
    for (const YamlEntry& entry : packages->value.entries) {
      const auto text = read_text(entry.value, key_text(entry.key), sink_);
      const auto folder = text ? folder_at(*text, entry.value.range) : std::nullopt;
      if (folder) input_.packages[entry.key] = *folder;
    }
  }

  std::optional<std::filesystem::path> folder_at(const std::string& text,
                                                 const base::SourceRange& place) {
    const auto folder = path_beside(place, text, files_);
    if (!gate_.check(folder, place, sink_)) return std::nullopt;
    std::error_code error;
    if (!std::filesystem::is_directory(folder, error) ||
        folder.string().find(':') != std::string::npos) {
      sink_.error(codes::kBadImport, place, fmt::format("`{}` is no folder", text));
      return std::nullopt;
    }
    return base::real_path(folder);
  }

  bool is_there(const YamlEntry& entry) {
    if (format_->is_there()) return true;
    sink_.error(codes::kImportUnavailable, entry.key_range, entry.key, format_->package);
    return false;
  }

  base::SourceRange range_at(std::size_t offset) const {
    const auto text = files_[file_].text();
    const auto end = std::min(text.find_first_of(">\n", offset), text.size());
    base::SourceRange range = file_range_;
    range.file = file_;
    range.begin = static_cast<std::uint32_t>(std::min(offset, text.size()));
    range.end = static_cast<std::uint32_t>(std::max(end, offset));
    return range;
  }

  /// A plain way down from a package or a folder of `models`, or from that of the description.
  /// Whether it may be read is decided when it is.
  std::optional<std::string> mesh_file(const std::string& uri,
                                       const std::filesystem::path& description) const {
    namespace fs = std::filesystem;
    if (!reads_meshes()) return std::nullopt;
    std::vector<fs::path> folders = {description.parent_path()};
    std::string name = uri;
    if (const auto part = package_part(uri)) {
      if (!is_plain_path(part->name)) return std::nullopt;
      folders.clear();
      for (const auto& place : package_places(part->name, input_.folders, input_.packages)) {
        folders.push_back(place.package);
      }
      name = part->rest;
    }
    const fs::path way(name);
    if (name.find(':') != name.npos || way.is_absolute()) return std::nullopt;
    if (!is_mesh_format(way)) return std::nullopt;
    if (std::find(way.begin(), way.end(), "..") != way.end()) {
      return mesh_file_above(name, folders, description);
    }
    for (const fs::path& part : way) {
      if (part.empty() || part.string().front() == '.') return std::nullopt;
    }
    for (const fs::path& folder : folders) {
      std::error_code error;
      files_.note_input((folder / way).lexically_normal().string());
      if (fs::is_regular_file(folder / way, error)) return fs::absolute(folder / way).string();
    }
    return std::nullopt;
  }

  /// A way up must end below the description's folder or one of `models`.
  std::optional<std::string> mesh_file_above(const std::string& name,
                                             const std::vector<std::filesystem::path>& folders,
                                             const std::filesystem::path& description) const {
    std::vector<std::filesystem::path> roots = {base::real_path(description).parent_path()};
    roots.insert(roots.end(), input_.folders.begin(), input_.folders.end());
    for (const auto& [name_of, folder] : input_.packages) roots.push_back(folder);
    for (const auto& folder : folders) {
      const auto way = way_within(base::real_path(folder), name, roots);
      if (!way) continue;
      std::error_code error;
      files_.note_input(way->first.string());
      if (std::filesystem::is_regular_file(way->first, error)) return way->first.string();
    }
    return std::nullopt;
  }

  void lay_under(const ImportedWorld& made) {
    const auto whole = range_at(0);
    MapNode under(whole), bodies(whole), joints(whole);
    for (const ImportedBody& body : made.bodies) {
      put_once(bodies, body.spec.name, body_node(body, range_at(body.offset)));
    }
    for (const ImportedJoint& joint : made.joints) {
      put_once(joints, joint.spec.name, joint_node(joint.spec, range_at(joint.offset)));
    }
    under.put(Key::kBodies, bodies.take());
    under.put(Key::kJoints, joints.take());
    under.text(Key::kFloorMaterial, made.floor_material);
    if (made.gravity_m_s2) {
      MapNode solver(whole);
      solver.number("gravity_m_s2", *made.gravity_m_s2);
      under.put(Key::kSolver, solver.take());
    }
    std::erase_if(world_.entries, [&](const YamlEntry& entry) {
      return entry.key == format_->key || entry.key == Key::kModels || entry.key == Key::kPackages;
    });
    const auto range = world_.range;
    YamlNode imported = under.take();
    refuse_mergers(imported, world_, Key::kBodies, "body", kOwnBodyKeys, sink_);
    refuse_mergers(imported, world_, Key::kJoints, "joint", kOwnJointKeys, sink_);
    world_ = merged(std::move(imported), std::move(world_));
    world_.range = range;
    add_friction(made.friction, whole);
  }

  /// Adds friction for the materials that are left after the scenario has replaced others.
  void add_friction(const FrictionSpec& friction, const base::SourceRange& range) {
    const auto known = materials_in(world_);
    MapNode pairs(range), under(range);
    for (const auto& [pair, mu] : friction.pairs) {
      if (!known.contains(pair.first) || !known.contains(pair.second)) continue;
      pairs.number(pair.first + "-" + pair.second, mu);
    }
    under.put(Key::kFriction, pairs.take());
    const auto own_range = world_.range;
    world_ = merged(under.take(), std::move(world_));
    world_.range = own_range;
  }

  void put_once(MapNode& map, const std::string& name, YamlNode node) {
    const auto range = node.range;
    if (names_.insert({&map, name}).second) {
      map.put_at(name, range, std::move(node));
      return;
    }
    sink_.error(codes::kBadImport, range, fmt::format("two things come to be called `{}`", name));
  }

  YamlNode& world_;
  const base::PathGate& gate_;
  base::SourceFiles& files_;
  base::DiagnosticSink& sink_;
  const ImportFormat* format_ = nullptr;
  base::SourceRange file_range_;
  std::string file_text_;
  base::FileId file_;
  ImportInput input_;
  std::set<std::pair<const MapNode*, std::string>> names_;
};

}  // namespace

bool tell_if_stopped(const std::atomic<bool>* stop, const base::SourceRange& place,
                     base::DiagnosticSink& sink) {
  if (stop == nullptr || !stop->load()) return false;
  sink.error(codes::kLimitReached, place, "--time-limit, or a signal,");
  return true;
}

bool add_imported(YamlNode& root, const base::PathGate& gate, base::SourceFiles& files,
                  base::DiagnosticSink& sink, const std::atomic<bool>* stop) {
  if (!root.is_map()) return true;
  for (YamlEntry& entry : root.entries) {
    if (entry.key == Key::kWorld && entry.value.is_map()) {
      return WorldImporter(entry.value, gate, files, sink, stop).run();
    }
  }
  return true;
}

}  // namespace parallax::harness
