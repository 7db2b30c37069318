#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "compiler/sema/typed_model.h"

namespace parallax::test {

/// A ground term, as it prints.
struct OldValue {
  std::string text;
  bool is_integer = false;
  std::int64_t number = 0;
  bool is_reified = false;
  bool fits = true;  // every argument inside it lies in its sort
};

/// Sorts, terms and the values of variables, as the encoder of 2005 has them.
class OldTerms {
 protected:
  explicit OldTerms(const compiler::TypedModel& model);
  const std::vector<OldValue>& domain(compiler::SortId sort);
  std::vector<OldValue> instances(compiler::SymbolId symbol);
  bool fits(compiler::SortId sort, const OldValue& value);
  OldValue applied(compiler::SymbolId symbol, const std::vector<OldValue>& arguments);
  OldValue term(compiler::TermId id);
  std::int64_t computed(compiler::ArithmeticOp op, std::int64_t a, std::int64_t b);
  bool compare(const compiler::TypedFormula& formula);
  void each_assignment(const std::vector<compiler::VariableId>& variables, std::size_t number,
                       const std::function<void()>& visit);
  const compiler::TypedModel& model_;
  std::map<std::uint32_t, OldValue> values_;  // by variable
  std::string beyond_;                        // why there is no answer

 private:
  std::map<std::uint32_t, std::vector<OldValue>> domains_;  // by sort
  std::map<std::string, OldValue> functions_;               // by function and arguments
};

}  // namespace parallax::test
