#pragma once

#include <cstdint>
#include <string>
#include <unordered_set>
#include <vector>

#include "compiler/artifact/artifact_text.h"
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
  /// What the enumeration of plans relies on: the constraints have an atom at every timepoint.
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

}  // namespace parallax::compiler
