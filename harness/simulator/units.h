#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "harness/simulator/simulator.h"

namespace parallax::harness {

/// What is odd about the units that a simulator names, and about what it observes in them.
struct UnitFinding {
  bool is_fault = false;  // else worth a look
  std::string text;
};

/// Is it a unit of the protocol other than 1, so that what is in it is a number?
bool is_unit_of_numbers(std::string_view unit);

/// Names against units ("box.yaw" in "m"), units that are none of SI ("deg", "mm"), angles beyond a
/// full turn, lengths beyond 10 km. `seen`: all states that were observed.
std::vector<UnitFinding> unit_findings(const SimulatorInfo& info, const std::vector<State>& seen);

}  // namespace parallax::harness
