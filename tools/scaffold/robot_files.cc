#include "tools/scaffold/robot_files.h"

#include <charconv>
#include <filesystem>
#include <optional>
#include <set>

#include "compiler/base/codes/scenarios.h"
#include "harness/import/description.h"
#include "harness/import/mesh.h"
#include "harness/import/plain_path.h"
#include "harness/import/way_within.h"
#include "harness/import/xml_outline.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFolder = "robot";  // of the scenario, for what is copied

/// The folder of a package: the given one, or one above the description that contains it or has its
/// name.
std::optional<fs::path> package_folder(const RobotRequest& request, const std::string& name) {
  if (const auto given = request.packages.find(name); given != request.packages.end()) {
    return fs::path(given->second);
  }
  std::error_code error;
  for (auto at = fs::absolute(request.file, error).parent_path(); at.has_relative_path();
       at = at.parent_path()) {
    if (at.filename() == name) return at;
    if (fs::is_directory(at / name, error)) return at / name;
  }
  return std::nullopt;
}

struct MeshPlaces {
  fs::path from, to;
};

/// Where a mesh is, and where its copy belongs so that the description finds it; none where the
/// description asks for what is no mesh, or for one outside of what is copied.
std::optional<MeshPlaces> mesh_places(const RobotRequest& request, const fs::path& copied_folder,
                                      const std::string& uri) {
  if (const auto part = harness::package_part(uri)) {
    if (!harness::is_plain_path(part->name) || !harness::is_plain_path(part->rest)) {
      return std::nullopt;
    }
    const auto folder = package_folder(request, part->name);
    if (!folder) return std::nullopt;
    return MeshPlaces{*folder / part->rest, fs::path(kFolder) / part->name / part->rest};
  }
  const auto way = harness::way_within("/" / copied_folder, uri, {fs::path("/") / kFolder});
  if (!way) return std::nullopt;
  return MeshPlaces{fs::path(request.file).parent_path() / uri, way->first.lexically_relative("/")};
}

void note_limit(const harness::XmlOutline& outline, const harness::XmlElement& limit,
                RobotFiles& out) {
  if (!limit.parent || outline.elements[*limit.parent].tag != "joint") return;
  const auto name = harness::plain_name(std::string(outline.elements[*limit.parent].name));
  for (const auto& [attribute, into] :
       {std::pair("effort", &out.efforts), std::pair("lower", &out.lows)}) {
    const auto* found = limit.find(attribute);
    if (found == nullptr) continue;
    double value = 0.0;
    const char* const end = found->value.data() + found->value.size();
    if (std::from_chars(found->value.data(), end, value).ec == std::errc()) (*into)[name] = value;
  }
}

}  // namespace

base::Result<RobotFiles> robot_files(const RobotRequest& request, base::DiagnosticSink& sink) {
  const fs::path file(request.file);
  RobotFiles out;
  std::string text;
  if (const auto fault = harness::read_bounded(file, harness::kMaxImportBytes, text)) {
    return sink.error_about(codes::kBadImport, request.file, *fault);
  }
  const auto outline = harness::outline_of(text);
  if (outline.fault)
    return sink.error_about(codes::kBadImport, request.file, outline.fault->message);
  if (outline.elements.empty() || outline.elements.front().tag != "robot") {
    return sink.error_about(codes::kBadImport, request.file, "it is no robot description in URDF");
  }
  std::error_code error;
  const auto folder = fs::path(kFolder) / fs::absolute(file, error).parent_path().filename();
  out.description = (folder / file.filename()).string();
  std::set<std::string> copied;
  for (const auto& element : outline.elements) {
    if (element.tag == "limit") note_limit(outline, element, out);
    if (element.tag != "mesh" || !element.parent) continue;
    const auto above = outline.elements[*element.parent].parent;
    const auto* name = element.find("filename");
    if (!above || outline.elements[*above].tag != "collision" || name == nullptr) continue;
    const auto places = mesh_places(request, folder, std::string(name->value));
    if (!places || !harness::is_mesh_format(places->from)) continue;
    if (!copied.insert(places->to.string()).second) continue;
    std::string mesh;
    if (harness::read_bounded(fs::canonical(places->from, error), harness::kMaxMeshBytes, mesh)) {
      continue;
    }
    out.files.push_back({places->to.string(), std::move(mesh)});
  }
  out.files.push_back({out.description, std::move(text)});
  return out;
}

}  // namespace parallax::tools
