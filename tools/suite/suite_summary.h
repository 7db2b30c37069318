#pragma once

#include <string>

#include "tools/suite/suite_record.h"

namespace parallax::tools {

/// First line of a Markdown summary, so that a newer one may take its place.
inline constexpr const char* kMarkdownMark = "<!-- parallax suite -->";

/// "3 passed, 1 failed, 2 without an answer ..." and a line end. A pass that was not run, and one
/// that needed more than one attempt, are counted among the passed and named beside.
std::string summary_text(const SuiteRecord& record);

/// The same for `--json`, with every case.
std::string summary_document(const SuiteRecord& record);

/// A table of the cases that need attention, for a pull request or a job's page.
std::string summary_markdown(const SuiteRecord& record);

/// Annotations that GitHub's runners show beside the lines of the cases: a command for each that
/// failed, gave no answer, is inconclusive or flaky, did not finish or is gone.
std::string github_annotations(const SuiteRecord& record);

}  // namespace parallax::tools
