#include "harness/config/quarantine.h"

#include "compiler/base/codes/scenarios.h"
#include "compiler/base/path_gate.h"
#include "harness/config/sections.h"

namespace parallax::harness {

base::Result<Quarantine> load_quarantine(const std::filesystem::path& path,
                                         base::SourceFiles& files, base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  base::PathGate gate(false);
  gate.admit_beside(path);
  const auto root = load_yaml(path, gate, files, sink);
  if (!root) return sink.already_reported();
  YamlFields fields(*root, "the list", sink);
  fields.only({Key::kQuarantine});
  Quarantine out;
  const auto* entries = fields.require(Key::kQuarantine);
  if (entries != nullptr && !entries->is_list()) {
    sink.error(codes::kWrongYamlKind, entries->range, key_text(Key::kQuarantine),
               describe(*entries), "a list of cases");
    return sink.already_reported();
  }
  for (const auto& node : entries == nullptr ? std::vector<YamlNode>{} : entries->items) {
    YamlFields entry(node, "the entry", sink);
    entry.only({Key::kCase, Key::kBecause});
    const auto *name = entry.require(Key::kCase), *reason = entry.require(Key::kBecause);
    if (name == nullptr || reason == nullptr) continue;
    auto case_name = read_text(*name, key_text(Key::kCase), sink);
    auto why = read_text(*reason, key_text(Key::kBecause), sink);
    if (!case_name || !why) continue;
    if (why->find_first_not_of(" \t\n") == std::string::npos) {
      sink.error(codes::kWrongYamlKind, reason->range, key_text(Key::kBecause), "empty",
                 "a reason in words");
    } else if (!out.emplace(*case_name, *std::move(why)).second) {
      sink.error(codes::kDuplicateCase, name->range, *case_name);
    }
  }
  if (sink.error_count() != errors_before) return sink.already_reported();
  return out;
}

}  // namespace parallax::harness
