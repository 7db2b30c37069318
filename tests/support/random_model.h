#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace parallax::test {

/// splitmix64 (Steele, Lea, Flood 2014): one seed, the same numbers everywhere.
class FuzzRandom {
 public:
  explicit FuzzRandom(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next();
  /// 0 .. bound - 1; `bound` is small, so the bias is of no matter.
  std::size_t below(std::size_t bound) { return static_cast<std::size_t>(next() % bound); }
  bool chance(std::size_t percent) { return below(100) < percent; }
  template <typename T>
  const T& pick(const std::vector<T>& values) {
    return values[below(values.size())];
  }

 private:
  std::uint64_t state_;
};

/// A formula as a tree that can be printed and made smaller: a leaf's text, or an operator
/// (`!`, `&`, `|`, `->`, `<->`, a quantifier such as `[time]`) over its parts; an aggregate is
/// `count{time: ` in front of its part and `}>=2` behind it.
struct RandomFormula {
  std::string text;
  std::vector<RandomFormula> parts;
  std::string tail = {};
  std::string print() const;
};

/// One line: a declaration, or a formula behind an optional label.
struct RandomStatement {
  std::string text;  // declaration
  std::string label;
  std::optional<RandomFormula> formula;
  std::string print() const;
};

struct RandomModel {
  std::uint64_t seed = 0;
  std::vector<RandomStatement> statements;
  /// Atoms of HoldsAt, Happens, ReleasedAt (for fluents that can be released) and user predicates.
  std::size_t atoms = 0;
  std::string print() const;
};

/// The number of atoms over all timepoints.
struct ModelSize {
  std::size_t least = 0;
  std::size_t most = 0;
};
inline constexpr ModelSize kBruteForceSize{1, 16};
inline constexpr ModelSize kSolverSize{20, 60};

/// Constructs that models have only on demand.
struct RandomAdditions {
  /// Effect axioms whose conditions mention effects; an effect may depend on its own absence.
  bool effect_constraints = false;
  /// A statement of mutex or xor over new events or fluents of unequal numbers of arguments.
  bool exclusions = false;
  /// Formulas with counts and sums of every kind, at every place that a formula may have.
  bool aggregates = false;
};

/// A model in which all other constructs of the language may occur: subsorts, ranges, nested
/// reified sorts, functions, every connective, quantifiers over empty sorts, fluents and events,
/// time arithmetic, completion with and without label, releases, noninertial and manualrelease
/// fluents, trajectories, definitions over effects, mutex and xor. Well-sorted by construction; it
/// may still be refused because a formula is false or says nothing. The same seed gives the same
/// model.
RandomModel random_model(std::uint64_t seed, const ModelSize& size,
                         const RandomAdditions& additions = {});

}  // namespace parallax::test
