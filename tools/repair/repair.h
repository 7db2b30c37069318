#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/base/result.h"
#include "tools/app/recorded_run.h"
#include "tools/repair/patch.h"
#include "tools/repair/verification.h"

namespace parallax::tools {

struct RepairOptions {
  RunFolderOptions folder;
  bool other_model = false;  // the scenario need not be as it was when it was run
  std::int64_t limit = 5;    // proposals that are shown; 0: all
};

/// Edits after which the model admits every recorded run, as far as it is needed.
struct Proposal {
  std::size_t size = 0;  // edits
  int oddity = 0;        // Edit::oddity, of all
  std::string words;     // a sentence without its period
  std::vector<ChangedFile> files;
  std::string text;         // of the edited model
  bool precaution = false;  // what may fail is taken to fail
  Verdict verdict;
  TraceEffects effects;
};

/// Where runs and model parted.
struct RunParting {
  std::vector<std::string> ids;  // of the runs
  std::size_t after = 0;         // timepoint
  Evidence::Step step;           // in front of it
  Evidence::State seen;          // there, unlike what the model says
};

struct RepairResult {
  std::size_t runs = 0, failed = 0;  // read from the folder; those that the model cannot follow
  std::vector<RunParting> partings;
  /// Runs that went the same way up to a step and then differently: chance, or the simulator.
  std::vector<std::string> contradictions;
  std::vector<Proposal> proposals;  // best first
  bool more = false;                // there are further ones that were not looked at
  std::size_t edits = 0;            // single edits that were considered
  std::string nearest_miss;         // where there is no proposal; may be empty
  std::vector<std::string> remarks;
};

/// What is to be changed in the model so that it admits what was seen in the runs of a folder. The
/// grammar is that of compiler/repair; it is searched by the number of edits, first about the steps
/// where runs and model parted. Every proposal was compiled from its text and held against every
/// run. Reports what read_journal and load_recorded_scenario report.
base::Result<RepairResult> propose_repairs(const RepairOptions& options, Context& context);

/// Writes the files of a proposal. Reports what cannot be written, before anything is.
base::Status apply_proposal(const Proposal& proposal, Context& context);

std::string repair_text(const RepairResult& result, const RepairOptions& options);
std::string repair_json(const RepairResult& result);

}  // namespace parallax::tools
