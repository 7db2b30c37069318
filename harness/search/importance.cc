#include <algorithm>
#include <cmath>

#include "harness/search/law_pool.h"
#include "harness/search/rare_event_batches.h"
#include "harness/search/weighted_bounds.h"

// Importance sampling with a defensive mixture (Hesterberg 1995) and a fitted law of several parts
// (cross-entropy: Rubinstein 1999). Each draw is from the law of starts with the probability
// `share`, else from the fitted law, so no weight is above 1 / share. Draws before the fitting was
// done do not count; the law is fitted anew between batches, from what was drawn before, which
// weighted_bounds.h allows for. What the fitted law misses is seen by the other draws alone: each
// discrepancy there weighs 1 / share, and there being none bounds how many there are.

namespace parallax::harness {
namespace {

constexpr std::uint64_t kImportanceStream = 100;
constexpr double kExploringShare = 0.25;  // of the budget, at most
constexpr double kFirstUniform = 0.015;   // of the budget: what exploring begins with
constexpr std::int64_t kFewestUniform = 80, kMostUniform = 2'000;
constexpr double kExploringDefence = 0.1;  // share of the law of starts while exploring
constexpr std::int64_t kStages = 60;       // of exploring, at most
constexpr std::size_t kMostKept = 2'000;
constexpr double kFirstShare = 0.6;
// Shares of the runs left after exploring, for budgets up to kUsual runs; less for larger ones.
constexpr double kFirstBatch = 0.03, kSecondBatch = 0.05, kUsual = 3'500.0;
constexpr double kErrorAbove = 0.97;  // of the whole error
constexpr double kFirstSpread = 4.0;
constexpr std::size_t kPointsAtOnce = 4096;

class ImportanceSampling {
 public:
  ImportanceSampling(const RareEventOptions& options, const BatchEvaluator& evaluate)
      : options_(options),
        rng_(options.seed, kImportanceStream),
        batches_(evaluate, result_),
        pool_(options.dimensions, kMostKept),
        error_above_(kErrorAbove * (1.0 - options.confidence)),
        error_below_((1.0 - kErrorAbove) * (1.0 - options.confidence)) {}

  RareEventResult run() {
    if (!explore()) return result_;
    result_.exploring = result_.runs;
    guess_ = pool_.discrepancies() > 0 ? pool_.probability() : 0.0;
    spread_ = kFirstSpread;
    const auto counted = static_cast<double>(options_.budget - result_.exploring);
    const double scale =
        std::pow(kUsual / std::max(kUsual, static_cast<double>(options_.budget)), 0.25);
    for (const double part : {kFirstBatch * scale, (kFirstBatch + kSecondBatch) * scale, 1.0}) {
      if (!certify(result_.exploring + static_cast<std::int64_t>(part * counted + 0.5))) {
        return result_;
      }
    }
    conclude();
    return result_;
  }

 private:
  struct Found {
    UnitPoint point;
    double weight = 0.0;
  };
  struct Answer {
    UnitPoint point;
    bool uniform = false;
    Evaluation evaluation;
  };

  bool explore() {
    const auto runs = static_cast<double>(options_.budget);
    const auto first =
        std::clamp(static_cast<std::int64_t>(kFirstUniform * runs), kFewestUniform, kMostUniform);
    // So few at a time that the law follows where they lead.
    const auto d = static_cast<std::int64_t>(options_.dimensions);
    const auto each = std::max(12 + 4 * d, first / 6);
    const auto enough = std::max(20 + 4 * d, first / 6);
    const auto most = static_cast<std::int64_t>(kExploringShare * runs);
    if (!draw_and_learn(DefensiveLaw{}, first)) return false;
    for (std::int64_t stage = 0; stage < kStages; ++stage) {
      if (pool_.discrepancies() >= enough || result_.runs + each > most) break;
      DefensiveLaw law;
      law.fitted = pool_.fit(rng_);
      if (!law.fitted) break;
      law.share = kExploringDefence;
      if (!draw_and_learn(std::move(law), result_.runs + each)) return false;
    }
    return true;
  }

  bool draw_and_learn(DefensiveLaw law, std::int64_t last) {
    std::vector<Particle> judged;
    const bool drawn = draw(law, last, [&](Answer& answer) {
      const double margin = answer.evaluation.margin;
      if (std::isfinite(margin)) judged.push_back({std::move(answer.point), margin});
    });
    if (drawn) pool_.add(std::move(law), judged);
    return drawn;
  }

  static bool is_inside(const UnitPoint& point) {
    return std::all_of(point.begin(), point.end(), [](double x) { return x >= 0.0 && x < 1.0; });
  }

  /// The share of the law of starts that should make the interval's ends least apart.
  double best_share(double left) const {
    const double enough_above = -std::log(error_above_), enough_below = -std::log(error_below_);
    double best = kFirstShare, least = 1e300;
    for (int percent = 30; percent <= 98; ++percent) {
      const double share = 0.01 * percent;
      const double above = 1.0 + enough_above / (share * left * guess_);
      const double off = std::sqrt(2.0 * enough_below * spread_ / ((1.0 - share) * left));
      const double ratio = above / std::max(0.02, 1.0 - off);
      if (ratio < least) {
        least = ratio;
        best = share;
      }
    }
    return best;
  }

