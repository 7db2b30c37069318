#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace parallax::tools {

/// The file of a run folder with the texts that the run read (docs/reference/formats.md).
inline constexpr std::string_view kInputsName = "inputs.json";

/// The scenario and every file that was read with it, as text for kInputsName. Only files below the
/// scenario's folder count, or below the nearest folder above it that is a marked root. Empty where
/// they are too large, or cannot be read.
std::string packed_inputs(const std::filesystem::path& scenario, const std::string& scenario_hash,
                          const std::vector<std::string>& inputs);

/// The location of unpacked texts.
struct UnpackedInputs {
  std::filesystem::path scenario;
  /// How the run called the folder that they were unpacked into; ends in no slash.
  std::string named;
};

/// Writes the texts of a run folder into `folder`, which is new and empty, and marks it as a root.
/// Nothing is written elsewhere, and no file can be executed. `named_scenario`: as the run called
/// it. None where there are no texts, they are of another scenario than `scenario_hash` says
/// (empty: any), or one is not what was kept.
std::optional<UnpackedInputs> unpack_inputs(const std::filesystem::path& run_folder,
                                            const std::string& scenario_hash,
                                            const std::string& named_scenario,
                                            const std::filesystem::path& folder);

}  // namespace parallax::tools
