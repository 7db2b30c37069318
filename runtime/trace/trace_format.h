#pragma once

#include <string>
#include <vector>

#include "runtime/trace/trace.h"

namespace parallax::runtime {

/// How a trace is written, as pieces that follow one another: what many traces have in common is
/// made once. A format has no state.
class TraceFormat {
 public:
  virtual ~TraceFormat() = default;
  /// What comes before the first timepoint. `number` is in decimal digits.
  virtual std::string head(const std::string& number) const = 0;
  /// What introduces timepoint t.
  virtual std::string introduction(Timepoint t) const = 0;
  /// One timepoint, independent of its number; `before` is the timepoint before, null at 0.
  virtual std::string point(const TracePoint* before, const TracePoint& point) const = 0;
  /// What comes after the last timepoint, with the end of the line.
  virtual std::string tail(const std::vector<std::string>& predicates) const = 0;
};

/// Changes only, for people.
const TraceFormat& text_format();
/// One JSON object a line.
const TraceFormat& jsonl_format();

std::string format_trace(const TraceFormat& format, const Trace& trace);

}  // namespace parallax::runtime
