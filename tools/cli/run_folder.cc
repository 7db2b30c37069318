#include "tools/cli/run_folder.h"

#include <string>

namespace parallax::tools {
namespace {

/// out/STEM, out/STEM-2, out/STEM-3, ...
std::filesystem::path numbered(const std::filesystem::path& scenario, int number) {
  const auto stem = scenario.stem().string();
  return std::filesystem::path("out") / (number == 1 ? stem : stem + "-" + std::to_string(number));
}

int first_free(const std::filesystem::path& scenario) {
  int number = 1;
  std::error_code error;
  while (std::filesystem::exists(numbered(scenario, number), error)) ++number;
  return number;
}

}  // namespace

std::filesystem::path default_run_folder(const std::filesystem::path& scenario) {
  return numbered(scenario, first_free(scenario));
}

std::filesystem::path newest_run_folder(const std::filesystem::path& scenario) {
  const int free = first_free(scenario);
  return numbered(scenario, free == 1 ? 1 : free - 1);
}

}  // namespace parallax::tools
