#pragma once

#include "compiler/syntax/ast.h"

namespace parallax::compiler {

// How strongly operators bind; the printer and the parser agree by this table alone.
inline constexpr int kQuantifierBinding = 1;
inline constexpr int kUntilBinding = 5;       // does not associate
inline constexpr int kComparisonBinding = 7;  // does not associate

constexpr int binding(Operator op) {
  switch (op) {
    case Operator::kImplies:
    case Operator::kIff:
      return 2;
    case Operator::kOr:
      return 3;
    case Operator::kAnd:
      return 4;
    case Operator::kUntil:
    case Operator::kSince:
      return kUntilBinding;
    case Operator::kEqual:
    case Operator::kNotEqual:
      return 6;
    case Operator::kLess:
    case Operator::kLessEqual:
    case Operator::kGreaterEqual:
    case Operator::kGreater:
      return kComparisonBinding;
    case Operator::kAdd:
    case Operator::kSubtract:
    case Operator::kNegate:
    case Operator::kPlus:
      return 8;
    case Operator::kMultiply:
    case Operator::kDivide:
    case Operator::kPower:
    case Operator::kModulo:
      return 9;
    case Operator::kNot:
    case Operator::kAlways:
    case Operator::kEventually:
    case Operator::kNext:
    case Operator::kWeakNext:
    case Operator::kHistorically:
    case Operator::kOnce:
    case Operator::kPreviously:
      return 10;
  }
  return 0;
}

/// `a & b & c` is one node with three children.
constexpr bool is_flat(Operator op) { return op == Operator::kAnd || op == Operator::kOr; }

}  // namespace parallax::compiler
