#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/word_table.h"
#include "harness/campaign/sample_record.h"

namespace parallax::harness {

/// An item that executions can show.
struct CoverItem {
  std::string place;  // "two/plan.lisp:6"
  std::string what;   // "OpenDrawer(top) fails"
};

/// The items that executions must show before a run ends by itself. They are fixed before the first
/// execution, so that no observation decides what is looked for.
class CoverWatch {
 public:
  virtual ~CoverWatch() = default;
  /// Items that some execution of the model shows, or for which the opposite was not proved.
  virtual const std::vector<CoverItem>& items() const = 0;
  /// Items of plan and model that no execution of the model goes through.
  virtual const std::vector<CoverItem>& unreachable() const = 0;
  /// Returns the indices of the items shown by an execution that came to a result. `admitted`: the
  /// model has an execution like it.
  virtual std::vector<std::size_t> shown_by(const SampleRecord& record, bool admitted) = 0;
};

/// The items shown and left over, and the bound for those left.
struct CoverResult {
  enum class End : std::uint8_t { kStopped, kShown, kRare, kRunLimit };
  End end = End::kStopped;  // why nothing more was looked for
  std::int64_t items = 0;
  std::vector<CoverItem> left;         // not shown by any execution
  std::vector<CoverItem> unreachable;  // not among the items
  std::int64_t drawn = 0, lost = 0;    // executions with a drawn start: observed, and lost
  /// An upper bound on the share of executions with a drawn start that show an item, for each item
  /// that is left. The confidence is that of all these bounds together.
  double confidence = 0.0, bound = 1.0;
  double epsilon = 0.0;  // what was asked for
};
inline constexpr auto kCoverEndWords =
    base::word_table<CoverResult::End>("stopped", "all shown", "rarer than epsilon", "max_runs");
constexpr std::string_view to_string(CoverResult::End end) { return kCoverEndWords.of(end); }

}  // namespace parallax::harness
