#include "harness/law/expression.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace parallax::harness {

double Expression::value(std::span<const double> values) const {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> stack(depth_ + 1);
  std::size_t top = 0;  // values on the stack
  bool finite = true;
  for (const auto& step : steps_) {
    if (step.operation == Operation::kPush || step.operation == Operation::kLoad) {
      stack[top++] = step.operation == Operation::kPush ? step.number : values[step.index];
      finite = finite && std::isfinite(stack[top - 1]);
      continue;
    }
    double& last = stack[top - 1];
    double result = 0.0;
    bool binary = true;
    const double a = top > 1 ? stack[top - 2] : 0.0, b = last;
    switch (step.operation) {
      case Operation::kPush:
      case Operation::kLoad:
        break;
      case Operation::kAdd:
        result = a + b;
        break;
      case Operation::kSubtract:
        result = a - b;
        break;
      case Operation::kMultiply:
        result = a * b;
        break;
      case Operation::kDivide:
        result = a / b;
        break;
      case Operation::kPower:
        result = std::pow(a, b);
        break;
      case Operation::kLess:
        result = (step.index == 0 ? a < b : b < a) ? 1.0 : 0.0;
        break;
      case Operation::kAtMost:
        result = (step.index == 0 ? a <= b : b <= a) ? 1.0 : 0.0;
        break;
      case Operation::kEqual:
        result = a == b ? 1.0 : 0.0;
        break;
      case Operation::kUnequal:
        result = a != b ? 1.0 : 0.0;
        break;
      case Operation::kAnd:
        result = std::min(a, b);
        break;
      case Operation::kOr:
        result = std::max(a, b);
        break;
      case Operation::kMin:
        result = std::min(a, b);
        break;
      case Operation::kMax:
        result = std::max(a, b);
        break;
      case Operation::kHypot:
        result = std::hypot(a, b);
        break;
      case Operation::kNegate:
        result = -b, binary = false;
        break;
      case Operation::kNot:
        result = 1.0 - b, binary = false;
        break;
      case Operation::kAbs:
        result = std::abs(b), binary = false;
        break;
      case Operation::kSqrt:
        result = std::sqrt(b), binary = false;
        break;
      case Operation::kSin:
        result = std::sin(b), binary = false;
        break;
      case Operation::kCos:
        result = std::cos(b), binary = false;
        break;
    }
    if (binary) --top;
    stack[top - 1] = result;
    finite = finite && std::isfinite(result);
  }
  return finite ? stack[0] : kNone;
}

}  // namespace parallax::harness
