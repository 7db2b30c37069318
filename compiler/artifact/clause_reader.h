#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "compiler/artifact/artifact_text.h"
#include "compiler/artifact/clause_runs.h"
#include "compiler/artifact/compiled_model.h"

namespace parallax::compiler {

/// Reads the part of an artifact that solvers read: the `p` line, the projection line and the
/// clauses, one a line. Fills clauses, origins, flags and timepoints, and checks that the copies of
/// repeated sections are copies.
class ClauseReader {
 public:
  ClauseReader(ArtifactCursor& cursor, CompiledModel& model) : cursor_(cursor), model_(model) {}

  /// The current line is the `p` line; `expected_clauses` is what the sections add up to.
  bool read(std::uint64_t expected_clauses, const std::vector<std::vector<ClauseRun>>& runs);

 private:
  bool read_header(std::uint64_t expected_clauses);
  bool read_projection();
  bool read_section(const Section& section, const std::vector<ClauseRun>& runs);
  bool read_copy(const Section& section, std::int64_t copy);
  bool next_clause();
  bool parse_clause();
  bool read_rest();
  bool cut_off();

  ArtifactCursor& cursor_;
  CompiledModel& model_;
  std::uint64_t clause_count_ = 0;
  std::vector<Literal> clause_;
};

}  // namespace parallax::compiler
