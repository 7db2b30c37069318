#pragma once

#include <string>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "runtime/optimize/optimum.h"
#include "tools/app/certify.h"
#include "tools/app/context.h"

namespace parallax::tools {

/// The least values of the model's objectives, and the traces that have them.
class BestTraces {
 public:
  /// Looks for the optimum of `model`, which has objectives. A session of its own.
  BestTraces(const compiler::CompiledModel& model, Context& context);

  const runtime::Optimum& optimum() const { return optimum_; }
  /// The model whose traces are the best ones of `model`. None: no trace or no optimum was found,
  /// or the sums need too many clauses.
  std::optional<compiler::CompiledModel> model_of_best(const compiler::CompiledModel& model) const;

  /// Makes and checks a proof that no trace of `model` is better, and keeps the verdict.
  void certify(const CertifyOption& option, const std::vector<std::string>& models,
               const compiler::CompiledModel& model, const std::optional<compiler::PlanGraph>& plan,
               Context& context);
  /// Takes over the verdict on the complete list of best traces: then there is no better one
  /// either.
  void adopt(const TraceCertifier& certifier) { verdict_ = certifier.verdict(); }

  /// `optimum 7 (no proof): count Happens(event,time)`, a line for each objective; or what is known
  /// of it.
  std::string text() const;
  /// `"optimum":7,"proved":true,`; of several objectives a list. Before the optimum is known also
  /// `"best"` and `"at_least"`.
  std::string fields() const;
  /// As TraceCertifier says them; empty: `certify` made no proof.
  const std::string& proof_fields() const { return proof_fields_; }

 private:
  std::string value_text(std::size_t objective) const;

  std::vector<std::string> texts_;
  runtime::Optimum optimum_;
  std::string verdict_ = "no proof", proof_fields_;
};

}  // namespace parallax::tools
