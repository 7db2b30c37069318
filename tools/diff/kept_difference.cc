#include "tools/diff/kept_difference.h"

#include "compiler/artifact/path_map.h"
#include "compiler/base/temporary_folder.h"
#include "tools/app/kept_inputs.h"

namespace parallax::tools {
namespace {

/// Names without the temporary folders.
void name_places(ModelRevision& side, const compiler::PathMap& map) {
  for (auto& fact : side.facts) fact.place.file = map.mapped(fact.place.file);
}

}  // namespace

std::optional<ModelDifference> compare_kept(const std::string& old_folder,
                                            const std::string& new_folder, Context& context) {
  const base::TemporaryFolder scratch("inputs");
  if (scratch.path().empty()) return std::nullopt;
  const auto old_root = scratch.path() / "old", new_root = scratch.path() / "new";
  const auto before = unpack_inputs(old_folder, "", "", old_root);
  const auto after = unpack_inputs(new_folder, "", "", new_root);
  if (!before || !after) return std::nullopt;
  Context own({.allow_outside = context.form().allow_outside}, context.stop());
  ModelDiffOptions options;
  options.traces = false;
  options.find_renamings = true;
  auto found = compare_models(before->scenario.string(), RevisionKind::kScenario,
                              after->scenario.string(), RevisionKind::kScenario, options, own);
  if (!found) return std::nullopt;
  compiler::PathMap map{std::filesystem::path()};
  map.add(old_root.string() + "=");
  map.add(new_root.string() + "=");
  name_places(found->old_side, map);
  name_places(found->new_side, map);
  if (found->settings) {
    for (auto& change : *found->settings) {
      change.old_file = map.mapped(change.old_file);
      change.new_file = map.mapped(change.new_file);
    }
  }
  return *std::move(found);
}

std::string kept_text(const ModelDifference& found, bool stat) {
  const auto report = found.report();
  auto out = renamings_text(found.renamings, stat) +
             to_text(report, compiler::FactKind::kDeclaration, "declarations", stat) +
             to_text(report, compiler::FactKind::kAxiom, "axioms", stat);
  if (found.settings) out += settings_text(*found.settings, stat);
  return out;
}

}  // namespace parallax::tools
