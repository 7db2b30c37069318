#pragma once

#include <string>

#include "compiler/ground/pass.h"

namespace parallax::compiler {

/// A line for each pass: wall-clock seconds and the size of the value afterwards.
std::string pass_table(const PassLog& log);
/// The same as a JSON array; the clock's values stand in fields named `timing`.
std::string pass_json(const PassLog& log);

}  // namespace parallax::compiler
