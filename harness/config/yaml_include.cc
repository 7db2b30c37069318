#include <algorithm>
#include <map>
#include <system_error>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/file_io.h"
#include "harness/config/keys.h"
#include "harness/config/yaml_reader.h"

namespace parallax::harness {
namespace {

using base::DiagnosticCode;

/// Files that include two others each would otherwise grow without bound.
constexpr int kMaxIncludes = 64;

class Includer {
 public:
  Includer(base::SourceFiles& files, base::DiagnosticSink& sink) : files_(files), sink_(sink) {}

  base::Result<YamlNode> load(const std::filesystem::path& path) {
    // The size is checked first: the parser's time grows faster than a hostile text.
    const auto text = base::read_file(path, sink_, kMaxYamlBytes);
    if (!text) return sink_.already_reported();
    const auto file = base::load_text(path, files_, sink_);
    if (!file) return sink_.already_reported();
    auto root = parse_yaml(*file, files_, sink_);
    if (!root) return sink_.already_reported();
    open_.push_back(real(path));
    auto result = resolved(std::move(*root));
    open_.pop_back();
    return result;
  }

 private:
  static std::filesystem::path real(const std::filesystem::path& path) {
    std::error_code error;
    auto result = std::filesystem::canonical(path, error);
    return error ? path : result;
  }

  /// Lays every map that holds `include` over what it includes. The depth is that of the tree,
  /// which kMaxYamlDepth bounds, times that of the includes, which have to be distinct files.
  base::Result<YamlNode> resolved(YamlNode node) {
    bool failed = false;
    for (auto& entry : node.entries) {
      if (entry.key == Key::kInclude || !entry.value.is_map()) continue;
      auto value = resolved(std::move(entry.value));
      if (value) {
        entry.value = std::move(*value);
      } else {
        failed = true;
      }
    }
    if (failed) return sink_.already_reported();
    const auto* found = node.find(Key::kInclude);
    if (found == nullptr) return node;
    const YamlEntry include = *found;
    std::erase_if(node.entries, [](const YamlEntry& entry) { return entry.key == Key::kInclude; });
    auto under = included(include);
    if (!under) return sink_.already_reported();
    under->range = node.range;
    return merged(std::move(*under), std::move(node));
  }

  base::Result<YamlNode> included(const YamlEntry& include) {
    const auto names =
        include.value.is_list() ? include.value.items : std::vector<YamlNode>{include.value};
    YamlNode result{YamlNode::Kind::kMap, include.key_range, {}, false, {}, {}};
    bool failed = names.empty();
    if (failed) {
      sink_.error(DiagnosticCode::kWrongYamlKind, include.key_range, key_text(Key::kInclude),
                  "empty", "a file name");
    }
    for (const auto& name : names) {
      auto root = one(name);
      if (root) {
        result = merged(std::move(result), std::move(*root));
      } else {
        failed = true;
      }
    }
    if (failed) return sink_.already_reported();
    return result;
  }

  base::Result<YamlNode> one(const YamlNode& name) {
    if (!name.is_scalar()) {
      return sink_.error(DiagnosticCode::kWrongYamlKind, name.range, key_text(Key::kInclude),
                         describe(name), "a file name");
    }
    const auto path = path_beside(name.range, name.text, files_);
    if (++includes_ > kMaxIncludes) {
      return sink_.error(DiagnosticCode::kTooManyIncludes, name.range, kMaxIncludes);
    }
    if (std::find(open_.begin(), open_.end(), real(path)) != open_.end()) {
      return sink_.error(DiagnosticCode::kIncludeCycle, name.range, name.text);
    }
    if (!std::filesystem::exists(path)) {
      return sink_.error(DiagnosticCode::kFileNotFound, name.range, path.string());
    }
    auto root = load(path);
    if (root && !root->is_map()) {
      return sink_.error(DiagnosticCode::kWrongYamlKind, name.range, "the included file",
                         describe(*root), "a map");
    }
    return root;
  }

  base::SourceFiles& files_;
  base::DiagnosticSink& sink_;
  std::vector<std::filesystem::path> open_;
  int includes_ = 0;
};

}  // namespace

YamlNode merged(YamlNode under, YamlNode over) {
  if (!under.is_map() || !over.is_map()) return over;
  std::map<std::string, std::size_t> known;
  for (std::size_t i = 0; i < under.entries.size(); ++i) known.emplace(under.entries[i].key, i);
  for (auto& entry : over.entries) {
    const auto at = known.find(entry.key);
    if (at == known.end()) {
      under.entries.push_back(std::move(entry));
    } else {
      auto& below = under.entries[at->second];
      below.key_range = entry.key_range;
      below.value = merged(std::move(below.value), std::move(entry.value));
    }
  }
  under.range = over.range;
  return under;
}

base::Result<YamlNode> load_yaml(const std::filesystem::path& path, base::SourceFiles& files,
                                 base::DiagnosticSink& sink) {
  return Includer(files, sink).load(path);
}

std::filesystem::path path_beside(const base::SourceRange& range, std::string_view text,
                                  const base::SourceFiles& files) {
  const std::filesystem::path named(text);
  if (named.is_absolute()) return named;
  return std::filesystem::path(files[range.file].name()).parent_path() / named;
}

}  // namespace parallax::harness
