#include <memory>

#include "compiler/base/codes/files.h"
#include "compiler/base/file_io.h"
#include "tools/app/coverage_report.h"
#include "tools/cli/command.h"
#include "tools/cli/shared_options.h"

namespace parallax::tools {
namespace {

struct CoverageCommandOptions {
  CoverageOptions coverage;
  std::string lcov;
};

int cover(const CoverageCommandOptions& options, Invocation& invocation) {
  const bool to_stdout = options.lcov == "-";
  if (to_stdout && invocation.options().json) {
    invocation.sink().error_about(codes::kUsage, "--lcov",
                                  "the tracefile and the document of --json cannot both go to the "
                                  "standard output; name a file for one of them");
    return 0;
  }
  const auto coverage = coverage_of(options.coverage, invocation);
  if (!coverage || invocation.stopped()) return 0;
  if (to_stdout) {
    invocation.result(coverage_lcov(*coverage));
    return 0;
  }
  if (!options.lcov.empty() && !base::write_output(options.lcov, coverage_lcov(*coverage),
                                                   invocation.files(), invocation.sink())) {
    return 0;
  }
  if (invocation.options().json) {
    invocation.document(coverage_json(*coverage));
  } else {
    invocation.result(coverage_text(*coverage));
  }
  return 0;
}

}  // namespace

Command coverage_command() {
  auto options = std::make_shared<CoverageCommandOptions>();
  OptionTable command("coverage",
                      "What recorded runs went through of their plans and models, and what not");
  command.footer(
      "Examples:\n"
      "  parallax coverage out/edge\n"
      "  parallax coverage out/plan1 out/plan2 --lcov coverage.info\n"
      "Exit codes: 0, and 3 for a run whose scenario has changed since.");
  command.option("run_dirs", options->coverage.folders, "Folders of runs").required().folder();
  add_recorded_scenario_option(command, options->coverage.scenario);
  command
      .option(
          "--limit", options->coverage.limit,
          "Look at so many traces of each model at most, but at all that were simulated; 0: all")
      .check(NonNegative{})
      .show_default();
  command
      .option("--lcov", options->lcov,
              "Write an lcov tracefile for genhtml, editors and CI services")
      .details("`-` prints it instead of the text.")
      .file();
  return command_of(std::move(command), options, cover);
}

}  // namespace parallax::tools
