#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/cli/launcher_options.h"
#include "tools/cli/mutate_suite.h"
#include "tools/cli/shared_options.h"

namespace parallax::tools {

/// The options of `parallax suite`.
struct SuiteOptions {
  std::vector<std::string> paths, merge;
  std::string only;
  std::string out = "out/suite";
  bool out_given = false;
  std::string junit, markdown, annotations, quarantine, cache, verify_cache, ledger;
  std::string history, revision;
  std::string shard = "1/1";
  std::uint64_t seed = 1;
  std::int64_t jobs = 1, memory_mb = 0, retries = 0;
  bool update_goldens = false;
  bool force = false;
  bool rerun_failed = false, resume = false;
  bool confirm = false;
  bool collect_only = false;
  bool no_cache = false;
  bool fast = false;
  CommandPermission commands;
  LauncherOptions launcher;
  MutateOptions mutants;
};

}  // namespace parallax::tools
