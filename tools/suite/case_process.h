#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compiler/base/subprocess.h"
#include "tools/suite/footprint.h"
#include "tools/suite/suite_runner.h"

namespace parallax::tools {

/// Options and files of a run of this program. File names come from others: one like
/// `--certify=m.e` is still a file.
struct CommandWords {
  std::vector<std::string> options;  // behind the command's name
  std::vector<std::string> files;
};

/// Runs this program again with other arguments. When `stop` is raised it is asked to end and
/// waited for all the same.
base::Captured run_this_program(const CommandWords& words, Footprint& footprint,
                                const std::atomic<bool>& stop,
                                std::optional<std::uint64_t> cpu_limit_s = {});

/// Did the command end because no worker was left? What its run says then is no answer.
bool lacked_workers(const base::Captured& child);

/// Notes why a process ended without an answer.
void report_no_answer(const base::Captured& child, CaseResult& result);

/// Passes the suite's permissions on to the process of a case.
void add_permissions(const RunnerOptions& options, bool simulates, std::vector<std::string>& words);

/// Time limit for explaining an answer, where the case has no limit of its own.
inline constexpr double kBlameLimitS = 60.0;

/// The document of `parallax explain --json` about models, or about a run folder, where it may make
/// further simulations to find the kind of cause. Empty if there is none: then the cause is
/// unknown, which changes no outcome.
std::string explanation_of(CommandWords words, double limit_s, const RunnerOptions& options,
                           Footprint& footprint, const std::atomic<bool>& stop);

}  // namespace parallax::tools
