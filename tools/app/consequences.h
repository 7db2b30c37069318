#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "runtime/consequences/backbone.h"
#include "tools/app/context.h"

namespace parallax::tools {

struct ConsequencesQuery {
  std::int64_t at = -1;      // this timepoint only; -1: all
  bool why = false;          // find axioms for what is always so
  bool only_always = false;  // only what is in all traces, which takes less
};

/// `HoldsAt(name,time)` or `Happens(name,time)`, and in which traces.
struct ConsequenceFact {
  std::string name;
  compiler::Timepoint time = 0;
  bool happens = false;
  runtime::Extent extent = runtime::Extent::kUndecided;
  /// A minimal set of axioms from which the fact follows (indices into CompiledModel::origins), for
  /// facts that are in all traces. None: not asked for, or not found in time.
  std::optional<std::vector<std::uint32_t>> axioms;
};

struct ModelConsequences {
  /// By timepoint: fluents, then events, as declared. Without facts that are not in all traces,
  /// where only those are asked for.
  std::vector<ConsequenceFact> facts;
  std::optional<bool> any;  // is there a trace?
  bool complete = true;
  /// The first timepoint at which an execution comes to where the plan's unrolling was cut. What is
  /// behind it is undecided.
  std::optional<compiler::Timepoint> cut = std::nullopt;
};

/// Reports kUsage where the timepoint lies beyond the horizon, or axioms are asked for of traces
/// that end at different lengths.
base::Result<ModelConsequences> find_model_consequences(const compiler::CompiledModel& model,
                                                        const ConsequencesQuery& query,
                                                        Context& context);

struct AbductionQuery {
  std::vector<std::string> events;  // `Shoot`, or ground: `Shoot(Gun)`
  std::int64_t limit = 10;          // 0: all
};

/// `name` happens at `time`.
struct Occurrence {
  std::string name;
  compiler::Timepoint time = 0;
};

struct Abduction {
  std::vector<std::vector<Occurrence>> explanations;  // by size, each by timepoint
  bool complete = false;                              // there are no others
  std::int64_t possible_only = 0;  // sets that the observation may, but need not follow
};

/// `model` was compiled with the observation as its state constraint, which is to hold at the
/// horizon. Reports kNoSuchEvent.
base::Result<Abduction> abduce(const compiler::CompiledModel& model, const AbductionQuery& query,
                               Context& context);

}  // namespace parallax::tools
