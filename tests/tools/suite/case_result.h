#pragma once

#include <string>

#include "tools/suite/suite_record.h"

namespace parallax::tools {

inline CaseResult result(Outcome outcome, const std::string& problem = {}) {
  CaseResult out;
  out.outcome = outcome;
  if (!problem.empty()) out.problems = {problem};
  return out;
}

inline bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace parallax::tools
