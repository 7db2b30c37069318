#pragma once

#include <string>

#include "runtime/trace/trace.h"
#include "runtime/trace/trace_format.h"

namespace parallax::runtime {

/// Comma-separated values after RFC 4180: one row for each trace and timepoint, one column for each
/// ground fluent (1 holds, 0 does not), release, event (1 happens; empty at the last timepoint of a
/// trace, where no event can happen) and user predicate; an open atom has an empty cell. The
/// columns depend on the model alone. The last row says how the list ended; it begins with `#`,
/// which plotting programs skip.
class CsvFormat final : public ListFormat {
 public:
  explicit CsvFormat(const CompiledModel& model);
  std::string begin() override;
  std::string trace(const Trace& trace, const OpenAtoms& open) override;
  std::string end(const ListEnd& end) override;

 private:
  /// By symbol, in the order of the columns.
  Vocabulary vocabulary_;
};

}  // namespace parallax::runtime
