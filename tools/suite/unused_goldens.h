#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/suite/suite_case.h"

namespace parallax::tools {

/// Files below the folders among `paths` that hold a list of traces, as golden files do, and that
/// no case names, sorted. Hidden files and folders, links, and what lies below `out` are passed
/// over. A folder may hold manifests outside of `paths`: only folders that were named as a whole
/// are searched.
std::vector<std::string> unused_goldens(const std::vector<std::string>& paths,
                                        const std::vector<SuiteCase>& cases,
                                        const std::filesystem::path& out);

}  // namespace parallax::tools
