#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "compiler/base/diagnostic.h"

namespace parallax::harness {

/// Cases that may fail for now, by name, with the reason why.
using Quarantine = std::map<std::string, std::string>;

/// Reads a list `quarantine: [{case: NAME, because: TEXT}, ...]`. Both keys are required, a case
/// stands there once, and a reason is not empty (docs/reference/suites.md).
base::Result<Quarantine> load_quarantine(const std::filesystem::path& path,
                                         base::SourceFiles& files, base::DiagnosticSink& sink);

}  // namespace parallax::harness
