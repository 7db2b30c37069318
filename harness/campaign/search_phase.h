#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "harness/campaign/search_result.h"
#include "harness/campaign/trial.h"

namespace parallax::harness {

enum class SearchEnd : std::uint8_t { kNothing, kDiscrepancy, kLostTooOften, kStopped };

struct SearchOutcome {
  SearchEnd end = SearchEnd::kNothing;
  SearchResult result;
  /// The simulated samples, in order, the discrepancy last.
  std::vector<TrialSample> samples;
};

/// A trace's start cuboid as a unit cube over what is drawn. Equal parts of the cube are equally
/// likely to be drawn from, before the conditions of a law.
class UnitCube {
 public:
  explicit UnitCube(const Sampler& sampler);
  std::size_t dimensions() const { return free_; }
  /// None: a condition of the law refuses the point.
  std::optional<State> start_at(std::span<const double> point) const;

 private:
  Sampler sampler_;
  std::size_t free_ = 0;
};

/// All starts of a trace as one unit cube: where it has several initial states the first coordinate
/// tells which, in equal parts or by their weights, and the others are those of that state's cube.
class StartCube {
 public:
  /// `starts` outlives it. Reports what start_sampler reports.
  static base::Result<StartCube> make(const StartStates& starts, const Scenario& scenario,
                                      const ModelFluents& fluents, base::DiagnosticSink& sink);
  std::size_t dimensions() const { return dimensions_; }
  /// None: a condition of the law refuses the point.
  std::optional<ChosenStart> start_at(const UnitPoint& point) const;

 private:
  explicit StartCube(const StartStates& starts) : starts_(&starts) {}

  const StartStates* starts_;
  std::vector<UnitCube> cubes_;  // by state
  std::size_t dimensions_ = 0;
};

/// The seed for the random choices in a search of the trace's starts.
std::uint64_t search_seed(const TracePlan& plan);
EvaluationKind evaluation_kind(const TrialSample& sample);

/// Tries starts that the strategy proposes, at most `spec.runs`, until one gives a discrepancy. It
/// takes the samples of the numbers 1 to `spec.runs`; draws come after them. Nothing that it shows
/// counts for a claim. What it does follows from the campaign's seed, whatever the number of jobs.
base::Result<SearchOutcome> search_trace(Trial& trial, const SearchSpec& spec,
                                         const Scenario& scenario, const ModelFluents& fluents,
                                         base::DiagnosticSink& sink);

}  // namespace parallax::harness
