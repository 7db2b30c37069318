#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "compiler/asp/asp_export.h"
#include "compiler/base/diagnostic.h"
#include "compiler/ground/grounder.h"
#include "compiler/reference/reference_evaluator.h"
#include "tests/fuzz/stated_exclusion.h"

namespace parallax::test {

/// The traces that one side finds.
struct TraceList {
  std::vector<compiler::Valuation> traces;
  bool complete = false;
  /// The atoms of user predicates that this side tells apart; none: all of them. One that no
  /// formula mentions may have any value, and a side need not know it.
  std::optional<std::set<std::string>> predicates = std::nullopt;
};

/// A model text as parallax reads it. Parts that could not be made are absent; `codes` says why.
struct FuzzCompilation {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  std::unique_ptr<compiler::TypedModel> typed;
  std::vector<StatedExclusion> exclusions;  // of the parsed text
  std::optional<compiler::CompiledModel> compiled;

  /// With an objective, as `--minimize` has it, unless that is empty.
  FuzzCompilation(const std::string& text, const compiler::GroundOptions& options,
                  const std::string& objective = {});
  /// The ids of errors, each once, blank-separated.
  std::string codes() const;
  /// The lines that they stand on, counted from 1.
  std::set<std::size_t> error_lines() const;
};

/// Ways of grounding that must not make a difference: the first is the default, the others switch
/// one refinement off each.
struct GroundVariant {
  std::string name;
  compiler::GroundOptions options;
};
std::vector<GroundVariant> ground_variants();

/// All valuations of the compiled model's atoms, at most `limit`.
TraceList solver_valuations(const compiler::CompiledModel& model, std::size_t limit);
/// Traces that ModelEnumerator finds: each observable part once.
TraceList enumerated_traces(const compiler::CompiledModel& model, std::size_t limit);
/// Number of traces found by the counter by components, in decimal digits.
std::string counted_traces(const compiler::CompiledModel& model);
/// Every assignment that the evaluator accepts; none if more than 2^`max_atoms` would be tried.
std::optional<TraceList> brute_force_traces(const compiler::ReferenceEvaluator& evaluator,
                                            std::size_t max_atoms);

struct ClingoAnswer {
  TraceList found;
  std::set<std::size_t> existing_axioms;  // by number; only if there is an answer set
};
/// Runs clingo on an exported program, with `--project` on observable atoms if `observable`.
/// None: clingo failed, `error` says how.
std::optional<ClingoAnswer> clingo_traces(const compiler::AspProgram& program, std::size_t limit,
                                          bool observable, std::size_t horizon, std::string& error);
/// The optimum of an exported program with `minimize`, `#minimize` statements; none without an
/// answer set. A text: clingo failed, and how.
std::variant<std::optional<std::int64_t>, std::string> clingo_optimum(
    const compiler::AspProgram& program, const std::string& minimize);
bool clingo_is_installed();

/// A trace as one line of its HoldsAt and Happens; in full also of its ReleasedAt.
std::string trace_key(const compiler::Valuation& trace, bool full);

}  // namespace parallax::test
