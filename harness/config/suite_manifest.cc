#include "harness/config/suite_manifest.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "compiler/base/ascii.h"
#include "compiler/base/codes/scenarios.h"
#include "compiler/base/file_io.h"
#include "harness/config/sections.h"

namespace parallax::harness {
namespace {

constexpr std::int64_t kMaxTraces = 1'000'000'000;
constexpr NumberBounds kTimeLimit{0.0, 86400.0, true, false};

class ManifestReader {
 public:
  ManifestReader(const base::PathGate& gate, const base::SourceFiles& files,
                 base::DiagnosticSink& sink)
      : gate_(gate), files_(files), sink_(sink) {}

  void read(const YamlNode& root, SuiteManifest& manifest) {
    YamlFields fields(root, "the manifest", sink_);
    fields.only({Key::kDefaults, Key::kCases});
    YamlNode defaults;
    if (const auto* node = fields.find(Key::kDefaults)) {
      check_defaults(*node);
      defaults = *node;
    }
    const auto* cases = fields.require(Key::kCases);
    if (cases == nullptr) return;
    if (!cases->is_list() || cases->items.empty()) {
      sink_.error(codes::kWrongYamlKind, cases->range, key_text(Key::kCases),
                  cases->is_list() ? "empty" : describe(*cases), "a list of cases");
      return;
    }
    for (const auto& node : cases->items) {
      manifest.cases.push_back(read_case(node.is_map() ? merged(defaults, node) : node));
    }
  }

 private:
  /// Only what several cases can share; mistakes in the values show where they are read.
  void check_defaults(const YamlNode& node) {
    YamlFields fields(node, key_text(Key::kDefaults), sink_);
    fields.only({Key::kHorizon, Key::kConstraints, Key::kLimits, Key::kExpect});
    if (const auto* expect = fields.find(Key::kExpect)) {
      YamlFields(*expect, key_text(Key::kExpect) + " of `defaults`", sink_).only({Key::kComplete});
    }
  }

  ManifestCase read_case(const YamlNode& node) {
    ManifestCase out;
    out.source = node.range;
    YamlFields fields(node, "the case", sink_);
    if (!node.is_map()) return out;
    fields.only(
        {Key::kId, Key::kModel, Key::kHorizon, Key::kConstraints, Key::kLimits, Key::kExpect});
    if (const auto* id = fields.require(Key::kId)) read_id(*id, out);
    if (const auto* models = fields.require(Key::kModel)) {
      out.models = located_texts(*models, Key::kModel, sink_);
      for (auto& model : out.models) resolve_model(model);
    }
    fields.integer(Key::kHorizon, 0, kMaxHorizon, out.horizon);
    if (const auto* constraints = fields.find(Key::kConstraints)) {
      out.constraints = located_texts(*constraints, Key::kConstraints, sink_);
    }
    if (const auto* limits = fields.find(Key::kLimits)) read_limits(*limits, out);
    const auto errors_before = sink_.error_count();
    if (const auto* expect = fields.find(Key::kExpect)) read_expectation(*expect, out.expect);
    const bool nothing =
        !out.expect.lists_traces() && out.expect.holds.empty() && out.expect.violated.empty();
    if (nothing && sink_.error_count() == errors_before) {
      sink_.error(codes::kCaseExpectsNothing, out.source, out.id);
    }
    return out;
  }

  void read_id(const YamlNode& node, ManifestCase& out) {
    const auto id = read_text(node, key_text(Key::kId), sink_);
    if (!id) return;
    out.id = *id;
    out.source = node.range;
    if (const auto problem = id_problem(*id); !problem.empty()) {
      sink_.error(codes::kBadCaseId, node.range, *id, problem);
      return;
    }
    const auto [first, is_new] = ids_.emplace(*id, node.range);
    if (is_new) return;
    sink_.error(codes::kDuplicateCase, node.range, *id)
        .note(first->second, "the first one is here");
  }

  void read_limits(const YamlNode& node, ManifestCase& out) {
    YamlFields fields(node, key_text(Key::kLimits) + " of a case", sink_);
    fields.only({Key::kTimeS, Key::kMemoryMb});
    fields.number(Key::kTimeS, kTimeLimit, out.time_limit_s);
    fields.integer(Key::kMemoryMb, 16, 10'000'000, out.memory_limit_mb);
  }

  void read_expectation(const YamlNode& node, TraceExpectation& out) {
    const auto errors_before = sink_.error_count();
    YamlFields fields(node, key_text(Key::kExpect) + " of a case", sink_);
    fields.only({Key::kTraces, Key::kComplete, Key::kGolden, Key::kHolds, Key::kViolated});
    fields.integer(Key::kTraces, 0, kMaxTraces, out.traces);
    fields.boolean(Key::kComplete, out.complete);
    if (const auto* holds = fields.find(Key::kHolds)) {
      out.holds = located_texts(*holds, Key::kHolds, sink_);
    }
    if (const auto* violated = fields.find(Key::kViolated)) {
      out.violated = located_texts(*violated, Key::kViolated, sink_);
    }
    if (const auto* golden = fields.find(Key::kGolden)) {
      if (auto text = read_text(*golden, key_text(Key::kGolden), sink_)) {
        const auto path = path_beside(golden->range, *text, files_).lexically_normal();
        out.golden = LocatedText{path.string(), golden->range};
        if (!gate_.check(path, golden->range, sink_)) return;
      }
    }
    const bool lists = out.lists_traces() || (out.holds.empty() && out.violated.empty());
    if (lists && !out.complete && out.traces.value_or(0) < 1 &&
        sink_.error_count() == errors_before) {
      const auto* place = fields.find(out.traces ? Key::kTraces : Key::kComplete);
      sink_.error(codes::kYamlOutOfBounds, place->range, key_text(Key::kTraces),
                  out.traces ? "0" : "not given",
                  fmt::format("at least 1 where `{}` is false", Key::kComplete));
    }
  }

