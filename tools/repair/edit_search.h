#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "compiler/repair/edit_grammar.h"
#include "runtime/compare/circuit.h"
#include "runtime/solver/sat_solver.h"
#include "tools/repair/evidence.h"

namespace parallax::tools {

/// Finds edits that make a model admit the observations. One incremental solver has a selector for
/// each edit and, for each way that runs went, a copy of the guarded model's clauses in which its
/// events and states are asserted.
class EditSearch {
 public:
  static constexpr std::size_t kMostEdits = 3;  // at once

  /// `guarded` is the compiled guarded model (guarded_text) with the horizon of the longest of
  /// `evidence`; all outlive the search.
  EditSearch(const compiler::CompiledModel& guarded, const std::vector<compiler::Edit>& edits,
             const std::vector<Evidence>& evidence, const std::atomic<bool>& stop);

  /// Excludes the edit from all sets from now on.
  void exclude(std::size_t edit) { require({~selector(edit)}); }

  struct Found {
    std::vector<std::vector<std::size_t>> sets;  // of edits, ascending
    bool complete = false;                       // there is no further one
  };
  /// Sets of `size` edits that contain no set that was found before.
  Found find(std::size_t size, std::size_t limit);
  /// One set of at most `size` edits for the clean runs and those failed ones alone.
  std::optional<std::vector<std::size_t>> find_for(const std::vector<std::size_t>& failed,
                                                   std::size_t size);

 private:
  void add(std::size_t number);
  void find_occurrences();
  bool propagate(std::vector<runtime::Literal> facts, compiler::Timepoint last,
                 std::vector<std::int8_t>& values) const;
  std::vector<std::uint32_t> open_clauses(compiler::Timepoint last, const std::vector<bool>& needed,
                                          std::vector<std::int8_t>& values) const;
  void add_refusal(const Evidence& evidence, std::size_t t, compiler::Literal happens,
                   compiler::Literal active, const std::map<std::string, compiler::Literal>& state);
  runtime::Literal selector(std::size_t edit) const {
    return runtime::Literal::positive(static_cast<std::int32_t>(edit) + 1);
  }
  std::vector<std::size_t> selected() const;
  void require(std::vector<runtime::Literal> clause) { solver_->add_clause(clause); }

  const compiler::CompiledModel& guarded_;
  const std::vector<compiler::Edit>& edits_;
  const std::vector<Evidence>& evidence_;
  compiler::AtomIndex index_;
  std::vector<std::uint32_t> undemanded_;
  std::vector<std::optional<runtime::Literal>> fixed_;   // selectors, by fixed variable - 1
  std::vector<std::vector<std::uint32_t>> occurrences_;  // clauses, by 2 * (variable - 1) + negated
  std::unique_ptr<runtime::SatSolver> solver_;
  runtime::Circuit circuit_;
  std::optional<runtime::EventCounter> counter_;
  std::vector<runtime::Literal> active_;  // by evidence: it counts
};

}  // namespace parallax::tools
