#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace parallax::tools {

/// Runs of `scenario` with this seed in the folders beside `run_dir` that found a discrepancy,
/// sorted by name. A clean run with the same seed drew the same starts, so its claim presupposes
/// that nothing was changed for the sake of those starts. Reads the report of each folder; folders
/// without one are skipped.
std::vector<std::string> earlier_discrepancies(const std::filesystem::path& run_dir,
                                               const std::string& scenario, std::uint64_t seed);

}  // namespace parallax::tools
