#pragma once

#include <optional>
#include <string>

#include "compiler/base/result.h"
#include "harness/campaign/journal.h"
#include "tools/app/blame.h"
#include "tools/app/context.h"
#include "tools/app/explain.h"
#include "tools/app/observed_path.h"
#include "tools/app/recorded_run.h"
#include "tools/app/scenario_model.h"

namespace parallax::tools {

/// A discrepancy of a recorded run: the course of one simulation, and where the scenario's model
/// cannot follow.
struct RecordedDiscrepancy {
  ScenarioModel loaded;
  harness::JournalText journal;
  ObservedPath path;
  std::optional<Parting> parting;  // none: the model goes along with all of it
};

/// `sample`: TRACE.SAMPLE, or empty for the first discrepancy. None if the run found none. Reports
/// what is wrong with the run folder, and a scenario that has changed since.
base::Result<std::optional<RecordedDiscrepancy>> load_discrepancy(const RunFolderOptions& folder,
                                                                  const std::string& sample,
                                                                  Context& context);

/// The observations of a discrepancy: as literals for the contradiction search, and as lines of
/// text.
ObservedRun observed_run(const RecordedDiscrepancy& found);

/// The sets that an explanation tells, best first: the one about the first difference, else a
/// smallest one; or all, those with an axiom about the last event first.
base::Result<runtime::MinimalSets> blamed_sets(const RecordedDiscrepancy& found,
                                               const SetOptions& options,
                                               ContradictionSearch& search);

}  // namespace parallax::tools
