#pragma once

#include <filesystem>
#include <vector>

#include "harness/config/scenario.h"

namespace parallax::harness {

/// The scenarios with other plans that the key `validate` of a scenario names, for repairs of its
/// model. Reports what reading the file reports, and files that are not there.
base::Result<std::vector<LocatedText>> scenarios_to_validate(const std::filesystem::path& scenario,
                                                             base::SourceFiles& files,
                                                             base::DiagnosticSink& sink,
                                                             bool allow_outside);

}  // namespace parallax::harness
