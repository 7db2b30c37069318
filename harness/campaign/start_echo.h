#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "harness/campaign/sample_record.h"

namespace parallax::harness {

/// Did simulations begin where they were drawn? A simulator that does not take a start, or only a
/// part of it, answers for other starts than those that a claim is about. The first observation of
/// each simulation is held against its start.
class StartEcho {
 public:
  /// Takes in a simulation that was not lost.
  void add(const SampleRecord& record);
  /// A sentence for each variable whose first observations lie away from where it was drawn: by
  /// more than a tenth of the width that was drawn from, in the root mean square of at least ten
  /// simulations.
  std::vector<std::string> faults() const;

 private:
  struct Variable {
    std::int64_t runs = 0;
    double low_drawn = 0.0, high_drawn = 0.0, low_seen = 0.0, high_seen = 0.0;
    double squares = 0.0;
  };
  std::map<std::string, Variable, std::less<>> variables_;
};

}  // namespace parallax::harness
