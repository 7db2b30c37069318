#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "compiler/artifact/compiled_model.h"

namespace parallax::runtime {

/// Facts that are not in question: what was seen of one execution.
struct Observed {
  compiler::Timepoint length = 0;  // it went so far
  std::vector<compiler::Literal> facts;
};

/// "There is a trace", clause by clause of the model, so that clauses can be left out.
///
/// Without state constraints a trace satisfies every clause. With constraints it ends at some
/// timepoint from 1 on at which they hold, and satisfies the clauses up to there: variables beyond
/// the model's choose the length, and a clause of timepoint t > 0 binds if the trace reaches t.
/// With an observation the length is what was seen, and its facts hold.
class ExecutionFormula {
 public:
  /// `model` outlives the object.
  explicit ExecutionFormula(const compiler::CompiledModel& model,
                            std::optional<Observed> observed = std::nullopt);

  const compiler::CompiledModel& model() const { return model_; }
  std::int32_t variables() const { return variables_; }
  /// Says nothing by itself: it defines an auxiliary.
  bool is_definition(std::size_t clause) const { return model_.clause_is_definition[clause]; }
  /// Clause `index` of the model; the view lasts until the next call.
  std::span<const compiler::Literal> clause(std::size_t index);
  /// The length, the definitions, what was observed.
  void for_each_always(const std::function<void(std::span<const compiler::Literal>)>& visit);

 private:
  bool is_guarded() const { return model_.has_constraints || observed_.has_value(); }
  void choose_length(const std::function<void(std::span<const compiler::Literal>)>& visit) const;
  compiler::Literal reaches(compiler::Timepoint t) const;
  compiler::Literal ends(compiler::Timepoint n) const;

  const compiler::CompiledModel& model_;
  std::optional<Observed> observed_;
  std::int32_t variables_;
  std::vector<compiler::Literal> clause_;
};

}  // namespace parallax::runtime
