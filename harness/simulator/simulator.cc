#include "harness/simulator/simulator.h"

#include <algorithm>

namespace parallax::harness {

bool SimulatorInfo::can(std::string_view capability) const {
  return std::find(capabilities.begin(), capabilities.end(), capability) != capabilities.end();
}

bool SimulatorInfo::is_instant(std::string_view action) const {
  return std::find(instant_actions.begin(), instant_actions.end(), action) != instant_actions.end();
}

}  // namespace parallax::harness
