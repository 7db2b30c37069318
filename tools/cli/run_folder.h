#pragma once

#include <filesystem>

namespace parallax::tools {

/// The folder of a run that names none: out/STEM, or out/STEM-2, ... where a run is there already.
/// Finished work is never overwritten.
std::filesystem::path default_run_folder(const std::filesystem::path& scenario);

/// The newest of those folders, for --resume; the first one if there is none.
std::filesystem::path newest_run_folder(const std::filesystem::path& scenario);

}  // namespace parallax::tools
