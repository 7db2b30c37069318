#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/base/shown_text.h"

namespace parallax::base {

struct DiagnosticStyle {
  bool color = false;
  bool help = true;  // advice, where there is no fix
};

/// Advice on how to fix the problem: the diagnostic's own, else that of the registry. A view of
/// either.
std::string_view help_of(const Diagnostic& diagnostic);

/// One diagnostic as text: `path:line:col-col: error[E2104]: text`, the source line with a caret,
/// notes, fix or help. Ends with a newline.
std::string to_text(const Diagnostic& diagnostic, const SourceFiles& files,
                    const DiagnosticStyle& style);

/// A JSON array of objects with the same fields: path, line, column, end_line, end_column,
/// severity, code, message, notes, fix, help. One line, no trailing newline.
std::string to_json(const std::vector<Diagnostic>& diagnostics, const SourceFiles& files);

/// The diagnostics as a SARIF 2.1.0 log of one run (OASIS, 2020): one rule for each code that
/// occurs, one result for each diagnostic with its region, its notes as related locations and its
/// fix in the message. Paths below the current folder are relative, columns count code points.
///
/// `partialFingerprints` identify a result by code, path, message and the text of its line, so they
/// stay when other lines are added or removed; equal ones are told apart by a running number.
/// One line, no final newline.
std::string to_sarif(const std::vector<Diagnostic>& diagnostics, const SourceFiles& files,
                     std::string_view tool_version);

}  // namespace parallax::base
