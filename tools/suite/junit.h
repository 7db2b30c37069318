#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/suite/suite_case.h"

namespace parallax::tools {

/// The report of a suite: a testsuite for each group, a testcase for each case. A case that has not
/// finished is an error, so that a crash of the suite is never a case less. `cases` and `results`
/// run parallel; cases of one group must stand together. `timestamp` is ISO 8601.
std::string to_junit(const std::vector<SuiteCase>& cases, const std::vector<CaseResult>& results,
                     std::string_view timestamp);

}  // namespace parallax::tools
