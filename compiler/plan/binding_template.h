#pragma once

#include <string>
#include <string_view>

#include "compiler/base/diagnostic.h"
#include "compiler/plan/plan_binding.h"

namespace parallax::compiler {

/// Cuts `text` at its variables and mapping functions; the literal text stays as written. `source`
/// is the place of `text`. Reports E4001 for a mapping function of anything but a variable.
base::Result<Template> parse_template(std::string_view text, base::SourceRange source,
                                      base::DiagnosticSink& sink);

/// True for region, place and gaze.
bool is_mapping_function(std::string_view name);

/// A variable `?x` at the start of `text`: its length, 0 if there is none.
std::size_t variable_length(std::string_view text);

}  // namespace parallax::compiler
