#pragma once

#include <string>

#include "tools/history/history_file.h"

namespace parallax::tools {

/// A history of suites as a page: changes and their revisions, the outcomes of every case line by
/// line, and the measured rates with their intervals. `file`: its name.
std::string history_page(const History& history, const std::string& file, double confidence);

}  // namespace parallax::tools
