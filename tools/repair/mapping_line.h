#pragma once

#include <optional>
#include <string>

#include "compiler/repair/axiom_form.h"
#include "harness/config/scenario.h"

namespace parallax::tools {

/// Adds an entry, `KEY: VALUE`, to the `mapping` of a scenario file, after the one for `beside`, in
/// the file's layout. None: the scenario binds that fluent by its name alone.
std::optional<compiler::TextChange> mapping_line(const harness::FluentBinding& beside,
                                                 const std::string& entry,
                                                 const base::SourceFiles& files);

}  // namespace parallax::tools
