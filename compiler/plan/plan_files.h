#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/base/path_gate.h"
#include "compiler/base/result.h"
#include "compiler/base/source_file.h"

namespace parallax::compiler {

/// A file or a folder of a plan, and where a file names it; none: the user named it.
struct PlanEntry {
  std::filesystem::path path;
  std::optional<base::SourceRange> place;
};

/// Reads the files of a plan in the order in which Lisp would load them. A folder stands for the
/// files that its system definition (`.asd`) names, in that order; without one for its `.lisp`
/// files by name (W-ORDER, if there are several). Of several definitions the one named like the
/// folder counts. Files that definitions name, and targets of links, must be admitted by `gate`. A
/// file that stands twice, a folder without plan and more than kMaxPlanFiles are CPL062.
base::Result<std::vector<base::FileId>> load_plan_files(std::span<const PlanEntry> paths,
                                                        const base::PathGate& gate,
                                                        base::SourceFiles& files,
                                                        base::DiagnosticSink& sink);

/// The plan files and system definitions that lie directly in a folder, by name; of either kind
/// at most one more than kMaxPlanFiles.
std::vector<std::filesystem::path> plan_files_in(const std::filesystem::path& folder);

}  // namespace parallax::compiler
