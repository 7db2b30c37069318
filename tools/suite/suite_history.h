#pragma once

#include <string>
#include <string_view>

#include "tools/history/history_file.h"
#include "tools/suite/suite_record.h"

namespace parallax::tools {

/// Notes the verdict in the document of `parallax run --json`.
void note_verdict(std::string_view run_document, CaseResult& result);

/// Notes the rates in the document of `parallax rates --json`: any discrepancy, and each cause.
void note_rates(std::string_view rates_document, CaseResult& result);

/// The line that a history keeps of the suite.
HistoryLine history_line(const SuiteRecord& record, const SuiteIdentity& suite,
                         std::string revision);

}  // namespace parallax::tools
