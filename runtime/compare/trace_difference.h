#pragma once

#include <gmpxx.h>

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runtime/compare/difference_finder.h"
#include "runtime/graph/trace_graph.h"

namespace parallax::runtime {

/// At least `value`; exactly that many if `exact`.
struct TraceNumber {
  mpz_class value;
  bool exact = false;
};

/// A trace that the other model does not have. Of all such traces it is one that the other model
/// rules out by the earliest timepoint (its clauses up to then contradict the trace up to then),
/// and among those one with the fewest shared events before it.
struct Witness {
  Trace trace;
  Timepoint excluded_by = 0;
  std::size_t events = 0;  // shared ones before `excluded_by`
  /// Origins of the other model, a minimal set that rules it out; empty with `impossible`.
  std::vector<std::uint32_t> excluding;
  /// An atom of the trace that is false in every trace of the other model: "Happens Go(r1) 2".
  std::optional<std::string> impossible;
  bool is_shortest = true;  // else the solver was stopped on the way
};

/// The traces of one model that the other does not have, compared on what both observe.
struct OneSided {
  DifferenceAnswer answer = DifferenceAnswer::kUnknown;
  std::optional<Witness> witness;
  TraceNumber count;
  std::int64_t solve_calls = 0;
  std::size_t refinements = 0;
};

struct TraceDifference {
  Timepoint horizon = 0;
  SharedVocabulary vocabulary;
  std::optional<TraceNumber> first_count, second_count;  // of all traces, where they were counted
  OneSided lost;                                         // traces of the first, not of the second
  OneSided gained;                                       // traces of the second, not of the first
};

struct DifferenceOptions {
  std::size_t list_limit = 200;        // traces that are found one by one to be counted
  std::size_t max_refinements = 200;   // DifferenceFinder
  GraphLimits graph = {2'000, 4'000};  // for counting beyond `list_limit`
  /// No witnesses, which take more time than counting.
  bool counts_only = false;
  /// One difference is enough: nothing is counted, and gained traces are sought only if none was
  /// lost.
  bool any_difference = false;
  /// By origin of each model: belongs to an edited axiom.
  std::vector<bool> first_edited, second_edited;
  const std::atomic<bool>* stop = nullptr;
};

/// A model that is compared with several others. Results about it are kept from one comparison to
/// the next.
class ComparedModel {
 public:
  /// The model outlives the object.
  explicit ComparedModel(const CompiledModel& model) : model_(&model) {}
  const CompiledModel& model() const { return *model_; }

  const CompiledModel& up_to(Timepoint horizon);
  /// Definitions of the model up to that horizon.
  std::shared_ptr<const Definitions> definitions(const SharedVocabulary& vocabulary,
                                                 std::optional<Literal> SharedAtom::*side,
                                                 Timepoint horizon, const std::atomic<bool>* stop);

 private:
  const CompiledModel* model_;
  std::unique_ptr<const CompiledModel> shorter_;
  std::map<std::pair<Timepoint, std::vector<bool>>, std::shared_ptr<const Definitions>> known_;
};

/// Compares the traces of two models without state constraints up to the smaller of their horizons.
TraceDifference compare_traces(ComparedModel& first, ComparedModel& second,
                               const DifferenceOptions& options);
TraceDifference compare_traces(const CompiledModel& first, const CompiledModel& second,
                               const DifferenceOptions& options);

}  // namespace parallax::runtime
