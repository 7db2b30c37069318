#pragma once

#include <string>
#include <vector>

#include "compiler/base/diagnostic.h"

namespace parallax::base {

struct DiagnosticStyle {
  bool color = false;
};

/// One diagnostic as text: `path:line:col-col: error[E2104]: text`, the source line with a caret,
/// notes, fix. Ends with a newline.
std::string to_text(const Diagnostic& diagnostic, const SourceFiles& files,
                    const DiagnosticStyle& style);

/// A JSON array of objects with the same fields: path, line, column, end_line, end_column,
/// severity, code, message, notes, fix. One line, no trailing newline.
std::string to_json(const std::vector<Diagnostic>& diagnostics, const SourceFiles& files);

/// Replaces control, invalid and bidirectional-control bytes by visible escapes.
std::string printable(std::string_view text);

}  // namespace parallax::base
