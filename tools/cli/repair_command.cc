#include <fmt/format.h>

#include <memory>

#include "compiler/base/diagnostic_codes.h"
#include "tools/cli/command.h"
#include "tools/cli/shared_options.h"
#include "tools/repair/apply.h"
#include "tools/repair/repair.h"

namespace parallax::tools {
namespace {

struct RepairCommandOptions {
  RepairOptions repair;
  std::int64_t apply = 0;  // 0: nothing is written
};

constexpr int kProposals = 1, kNoneFound = 4;

int apply(const RepairResult& result, std::int64_t number, Invocation& invocation) {
  const auto count = static_cast<std::int64_t>(result.proposals.size());
  if (number > count) {
    invocation.sink().error_about(
        base::DiagnosticCode::kUsage, "--apply",
        fmt::format("there is no proposal {}; there are {}", number, count));
    return 0;
  }
  const auto& proposal = result.proposals[static_cast<std::size_t>(number) - 1];
  if (!apply_proposal(proposal, invocation)) return 0;
  for (const auto& file : proposal.files) invocation.remark("wrote " + file.name);
  return 0;
}

int repair(const RepairCommandOptions& options, Invocation& invocation) {
  auto repair = options.repair;
  if (repair.limit != 0) repair.limit = std::max(repair.limit, options.apply);
  const auto result = propose_repairs(repair, invocation);
  if (!result) return 0;
  if (invocation.options().verbosity > 0) {
    for (const auto& text : result->remarks) invocation.remark(text);
  }
  invocation.options().json ? invocation.document(repair_json(*result))
                            : invocation.result(repair_text(*result, repair));
  if (result->partings.empty()) {
    return invocation.stopped() || !result->remarks.empty() ? kNoneFound : 0;
  }
  if (options.apply > 0 && !result->proposals.empty()) {
    return apply(*result, options.apply, invocation);
  }
  if (result->proposals.empty()) return kNoneFound;
  // What was found is right by itself, even if a limit kept others from being found.
  invocation.answered();
  return kProposals;
}

}  // namespace

Command repair_command() {
  auto options = std::make_shared<RepairCommandOptions>();
  OptionTable command("repair", "Propose changes of a model that recorded runs have refuted");
  command.footer(
      "Examples:\n"
      "  parallax repair out/plan2\n"
      "  parallax repair out/plan2 --limit 1 | git apply\n"
      "  parallax repair out/plan2 --apply 1\n"
      "Exit codes: 0 nothing to repair, or a proposal was applied; 1 proposals; 4 none was found.");
  command.option("run_dir", options->repair.folder.folder, "The folder of a run").required();
  add_recorded_scenario_option(command, options->repair.folder.scenario);
  command.flag("--other-model", options->repair.other_model,
               "The scenario or its model may have changed since the run");
  command.option("--limit", options->repair.limit, "Show so many proposals at most; 0: all found")
      .check(NonNegative{})
      .show_default();
  command.option("--apply", options->apply, "Write this proposal into the files of the model")
      .check(Positive{});
  return {std::move(command),
          [options](Invocation& invocation) { return repair(*options, invocation); }};
}

}  // namespace parallax::tools
