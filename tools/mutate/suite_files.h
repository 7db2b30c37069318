#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tools/app/context.h"
#include "tools/mutate/case_model.h"
#include "tools/suite/scratch_copy.h"
#include "tools/suite/suite_case.h"

namespace parallax::tools {

/// A model or plan of a suite with one mistake in it.
struct Mutant {
  std::string file;  // as it is read
  std::uint32_t line = 0;
  std::string kind, words;         // as of compiler::Mutation
  std::string text;                // of the file, with the mistake
  std::vector<std::size_t> cases;  // that read the file, those that cost least first
};

/// All files that the cases of a suite read, and the mistakes that can be made in them.
struct SuiteFiles {
  SuiteTexts texts;
  std::vector<std::set<std::string>> reads;         // by case: where its files really lie
  std::vector<std::optional<CaseModel>> originals;  // by case; none: it is refused
  std::vector<Mutant> mutants;                      // by file and line
};

/// Compiles the original models of the cases, and makes every mutant of them. Reports files that
/// cannot be read.
base::Result<SuiteFiles> look_at_suite(const std::vector<SuiteCase>& cases, Context& context);

/// `most` of the mutants, evenly spread over all of them; 0: all.
void keep_spread(std::vector<Mutant>& mutants, std::size_t most);

}  // namespace parallax::tools
