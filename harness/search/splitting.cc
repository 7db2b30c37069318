#include <algorithm>
#include <cmath>
#include <limits>

#include "harness/confidence/quantiles.h"
#include "harness/search/rare_event_batches.h"
#include "harness/search/splitting_pilot.h"

// Adaptive multilevel splitting (Cérou and Guyader 2007), the worst particle at a time (Guyader,
// Hengartner and Matzner-Løber 2011): it becomes a copy of another, which then makes moves that
// stay below its margin, until all are discrepancies. Each replacement divides the probability by
// 1 - 1/n. The estimate has the right mean whatever the moves are, as long as they keep the law of
// starts (Bréhier, Lelièvre and Rousset 2015); with moves that forget where they began, the number
// of replacements has Poisson's law. Several independent populations give estimates of about a
// lognormal law, and the interval is Cox's for the mean of such (Land 1972; Zhou and Gao 1997).

namespace parallax::harness {
namespace {

constexpr std::uint64_t kSplittingStream = 200;
constexpr double kPilotShare = 0.15;  // of the budget, at most
constexpr double kRunsPerEstimate = 2000.0;
constexpr double kFewestEstimates = 8.0, kMostEstimates = 20.0;
constexpr double kFewestMoves = 6.0, kMostMoves = 60.0;
constexpr double kFewestParticles = 10.0;
constexpr double kLeastAcceptance = 0.03;
constexpr double kMostExcess = 6.0;

struct SplittingPlan {
  std::size_t estimates = 0, particles = 0, moves = 0;

  /// So that an event whose probability is the inverse of the budget takes all of it.
  explicit SplittingPlan(std::int64_t budget) {  // what the pilot left of it
    const auto runs = static_cast<double>(budget);
    const double count =
        std::clamp(std::round(runs / kRunsPerEstimate), kFewestEstimates, kMostEstimates);
    const double steps = std::clamp(std::round(std::sqrt(runs) / 18.0), kFewestMoves, kMostMoves);
    estimates = static_cast<std::size_t>(count);
    moves = static_cast<std::size_t>(steps);
    particles = static_cast<std::size_t>(runs / count / (1.0 + steps * std::log(runs)));
  }
};

class Population {
 public:
  Population(std::size_t dimensions, const SplittingPlan& plan, std::uint64_t seed,
             std::uint64_t stream, const std::vector<PilotLevel>& pilot)
      : rng_(seed, stream), dimensions_(dimensions), moves_(plan.moves), pilot_(&pilot) {
    particles_.resize(plan.particles);
    for (std::size_t i = 0; i < particles_.size(); ++i) changing_.push_back(i);
  }

  /// Returns the points to simulate next; none: it is done.
  std::vector<UnitPoint> wanted() {
    while (!changing_.empty()) {
      if (begun_ && made_ == moves_) {
        replace_worst();
        continue;
      }
      proposed_.clear();
      asked_.clear();
      for (const auto which : changing_) {
        auto point = begun_ ? moved(particles_[which].point, (*pilot_)[guide_].points, rng_)
                            : std::optional(uniform_start(rng_, dimensions_));
        if (!point) continue;
        proposed_.push_back(std::move(*point));
        asked_.push_back(which);
      }
      if (begun_) ++made_;
      if (!proposed_.empty()) return proposed_;
    }
    return {};
  }

  void take(const Evaluation* answers) {
    std::vector<std::size_t> again;
    for (std::size_t i = 0; i < proposed_.size(); ++i) {
      const double margin = answers[i].margin;
      if (!begun_ && !std::isfinite(margin)) {
        again.push_back(asked_[i]);  // no valid start: another one
        continue;
      }
      const bool accepted = !begun_ || margin < level_;  // never one that has none
      if (accepted) particles_[asked_[i]] = {std::move(proposed_[i]), margin};
      tried_ += begun_ ? 1 : 0;
      accepted_ += begun_ && accepted ? 1 : 0;
    }
    if (begun_) return;
    changing_ = std::move(again);
    if (!changing_.empty()) return;
    begun_ = true;
    const auto same = [&](const Particle& one) { return one.margin == particles_[0].margin; };
    flat_ = particles_[0].margin >= 0.0 && std::all_of(particles_.begin(), particles_.end(), same);
    replace_worst();
  }

  double log_estimate() const { return log_; }
  bool is_flat() const { return flat_; }
  bool died_out() const { return died_out_; }
  std::int64_t tried() const { return tried_; }
  std::int64_t accepted() const { return accepted_; }

 private:
  void replace_worst() {
    changing_.clear();
    made_ = 0;
    level_ = -std::numeric_limits<double>::infinity();
    for (const auto& one : particles_) level_ = std::max(level_, one.margin);
    while (guide_ + 1 < pilot_->size() && (*pilot_)[guide_ + 1].level >= level_) ++guide_;
    if (level_ < 0.0) return;  // all of them are discrepancies
    std::vector<std::size_t> left;
    for (std::size_t i = 0; i < particles_.size(); ++i) {
      (particles_[i].margin < level_ ? left : changing_).push_back(i);
    }
    died_out_ = left.empty();
    if (died_out_) return changing_.clear();
    log_ += std::log(static_cast<double>(left.size()) / static_cast<double>(particles_.size()));
    for (const auto which : changing_) {
      const auto from = static_cast<std::size_t>(rng_.uniform() * static_cast<double>(left.size()));
      particles_[which] = particles_[left[from]];
    }
  }

