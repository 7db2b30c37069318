#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "runtime/trace/trace.h"
#include "runtime/trace/trace_format.h"

namespace parallax::runtime {

/// Atoms that distinguish two traces.
enum class Distinct : std::uint8_t {
  kObservable,  // HoldsAt and Happens
  kAll,         // also ReleasedAt and user predicates, as the 2005 reasoner counts models
};

/// Order of the traces.
enum class TraceOrder : std::uint8_t {
  kCanonical,
  /// The trace that the solver finds first, for callers that want one witness: to prove that none
  /// comes before it can cost many times as much. The same on every machine with the same solver.
  kAny,
};

/// Statistics of a search for traces.
struct SourceStats {
  std::string strategy;                     // "blocking", "guarded", "tree", "graph"
  std::string remark;                       // why not the graph, if it would have paid
  std::size_t states = 0, transitions = 0;  // of the graph
  std::int64_t solve_calls = 0;
  /// The absence of a trace was proved for one representative of each orbit only
  /// (runtime/symmetry).
  bool by_symmetry = false;
};

/// The traces of a model at its full horizon, each once, in canonical order (timepoint, then
/// declaration order, false before true) whatever the strategy, unless any order is asked for.
class TraceSource {
 public:
  TraceSource() = default;
  TraceSource(const TraceSource&) = delete;
  TraceSource& operator=(const TraceSource&) = delete;
  virtual ~TraceSource() = default;
  /// The next trace, or none. After none, `exhausted()` tells whether it is proved that no trace is
  /// left.
  virtual std::optional<Trace> next() = 0;
  /// Appends the next trace as `format` writes it; false if next() gives none.
  virtual bool print_next(const TraceFormat& format, std::string& out) {
    const auto trace = next();
    if (trace) out += format_trace(format, *trace);
    return trace.has_value();
  }
  virtual bool exhausted() const = 0;
  /// Finds out whether there is another trace, for exhausted() to tell; which one may stay unknown.
  /// Nothing is listed after it.
  virtual void look_on() { (void)next(); }
  virtual SourceStats stats() const = 0;
};

}  // namespace parallax::runtime
