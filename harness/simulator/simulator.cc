#include "harness/simulator/simulator.h"

#include <algorithm>
#include <array>
#include <utility>

#include "compiler/base/contract.h"

namespace parallax::harness {

bool SimulatorInfo::can(std::string_view capability) const {
  return std::find(capabilities.begin(), capabilities.end(), capability) != capabilities.end();
}
namespace {

constexpr std::array<std::pair<SimStatus, std::string_view>, 6> kWords = {{
    {SimStatus::kOk, "ok"},
    {SimStatus::kFailed, "failed"},
    {SimStatus::kTruncated, "truncated"},
    {SimStatus::kInvalidStart, "invalid_start"},
    {SimStatus::kUnsupported, "unsupported"},
    {SimStatus::kLost, "lost"},
}};

}  // namespace

std::string_view to_string(SimStatus status) {
  for (const auto& [value, word] : kWords) {
    if (value == status) return word;
  }
  base::contract_violated("status", "an enumerator of SimStatus", __FILE__, __LINE__);
}

SimStatus sim_status_from(std::string_view word) {
  for (const auto& [value, name] : kWords) {
    if (name == word) return value;
  }
  return SimStatus::kUnsupported;
}

}  // namespace parallax::harness
