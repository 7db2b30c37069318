#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "harness/campaign/sample_record.h"

namespace parallax::harness {

/// Something that executions can show.
struct CoverItem {
  std::string place;  // "two/plan.lisp:6"
  std::string what;   // "OpenDrawer(top) fails"
};

/// What executions are to show before a run ends by itself. It is settled before the first one, so
/// that nothing that is seen decides what is looked for.
class CoverWatch {
 public:
  virtual ~CoverWatch() = default;
  /// What the model has executions with, or was not proved to have none with.
  virtual const std::vector<CoverItem>& items() const = 0;
  /// What stands in plan and model, and no execution of the model goes through.
  virtual const std::vector<CoverItem>& unreachable() const = 0;
  /// The items, by index, that an execution showed which came to a result. `admitted`: the model
  /// has one like it.
  virtual std::vector<std::size_t> shown_by(const SampleRecord& record, bool admitted) = 0;
};

/// What became of the items.
struct CoverResult {
  enum class End : std::uint8_t { kStopped, kShown, kRare, kRunLimit };
  End end = End::kStopped;  // why nothing more was looked for
  std::int64_t items = 0;
  std::vector<CoverItem> left;         // that no execution showed
  std::vector<CoverItem> unreachable;  // not among the items
  std::int64_t drawn = 0, lost = 0;    // executions with a drawn start: seen, and not
  /// With this confidence in all bounds together, each of those that are left comes in fewer of the
  /// executions with a drawn start.
  double confidence = 0.0, bound = 1.0;
  double epsilon = 0.0;  // what was asked for
};
/// "stopped", "all shown", "rarer than epsilon", "max_runs"
std::string_view to_string(CoverResult::End end);

}  // namespace parallax::harness
