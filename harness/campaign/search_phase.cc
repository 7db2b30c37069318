// Looks for a discrepancy of a trace before the runs that count.
//
// A strategy (harness/search) proposes starts as points of the unit cube over what is drawn;
// they are simulated in batches, and the margins of the answers guide the next proposals.
// Margins are on a scale that the runs so far define, so all of them are given anew with each
// batch. A whole batch is always asked for, even if fewer runs are left, so that what is
// proposed does not depend on where the search ends, nor on the number of jobs. The search uses
// a random stream of its own and nothing that it shows counts for a claim: its starts are
// chosen, not drawn. It ends with the first discrepancy.

#include "harness/campaign/search_phase.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/base/words.h"
#include "harness/campaign/sample_margin.h"
#include "harness/sampling/law_draw.h"

namespace parallax::harness {
namespace {

class SearchPhase {
 public:
  SearchPhase(Trial& trial, const StartCube& cube, const SearchSpec& spec, const Scenario& scenario,
              const ModelFluents& fluents)
      : trial_(trial), spec_(spec), scenario_(scenario), fluents_(fluents), cube_(cube) {
    outcome_.result.spec = spec;
  }

  base::Result<SearchOutcome> run(base::DiagnosticSink& sink) {
    if (cube_.dimensions() == 0) return finished(SearchEnd::kNothing);  // one start, drawn anyway
    const auto& plan = trial_.plan();
    const auto strategy = make_strategy(spec_.strategy, cube_.dimensions(), search_seed(plan));
    for (std::int64_t next = 1; next <= spec_.runs;) {
      const auto count = std::min(static_cast<std::int64_t>(kSearchBatch), spec_.runs - next + 1);
      // Always a whole batch: what is proposed must not depend on where the search ends.
      auto points = strategy->propose(history(), kSearchBatch);
      points.resize(static_cast<std::size_t>(count));
      std::vector<std::optional<ChosenStart>> starts;
      for (const auto& point : points) starts.push_back(cube_.start_at(point));
      auto tried = trial_.try_starts(next, std::move(starts));
      if (!tried) return sink.already_reported();
      if (!*tried) return finished(SearchEnd::kStopped);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const auto end = take(std::move(points[i]), std::move((**tried)[i]));
        if (end != SearchEnd::kNothing) return finished(end);
      }
      next += count;
    }
    return finished(SearchEnd::kNothing);
  }

 private:
  struct Tried {
    UnitPoint point;
    EvaluationKind kind = EvaluationKind::kClean;
    std::optional<std::size_t> run;  // number in the scale
    std::int64_t sample = 0;
  };

  /// The points tried so far, with their margins in the current scale.
  SearchHistory history() const {
    SearchHistory out(cube_.dimensions());
    for (const auto& tried : tried_) {
      Evaluation evaluation{tried.point, tried.kind};
      if (tried.run) {
        if (const auto margin = scale_.margin(*tried.run)) evaluation.margin = *margin;
      }
      out.add(std::move(evaluation));
    }
    return out;
  }

  SearchEnd take(UnitPoint point, TrialSample sample) {
    auto& result = outcome_.result;
    Tried tried{std::move(point), evaluation_kind(sample), std::nullopt, sample.record.sample};
    if (tried.kind == EvaluationKind::kInvalid) {
      ++result.invalid;
      tried_.push_back(std::move(tried));
      return SearchEnd::kNothing;
    }
    ++result.runs;
    const bool discrepancy = tried.kind == EvaluationKind::kDiscrepancy;
    const bool too_often = sample.verdict == SampleVerdict::kLostTooOften;
    if (tried.kind == EvaluationKind::kLost) {
      ++result.lost;
    } else {
      tried.run = scale_.size();
      scale_.add(margin_parts(*scenario_.mapping, fluents_, *trial_.plan_of(sample.record).trace,
                              scenario_.comparison(), sample.record),
                 discrepancy);
    }
    tried_.push_back(std::move(tried));
    outcome_.samples.push_back(std::move(sample));
    if (discrepancy) return SearchEnd::kDiscrepancy;
    return too_often ? SearchEnd::kLostTooOften : SearchEnd::kNothing;
  }

  SearchOutcome finished(SearchEnd end) {
    auto& result = outcome_.result;
    outcome_.end = end;
    result.found = end == SearchEnd::kDiscrepancy;
    result.contradicting.assign(scale_.contradicting().begin(), scale_.contradicting().end());
    for (const auto& tried : tried_) {
      if (!tried.run || scale_.part_of(*tried.run).empty()) continue;
      const double margin = *scale_.margin(*tried.run);
      if (result.nearest && margin >= result.margin) continue;
      result.nearest = tried.sample;
      result.margin = margin;
      result.part = scale_.part_of(*tried.run);
    }
    return std::move(outcome_);
  }

