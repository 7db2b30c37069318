#pragma once

// From texts to clauses: a model, a plan with its binding table, or a whole scenario.
//
//     parallax::Context context;
//     const auto loaded = parallax::load_scenario_model("scenario.yaml", context);
//     if (!loaded) std::fputs(parallax::reports(context).c_str(), stderr);
//
// Functions that may fail return a Result, and have said in the context's sink what is wrong.

#include <string>

#include "compiler/artifact/artifact_reader.h"
#include "compiler/artifact/artifact_writer.h"
#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/result.h"
#include "compiler/pipeline/compile.h"
#include "tools/app/context.h"
#include "tools/app/model_options.h"
#include "tools/app/scenario_model.h"

namespace parallax {

using base::Result;

using compiler::Compilation;
using compiler::CompiledModel;
using compiler::load_artifact;
using compiler::to_artifact;

using tools::compile_models;
using tools::Context;
using tools::load_scenario_model;
using tools::ModelOptions;
using tools::ScenarioModel;

/// Everything that was reported, as the program would print it.
inline std::string reports(const Context& context) {
  std::string text;
  for (const auto& diagnostic : context.sink().sorted()) {
    text += base::to_text(diagnostic, context.files(), {});
  }
  return text;
}

}  // namespace parallax
