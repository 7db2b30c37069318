#include "tools/diff/kept_difference.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "compiler/artifact/path_map.h"
#include "compiler/base/shown_text.h"
#include "harness/campaign/journal.h"
#include "harness/campaign/replay.h"
#include "tools/app/kept_inputs.h"
#include "tools/app/recorded_run.h"
#include "tools/app/scenario_model.h"

namespace parallax::tools {
namespace {

/// Names without the temporary folders.
void name_places(ModelRevision& side, const compiler::PathMap& map) {
  for (auto& fact : side.facts) fact.place.file = map.mapped(fact.place.file);
}

/// The kept texts of one run, unpacked.
struct KeptSide {
  std::filesystem::path scenario;
  std::string refused;  // empty: they are the run's
  bool is_altered = false;
};

/// Unpacks the texts of `folder` into `root` and checks that together they are what the run read:
/// a hash for each file says nothing of one that was exchanged with its hash.
KeptSide kept_side(const std::string& folder, const std::filesystem::path& root,
                   const Context& context) {
  const auto name = base::printable(folder);
  Context own({.allow_outside = context.form().allow_outside}, context.stop());
  const auto journal = harness::read_journal(folder, own.files(), own.sink());
  if (!journal || !journal->header) return {{}, name + " has no journal that can be read", false};
  const auto& header = *journal->header;
  std::error_code error;
  if (!std::filesystem::exists(std::filesystem::path(folder) / kInputsName, error)) {
    return {{}, name + " kept no texts", false};
  }
  const KeptSide altered{
      {}, fmt::format("{}/{} does not hold what the run read", name, kInputsName), true};
  const auto unpacked = unpack_inputs(folder, header.scenario_hash, header.scenario, root);
  if (!unpacked) return altered;
  // Only the texts of the scenario count for its hash, so a context of its own reads them.
  Context reader({.allow_outside = context.form().allow_outside}, context.stop());
  const auto loaded = load_scenario_model(
      unpacked->scenario, reader, {.as_run = true, .execution = recorded_execution(header)});
  if (!loaded || !harness::scenario_change(header, loaded->sources_hash).empty()) return altered;
  return {unpacked->scenario, {}, false};
}

}  // namespace

KeptPair::KeptPair(const std::string& old_folder, const std::string& new_folder,
                   const Context& context) {
  if (scratch_.path().empty()) {
    refused_ = "there is no temporary folder";
    return;
  }
  const auto before = kept_side(old_folder, scratch_.path() / "old", context);
  const auto after = kept_side(new_folder, scratch_.path() / "new", context);
  for (const auto* side : {&before, &after}) {
    if (refused_.empty() || (side->is_altered && !is_altered_)) refused_ = side->refused;
    is_altered_ = is_altered_ || side->is_altered;
  }
  before_ = before.scenario;
  after_ = after.scenario;
}

std::optional<ModelDifference> KeptPair::compare(const Context& context) const {
  Context own({.allow_outside = context.form().allow_outside}, context.stop());
  ModelDiffOptions options;
  options.traces = false;
  options.find_renamings = true;
  auto found = compare_models(before_.string(), RevisionKind::kScenario, after_.string(),
                              RevisionKind::kScenario, options, own);
  if (!found) return std::nullopt;
  compiler::PathMap map{std::filesystem::path()};
  map.add((scratch_.path() / "old").string() + "=");
  map.add((scratch_.path() / "new").string() + "=");
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

KeptComparison compare_kept(const std::string& old_folder, const std::string& new_folder,
                            Context& context) {
  const KeptPair pair(old_folder, new_folder, context);
  if (!pair.refused().empty()) return {std::nullopt, pair.refused(), pair.is_altered()};
  auto found = pair.compare(context);
  if (!found) return {std::nullopt, "they cannot be read any more", false};
  return {std::move(found), {}, false};
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
