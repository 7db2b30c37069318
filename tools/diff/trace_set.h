#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/trace/trace.h"
#include "tools/app/context.h"

namespace parallax::tools {

/// The traces of a file, each once, as sets of what holds and happens.
struct TraceSet {
  std::string name;
  std::vector<runtime::Trace> traces;  // in the order of the file
  bool closed = false;                 // the file says how the list ended
  bool complete = false;               // and that these are all traces
  bool tells_last_events = true;       // also the events of the last timepoints, perhaps none
};

/// Reads lines of `parallax traces --format jsonl`, or ITF, as `traces --replay` does (E6101,
/// E6102), except that no model declares the names. Linear in the file.
base::Result<TraceSet> load_trace_set(const std::string& path, Context& context);

/// The traces with changes only, sorted, and what is known of the list.
std::string canonical_text(const TraceSet& set);

/// The traces of one set that the other has not.
struct TraceSetSide {
  std::size_t count = 0;
  /// The one that leaves all traces of the other set at the earliest timepoint; among those the one
  /// with the fewest events before it, then the first of the file.
  std::optional<runtime::Trace> witness;
  std::int64_t leaves_at = 0;
};
TraceSetSide only_in(const TraceSet& set, const TraceSet& other);

}  // namespace parallax::tools
