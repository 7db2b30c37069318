#pragma once

#include <gmpxx.h>

#include <atomic>
#include <cstdint>
#include <optional>

#include "compiler/artifact/compiled_model.h"
#include "runtime/enumerate/clause_search.h"
#include "runtime/enumerate/trace_source.h"
#include "runtime/graph/component_counter.h"

namespace parallax::runtime {

using compiler::CompiledModel;

/// How much may be looked at: a trial tells models that fall apart soon from others.
enum class ComponentEffort : std::uint8_t { kTrial, kFull };

/// The traces of a model whatever its clauses tie together, by their numbers: counted by
/// components. The k-th one is found from the remaining counts when its atoms are set one after the
/// other.
class ComponentTraces final : public TraceSource {
 public:
  /// `model` outlives the traces; `stop` may be null.
  ComponentTraces(const CompiledModel& model, Distinct distinct, const std::atomic<bool>* stop,
                  ComponentEffort effort = ComponentEffort::kFull);
  /// How many there are; none: stopped, or too much to count.
  const std::optional<mpz_class>& total() const { return total_; }
  /// The next trace becomes the one that `before` others precede.
  void seek(const mpz_class& before) { next_ = before; }
  std::optional<Trace> next() override;
  bool print_next(const TraceFormat& format, std::string& out) override;
  bool exhausted() const override { return total_ && next_ >= *total_; }
  SourceStats stats() const override;

 private:
  const CompiledModel& model_;
  Symbols symbols_;
  const std::atomic<bool>* stop_;
  ComponentCounter counter_;
  ClauseSearch search_;
  std::optional<mpz_class> total_;
  mpz_class next_ = 0;
};

}  // namespace parallax::runtime
