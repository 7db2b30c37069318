#pragma once

#include <string>
#include <utility>

#include "tests/support/interpreter/world.h"

namespace parallax::test {

/// Control leaves the block with this number.
struct Leave {
  int block = 0;
  PlanItem value;
};
/// The body of this failure handling starts again.
struct Again {
  int handling = 0;
};
/// Nobody in this task handled the failure: the task ends.
struct TaskFailed {
  int task = 0;
  std::string what;
};
/// Nobody handled a failure of this class.
struct Unhandled {
  std::string what;
};
/// The branch that runs is ended by another one.
struct Evaporated {};
/// The trace is complete, or the horizon is reached: nothing more is executed, no clean-ups either.
struct Stop {
  bool hit = false;
};

inline PlanItem symbol_item(std::string text) {
  PlanItem out;
  out.kind = PlanItem::Kind::kSymbol;
  out.text = std::move(text);
  return out;
}
inline PlanItem number_item(double number) {
  PlanItem out;
  out.kind = PlanItem::Kind::kNumber;
  out.number = number;
  return out;
}
inline PlanItem true_item(bool value) {
  PlanItem out;
  if (value) out.kind = PlanItem::Kind::kTrue;
  return out;
}

}  // namespace parallax::test
