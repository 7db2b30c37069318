#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/result.h"
#include "tools/app/recorded_run.h"

namespace parallax::tools {

enum class CoverageGroup : std::uint8_t {
  kPerforms,
  kBranches,  // both ways of a condition, and the two outcomes of a perform
  kHandlers,
  kRetries,  // performs that are tried again after they failed
  kEvents,
  kAxioms,  // effect axioms, preconditions, triggers
  kTraces,
};
inline constexpr std::array<std::string_view, 7> kCoverageGroups = {
    "performs", "branches", "handlers", "retries", "events", "axioms", "traces"};

/// Something that can be exercised, by where it stands.
struct CoverageKey {
  CoverageGroup group = CoverageGroup::kPerforms;
  std::string file;  // as messages name it
  std::uint32_t line = 0, column = 0;
  std::string id;
  friend auto operator<=>(const CoverageKey&, const CoverageKey&) = default;
};
struct CoverageCount {
  std::string text;         // what stands there, on one line; may be empty
  std::int64_t hits = 0;    // simulations that went through it
  std::int64_t traces = 0;  // traces of the model that do
};

struct Coverage {
  std::map<CoverageKey, CoverageCount> items;
  std::vector<std::string> scenarios;
  std::int64_t runs = 0, simulations = 0;
  /// The model's traces that were looked at are all that it has, up to its bound.
  bool all_traces = true;
};

struct CoverageOptions {
  std::vector<std::string> folders;
  std::string scenario;       // of all of them, where it lies by now; may be empty
  std::int64_t limit = 1000;  // traces of each model that are looked at; 0: all
};

/// What recorded runs, open loop, went through of their plans and models. Every folder is held
/// against its scenario as `replay` does it: reports what read_journal, load_recorded_scenario and
/// check_recorded_run report, and kCheckGivenUp for a model that is too large for the evaluator.
base::Result<Coverage> coverage_of(const CoverageOptions& options, Context& context);

}  // namespace parallax::tools
