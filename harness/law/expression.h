#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/base/result.h"

namespace parallax::harness {

/// A formula over the values of a start: "0.2 + 1.03 * fill", "milk1.x + 0.1 < cup.x or fill >
/// 0.5".
///
/// The syntax, in falling order of binding: numbers, names ("box.x"), min(a, b, ..), max, abs,
/// sqrt, sin, cos, hypot and brackets; ^; unary -; * /; + -; < <= > >= == !=; not; and; or. Numbers
/// and truths are kept apart, and comparisons do not chain. It has no state, so threads may share
/// it.
class Expression {
 public:
  enum class Kind : std::uint8_t { kNumber, kTruth };
  struct Name {
    std::string text;
    base::SourceRange source;  // where it stands first
  };

  /// Reports kBadFormula at the word that is wrong. `source` is where the text stands.
  static base::Result<Expression> parse(std::string_view text, Kind wanted,
                                        const base::SourceRange& source,
                                        base::DiagnosticSink& sink);

  const std::string& text() const { return text_; }
  const std::vector<Name>& names() const { return names_; }
  /// The value, `values` by names(); a truth is 1 or 0. NaN where any part has no finite value.
  double value(std::span<const double> values) const;

 private:
  friend class ExpressionParser;
  enum class Operation : std::uint8_t {
    kPush,
    kLoad,
    kAdd,
    kSubtract,
    kMultiply,
    kDivide,
    kPower,
    kNegate,
    kLess,
    kAtMost,
    kEqual,
    kUnequal,
    kNot,
    kAnd,
    kOr,
    kMin,
    kMax,
    kAbs,
    kSqrt,
    kSin,
    kCos,
    kHypot,
  };
  struct Step {
    Operation operation;
    double number = 0.0;    // kPush
    std::size_t index = 0;  // kLoad
  };
  std::string text_;
  std::vector<Name> names_;
  std::vector<Step> steps_;  // in postfix order
  std::size_t depth_ = 0;    // of its stack
};

}  // namespace parallax::harness
