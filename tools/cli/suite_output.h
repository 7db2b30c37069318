#pragma once

#include "harness/config/quarantine.h"
#include "tools/cli/command.h"
#include "tools/cli/suite_options.h"
#include "tools/suite/suite_loop.h"
#include "tools/suite/suite_record.h"

namespace parallax::tools {

/// May the files be written that the options name? Results replace earlier results, a report
/// replaces an earlier report or an empty file, and no file that the suite reads is replaced.
bool may_write(const SuiteOptions& options, Invocation& invocation);

/// Tells cases as they finish: those that did not pass, with what is wrong with them, on standard
/// output, the others as remarks. Under --json all are remarks.
SuiteVoice suite_voice(Invocation& invocation);

/// Tells which cases are gone.
void tell_removed(const SuiteRecord& record, const SuiteVoice& voice);

/// The cases that may fail for now, if a list was named.
base::Result<harness::Quarantine> quarantine_of(const SuiteOptions& options,
                                                Invocation& invocation);

/// Names cases in quarantine that pass and, of a `whole` suite, entries without a case: a list of
/// known failures must not outlive them.
void speak_of_quarantine(const SuiteRecord& record, bool whole, const Invocation& invocation);

/// Prints and writes the results; returns the exit code.
int conclude(SuiteRecord& record, const SuiteOptions& options, Invocation& invocation);

}  // namespace parallax::tools
