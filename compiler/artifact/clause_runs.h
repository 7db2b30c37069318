#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compiler/artifact/artifact_text.h"
#include "compiler/artifact/compiled_model.h"

namespace parallax::compiler {

// Properties of clauses that a file may leave out because they follow from the clauses.

/// The least horizon at which every variable of the clause exists.
Timepoint derived_timepoint(const CompiledModel& model, std::span<const Literal> clause);

/// The timepoint that a clause of the section's first copy has unless the file says otherwise: the
/// width of a repeated section, in which all clauses appear together; else the derived one, which
/// is too early only where auxiliaries of a later timepoint are among the fixed variables.
Timepoint usual_timepoint(const CompiledModel& model, const Section& section,
                          std::span<const Literal> clause);

/// Which nameless variables occur: by fixed variable - 1, and by slot at any timepoint. One that
/// occurs is an auxiliary, one that does not is unused.
struct Occurrences {
  std::vector<bool> fixed;
  std::vector<bool> slots;
};
Occurrences occurrences(const CompiledModel& model);

/// Calls `visit` for the variables of HoldsAt and Happens, ascending: two models that agree on them
/// are one trace.
void for_each_observable(const CompiledModel& model,
                         const std::function<void(std::int32_t)>& visit);

/// Is `later` the clause `first` moved by `steps` timepoints?
bool is_shifted(const CompiledModel& model, std::span<const Literal> first,
                std::span<const Literal> later, std::int64_t steps);

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
