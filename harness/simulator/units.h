#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "harness/simulator/simulator.h"

namespace parallax::harness {

/// A finding about the units that a simulator names, or about values observed in them.
struct UnitFinding {
  bool is_fault = false;  // else worth a look
  std::string text;
};

/// Is it a unit of the protocol other than 1, so that what is in it is a number?
bool is_unit_of_numbers(std::string_view unit);

/// Finds names that contradict their units ("box.yaw" in "m"), units outside SI ("deg", "mm"),
/// angles beyond a full turn, and lengths beyond 10 km. `seen`: all states that were observed.
std::vector<UnitFinding> unit_findings(const SimulatorInfo& info, const std::vector<State>& seen);

}  // namespace parallax::harness
