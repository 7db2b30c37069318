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

namespace {

/// The first option given that says which plan there is, or how it is unrolled; empty: none.
std::string plan_option(const ModelOptions& options) {
  const ModelOptions usual;
  const auto& unroll = options.unroll;
  if (!options.plan.empty()) return "--plan";
  if (!options.bind.empty()) return "--bind";
  if (!options.plan_entry.empty()) return "--plan-entry";
  if (!options.regions.empty()) return "--regions";
  if (unroll.max_loop != usual.unroll.max_loop) return "--max-loop";
  if (unroll.max_call_depth != usual.unroll.max_call_depth) return "--max-call-depth";
  if (unroll.max_locations != usual.unroll.max_locations) return "--max-locations";
  if (unroll.location_samples != usual.unroll.location_samples) return "--location-samples";
  if (options.par != usual.par) return "--par";
  if (options.max_horizon != usual.max_horizon) return "--max-horizon";
  return {};
}

}  // namespace

base::Status fits_scenario(const ModelOptions& options, Context& context) {
  const auto refuse = [&](const std::string& why) {
    return context.sink().error_about(codes::kUsage, options.models.front(), why);
  };
  if (!options.until.empty()) {
    return refuse(
        "the `constraints` of a scenario say where its traces end: --until is for models");
  }
  if (!options.plan.empty() || !options.bind.empty() || !options.plan_entry.empty()) {
    return refuse("a scenario names its plan and its binding table itself: --plan is for models");
  }
  if (!options.regions.empty()) {
    return refuse("a scenario has regions of its own: --regions is for models");
  }
  if (!options.compat.empty()) {
    return refuse("scenarios have the standard meaning: --compat is for models");
  }
  if (options.max_horizon != ModelOptions().max_horizon) {
    return refuse("a scenario says its horizon: --max-horizon is for models; give --horizon");
  }
  return base::Unit{};
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
  if (!options.include_dirs.empty()) {
    return refuse("a compiled model loads no other file; give --include to compile");
  }
  if (const auto option = plan_option(options); !option.empty()) {
    return sink.error_about(
        codes::kUsage, options.models.front(),
        fmt::format("the plan of a compiled model is fixed; give {} to compile", option));
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
