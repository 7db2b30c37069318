#pragma once

#include "compiler/base/json.h"
#include "harness/simulator/protocol.h"

namespace parallax::harness {

/// The motion in the result of an action, as packed frames or as plain ones. It is told besides the
/// outcome: what is wrong with it is its `fault`, and does not make the outcome wrong.
void read_motion(const nlohmann::json& result, OutcomeReply& reply);

}  // namespace parallax::harness
