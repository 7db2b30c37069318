#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// A variable, a constant or numeral, "there is one of this sort", or a term over variables.
struct LiteralArgument {
  enum class Kind : std::uint8_t { kVariable, kConstant, kSome, kTerm };
  Kind kind = Kind::kVariable;
  std::string name;  // name of the variable or constant, or of the sort; "count-1", "Price(item)"
  friend bool operator==(const LiteralArgument&, const LiteralArgument&) = default;
};

/// Literal that an edit may add to a condition: a fluent at the event's time, a predicate without
/// time, an equation, or a comparison of numbers (`x<y`), each perhaps negated.
struct ConditionLiteral {
  enum class Kind : std::uint8_t { kFluent, kPredicate, kEqual };
  Kind kind = Kind::kFluent;
  bool negated = false;
  std::string symbol;  // for a fluent or predicate
  std::vector<LiteralArgument> arguments;
  bool less = false;  // kEqual: `<` instead of `=`
  friend bool operator==(const ConditionLiteral&, const ConditionLiteral&) = default;

  std::size_t count(LiteralArgument::Kind of) const;
};

/// The literal as the language writes it; `time` is the name of the variable. Quantified variables
/// are named after their sort, with a digit where `taken` has the name.
std::string print(const ConditionLiteral& literal, const std::string& time,
                  const std::vector<std::string>& taken);

/// The same for an axiom about more than the literal's symbol covers: where a variable of `taken`
/// has a value outside of the symbol's sort, the formula is false. A literal by itself has no
/// instance there, and with it the whole axiom has none.
std::string print_everywhere(const ConditionLiteral& literal, const TypedModel& model,
                             const std::string& time, const std::vector<std::string>& taken);

/// Condition that each variable has a value in the symbol's sorts; empty: it always has one.
std::string typing_of(const ConditionLiteral& literal, const TypedModel& model,
                      const std::vector<std::string>& taken);

/// The literal with other names for its variables: terms of the axiom that it is put into.
ConditionLiteral renamed(ConditionLiteral literal, const std::map<std::string, std::string>& names);

/// Pattern of the printed atoms that the literal is about, "F(a,b)" or "F(a,*)": an open place is
/// `*`, as is a variable without a value. Empty for an equation.
std::string atom_pattern(const ConditionLiteral& literal,
                         const std::map<std::string, std::string>& values);

/// Does a printed atom fit the pattern?
bool matches(std::string_view atom, std::string_view pattern);

/// A variable with its sort.
struct SortedVariable {
  std::string name;
  SortId sort;
};
/// Sort that a variable's name gives: the name without trailing digits. None: there is no such
/// sort.
std::optional<SortId> sort_of_variable(const TypedModel& model, std::string_view name);
/// Names for variables of these sorts: "base", "item1", "item2".
std::vector<std::string> variables_for(const TypedModel& model, const std::vector<SortId>& sorts);
/// The constants of a sort and of all sorts below it, in order of declaration; the numerals of a
/// sort of few numbers.
std::vector<std::string> constants_of(const TypedModel& model, SortId sort);

/// Every literal over the model's fluents and predicates with these variables, constants, and
/// places that are left open; equations between variables, and between one and a constant or the
/// value of a function; of numbers also `x<y` and `x=y+1`. Symbols with more than `most_each`
/// literals have none with constants. This is the one language of conditions of `repair` and
/// `learn`. `constants`: false leaves them out everywhere.
std::vector<ConditionLiteral> condition_literals(const TypedModel& model,
                                                 const std::vector<SortedVariable>& variables,
                                                 std::size_t most_each, bool constants = true);

}  // namespace parallax::compiler
