#include <algorithm>
#include <memory>

#include "compiler/artifact/artifact_writer.h"
#include "compiler/base/codes/files.h"
#include "tools/app/dead_retries.h"
#include "tools/app/model_options.h"
#include "tools/app/scenario_check.h"
#include "tools/app/scenario_model.h"
#include "tools/cli/command.h"
#include "tools/cli/shared_options.h"

namespace parallax::tools {
namespace {

bool is_scenario(const std::string& path) {
  return path.ends_with(".yaml") || path.ends_with(".yml");
}

struct CheckCommandOptions {
  ModelOptions model;
  std::vector<std::string> allow;
  bool no_lint = false;
};

/// Mutes the warnings that --allow names. False if one is no warning.
bool mute_allowed(const std::vector<std::string>& allow, Invocation& invocation) {
  const auto& codes = base::all_diagnostics();
  for (const auto& id : allow) {
    const auto found =
        std::find_if(codes.begin(), codes.end(), [&](const auto& info) { return info.id == id; });
    if (found == codes.end() || found->severity != base::Severity::kWarning) {
      invocation.sink().error_about(codes::kUsage, "",
                                    fmt::format("`{}` is the code of no warning", id));
      return false;
    }
    invocation.sink().mute(found->code);
  }
  return true;
}

int check(const CheckCommandOptions& check_options, Invocation& invocation) {
  const auto& options = check_options.model;
  if (!mute_allowed(check_options.allow, invocation)) return 0;
  std::vector<std::string> models;
  for (const auto& path : options.models) {
    // Reports into the sink; a result says only that there was nothing to report.
    if (is_scenario(path)) {
      const auto loaded =
          load_scenario_model(path, invocation, {.as_run = true, .lint = !check_options.no_lint});
      if (!loaded) continue;
      report_dead_retries(loaded->compilation, invocation);
      report_dead_handlers(loaded->compilation, invocation);
      check_before_run(*loaded, invocation);
    } else if (compiler::is_artifact_name(path)) {
      (void)compiler::load_artifact(path, invocation.files(), invocation.sink());
    } else {
      models.push_back(path);
    }
  }
  if (!models.empty()) {
    auto input_options = options;
    input_options.models = models;
    input_options.lint = !check_options.no_lint;
    const auto compilation = compile_models(input_options, invocation);
    if (compilation) {
      report_dead_retries(*compilation, invocation);
      report_dead_handlers(*compilation, invocation);
    }
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

Command check_command() {
  auto options = std::make_shared<CheckCommandOptions>();
  OptionTable command("check", "Parse, check and lint models and scenarios; report every error");
  command.footer(
      "Examples:\n"
      "  parallax check domain.e problem.e --horizon 6\n"
      "  parallax check scenarios/two_regions/edge.yaml\n"
      "  parallax check domain.e --allow W2102 --diagnostics=sarif 2> report.sarif\n"
      "Several .e files are one model; every .yaml file is a scenario of its own.");
  add_model_options(command, options->model);
  add_plan_options(command, options->model);
  command.heading("Lint");
  command.option("--allow", options->allow, "Do not report warnings of this code")
      .list(ListForm::kAsManyAsFollowFromOne);
  command.flag("--no-lint", options->no_lint, "Report no W21xx: what is legal but odd");
  return command_of(std::move(command), options, check);
}

}  // namespace parallax::tools
