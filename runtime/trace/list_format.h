#pragma once

#include <cstdint>
#include <string>

#include "runtime/trace/trace.h"

namespace parallax::runtime {

/// What is known when a list of traces ends.
struct ListEnd {
  std::int64_t traces = 0;
  bool complete = false;
  /// "complete", "stopped", ...: what is known of the traces that were not listed. Never
  /// "complete" where `complete` is false.
  std::string exploration;
  std::string remark;  // what follows it in texts: ` (proof checked), 3 checked`
  std::string fields;  // the same as members of a JSON object, a comma behind each
};

/// One way to write a list of traces: the concatenation of begin(), trace() for each trace in
/// order, and end(). Stateful, for one list only. Equal traces give equal bytes.
class ListFormat {
 public:
  virtual ~ListFormat() = default;
  virtual std::string begin() { return {}; }
  virtual std::string trace(const Trace& trace) = 0;
  virtual std::string end(const ListEnd& end) = 0;
};

}  // namespace parallax::runtime
