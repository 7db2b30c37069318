#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <vector>

#include "compiler/pipeline/compile.h"

namespace parallax::test {

/// Calls `visit` with each text of scenarios/classics that is a model by itself, by name.
inline void for_each_classic(const std::function<void(const compiler::Compilation&)>& visit) {
  const auto folder = std::filesystem::path(PARALLAX_SOURCE_DIR) / "scenarios/classics";
  std::vector<std::filesystem::path> texts;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() == ".e") texts.push_back(entry.path());
  }
  std::sort(texts.begin(), texts.end());
  for (const auto& text : texts) {
    CAPTURE(text);
    compiler::CompileInput input;
    input.models = {text};
    base::SourceFiles files;
    base::DiagnosticSink sink;
    const auto compiled = compiler::compile_model(input, files, sink);
    if (compiled) visit(*compiled);  // else others load it
  }
}

}  // namespace parallax::test
