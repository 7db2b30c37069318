#pragma once

#include <optional>
#include <string>

#include "compiler/repair/axiom_form.h"
#include "harness/config/scenario.h"

namespace parallax::tools {

/// Puts an entry, `KEY: VALUE`, into the `mapping` of a scenario file, behind the one for `beside`,
/// as the file is laid out. None: the scenario binds that fluent by its name alone.
std::optional<compiler::TextChange> mapping_line(const harness::FluentBinding& beside,
                                                 const std::string& entry,
                                                 const base::SourceFiles& files);

}  // namespace parallax::tools
