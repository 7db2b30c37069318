#include "tools/app/model_options.h"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/artifact/artifact_writer.h"
#include "compiler/base/codes/artifacts.h"
#include "compiler/base/codes/files.h"
#include "tools/app/version.h"

namespace parallax::tools {

compiler::CompileInput compile_input(const ModelOptions& options, const Context& context) {
  compiler::CompileInput input;
  for (const auto& model : options.models) input.models.emplace_back(model);
  for (const auto& folder : options.include_dirs) input.load.include_dirs.emplace_back(folder);
  input.load.allow_outside = context.form().allow_outside;
  if (options.horizon >= 0) input.horizon = options.horizon;
  if (!options.compat.empty()) input.ground.meaning = compiler::Meaning::kDecreasoner;
  input.ground.stop = &context.stop();
  input.objectives_of_model = options.best;
  input.costs = options.stats;
  input.lint = options.lint;
  input.producer = fmt::format("parallax {}", kVersion);
  return input;
}

bool names_artifact(const ModelOptions& options) {
  return std::any_of(options.models.begin(), options.models.end(),
                     [](const std::string& name) { return compiler::is_artifact_name(name); });
}

base::Result<compiler::CompiledModel> load_artifact(const ModelOptions& options, Context& context) {
  auto& sink = context.sink();
  const auto refuse = [&](const char* what) {
    return sink.error_about(codes::kUsage, options.models.front(), what);
  };
  if (options.models.size() > 1) {
    return refuse("a compiled model stands alone; compile the texts together instead");
  }
  if (!options.compat.empty() || !options.until.empty()) {
    return refuse("the meaning of a compiled model is fixed; give --compat and --until to compile");
  }
  if (!options.minimize.empty()) {
    return refuse(
        "--minimize needs the texts of the model; give it to compile, and --best to what reads the "
        "compiled model");
  }
  auto model = compiler::load_artifact(options.models.front(), context.files(), sink);
  if (model && options.horizon >= 0 && options.horizon != model->horizon) {
    return sink.error_about(codes::kHorizonNotExtensible, options.models.front(), options.horizon,
                            fmt::format("it was compiled for the horizon {}", model->horizon));
  }
  return model;
}

}  // namespace parallax::tools
