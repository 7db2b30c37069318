#pragma once

// Only harness/config/*.cc include this header.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/base/path_gate.h"
#include "compiler/base/source_file.h"
#include "harness/config/scenario.h"

namespace parallax::harness {

class ReadLog;
struct YamlEntry;

/// A YAML value with its place. A scalar's range is the value without quotes; the range of a map, a
/// list or nothing is that of the key before it, or of its first token inside a list.
struct YamlNode {
  enum class Kind : std::uint8_t { kNull, kScalar, kList, kMap };
  Kind kind = Kind::kNull;
  base::SourceRange range;
  std::string text;     // of a scalar
  bool quoted = false;  // then it is text, whatever it looks like
  std::vector<YamlNode> items;
  std::vector<YamlEntry> entries;  // in source order, keys distinct
  ReadLog* log = nullptr;          // where its readers write down what they know of its fields
  std::uint32_t id = 0;            // there; copies keep it

  bool is_map() const { return kind == Kind::kMap; }
  bool is_list() const { return kind == Kind::kList; }
  bool is_scalar() const { return kind == Kind::kScalar; }
  const YamlEntry* find(std::string_view key) const;
};

struct YamlEntry {
  std::string key;
  base::SourceRange key_range;
  YamlNode value;
};

/// "a map", "a list", "the text `x`", "nothing": for messages.
std::string describe(const YamlNode& node);

inline constexpr int kMaxYamlDepth = 64;
inline constexpr std::size_t kMaxYamlBytes = kMaxScenarioBytes;

/// Reads one YAML document as a tree. Duplicate keys, anchors, aliases, tags, merge keys, further
/// documents, keys that are no scalars and texts deeper than kMaxYamlDepth are refused; what the
/// parser rejects becomes kYamlSyntax at the place it names.
base::Result<YamlNode> parse_yaml(base::FileId file, const base::SourceFiles& files,
                                  base::DiagnosticSink& sink);

/// Loads and parses `path`; then a map with the key `include: FILE`, or `include: [FILE, ...]`, is
/// laid over the documents of these files (maps merge key by key, everything else is replaced),
/// at any level of maps. Paths start at the folder of the file that names them.
/// What `gate` does not admit is refused.
base::Result<YamlNode> load_yaml(const std::filesystem::path& path, const base::PathGate& gate,
                                 base::SourceFiles& files, base::DiagnosticSink& sink);

/// `over` on top of `under`: maps merge key by key, anything else in `over` replaces.
YamlNode merged(YamlNode under, YamlNode over);

/// The path in `text`, which stands at `range`, relative to the folder of its file.
std::filesystem::path path_beside(const base::SourceRange& range, std::string_view text,
                                  const base::SourceFiles& files);

}  // namespace parallax::harness
