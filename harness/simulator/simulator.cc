#include "harness/simulator/simulator.h"

#include <algorithm>

namespace parallax::harness {

bool SimulatorInfo::can(std::string_view capability) const {
  return std::find(capabilities.begin(), capabilities.end(), capability) != capabilities.end();
}

}  // namespace parallax::harness
