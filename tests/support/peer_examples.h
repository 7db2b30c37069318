#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <optional>
#include <vector>

namespace parallax::test {

/// The folder that holds `examples/` of the Discrete Event Calculus Reasoner 1.0: the value of
/// PARALLAX_PEER_EXAMPLES, or a folder beside the checkout. None, with a visible line, where there
/// is none: the examples are not ours to ship.
inline std::optional<std::filesystem::path> peer_examples() {
  namespace fs = std::filesystem;
  const char* named = std::getenv("PARALLAX_PEER_EXAMPLES");
  const fs::path folder = named != nullptr
                              ? fs::path(named)
                              : fs::path(PARALLAX_SOURCE_DIR) / ".." / "shared" / "peer-examples";
  std::error_code error;
  if (fs::is_directory(folder / "examples", error)) return folder;
  std::cout << "SKIPPED: no examples of the 2005 reasoner (PARALLAX_PEER_EXAMPLES)\n";
  return std::nullopt;
}

/// The examples that come with an answer (the same name with `.txt`), sorted.
inline std::vector<std::filesystem::path> answered_examples(const std::filesystem::path& root) {
  std::vector<std::filesystem::path> examples;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root / "examples")) {
    auto answer = entry.path();
    answer.replace_extension(".txt");
    if (entry.path().extension() == ".e" && std::filesystem::exists(answer)) {
      examples.push_back(entry.path());
    }
  }
  std::sort(examples.begin(), examples.end());
  return examples;
}

}  // namespace parallax::test
