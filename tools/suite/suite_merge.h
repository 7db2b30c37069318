#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "tools/suite/suite_results.h"

namespace parallax::tools {

/// The merged results of the shards of one suite, as if one process had run them all.
struct MergedSuite {
  SuiteIdentity identity;  // shard 1/1
  std::vector<SuiteCase> cases;
  std::vector<CaseResult> results;  // parallel; of a shard that is not there: kNotFinished
  std::vector<Shard> missing;       // no folder has these
  std::vector<std::string> lost;    // folders without results that can be read
  std::set<std::string> removed;    // cases that a shard has told to be gone
};

/// Reads the folders of shards (--out of each). One that is absent, empty or cut short is a shard
/// that is missing; only where no folder has results this is refused (kNoEarlierResults). Refused
/// (kUsage), with both folders named: results of different programs, seeds, selections or revisions
/// (lists of cases, their definitions, files that were read), a shard twice, a case that two shards
/// have or that its own does not have.
base::Result<MergedSuite> merge_suites(const std::vector<std::string>& folders,
                                       base::DiagnosticSink& sink);

}  // namespace parallax::tools
