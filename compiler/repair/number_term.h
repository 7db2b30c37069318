#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compiler/repair/condition_literal.h"
#include "compiler/syntax/ast.h"

namespace parallax::compiler {

/// Is it a sort of numbers, other than timepoints?
bool is_number_sort(const TypedModel& model, SortId sort);
/// The numerals of such a sort, ascending; none if there are more than 16.
std::vector<std::string> numerals_of(const TypedModel& model, SortId sort);

/// The term with other names for its variables: "count-1" with `count` named `count2`.
std::string with_names(const std::string& term, const std::map<std::string, std::string>& names);
/// `x`, `x+1`, `x-1`: a variable and what is added to it. None: another term.
struct SteppedVariable {
  std::string variable;
  int by = 0;
};
std::optional<SteppedVariable> stepped_variable(const std::string& term);
/// The value of a numeral, a variable, or of `x+1` and `x-1`. None: it is not known.
std::optional<std::int64_t> number_of(const std::string& term,
                                      const std::map<std::string, std::string>& values);
/// Does the comparison hold, as far as it is known?
std::optional<bool> compares(const ConditionLiteral& literal,
                             const std::map<std::string, std::string>& values);

/// Terms over these variables with the value of a declared function: "Price(item)", for functions
/// whose values fit the sort; of many functions those that are declared first.
std::vector<std::string> function_terms(const TypedModel& model, SortId sort,
                                        const std::vector<SortedVariable>& variables);

/// A text that may stand instead of a formula or term, with its oddity.
using OtherText = std::pair<std::string, int>;
/// Alternatives to a comparison: the opposite, another relation, a number that is one off, the
/// other one of `+` and `-`, another variable of the sort. Empty for other formulas.
std::vector<OtherText> other_comparisons(const Ast& ast, NodeId comparison, const TypedModel& model,
                                         const std::vector<SortedVariable>& variables);

}  // namespace parallax::compiler
