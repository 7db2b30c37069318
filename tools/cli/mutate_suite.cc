#include "tools/cli/mutate_suite.h"

#include <fmt/format.h>

#include "compiler/base/codes/files.h"
#include "tools/cli/shared_options.h"

namespace parallax::tools {

int mutate_suite(const std::vector<SuiteCase>& cases, const MutateOptions& options,
                 MutationOptions score, Invocation& invocation) {
  auto& sink = invocation.sink();
  const auto refuse = [&](const std::string& why) {
    sink.error_about(codes::kUsage, "", why);
    return 0;
  };
  const auto least = share_of(options.at_least.empty() ? "100%" : options.at_least);
  if (!least) {
    return refuse(fmt::format("--at-least: `{}` is no share from 0% to 100%", options.at_least));
  }
  score.at_most = static_cast<std::size_t>(options.at_most);
  score.only_files = options.mutants_of;
  const auto found = score_suite(cases, score, invocation);
  if (!found) return 0;
  if (found->red.empty() && found->made == 0 && !options.mutants_of.empty() &&
      !invocation.stopped()) {
    return refuse(
        fmt::format("--mutants-of: no model or plan that the cases read has `{}` in its "
                    "name",
                    options.mutants_of));
  }
  if (invocation.options().json) {
    invocation.document(mutation_document(*found));
  } else {
    invocation.result(mutation_text(*found));
  }
  if (!found->red.empty()) return 1;
  if (found->count(MutantOutcome::kOpen) > 0 || invocation.stopped()) return 4;
  const auto noticed = found->count(MutantOutcome::kNoticed);
  if (static_cast<double>(noticed) < *least * static_cast<double>(found->observable())) return 1;
  const bool undecided = found->count(MutantOutcome::kUnknown) > 0;
  return undecided && options.at_least.empty() ? 4 : 0;
}

void add_mutate_options(OptionTable& command, MutateOptions& options) {
  const UnderHeading heading(command, "Mutation");
  command
      .flag("--mutate", options.mutate,
            "Mutation testing: which mistakes in its models and plans the suite does not notice")
      .details("docs/guide/regression.md explains it.");
  command
      .option("--at-most", options.at_most,
              "With --mutate: so many mutants, evenly spread over all of them")
      .check(WholeNumber{1, 1'000'000})
      .needs("--mutate");
  command
      .option("--mutants-of", options.mutants_of,
              "With --mutate: only mutants of files whose names contain this")
      .needs("--mutate");
  command
      .option("--at-least", options.at_least,
              "With --mutate: exit code 0 if this share (90%) of the observable mutants is noticed")
      .needs("--mutate");
}

}  // namespace parallax::tools
