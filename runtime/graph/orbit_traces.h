#pragma once

#include <gmpxx.h>

#include <memory>
#include <optional>
#include <set>
#include <string>

#include "runtime/graph/model_traces.h"
#include "runtime/symmetry/orbit.h"

namespace parallax::runtime {

/// The traces of a model up to exchanging constants that it does not tell apart: of each orbit the
/// first one in canonical order, in that order, with the orbit's size. The sizes add up to the
/// number of all traces. Memory: a form for each orbit found, where there
/// is any symmetry.
class OrbitTraces {
 public:
  /// `model` outlives the traces.
  OrbitTraces(const CompiledModel& model, const TraceQuery& query);
  /// The next trace; none if there is none, or the search was stopped.
  std::optional<Trace> next();
  /// How many traces the last one stands for.
  const mpz_class& size() const { return size_; }
  /// How many those given so far stand for.
  const mpz_class& total() const { return total_; }
  bool exhausted() const { return traces_->exhausted(); }
  SourceStats stats() const;
  const std::string& refusal() const { return traces_->refusal(); }
  const Interchangeables& constants() const { return symmetry_.constants(); }

 private:
  ModelSymmetry symmetry_;
  CompiledModel broken_;
  std::optional<TraceOrbits> orbits_;
  std::unique_ptr<ModelTraces> traces_;
  std::set<std::string> forms_;
  mpz_class size_, total_;
  std::int64_t given_ = 0;
};

}  // namespace parallax::runtime
