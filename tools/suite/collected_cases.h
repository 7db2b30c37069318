#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "tools/suite/suite_results.h"

namespace parallax::tools {

/// The selection of cases that a suite was asked to run.
struct SuiteSelection {
  const std::vector<std::string>& paths;
  const std::string& only;
  bool fast = false;
};

/// The names of all cases of the last suite: of `earlier`, the results in its folder, and of the
/// last line of the history, each if it `is_comparable`. No history, or one that cannot be read:
/// nothing of it.
std::set<std::string> last_names(const StoredResults& earlier, const std::string& history,
                                 const std::function<bool(const SuiteSelection&)>& is_comparable);

/// Names that a suite which looks at fewer cases hands on, so that it hides none that is gone: all
/// cases that the results in its folder know, if they are of the same paths.
std::set<std::string> known_names(const StoredResults& earlier, const SuiteIdentity& suite);

/// Cases that the last suite had and that are no cases any more. `names` are all cases of today,
/// whether or not they are selected; `last` are names of the last suite. Only names that contain
/// `only` and belong to `shard` are looked at. Sorted by name.
std::vector<SuiteCase> removed_cases(const std::set<std::string>& names,
                                     const std::set<std::string>& last, const std::string& only,
                                     const Shard& shard);

/// Cases as they were collected, without running them: a name on each line.
std::string collected_text(const std::vector<SuiteCase>& cases);

/// The same for `--json`, with what is gone.
std::string collected_document(const std::vector<SuiteCase>& cases,
                               const std::vector<std::string>& unused_goldens);

}  // namespace parallax::tools
