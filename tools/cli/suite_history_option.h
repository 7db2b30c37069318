#pragma once

#include <string>

#include "tools/cli/command.h"
#include "tools/cli/suite_options.h"
#include "tools/suite/last_pass.h"
#include "tools/suite/suite_record.h"
#include "tools/suite/suite_runner.h"

namespace parallax::tools {

/// Why the suite can have no line in a history; empty: it can.
std::string unfit_for_history(const SuiteOptions& options);

/// May the history be appended to? Asked before the first case.
bool may_append(const SuiteOptions& options, Invocation& invocation);

/// The texts of a history's last line, which the next one is compared with by value.
struct HistoryTexts {
  const LastPasses* told = nullptr;  // null: none are kept
  const RunnerOptions* runner = nullptr;
};

/// Appends the suite to its history, and says what changed since the line before it.
void append_to_history(const SuiteRecord& record, const SuiteIdentity& suite,
                       const SuiteOptions& options, Invocation& invocation,
                       const HistoryTexts& texts = {});

}  // namespace parallax::tools
