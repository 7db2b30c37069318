#include <algorithm>
#include <memory>

#include "compiler/base/codes/files.h"
#include "tools/app/file_check.h"
#include "tools/app/model_options.h"
#include "tools/cli/command.h"
#include "tools/cli/shared_options.h"

namespace parallax::tools {
namespace {

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
  if (!mute_allowed(check_options.allow, invocation)) return 0;
  auto options = check_options.model;
  options.lint = !check_options.no_lint;
  check_files(options, invocation);
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
