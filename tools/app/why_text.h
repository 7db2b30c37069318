#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/explain/clause_text.h"
#include "runtime/explain/why.h"
#include "tools/app/trace_fact.h"

namespace parallax::tools {

/// Tells a chain of facts in words, earliest first, each with the axiom that it rests on.
class WhyText {
 public:
  /// `model` outlives the object; `trace`: its number.
  WhyText(const compiler::CompiledModel& model, std::int64_t trace)
      : model_(model), trace_(trace), clauses_(model) {}

  /// `asked`: as it is in the trace; none: no clause mentions the atom.
  std::string text(const TraceFact& fact, std::optional<compiler::Literal> asked,
                   const std::vector<runtime::WhyStep>& steps) const;
  /// One object and a newline.
  std::string json(const TraceFact& fact, std::optional<compiler::Literal> asked,
                   const std::vector<runtime::WhyStep>& steps) const;

 private:
  std::string state(compiler::Literal literal) const;
  std::string when(compiler::Literal literal, std::optional<compiler::Timepoint> now) const;
  std::string reason(const runtime::WhyStep& step) const;
  std::string inertia(const runtime::WhyStep& step) const;
  std::string premises(const runtime::WhyStep& step) const;
  std::string line(const runtime::WhyStep& step) const;

  const compiler::CompiledModel& model_;
  std::int64_t trace_;
  runtime::ClauseText clauses_;
};

}  // namespace parallax::tools