  DefensiveLaw begin_law(double left) {
    DefensiveLaw law;
    double variance = 0.1 * left;  // of a draw's weight if it is a discrepancy, in units of p^2
    if (guess_ > 0.0) law.fitted = pool_.fit(rng_);
    if (law.fitted) {
      law.share = certified_.empty() ? kFirstShare : best_share(left);
      variance = spread_ / (1.0 - law.share);
    }
    bet_ = std::sqrt(-2.0 * std::log(error_below_) / (left * variance)) / law.share;
    bet_ = std::clamp(bet_, 1e-6, 0.9);
    return law;
  }

  /// Draws from the law until `last` runs are made.
  template <typename Take>
  bool draw(DefensiveLaw& law, std::int64_t last, Take take) {
    std::vector<Answer> drawn;
    std::vector<UnitPoint> points;
    std::vector<Evaluation> answers;
    while (result_.runs < last) {
      points.clear();
      drawn.clear();
      const auto wanted = std::min(kPointsAtOnce, static_cast<std::size_t>(last - result_.runs));
      while (points.size() < wanted) {
        const bool plain = !law.fitted || rng_.uniform() < law.share;
        auto point = plain ? uniform_start(rng_, options_.dimensions) : law.fitted->draw(rng_);
        ++law.draws;
        // Outside of the cube there is nothing to simulate, and it is known that no start is there.
        if (!plain && !is_inside(point)) continue;
        points.push_back(point);
        drawn.push_back({std::move(point), plain, {}});
      }
      if (!batches_.run(points, answers)) return false;
      for (std::size_t i = 0; i < points.size(); ++i) {
        drawn[i].evaluation = std::move(answers[i]);
        take(drawn[i]);
      }
    }
    return true;
  }

  bool certify(std::int64_t last) {
    if (result_.runs >= last) return true;
    auto law = begin_law(static_cast<double>(options_.budget - result_.runs));
    double sum = 0.0, squares = 0.0;
    std::vector<Particle> judged;
    const bool drawn = draw(law, last, [&](Answer& answer) {
      const auto kind = answer.evaluation.kind;
      WeightedBounds::Draw one;
      one.weight = 1.0 / law.density(answer.point);
      one.share = law.share;
      one.valid = kind != EvaluationKind::kInvalid;
      one.failed = kind == EvaluationKind::kDiscrepancy;
      one.lost = kind == EvaluationKind::kLost;
      bounds_.add(one, bet_);
      if (!one.valid) return;
      valid_ += one.weight;
      if (answer.uniform) ++result_.uniform;
      const double margin = answer.evaluation.margin;
      if (std::isfinite(margin) && (!answer.uniform || one.failed)) {
        judged.push_back({answer.point, margin});
      }
      if (!one.failed) return;
      ++result_.found;
      sum += one.weight;
      squares += one.weight * one.weight;
      found_.push_back({std::move(answer.point), one.weight});
    });
    if (!drawn) return false;
    const auto draws = static_cast<double>(law.draws);
    if (sum > 0.0) guess_ = sum / draws;
    if (sum > 0.0 && law.fitted) {
      spread_ = std::max(0.05, (1.0 - law.share) * squares / draws / (guess_ * guess_));
    }
    certified_.push_back(law);
    pool_.add(std::move(law), judged);
    return true;
  }

  /// Each discrepancy as if all draws were from the mean of all laws.
  void conclude() {
    double sum = 0.0, squares = 0.0, draws = 0.0;
    for (const auto& law : certified_) draws += static_cast<double>(law.draws);
    for (const auto& one : found_) {
      double all = 0.0;
      for (const auto& law : certified_) {
        all += static_cast<double>(law.draws) * law.density(one.point);
      }
      sum += 1.0 / all;
      squares += 1.0 / (all * all);
    }
    const double share_valid = result_.invalid > 0 ? valid_ / draws : 1.0;
    result_.lower = bounds_.lower(error_below_);
    result_.upper = std::max(result_.lower, bounds_.upper(error_above_));
    if (result_.found == 0) {
      result_.end = RareEventEnd::kUnreached;
      return;
    }
    result_.probability = std::clamp(sum / share_valid, result_.lower, result_.upper);
    result_.standard_error = std::sqrt(squares) / share_valid;
    result_.effective = sum * sum / squares;
  }

  const RareEventOptions& options_;
  RareEventResult result_;
  SearchRng rng_;
  RareEventBatches batches_;
  LawPool pool_;
  WeightedBounds bounds_;
  double error_above_, error_below_;
  std::vector<DefensiveLaw> certified_;
  std::vector<Found> found_;
  double guess_ = 0.0;   // of p
  double spread_ = 0.0;  // variance of a weight, per draw from the fitted law, in units of p^2
  double bet_ = 0.1;
  double valid_ = 0.0;
};

}  // namespace

RareEventResult estimate_by_importance(const RareEventOptions& options,
                                       const BatchEvaluator& evaluate) {
  return ImportanceSampling(options, evaluate).run();
}

}  // namespace parallax::harness