  SearchRng rng_;
  std::size_t dimensions_, moves_, made_ = 0;
  const std::vector<PilotLevel>* pilot_;
  std::size_t guide_ = 0;
  std::vector<Particle> particles_;
  std::vector<std::size_t> changing_, asked_;
  std::vector<UnitPoint> proposed_;
  double level_ = std::numeric_limits<double>::infinity();
  double log_ = 0.0;
  std::int64_t tried_ = 0, accepted_ = 0;
  bool begun_ = false, flat_ = false, died_out_ = false;
};

/// Cox's interval for the mean of a lognormal law.
void set_splitting_interval(const RareEventOptions& options, const SplittingPlan& plan,
                            const std::vector<double>& logs, RareEventResult& result) {
  const auto n = static_cast<double>(logs.size());
  double mean = 0.0, variance = 0.0;
  for (const double one : logs) mean += one / n;
  for (const double one : logs) variance += (one - mean) * (one - mean) / (n - 1.0);
  double sum = 0.0;
  for (const double one : logs) sum += std::exp(one);
  // The mean of the estimates themselves is right whatever their law is.
  const double centre = std::log(sum / n);
  const double error = std::sqrt(variance / n + 0.5 * variance * variance / (n - 1.0));
  const double off = error * student_t_quantile(0.5 * (1.0 + options.confidence), n - 1.0);
  result.probability = std::min(1.0, std::exp(centre));
  result.lower = std::min(1.0, std::exp(centre - off));
  result.upper = std::min(1.0, std::exp(centre + off));
  result.standard_error = result.probability * error;
  const double ideal = std::max(-mean, 1.0) / static_cast<double>(plan.particles);
  result.excess = variance / ideal;
}

}  // namespace

RareEventResult estimate_by_splitting(const RareEventOptions& options,
                                      const BatchEvaluator& evaluate) {
  RareEventResult result;
  RareEventBatches batches(evaluate, result);
  SearchRng pilot_rng(options.seed, kSplittingStream - 1);
  const auto pilot =
      run_pilot(options.dimensions,
                static_cast<std::int64_t>(kPilotShare * static_cast<double>(options.budget)),
                pilot_rng, batches);
  if (!pilot) return result;
  result.exploring = result.runs;
  const SplittingPlan plan(options.budget - result.runs);
  std::vector<Population> populations;
  const auto add = [&] {
    populations.emplace_back(options.dimensions, plan, options.seed,
                             kSplittingStream + populations.size(), *pilot);
  };
  while (populations.size() < plan.estimates) add();
  bool is_full = false;
  std::vector<Evaluation> answers;
  for (;;) {
    // All go on together, so that there is much to simulate at the same time.
    std::vector<UnitPoint> points;
    std::vector<std::size_t> counts;
    bool out = false;
    for (auto& one : populations) {
      auto wanted = one.wanted();
      counts.push_back(wanted.size());
      std::move(wanted.begin(), wanted.end(), std::back_inserter(points));
      out = out || one.is_flat() || one.died_out();
    }
    if (out) {
      result.end = RareEventEnd::kFlat;
      return result;
    }
    if (points.empty()) {
      // The budget that the first populations leave goes to others. Their number is set only once,
      // so that the results have hardly any influence on it.
      constexpr double kReserve = 1.1;
      const double each = kReserve * static_cast<double>(result.runs - result.exploring) /
                          static_cast<double>(populations.size());
      const auto more =
          static_cast<std::size_t>(static_cast<double>(options.budget - result.runs) / each);
      if (is_full || more == 0) break;
      is_full = true;
      for (std::size_t i = 0; i < more; ++i) add();
      continue;
    }
    if (result.runs + static_cast<std::int64_t>(points.size()) > options.budget) {
      result.end = RareEventEnd::kUnreached;
      return result;
    }
    if (!batches.run(points, answers)) return result;
    const Evaluation* at = answers.data();
    for (std::size_t i = 0; i < populations.size(); ++i) {
      if (counts[i] > 0) populations[i].take(at);
      at += counts[i];
    }
  }
  std::vector<double> logs;
  double tried = 0.0, accepted = 0.0;
  for (const auto& one : populations) {
    logs.push_back(one.log_estimate());
    result.estimates.push_back(std::exp(one.log_estimate()));
    tried += static_cast<double>(one.tried());
    accepted += static_cast<double>(one.accepted());
  }
  result.acceptance = tried > 0.0 ? accepted / tried : 1.0;
  set_splitting_interval(options, plan, logs, result);
  if (result.lost > 0) {
    result.end = RareEventEnd::kLost;
  } else if (result.acceptance < kLeastAcceptance || result.excess > kMostExcess) {
    result.end = RareEventEnd::kUnresolved;
  }
  return result;
}

}  // namespace parallax::harness
