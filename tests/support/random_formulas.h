#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tests/support/random_schema.h"

namespace parallax::test {

/// Random terms and formulas over a schema. Variables in scope are named by their sorts.
class RandomFormulas {
 public:
  RandomFormulas(FuzzRandom& random, const RandomSchema& schema, bool aggregates = false)
      : random_(random), schema_(schema), aggregates_(aggregates) {}

  /// The variables in scope, innermost last.
  std::vector<std::string>& scope() { return scope_; }
  /// A variable of the sort, `thing` or `thing1`; puts it into scope.
  std::string enter(const std::string& sort);
  /// Sorts that a variable can have.
  std::string any_sort();

  /// None: nothing in scope or declared is of the sort.
  std::optional<std::string> term(const std::string& sort, int depth);
  std::optional<std::string> apply(const RandomSymbol& symbol, int depth);
  std::string time();
  /// Forgets the scope. A formula looks one way in time at most: only now, ahead, back, or -
  /// seldom, since most instances then lie outside the timepoints - anywhere.
  void start();
  /// Connectives and quantifiers at most `depth` deep.
  RandomFormula formula(int depth);
  RandomFormula atom();
  /// `count{..: formula}` or `sum{..: weight: formula}`, compared with a number or a variable.
  RandomFormula aggregate(int depth);
  /// Happens(.., time) for a random event and time term; an atom over `time` where there is none.
  RandomFormula occurrence();

 private:
  std::optional<std::string> holds(const char* predicate);
  std::optional<std::string> user_atom();
  std::optional<std::string> comparison();
  std::optional<std::string> arithmetic(const std::string& sort, int depth);
  std::optional<std::string> variable(const std::string& sort);
  RandomFormula quantified(int depth);
  std::string new_variables();
  std::string number(const std::vector<std::string>& numbers, std::size_t variable_percent);
  std::string moment_near(const std::string& moment);

  FuzzRandom& random_;
  const RandomSchema& schema_;
  const bool aggregates_;
  enum class Look { kNow, kAhead, kBack, kAnywhere };
  std::vector<std::string> scope_;
  Look look_ = Look::kNow;
};

/// "thing" of "thing12".
std::string sort_of(const std::string& variable);

}  // namespace parallax::test
