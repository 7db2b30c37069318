#pragma once

#include <string>

namespace parallax::tools {

/// Compiles a model file in this process and prints one line: processor time of reading and
/// grounding, of making clauses, of writing them as text; numbers of clauses and bytes. 3 if the
/// model has an error.
int print_stages(const std::string& file);

}  // namespace parallax::tools
