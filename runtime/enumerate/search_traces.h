#pragma once

#include <atomic>
#include <limits>
#include <vector>

#include "runtime/enumerate/clause_search.h"
#include "runtime/enumerate/trace_source.h"

namespace parallax::runtime {

/// The traces by search alone: the next one is where the search goes on. Nothing is kept of those
/// before, and there is no solver to wait for; but what a goal far ahead rules out is tried all the
/// same.
class SearchTraces final : public TraceSource {
 public:
  /// Gives up where a trace costs more than `conflicts`. `model` outlives the traces; `stop` may be
  /// null.
  SearchTraces(const CompiledModel& model, Distinct distinct, const std::atomic<bool>* stop,
               std::int64_t conflicts = std::numeric_limits<std::int64_t>::max());
  std::optional<Trace> next() override;
  bool exhausted() const override { return exhausted_; }
  /// Are there perhaps more traces, for which the budget does not suffice?
  bool gave_up() const { return gave_up_; }
  SourceStats stats() const override;

 private:
  const CompiledModel& model_;
  const std::atomic<bool>* stop_;
  std::int64_t conflicts_;
  ClauseSearch search_;
  std::int64_t found_ = 0;
  bool exhausted_ = false, gave_up_ = false;
};

}  // namespace parallax::runtime
