#include "harness/config/yaml_reader.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <map>
#include <optional>
#include <sstream>
#include <system_error>

#include "compiler/base/codes/scenarios.h"
#include "compiler/base/file_io.h"
#include "harness/config/keys.h"

namespace parallax::harness {

using base::SourceRange;

namespace {

/// Thrown by the handler and caught in parse_yaml: yaml-cpp has no other way to stop early.
struct TooDeep {
  std::uint32_t offset;
};

/// Turns yaml-cpp's events into the tree. The events are used, and not its own nodes, because they
/// show aliases, anchors, tags and duplicate keys, which its nodes have resolved already.
class TreeBuilder final : public YAML::EventHandler {
 public:
  TreeBuilder(base::FileId file, const base::SourceFiles& files, base::DiagnosticSink& sink)
      : file_(file), text_(files[file].text()), sink_(sink) {}

  YamlNode take() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    refuse_anchor(mark, anchor);
    place(YamlNode{YamlNode::Kind::kNull, token(mark), {}, false, {}, {}});
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    sink_.error(codes::kYamlFeature, token(mark), "aliases");
    place(YamlNode{YamlNode::Kind::kNull, token(mark), {}, false, {}, {}});
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    refuse_tag(mark, tag);
    refuse_anchor(mark, anchor);
    YamlNode node{YamlNode::Kind::kScalar, scalar_range(mark, value), value, tag == "!", {}, {}};
    if (!node.quoted && (value == "~" || value == "null")) node.kind = YamlNode::Kind::kNull;
    place(std::move(node));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(YamlNode::Kind::kList, mark, tag, anchor);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(YamlNode::Kind::kMap, mark, tag, anchor);
  }
  void OnMapEnd() override { close(); }

 private:
  struct Level {
    YamlNode node;
    std::optional<YamlEntry> entry;                // a key that waits for its value
    std::map<std::string, SourceRange> keys = {};  // of the entries so far
  };

  std::uint32_t offset(const YAML::Mark& mark) const {
    const auto size = static_cast<std::uint32_t>(text_.size());
    return mark.pos < 0 ? 0 : std::min(static_cast<std::uint32_t>(mark.pos), size);
  }

  SourceRange token(const YAML::Mark& mark) const {
    const auto begin = offset(mark);
    const auto size = static_cast<std::uint32_t>(text_.size());
    return {file_, begin, std::min(begin + 1, size)};
  }

  /// yaml-cpp gives the start only. The end is exact for plain and quoted scalars on one line;
  /// others end with their first line.
  SourceRange scalar_range(const YAML::Mark& mark, const std::string& value) const {
    const auto begin = offset(mark);
    if (text_.substr(begin).starts_with(value)) {
      return {file_, begin, begin + static_cast<std::uint32_t>(value.size())};
    }
    if (begin < text_.size() && (text_[begin] == '"' || text_[begin] == '\'')) {
      const char quote = text_[begin];
      auto end = begin + 1;
      while (end < text_.size() && text_[end] != quote) {
        end += quote == '"' && text_[end] == '\\' ? 2U : 1U;
      }
      return {file_, begin + 1, std::min(end, static_cast<std::uint32_t>(text_.size()))};
    }
    const auto line_end = std::min(text_.find('\n', begin), text_.size());
    return {file_, begin, static_cast<std::uint32_t>(line_end)};
  }

  void refuse_anchor(const YAML::Mark& mark, YAML::anchor_t anchor) {
    if (anchor != 0) sink_.error(codes::kYamlFeature, token(mark), "anchors");
  }
  /// "?" and "!" are what yaml-cpp calls plain and quoted values without a tag.
  void refuse_tag(const YAML::Mark& mark, const std::string& tag) {
    if (tag.empty() || tag == "?" || tag == "!") return;
    sink_.error(codes::kYamlFeature, token(mark), "tags");
  }

  void open(YamlNode::Kind kind, const YAML::Mark& mark, const std::string& tag,
            YAML::anchor_t anchor) {
    refuse_tag(mark, tag);
    refuse_anchor(mark, anchor);
    if (levels_.size() >= static_cast<std::size_t>(kMaxYamlDepth)) throw TooDeep{offset(mark)};
    levels_.push_back({YamlNode{kind, token(mark), {}, false, {}, {}}, std::nullopt});
  }

  void close() {
    auto node = std::move(levels_.back().node);
    levels_.pop_back();
    place(std::move(node));
  }

  void place(YamlNode node) {
    if (levels_.empty()) {
      root_ = std::move(node);
      return;
    }
    auto& level = levels_.back();
    if (level.node.is_list()) {
      level.node.items.push_back(std::move(node));
    } else if (!level.entry) {
      start_entry(level, std::move(node));
    } else {
      if (!node.is_scalar()) node.range = level.entry->key_range;
      level.entry->value = std::move(node);
      const auto fresh = level.keys.emplace(level.entry->key, level.entry->key_range).second;
      if (fresh) level.node.entries.push_back(std::move(*level.entry));
      level.entry.reset();
    }
  }

  void start_entry(Level& level, YamlNode key) {
    if (!key.is_scalar()) {
      sink_.error(codes::kYamlSyntax, key.range, "a key must be a word");
    } else if (key.text == "<<" && !key.quoted) {
      sink_.error(codes::kYamlFeature, key.range, "merge keys");
    } else if (const auto earlier = level.keys.find(key.text); earlier != level.keys.end()) {
      sink_.error(codes::kDuplicateKey, key.range, key.text)
          .note(earlier->second, "first given here");
    }
    level.entry = YamlEntry{std::move(key.text), key.range, {}};
  }

