#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "compiler/base/known.h"

namespace parallax::runtime {

using compiler::CompiledModel;
using compiler::Timepoint;

/// The atoms that are true at one timepoint, sorted by bytes.
struct TracePoint {
  std::vector<std::string> holds;
  std::vector<std::string> happens;
  std::vector<std::string> released;
  /// The plan's step that is performed here: an index into CompiledModel::plan.
  std::optional<std::size_t> plan_step;
  /// Did that step succeed? If it is one that returns something, what it returned.
  bool succeeded = false;
  std::optional<std::string> returned;
  /// The returned objects that the plan still knows here, by register: `?item1`, `cup1`.
  std::map<std::string, std::string> registers;
};

/// One execution trace: timepoints 0 .. length, events at 0 .. length - 1.
struct Trace {
  std::int64_t number = 0;  // from 1, in the order of enumeration
  std::vector<TracePoint> points;
  std::vector<std::string> predicates;  // true atoms of user predicates, sorted
  /// Do other initial states lead to the same events? This one is the first in canonical order.
  base::Known other_initial_states = base::Known::kNo;
  /// Can the same events from the same initial state also end in other states?
  base::Known other_outcomes = base::Known::kNo;
  Timepoint length() const { return static_cast<Timepoint>(points.size()) - 1; }
};

/// Reads a trace of the given length from a valuation of the model's variables.
Trace decode_trace(const CompiledModel& model, Timepoint length,
                   const std::function<bool(compiler::Literal)>& value);

/// The events of the trace, in order, as one stable text: `Go(r2);PickUp();` (several events of one
/// timepoint are joined by `+`); what a perform returned stands behind it: `Detect(cup)=cup1;`.
std::string event_key(const Trace& trace);

/// Changes only: what holds at 0, then per timepoint the events, what ceased and what began.
std::string to_text(const Trace& trace);
/// One JSON object on one line, fields as documented for `parallax traces --format jsonl`.
std::string to_jsonl(const Trace& trace);

}  // namespace parallax::runtime
