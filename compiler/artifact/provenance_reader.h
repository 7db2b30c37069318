#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "compiler/artifact/artifact_text.h"
#include "compiler/artifact/clause_runs.h"
#include "compiler/artifact/compiled_model.h"
#include "compiler/artifact/places.h"

namespace parallax::compiler {

/// Reads the lines of an artifact that say where clauses and plan steps come from: `in`, `axiom`,
/// `section`, `clauses`, `step` and `argument`.
class ProvenanceReader {
 public:
  ProvenanceReader(ArtifactCursor& cursor, CompiledModel& model) : cursor_(cursor), model_(model) {}

  bool read_in() { return places_.read_file(cursor_); }
  bool read_axiom();
  bool read_section();
  bool read_clauses();
  bool read_step();
  bool read_argument();
  bool read_cut();

  /// The runs of each section, in the order of `model.sections`, whose `begin` are set.
  const std::vector<std::vector<ClauseRun>>& runs() const { return runs_; }
  /// Clauses of all copies of all sections.
  std::uint64_t clause_count() const { return clause_count_; }

 private:
  bool read_value(std::string_view type, PlanValue& value);

  ArtifactCursor& cursor_;
  CompiledModel& model_;
  PlaceReader places_;
  std::unordered_map<std::string, std::uint32_t> origins_;  // by id, for look-up only
  std::vector<std::vector<ClauseRun>> runs_;
  std::uint64_t clause_count_ = 0;
};

}  // namespace parallax::compiler
