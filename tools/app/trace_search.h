#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/graph/model_traces.h"
#include "tools/app/certify.h"
#include "tools/app/context.h"
#include "tools/app/trace_writer.h"

namespace parallax::tools {

/// A query for traces, and how they are to be found.
struct SearchOptions {
  std::int64_t limit = 10;  // 0: all
  std::string distinct = "observable";
  std::string strategy = "auto";
  std::int64_t from = 1;
  std::int64_t sample = 0;  // number of traces to draw; 0: traces are listed
  std::int64_t seed = 1;
  std::string hits = "first";  // the last two are for plans and state constraints
  bool split_initial = false;
  std::string order;            // "canonical", "any"; empty: what suits
  bool up_to_symmetry = false;  // one of each orbit
  std::int64_t jobs = 0;        // threads for a hard question; 0: it is not cut into cubes
  bool stats = false;           // say how they were found
};

/// How a search ended: what is known of the traces that were not listed.
struct Ending {
  std::string exploration = "stopped";
  bool complete = false;
  std::vector<std::string> bounds = {};  // why it is complete up to the bound only
  /// The least length of a prefix that meets the constraints and cannot go on, if there is one.
  std::optional<compiler::Timepoint> dead_end = std::nullopt;
  std::string in_all = {};  // up to symmetry: for how many traces those given stand
  bool searched = false;    // the certifier's solver found by itself that there are no others
};

/// Traces of a model with a plan or constraints.
Ending list_plan_traces(const SearchOptions& options, const compiler::CompiledModel& model,
                        TraceCertifier& certifier, TraceWriter& writer, Context& context);

/// Traces of a model: listed, or drawn where a sample is asked for. None if the strategy cannot be
/// had, reported. Where a proof is asked for the first ones are searched by the certifier's solver.
std::optional<Ending> list_model_traces(const SearchOptions& options,
                                        const compiler::CompiledModel& model,
                                        TraceCertifier& certifier, TraceWriter& writer,
                                        Context& context);

/// The number of traces of a model, or of their orbits, without making them. None if the strategy
/// cannot be had, reported; of orbits also where they have to be listed, which is not reported.
struct CountedTraces {
  std::string number, strategy;
  Ending ending;
};
std::optional<CountedTraces> count_model_traces(const SearchOptions& options,
                                                const compiler::CompiledModel& model,
                                                TraceCertifier& certifier, Context& context);

}  // namespace parallax::tools
