#include "tools/cli/run_folder.h"

#include <string>

namespace parallax::tools {

std::filesystem::path default_run_folder(const std::filesystem::path& scenario) {
  const auto stem = scenario.stem().string();
  std::filesystem::path folder = std::filesystem::path("out") / stem;
  for (int number = 2; std::filesystem::exists(folder); ++number) {
    folder = std::filesystem::path("out") / (stem + "-" + std::to_string(number));
  }
  return folder;
}

}  // namespace parallax::tools
