#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/cli/command.h"
#include "tools/mutate/mutation_score.h"

namespace parallax::tools {

/// The options of `suite --mutate`.
struct MutateOptions {
  bool mutate = false;
  std::int64_t at_most = 0;
  std::string mutants_of;
  std::string at_least;
};
void add_mutate_options(OptionTable& command, MutateOptions& options);

/// Prints the mutants that the suite would not notice; returns the exit code. `score` has the
/// suite's own options.
int mutate_suite(const std::vector<SuiteCase>& cases, const MutateOptions& options,
                 MutationOptions score, Invocation& invocation);

}  // namespace parallax::tools
