#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "harness/campaign/sample_row.h"

namespace parallax::harness {

// One row for each simulation, in the order of the rows; numbers are decimals that read back to the
// same bits (docs/guide/running.md).

/// The beginning of a file that samples_csv wrote.
inline constexpr const char* kSamplesCsvMark = "trace,sample,seed,start,rejected,retries,outcome,";
/// Is this the beginning of a file that one of the two wrote?
bool is_sample_table(std::string_view head);

/// The rows as CSV after RFC 4180, with a header. After the fixed columns there is one for each
/// variable of the starts, by name, then one for each margin, by number of the event and name;
/// empty where a row has none.
std::string samples_csv(const std::vector<SampleRow>& rows);
/// The rows as JSON, one object a line.
std::string samples_jsonl(const std::vector<SampleRow>& rows);

}  // namespace parallax::harness
