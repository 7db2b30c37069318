#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/reference/reference_evaluator.h"
#include "tests/support/random_model.h"

namespace parallax::test {

/// A temporal formula that is worked out on its own tree, without parser, checker or model: one of
/// the operators of docs/reference/model_language.md over its parts, or a state formula. Over two
/// things A and B, fluents On(thing) and G(), events Push(thing). `thing` is the variable of its
/// quantifiers.
struct TemporalFormula {
  std::string op;  // "always", "until", "!", "&", "[thing]", ...; empty: a state formula
  std::string text;
  std::vector<TemporalFormula> parts;

  std::string print() const;
  /// Value at t of the trace; none where it names a timepoint before 0.
  std::optional<bool> value(const compiler::Valuation& trace, int t,
                            const std::string& thing = {}) const;
  bool has(const std::vector<std::string>& ops) const;
  bool looks_on() const { return has({"always", "eventually", "next", "weak_next", "until"}); }
  bool looks_back() const { return has({"historically", "once", "previously", "since"}); }
};

/// Operators nested at most `depth` deep. `bound`: a quantifier over `thing` stands around it.
TemporalFormula random_temporal(FuzzRandom& random, int depth, bool bound = false);

/// A model over these symbols with random effects, preconditions, demanded events, state
/// constraints and start. Some have prefixes that cannot go on, some no trace; a start and events
/// determine the rest.
std::string random_temporal_model(FuzzRandom& random);

}  // namespace parallax::test
