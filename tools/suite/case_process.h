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

/// What this program is run with. Files are named by others: one of the name `--certify=m.e` is a
/// file all the same.
struct CommandWords {
  std::vector<std::string> options;  // behind the command's name
  std::vector<std::string> files;
};

/// Runs this program again with other arguments. When `stop` is raised it is asked to end and
/// waited for all the same.
base::Captured run_this_program(const CommandWords& words, Footprint& footprint,
                                const std::atomic<bool>& stop,
                                std::optional<std::uint64_t> cpu_limit_s = {});

/// Of a process that ended without an answer: notes why.
void report_no_answer(const base::Captured& child, CaseResult& result);

/// What the process of a case may do is what the suite may.
void add_permissions(const RunnerOptions& options, bool simulates, std::vector<std::string>& words);

/// What explains an answer may take so long, where the case has no limit of its own.
inline constexpr double kBlameLimitS = 60.0;

/// The document of `parallax explain --json` about models, or a run folder, for whose kind of cause
/// it may make further simulations. Empty where it gives none: then it is not known what to blame,
/// which changes no outcome.
std::string explanation_of(CommandWords words, double limit_s, const RunnerOptions& options,
                           Footprint& footprint, const std::atomic<bool>& stop);

}  // namespace parallax::tools