  Trial& trial_;
  const SearchSpec& spec_;
  const Scenario& scenario_;
  const ModelFluents& fluents_;
  const StartCube& cube_;
  MarginScale scale_;
  std::vector<Tried> tried_;
  SearchOutcome outcome_;
};

}  // namespace

UnitCube::UnitCube(const Sampler& sampler) : sampler_(sampler) {
  if (const auto* law = sampler.law()) {
    for (std::size_t i = 0; i < law->coordinates(); ++i) free_ += law->is_free(i) ? 1 : 0;
    return;
  }
  for (const auto& dimension : sampler.cuboid().dimensions) {
    if (dimension.interval.lower != dimension.interval.upper) ++free_;
  }
}

base::Result<StartCube> StartCube::make(const StartStates& starts, const Scenario& scenario,
                                        const ModelFluents& fluents, base::DiagnosticSink& sink) {
  StartCube out(starts);
  if (starts.is_single()) {
    out.cubes_.emplace_back(starts.first().sampler);
    out.dimensions_ = out.cubes_.front().dimensions();
    return out;
  }
  // A trace with too many states to list is searched from its first state only.
  for (std::int64_t state = 1; state <= starts.count().value_or(1); ++state) {
    const auto sampler = start_sampler(scenario, fluents.ground(), starts.holds(state), sink);
    if (!sampler) return sink.already_reported();
    out.cubes_.emplace_back(*sampler);
    out.dimensions_ = std::max(out.dimensions_, 1 + out.cubes_.back().dimensions());
  }
  return out;
}

std::optional<ChosenStart> StartCube::start_at(const UnitPoint& point) const {
  const std::span<const double> all(point);
  const auto state = starts_->state_at(all.empty() ? 0.0 : all.front());
  const auto& cube = cubes_[static_cast<std::size_t>(std::max<std::int64_t>(state, 1) - 1)];
  auto at = cube.start_at(all.subspan(starts_->is_single() ? 0 : 1));
  if (!at) return std::nullopt;
  return ChosenStart{state, *std::move(at)};
}

std::optional<State> UnitCube::start_at(std::span<const double> point) const {
  std::size_t next = 0;
  if (const auto* law = sampler_.law()) {
    constexpr double kBelowOne = 1.0 - 0x1.0p-53;
    std::vector<double> coordinates(law->coordinates());
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
      if (law->is_free(i)) coordinates[i] = std::clamp(point[next++], 0.0, kBelowOne);
    }
    return law->start_at(coordinates, nullptr);
  }
  State state;
  for (const auto& [variable, interval] : sampler_.cuboid().dimensions) {
    double value = interval.lower;
    if (interval.lower != interval.upper) {
      const double lower = interval.lower + sampler_.inset();
      const double upper = std::nextafter(interval.upper - sampler_.inset(), lower);
      value = std::clamp(lower + point[next++] * (upper - lower), lower, upper);
    }
    state.emplace(variable, value);
  }
  return state;
}

std::uint64_t search_seed(const TracePlan& plan) {
  constexpr std::uint64_t kSearchStream = 0x736561726368ULL;  // "search": not that of draws
  return mix64(plan.campaign_seed ^ mix64(plan.trace_key ^ kSearchStream));
}

EvaluationKind evaluation_kind(const TrialSample& sample) {
  if (sample.record.status == SampleStatus::kRejected) return EvaluationKind::kInvalid;
  switch (sample.verdict) {
    case SampleVerdict::kAsPredicted:
    case SampleVerdict::kAdmitted:
      return EvaluationKind::kClean;
    case SampleVerdict::kDiscrepancy:
      return EvaluationKind::kDiscrepancy;
    case SampleVerdict::kLost:
    case SampleVerdict::kLostTooOften:
      break;
  }
  return EvaluationKind::kLost;
}

base::Result<SearchOutcome> search_trace(Trial& trial, const SearchSpec& spec,
                                         const Scenario& scenario, const ModelFluents& fluents,
                                         base::DiagnosticSink& sink) {
  const auto cube = StartCube::make(trial.starts(), scenario, fluents, sink);
  if (!cube) return sink.already_reported();
  auto outcome = SearchPhase(trial, *cube, spec, scenario, fluents).run(sink);
  trial.begin_after(spec.runs);
  return outcome;
}

std::string search_text(const SearchResult& result, std::int64_t trace) {
  auto text = fmt::format("{} by {}, {}", base::counted(result.runs, "simulation"),
                          to_string(result.spec.strategy),
                          result.found ? "the last one a discrepancy" : "no discrepancy");
  if (result.invalid > 0) text += fmt::format("; {} invalid starts", result.invalid);
  if (result.lost > 0) text += fmt::format("; {} lost", result.lost);
  if (result.nearest && !result.found) {
    text += fmt::format("; the nearest was {}.{}, with {:.3g} of the usual margin ({})", trace,
                        *result.nearest, result.margin, result.part);
  }
  return text;
}

}  // namespace parallax::harness
