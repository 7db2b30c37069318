#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace parallax::tools {

/// Runs of `scenario` with this seed in the folders beside `run_dir` that found a discrepancy,
/// sorted by name. A run that finds none now drew the same starts, so what it claims supposes that
/// nothing was changed for those starts. Reads the report of each folder; what is no report is
/// passed over.
std::vector<std::string> earlier_discrepancies(const std::filesystem::path& run_dir,
                                               const std::string& scenario, std::uint64_t seed);

}  // namespace parallax::tools
