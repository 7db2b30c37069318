#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "compiler/artifact/symbol_table.h"
#include "compiler/base/known.h"

namespace parallax::runtime {

using compiler::CompiledModel;
using compiler::Timepoint;

/// The symbols that the ids of a trace stand for. Shared, because a trace outlives its source and
/// often the model, and all traces of a source have the same symbols.
using Symbols = std::shared_ptr<const compiler::SymbolTable>;
Symbols symbols_of(const CompiledModel& model);

/// Printed names, sorted by bytes: views into a symbol table.
using Names = std::vector<std::string_view>;
Names sorted_names(const compiler::SymbolTable& symbols, std::span<const compiler::FluentId> ids);
Names sorted_names(const compiler::SymbolTable& symbols, std::span<const compiler::EventId> ids);

/// Is the id among `ids`, which are ascending?
template <typename Id>
bool contains(const std::vector<Id>& ids, Id id) {
  return std::binary_search(ids.begin(), ids.end(), id);
}

/// Atoms that are true at one timepoint: ids, ascending.
struct TracePoint {
  std::vector<compiler::FluentId> holds;
  std::vector<compiler::EventId> happens;
  std::vector<compiler::FluentId> released;
  /// The plan's step that is performed here: an index into CompiledModel::plan.
  std::optional<std::size_t> plan_step;
  /// Did that step succeed? `returned` is the object, if the step returns one.
  bool succeeded = false;
  std::optional<std::string> returned;
  /// The returned objects that the plan still knows here, by register: `?item1`, `cup1`.
  std::map<std::string, std::string> registers;
};

/// A point from printed names. Names that the table lacks are added to it.
TracePoint point_of_names(std::span<const std::string> holds, std::span<const std::string> happens,
                          compiler::SymbolTable& symbols);

/// One execution trace: timepoints 0 .. length, events at 0 .. length - 1.
struct Trace {
  std::int64_t number = 0;  // from 1, in the order of enumeration
  Symbols symbols;          // of the ids in `points`; null only where there are none
  std::vector<TracePoint> points;
  std::vector<std::string> predicates;  // true atoms of user predicates, sorted
  /// Number of traces that symmetries make of this one, in decimal, if it stands for them.
  std::string orbit;
  /// How the plan ended, as PlanEnds says it; empty where nobody asked.
  std::string ended;
  /// Do other initial states lead to the same events? This one is the first in canonical order.
  base::Known other_initial_states = base::Known::kNo;
  /// Can the same events from the same initial state also end in other states?
  base::Known other_outcomes = base::Known::kNo;
  Timepoint length() const { return static_cast<Timepoint>(points.size()) - 1; }

  Names holds(std::size_t t) const { return names(points[t].holds); }
  Names happens(std::size_t t) const { return names(points[t].happens); }
  Names released(std::size_t t) const { return names(points[t].released); }

 private:
  template <typename Id>
  Names names(const std::vector<Id>& ids) const {
    return ids.empty() ? Names() : sorted_names(*symbols, ids);
  }
};

/// Reads a trace of the given length from a valuation of the model's variables. `symbols` are the
/// model's.
Trace decode_trace(const CompiledModel& model, Symbols symbols, Timepoint length,
                   const std::function<bool(compiler::Literal)>& value);

/// The events of the trace, in order, as one stable text: `Go(r2);PickUp();` (several events of one
/// timepoint are joined by `+`); the object that a perform returned stands behind it:
/// `Detect(cup)=cup1;`.
std::string event_key(const Trace& trace);

/// Changes only: the fluents that hold at 0, then per timepoint the events, and the fluents that
/// ceased and began.
std::string to_text(const Trace& trace);
/// One JSON object on one line, fields as documented for `parallax traces --format jsonl`.
std::string to_jsonl(const Trace& trace);
/// The same without `released` and `predicates`: nothing is said of atoms that HoldsAt and Happens
/// may leave open.
std::string observable_jsonl(const Trace& trace);

/// The ground atoms of one declared symbol, in declaration order.
struct SymbolInstances {
  std::string symbol;
  std::vector<std::string> atoms;  // printed
  std::vector<std::uint32_t> ids;  // of the fluent or event; of predicates the place among all
};

/// The names that traces of a model are written with.
struct Vocabulary {
  std::vector<SymbolInstances> fluents, events;
  std::vector<SymbolInstances> releasable;  // the fluents that can be released
  std::vector<SymbolInstances> predicates;  // user predicates that some formula mentions
  /// Events that may happen at the last timepoint, which `--compat decreasoner` has atoms for.
  std::set<std::string> last_events;
  Timepoint horizon = 0;
};

Vocabulary vocabulary_of(const compiler::CompiledModel& model);

/// Hash of the texts that a model was compiled from, in the order of loading, and of the options
/// that its meaning depends on, as 16 hexadecimal digits. File names and the horizon do not count.
/// FNV-1a: it finds accidents, and does not protect against forgery.
std::string model_hash(const compiler::CompiledModel& model);

}  // namespace parallax::runtime
