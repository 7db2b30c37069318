#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "compiler/base/result.h"
#include "harness/cluster/fleet.h"
#include "tools/app/scenario_model.h"
#include "tools/cli/command.h"

namespace parallax::tools {

/// Workers on other machines: docs/guide/clusters.md.
struct LauncherOptions {
  std::string launcher, hosts;
  double start_s = 120.0, silence_s = 30.0;
  std::int64_t first_slot = 0;
  bool jobs_given = false;  // for the command's --jobs
  bool mixed = false;       // workers may be of other kinds than this program
};
void add_launcher_options(OptionTable& command, LauncherOptions& options);
/// Adds --mixed, to a command whose results may come of several kinds of workers.
void add_mixed_option(OptionTable& command, LauncherOptions& options);

/// The places that the options name; null if they name none. `jobs` becomes the number of workers.
/// Reports kUsage and what reading places reports.
base::Result<std::shared_ptr<harness::Fleet>> fleet_of(const LauncherOptions& options,
                                                       std::int64_t& jobs, Invocation& invocation);

/// The command that a prefix of the fleet is put before: this program, in this folder.
std::vector<std::string> fleet_worker(const ScenarioModel& loaded, const harness::Fleet& fleet,
                                      const Invocation& invocation);

/// The same options for another process of this program that makes one simulation at a time; no
/// words where no place is named.
std::vector<std::string> launcher_words(const LauncherOptions& options);

/// Reports at the end what became of the places. `fleet` may be null. False: the results do not
/// count.
bool report_fleet(const std::shared_ptr<harness::Fleet>& fleet, Invocation& invocation);

}  // namespace parallax::tools
