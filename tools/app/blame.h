#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "compiler/base/known.h"
#include "runtime/explain/contradiction.h"
#include "runtime/explain/group_solver.h"
#include "tools/app/context.h"
#include "tools/app/observed_path.h"

namespace parallax::tools {

/// A fluent whose observed value the model excludes.
struct Difference {
  /// Relation to the first difference, which is the one reported.
  enum class Role : std::uint8_t {
    kFirst,
    kFollows,     // implied by the first one and axioms about single states
    kSameAction,  // another effect of the same action
    kFurther,
  };
  compiler::FluentId fluent;
  std::string name;
  bool observed = false;
  bool neither = false;  // it neither holds nor does not; `observed` is what the model excludes
  Role role = Role::kFurther;
  /// A minimal set of groups (group_axioms) that contradict the observed value.
  runtime::IndexSet blamed;
};

/// Where a recorded simulation and the model part, and in what.
struct Parting {
  enum class Kind : std::uint8_t {
    kFluents,     // `differences`, each of them impossible by itself
    kTogether,    // each fluent is possible as it was seen, all together are not
    kOutcome,     // the state is possible, but not with this outcome of the last perform
    kImpossible,  // the last event cannot happen where it did
    kNoState,     // no state of a model stands for what was seen, and no axiom is against it
  };
  Kind kind = Kind::kFluents;
  std::size_t after = 0;                // timepoint
  std::vector<Difference> differences;  // the first one first
  /// kTogether, kOutcome: a minimal set of observed fluents that contradict the model.
  std::vector<std::pair<compiler::FluentId, bool>> needed;
  runtime::Observed observed;  // all that was seen up to there
};

/// Finds the first timepoint at which the model contradicts the observed path. All observed states
/// up to there, the events and their outcomes are asserted; unknown values stay open. None if the
/// model admits the whole path. Fails, having reported kExplanationCutShort, if the search was
/// stopped.
base::Result<std::optional<Parting>> find_parting(const compiler::CompiledModel& model,
                                                  const ObservedPath& path, Context& context);

/// A paragraph for a contradictory set, whose clauses of ground instances are `clauses`: what was
/// seen, what the model says, why it cannot follow. The first sentence names event, fluent and
/// reason.
std::string blame_words(const compiler::CompiledModel& model, const ObservedPath& path,
                        const Parting& parting, const std::vector<std::size_t>& clauses);

/// The other differences, a sentence for each role; empty if there are none.
std::string consequence_words(const ObservedPath& path, const Parting& parting);

/// "`F` no longer holds at 5": as it was seen at the parting.
std::string seen_words(const ObservedPath& path, const Parting& parting,
                       const Difference& difference);

/// Why an action failed, as the simulator says; else its status.
std::string reason_of(const harness::ActionOutcome& outcome);

/// The groups with an effect of the event that led to the parting.
runtime::IndexSet groups_of_event(const compiler::CompiledModel& model,
                                  const runtime::AxiomGroups& axioms, const ObservedPath& path,
                                  const Parting& parting);

}  // namespace parallax::tools
