#pragma once

#include <string>
#include <vector>

#include "harness/recording/recording.h"

namespace parallax::harness {

/// A remark at one time: "Go(bTable) begins", "left holds cup1".
struct Mark {
  double time_s = 0.0;
  std::string text;
  bool is_trouble = false;  // an event that did not go well
};

/// Beginnings and ends of events, and what grippers take and let go, in order of time.
std::vector<Mark> marks_of(const Recording& recording);

}  // namespace parallax::harness
