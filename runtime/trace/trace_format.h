#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/trace/trace.h"

namespace parallax::runtime {

struct OpenAtoms;

/// A format of traces, as pieces that follow one another: a piece that many traces have in common
/// is made once. A format has no state.
class TraceFormat {
 public:
  virtual ~TraceFormat() = default;
  /// Text before the first timepoint. `number` is in decimal digits, and so is `orbit`
  /// (Trace::orbit), which may be empty.
  virtual std::string head(const std::string& number, const std::string& orbit) const = 0;
  /// Text that introduces timepoint t.
  virtual std::string introduction(Timepoint t) const = 0;
  /// One timepoint, independent of its number; `before` is the timepoint before, null at 0.
  virtual std::string point(const compiler::SymbolTable& symbols, const TracePoint* before,
                            const TracePoint& point) const = 0;
  /// Text after the last timepoint, with the end of the line.
  virtual std::string tail(const std::vector<std::string>& predicates) const = 0;
};

/// Text for people, with the changes only.
const TraceFormat& text_format();
/// One JSON object a line.
const TraceFormat& jsonl_format();

std::string format_trace(const TraceFormat& format, const Trace& trace);
/// With a number that may be too large for `trace.number`, in decimal digits.
std::string format_trace(const TraceFormat& format, const Trace& trace, const std::string& number);

/// Results at the end of a list of traces.
struct ListEnd {
  std::int64_t traces = 0;
  bool complete = false;
  /// "complete", "stopped", ...: the state of knowledge about the traces that were not listed.
  /// Never "complete" where `complete` is false.
  std::string exploration;
  std::string remark;  // the text after it: ` (proof checked), 3 checked`
  std::string fields;  // the same as members of a JSON object, a comma behind each
};

/// One way to write a list of traces: the concatenation of begin(), trace() for each trace in
/// order, and end(). Stateful, for one list only. Equal traces with the
/// same open atoms give equal bytes.
class ListFormat {
 public:
  virtual ~ListFormat() = default;
  virtual std::string begin() { return {}; }
  /// Open atoms are not told as facts.
  virtual std::string trace(const Trace& trace, const OpenAtoms& open) = 0;
  virtual std::string end(const ListEnd& end) = 0;
};

}  // namespace parallax::runtime
