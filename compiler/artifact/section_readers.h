#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "compiler/artifact/artifact_text.h"
#include "compiler/artifact/clause_runs.h"
#include "compiler/artifact/compiled_model.h"

namespace parallax::compiler {

/// Reads the lines of an artifact that say what variables stand for: `fluent`, `event`, `slot` and
/// `atom`. The tables of the model have their sizes already.
class SymbolReader {
 public:
  SymbolReader(ArtifactCursor& cursor, CompiledModel& model) : cursor_(cursor), model_(model) {}

  bool read_fluent();
  bool read_event();
  bool read_slot();
  bool read_atom();
  /// After the clauses: variables that no line names are auxiliaries if a clause mentions them.
  void name_the_rest();
  /// Checks that the constraints have an atom at every timepoint, as the enumeration of plans
  /// requires.
  bool check_hits();

 private:
  bool read_ground_name(std::string_view what, AtomKind kind, std::int64_t lower,
                        std::int64_t upper, GroundName& name);
  bool read_kind(AtomKind& kind);
  bool claim_slot(std::int64_t slot, AtomKind kind, const std::string& name);
  bool unique(AtomKind kind, Timepoint time, const std::string& name, bool declared);

  ArtifactCursor& cursor_;
  CompiledModel& model_;
  std::vector<bool> slot_taken_, fixed_taken_;
  std::unordered_set<std::string> names_;  // for look-up only
};

/// Reads the lines of an artifact that say what best traces have least of: `objective` and `term`.
/// The tables of the model have their sizes already.
class ObjectiveReader {
 public:
  ObjectiveReader(ArtifactCursor& cursor, CompiledModel& model) : cursor_(cursor), model_(model) {}

  bool read_objective();
  bool read_term();

 private:
  ArtifactCursor& cursor_;
  CompiledModel& model_;
  std::int64_t total_ = 0;  // of the magnitudes of the last objective's weights
};

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

/// Reads the part of an artifact that solvers read: the `p` line, the projection line and the
/// clauses, one a line. Fills clauses, origins, flags and timepoints, and checks that the copies of
/// repeated sections are copies.
class ClauseReader {
 public:
  ClauseReader(ArtifactCursor& cursor, CompiledModel& model) : cursor_(cursor), model_(model) {}

  /// The current line is the `p` line; `expected_clauses` is the sum over the sections.
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
