#include <memory>

#include "tools/cli/model_options.h"
#include "tools/cli/scenario_model.h"

namespace parallax::tools {
namespace {

bool is_scenario(const std::string& path) {
  return path.ends_with(".yaml") || path.ends_with(".yml");
}

int check(const ModelOptions& options, Invocation& invocation) {
  std::vector<std::string> models;
  for (const auto& path : options.models) {
    // Reports into the sink; a result says only that there was nothing to report.
    if (is_scenario(path)) {
      (void)load_scenario_model(path, invocation);
    } else {
      models.push_back(path);
    }
  }
  if (!models.empty()) {
    auto input_options = options;
    input_options.models = models;
    (void)compiler::compile_model(compile_input(input_options), invocation.files(),
                                  invocation.sink());
  }
  if (invocation.sink().has_errors()) return 0;
  if (invocation.options().json) {
    invocation.document("{\"status\":\"ok\"}\n");
  } else {
    invocation.remark("no errors");
  }
  return 0;
}

}  // namespace

Command add_check_command(CLI::App& app) {
  auto options = std::make_shared<ModelOptions>();
  auto* command =
      app.add_subcommand("check", "Parse and check models and scenarios; report every error");
  command->footer(
      "Examples:\n"
      "  parallax check domain.e problem.e --horizon 6\n"
      "  parallax check scenarios/two_regions/edge.yaml\n"
      "Several .e files are one model; every .yaml file is a scenario of its own.");
  add_model_options(*command, *options);
  return {command, [options](Invocation& invocation) { return check(*options, invocation); }};
}

}  // namespace parallax::tools
