#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/support/random_model.h"

namespace parallax::test {

/// A symbol with argument sorts; functions and constructors have a result.
struct RandomSymbol {
  std::string name;
  std::vector<std::string> arguments;
  std::string result;
};

/// Declarations of a random model, and the elements of every sort.
struct RandomSchema {
  struct Interval {
    int lower = 0;
    int upper = 0;
  };
  int horizon = 1;
  std::map<std::string, std::vector<std::string>> elements;   // by sort, printed
  std::map<std::string, std::vector<std::string>> ancestors;  // by sort: itself and above
  std::map<std::string, Interval> ranges;                     // integer sorts
  std::vector<std::string> plain;                             // sorts of named constants
  std::vector<RandomSymbol> fluents, events, predicates, functions, terms;
  std::vector<std::string> noninertial, manual_release, releasable;  // fluent names
  bool causal = false;                                               // ECCausal.e is loaded
  bool interval = false;                                             // DEC.e is loaded
  bool encoding3 = false;
  bool offsets = false;  // `offset` has a range
  std::vector<RandomStatement> statements;

  bool is_integer(const std::string& sort) const { return ranges.contains(sort); }
  bool below(const std::string& sort, const std::string& ancestor) const;
  /// Have the two sorts an element in common by declaration?
  bool related(const std::string& a, const std::string& b) const;
  std::size_t instances(const RandomSymbol& symbol) const;
  std::size_t atoms() const;
};

RandomSchema random_schema(FuzzRandom& random, bool large);

}  // namespace parallax::test