  void resolve_model(LocatedText& model) {
    const auto resolved = path_beside(model.source, model.text, files_).lexically_normal();
    // For a path outside the gate, not even its existence is told.
    if (gate_.check(resolved, model.source, sink_)) {
      (void)base::check_file(resolved, model.source, sink_);
    }
    model.text = resolved.string();
  }

  const base::PathGate& gate_;
  const base::SourceFiles& files_;
  base::DiagnosticSink& sink_;
  std::map<std::string, base::SourceRange> ids_;  // the first use of each
};

}  // namespace

std::string id_problem(std::string_view id) {
  constexpr std::size_t kMaxIdLength = 100;
  if (id.size() > kMaxIdLength) return fmt::format("it is longer than {} bytes", kMaxIdLength);
  if (id.empty() || !base::is_name_character(id.front()) || id.front() == '_') {
    return "it does not begin with a letter or a digit";
  }
  const auto bad = std::find_if(id.begin(), id.end(), [](char c) {
    return !base::is_name_character(c) && c != '-' && c != '.';
  });
  return bad == id.end() ? "" : "it has other characters than letters, digits, `_`, `-` and `.`";
}

namespace {

/// May a file without `expect` be a scenario? One with a model and a world may, and so may one with
/// a model and a key that no scenario has: the key may be a misspelt `expect`. A file with a model
/// alone is a part that others include.
bool may_be_scenario(const YamlNode& root) {
  if (root.find(Key::kModel) == nullptr) return false;
  if (root.find(Key::kWorld) != nullptr || root.find(Key::kSimulator) != nullptr) return true;
  return std::any_of(root.entries.begin(), root.entries.end(), [](const YamlEntry& entry) {
    return std::find(kScenarioKeys.begin(), kScenarioKeys.end(), entry.key) == kScenarioKeys.end();
  });
}

/// Is it a manifest whose key `cases` is misspelt? It has a list of things with a model or an id
/// that something is expected of.
bool may_be_manifest(const YamlNode& root) {
  const auto is_case = [](const YamlNode& item) {
    return item.is_map() && item.find(Key::kExpect) != nullptr &&
           (item.find(Key::kModel) != nullptr || item.find(Key::kId) != nullptr);
  };
  return std::any_of(root.entries.begin(), root.entries.end(), [&](const YamlEntry& entry) {
    const auto& items = entry.value.items;
    return entry.value.is_list() && std::any_of(items.begin(), items.end(), is_case);
  });
}

}  // namespace

SuiteFileKind suite_file_kind(const std::filesystem::path& path, bool allow_outside) {
  base::SourceFiles files;
  return suite_file_kind(path, allow_outside, files);
}

SuiteFileKind suite_file_kind(const std::filesystem::path& path, bool allow_outside,
                              base::SourceFiles& files) {
  base::DiagnosticSink unread;
  base::PathGate gate(allow_outside);
  gate.admit_beside(path);
  if (const auto root = load_yaml(path, gate, files, unread)) {
    if (root->find(Key::kCases) != nullptr) return SuiteFileKind::kManifest;
    const auto* expect = root->find(Key::kExpect);
    // An empty one takes back what an included file expects.
    const bool is_scenario =
        expect != nullptr ? expect->value.kind != YamlNode::Kind::kNull : may_be_scenario(*root);
    if (is_scenario) return SuiteFileKind::kScenario;
    return may_be_manifest(*root) ? SuiteFileKind::kManifest : SuiteFileKind::kOther;
  }
  if (files.size() == 0) return SuiteFileKind::kBroken;
  // The file alone, where what it includes cannot be read.
  const auto own = parse_yaml(base::FileId(0), files, unread);
  if (own && own->find(Key::kCases) != nullptr) return SuiteFileKind::kManifest;
  const bool may_be_either = !own || own->find(Key::kInclude) != nullptr;
  return may_be_either ? SuiteFileKind::kBroken : SuiteFileKind::kOther;
}

base::Result<SuiteManifest> load_manifest(const std::filesystem::path& path,
                                          base::SourceFiles& files, base::DiagnosticSink& sink,
                                          bool allow_outside) {
  const auto errors_before = sink.error_count();
  base::PathGate gate(allow_outside, &files);
  gate.admit_beside(path);
  const auto root = load_yaml(path, gate, files, sink);
  if (!root) return sink.already_reported();
  SuiteManifest manifest{path, {}};
  ManifestReader(gate, files, sink).read(*root, manifest);
  if (sink.error_count() != errors_before) return sink.already_reported();
  return manifest;
}

}  // namespace parallax::harness
