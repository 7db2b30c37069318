#pragma once

#include <string>
#include <vector>

#include "compiler/compare/fact.h"
#include "tools/app/context.h"

namespace parallax::tools {

/// The report of a run as JSON: of a run folder, or a report.json (E7111). It is an object with
/// `verdict` and `traces`.
base::Result<std::string> load_run_report(const std::string& path, Context& context);

/// The report of a run as facts: its settings as declarations; its verdict, and for every trace its
/// verdict and its discrepancies, as axioms. A trace is known by its events and its initial state.
/// `path` is a run folder or a report.json (E7111).
base::Result<std::vector<compiler::Fact>> load_run_facts(const std::string& path, Context& context);

/// The canonical text of one file: one fact a line, sorted, for goldens and `git diff`. Models (.e)
/// are read alone: what they load need not exist. A usage error for other kinds of files.
base::Result<std::string> canonical_text_of(const std::string& path, Context& context);

}  // namespace parallax::tools
