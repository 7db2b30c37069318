#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/compare/trace_difference.h"
#include "tools/diff/attribution.h"
#include "tools/diff/fact_report.h"
#include "tools/diff/revision.h"

namespace parallax::tools {

struct ModelDiffOptions {
  LoadRevision load;
  bool facts = true;   // compare declarations and axioms
  bool traces = true;  // compare meaning
  std::size_t list_limit = 200;
};

/// All that is known of the difference of two models.
struct ModelDifference {
  ModelRevision old_side, new_side;
  compiler::FactDifference facts;
  std::optional<runtime::TraceDifference> traces;
  /// What the witnesses depend on; none where it was not tried.
  std::optional<std::vector<Edit>> lost_edits, gained_edits;
  std::vector<std::string> remarks;  // what was not compared, and why

  FactReport report() const { return {old_side.facts, new_side.facts, facts}; }
};

base::Result<ModelDifference> compare_models(const std::string& old_path, RevisionKind old_kind,
                                             const std::string& new_path, RevisionKind new_kind,
                                             const ModelDiffOptions& options, Context& context);

/// The part about traces, for people and as JSON. `stat`: numbers without witnesses.
std::string traces_text(const ModelDifference& difference, bool stat);
std::string traces_json(const ModelDifference& difference);

}  // namespace parallax::tools
