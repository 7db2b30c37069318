#pragma once

#include <string>
#include <unordered_map>

#include "compiler/base/diagnostic.h"
#include "compiler/sema/sort_domains.h"
#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// Recognises `F(C1,...,Cn)=V.` and keeps the model's table of function values.
class FunctionTable {
 public:
  FunctionTable(TypedModel& model, base::DiagnosticSink& sink) : model_(model), sink_(sink) {}

  /// True if `formula` is an entry of the table; it is then no axiom. E2304 if the same arguments
  /// have another value already.
  bool add(TypedFormulaId formula, SortDomains& domains);

 private:
  bool is_value(TermId term) const;
  void append_key(TermId term, std::string& key) const;
  bool lies_in(TermId value, SortId sort, SortDomains& domains) const;

  TypedModel& model_;
  base::DiagnosticSink& sink_;
  std::unordered_map<std::string, std::size_t> entries_;  // key of F(C1..Cn) to position
};

}  // namespace parallax::compiler
