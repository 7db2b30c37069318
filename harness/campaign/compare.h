#pragma once

#include <optional>
#include <string>

#include "harness/campaign/sample_record.h"
#include "harness/simulator/simulator.h"

namespace parallax::harness {

/// Equal to the last bit: 0.0 and -0.0 are not, nor are 1 and 1.0.
bool bit_equal(const Value& a, const Value& b);

/// A value as the shortest decimal that reads back to it, with its bits for a number that is not
/// whole: "0.1 (0x1.999999999999ap-4)".
std::string exact_text(const Value& value);

/// Where two simulations of one start part first, in order of time: outcome of an act, then the
/// observation after it, variables in order of their names.
struct RecordDifference {
  std::int64_t timepoint = 0;
  std::string variable;  // "box.x", or "act: status"
  std::string a, b;      // exact_text, or "absent"
};
std::optional<RecordDifference> first_difference(const SampleRecord& a, const SampleRecord& b);

}  // namespace parallax::harness
