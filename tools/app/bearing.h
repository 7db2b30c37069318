#pragma once

#include <cstdint>

#include "compiler/base/result.h"
#include "harness/campaign/journal.h"
#include "runtime/session/solver_session.h"
#include "tools/app/context.h"
#include "tools/app/discrepancy.h"
#include "tools/app/observed_path.h"

namespace parallax::tools {

/// The journal as it was before its first simulation.
harness::JournalText without_samples(const harness::JournalText& journal);

/// How a simulation bears on a discrepancy.
enum class Bearing : std::uint8_t {
  kSame,   // it goes wrong there, in the same way
  kClean,  // it gets past it
  kOther,  // it goes wrong earlier or otherwise, or goes another way, and says nothing of it
};

/// Compares simulations of one trace, or executions of one plan, with a discrepancy of it.
class BearingReader {
 public:
  /// `found`, which has a parting, and `context` outlive the object.
  BearingReader(const RecordedDiscrepancy& found, Context& context);

  Bearing bearing(const ObservedPath& path);
  /// The same for a record with any number; reports as observed_path does.
  base::Result<Bearing> bearing(const harness::SampleRecord& record);

 private:
  bool goes_the_same_way(const ObservedPath& path, std::size_t after) const;

  const RecordedDiscrepancy& found_;
  Context& context_;
  harness::JournalText journal_;  // without simulations
  PathFacts facts_;
  runtime::SolverSession session_;
};

}  // namespace parallax::tools
