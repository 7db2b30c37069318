#pragma once

#include <string>
#include <vector>

#include "compiler/pipeline/compile.h"
#include "tools/cli/command.h"

namespace parallax::tools {

/// The options of every command that reads a model.
struct ModelOptions {
  std::vector<std::string> models;
  std::vector<std::string> include_dirs;
  bool allow_outside = false;
  std::string compat;              // "decreasoner", or empty for the standard meaning
  std::int64_t horizon = -1;       // -1: as the model says
  std::vector<std::string> until;  // state constraints
  bool stats = false;              // count what each axiom costs; commands offer it themselves
};
void add_model_options(CLI::App& command, ModelOptions& options);

compiler::CompileInput compile_input(const ModelOptions& options);

}  // namespace parallax::tools