  base::FileId file_;
  std::string_view text_;
  base::DiagnosticSink& sink_;
  YamlNode root_;
  std::vector<Level> levels_;
};

SourceRange at_mark(base::FileId file, const YAML::Mark& mark, const base::SourceFiles& files) {
  const auto size = static_cast<std::uint32_t>(files[file].text().size());
  const auto begin = mark.pos < 0 ? 0U : std::min(static_cast<std::uint32_t>(mark.pos), size);
  return {file, begin, std::min(begin + 1, size)};
}

/// A tab where a line is indented, up to the place; YAML has no indentation but blanks.
std::optional<SourceRange> tab_before(const SourceRange& place, std::string_view text) {
  for (std::size_t begin = 0; begin <= place.begin && begin < text.size();) {
    const auto content = std::min(text.find_first_not_of(" \t", begin), text.size());
    const auto tab = text.substr(begin, content - begin).find('\t');
    const bool says_nothing = content == text.size() || text[content] == '\n' ||
                              text[content] == '\r' || text[content] == '#';
    if (tab != std::string_view::npos && !says_nothing) {
      const auto at = static_cast<std::uint32_t>(begin + tab);
      return SourceRange{place.file, at, at + 1};
    }
    const auto newline = text.find('\n', content);
    if (newline == std::string_view::npos) break;
    begin = newline + 1;
  }
  return std::nullopt;
}

/// Files that include two others each would otherwise grow without bound.
constexpr int kMaxIncludes = 64;

class Includer {
 public:
  Includer(const base::PathGate& gate, base::SourceFiles& files, base::DiagnosticSink& sink)
      : gate_(gate), files_(files), sink_(sink) {}

  base::Result<YamlNode> load(const std::filesystem::path& path) {
    files_.note_input(path.string());
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
      sink_.error(codes::kWrongYamlKind, include.key_range, key_text(Key::kInclude), "empty",
                  "a file name");
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
      return sink_.error(codes::kWrongYamlKind, name.range, key_text(Key::kInclude), describe(name),
                         "a file name");
    }
    const auto path = path_beside(name.range, name.text, files_);
    if (!gate_.check(path, name.range, sink_)) return sink_.already_reported();
    if (++includes_ > kMaxIncludes) {
      return sink_.error(codes::kTooManyIncludes, name.range, kMaxIncludes);
    }
    if (std::find(open_.begin(), open_.end(), real(path)) != open_.end()) {
      return sink_.error(codes::kIncludeCycle, name.range, name.text);
    }
    files_.note_input(path.string());
    if (!base::check_file(path, name.range, sink_)) return sink_.already_reported();
    auto root = load(path);
    if (root && !root->is_map()) {
      return sink_.error(codes::kWrongYamlKind, name.range, "the included file", describe(*root),
                         "a map");
    }
    return root;
  }

  const base::PathGate& gate_;
  base::SourceFiles& files_;
  base::DiagnosticSink& sink_;
  std::vector<std::filesystem::path> open_;
  int includes_ = 0;
};

}  // namespace

const YamlEntry* YamlNode::find(std::string_view key) const {
  const auto found = std::find_if(entries.begin(), entries.end(),
                                  [&](const YamlEntry& entry) { return entry.key == key; });
  return found == entries.end() ? nullptr : &*found;
}

std::string describe(const YamlNode& node) {
  constexpr std::size_t kShown = 40;
  switch (node.kind) {
    case YamlNode::Kind::kNull:
      return "empty";
    case YamlNode::Kind::kMap:
      return node.entries.empty() ? "an empty map" : "a map";
    case YamlNode::Kind::kList:
      return node.items.empty() ? "an empty list" : "a list";
    case YamlNode::Kind::kScalar:
      break;
  }
  const bool cut = node.text.size() > kShown;
  return "`" + node.text.substr(0, kShown) + (cut ? "...`" : "`");
}

base::Result<YamlNode> parse_yaml(base::FileId file, const base::SourceFiles& files,
                                  base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  TreeBuilder builder(file, files, sink);
  try {
    std::istringstream stream{std::string(files[file].text())};
    YAML::Parser parser(stream);
    parser.HandleNextDocument(builder);
    auto root = builder.take();
    TreeBuilder rest(file, files, sink);
    if (parser.HandleNextDocument(rest)) {
      sink.error(codes::kYamlFeature, rest.take().range, "further documents");
    }
    if (sink.error_count() != errors_before) return sink.already_reported();
    return root;
  } catch (const YAML::Exception& error) {
    const auto place = at_mark(file, error.mark, files);
    if (const auto tab = tab_before(place, files[file].text())) {
      return sink.error(codes::kYamlSyntax, *tab, "a line is indented with a tab")
          .help("Indent with blanks.");
    }
    return sink.error(codes::kYamlSyntax, place, error.msg);
  } catch (const TooDeep& stop) {
    return sink.error(codes::kYamlTooDeep, SourceRange{file, stop.offset, stop.offset + 1},
                      kMaxYamlDepth);
  }
}

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

base::Result<YamlNode> load_yaml(const std::filesystem::path& path, const base::PathGate& gate,
                                 base::SourceFiles& files, base::DiagnosticSink& sink) {
  return Includer(gate, files, sink).load(path);
}

std::filesystem::path path_beside(const base::SourceRange& range, std::string_view text,
                                  const base::SourceFiles& files) {
  const std::filesystem::path named(text);
  if (named.is_absolute()) return named;
  return std::filesystem::path(files[range.file].name()).parent_path() / named;
}

}  // namespace parallax::harness
