#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/artifact/artifact_text.h"
#include "compiler/artifact/compiled_model.h"

namespace parallax::compiler {

/// `plain` clauses, then `definitions` clauses that define auxiliaries, all that `repeat` times.
/// Written `3`, `1+2`, `0+4`, `1+2x50`.
struct ClauseGroup {
  std::uint32_t plain = 0;
  std::uint32_t definitions = 0;
  std::uint32_t repeat = 1;
  std::uint64_t size() const {
    return (std::uint64_t{plain} + definitions) * std::uint64_t{repeat};
  }
};

/// Clauses of one origin that follow one another.
struct ClauseRun {
  std::uint32_t origin = 0;
  std::optional<Timepoint> timepoint;  // of every clause; none: usual_timepoint
  std::vector<ClauseGroup> groups;
};

/// The clauses of a section's first copy as runs.
std::vector<ClauseRun> clause_runs(const CompiledModel& model, const Section& section);

/// Appends a blank and the groups, separated by commas.
void append_counts(const std::vector<ClauseGroup>& groups, std::string& out);
/// Reads the next word of the line as groups; no group is empty.
bool read_counts(ArtifactCursor& cursor, std::vector<ClauseGroup>& groups);

}  // namespace parallax::compiler
