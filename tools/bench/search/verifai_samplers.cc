#include "tools/bench/search/verifai_samplers.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "harness/search/gaussian_process.h"

namespace parallax::bench {
namespace {

using harness::GaussianProcess;
using harness::SearchHistory;
using harness::SearchRng;
using harness::SearchStrategy;
using harness::UnitPoint;

constexpr std::size_t kBuckets = 5;

/// The margin below which a point counts as found.
class Threshold {
 public:
  explicit Threshold(bool adaptive) : adaptive_(adaptive) {}
  double at(const SearchHistory& history) const {
    const auto& judged = history.judged();
    if (!adaptive_ || judged.size() < 20 || history.is_flat()) return 0.0;
    const auto rank = std::min(judged.size() / 10, history.leading().size() - 1);
    return history[history.leading()[rank]].margin;
  }

 private:
  bool adaptive_;
};

std::size_t bucket_of(double value) {
  return std::min(kBuckets - 1, static_cast<std::size_t>(value * static_cast<double>(kBuckets)));
}

double in_bucket(SearchRng& rng, std::size_t bucket) {
  return (static_cast<double>(bucket) + rng.uniform()) / static_cast<double>(kBuckets);
}

class BucketCrossEntropy final : public SearchStrategy {
 public:
  BucketCrossEntropy(std::size_t dimensions, std::uint64_t seed, bool adaptive)
      : rng_(seed, 11),
        threshold_(adaptive),
        law_(dimensions, std::vector<double>(kBuckets, 1.0 / static_cast<double>(kBuckets))) {}

  std::vector<UnitPoint> propose(const SearchHistory& history, std::size_t count) override {
    const double threshold = threshold_.at(history);
    for (; seen_ < history.all().size(); ++seen_) {
      if (history[seen_].margin < threshold) update(history[seen_].point);
    }
    std::vector<UnitPoint> points;
    while (points.size() < count) {
      UnitPoint point;
      for (const auto& law : law_) point.push_back(in_bucket(rng_, drawn(law)));
      points.push_back(std::move(point));
    }
    return points;
  }

 private:
  void update(const UnitPoint& point) {
    for (std::size_t i = 0; i < law_.size(); ++i) {
      for (auto& one : law_[i]) one *= kAlpha;
      law_[i][bucket_of(point[i])] += 1.0 - kAlpha;
    }
  }
  std::size_t drawn(const std::vector<double>& law) {
    double rest = rng_.uniform();
    for (std::size_t b = 0; b + 1 < law.size(); ++b) {
      if (rest < law[b]) return b;
      rest -= law[b];
    }
    return law.size() - 1;
  }

  static constexpr double kAlpha = 0.9;
  SearchRng rng_;
  Threshold threshold_;
  std::vector<std::vector<double>> law_;
  std::size_t seen_ = 0;
};

class BucketBandit final : public SearchStrategy {
 public:
  BucketBandit(std::size_t dimensions, std::uint64_t seed)
      : rng_(seed, 12),
        tried_(dimensions, std::vector<double>(kBuckets, 1.0)),
        found_(dimensions, std::vector<double>(kBuckets, 0.0)) {}

  std::vector<UnitPoint> propose(const SearchHistory& history, std::size_t count) override {
    for (; seen_ < history.all().size(); ++seen_) {
      const auto& evaluation = history[seen_];
      for (std::size_t i = 0; i < found_.size() && evaluation.margin < 0.0; ++i) {
        found_[i][bucket_of(evaluation.point[i])] += 1.0;
      }
    }
    std::vector<UnitPoint> points;
    while (points.size() < count) {
      UnitPoint point;
      for (std::size_t i = 0; i < tried_.size(); ++i) {
        const auto bucket = most_promising(i);
        tried_[i][bucket] += 1.0;
        point.push_back(in_bucket(rng_, bucket));
      }
      total_ += 1.0;
      points.push_back(std::move(point));
    }
    return points;
  }

 private:
  std::size_t most_promising(std::size_t i) {
    double most = -1.0;
    std::vector<std::size_t> best;
    for (std::size_t b = 0; b < kBuckets; ++b) {
      const double bound = found_[i][b] / tried_[i][b] +
                           std::sqrt(2.0 * std::log(std::max(total_, 1.0)) / tried_[i][b]);
      if (bound > most) best.clear();
      if (bound >= most) best.push_back(b);
      most = std::max(most, bound);
    }
    return best[static_cast<std::size_t>(rng_.uniform() * static_cast<double>(best.size()))];
  }

  SearchRng rng_;
  std::vector<std::vector<double>> tried_, found_;  // by coordinate and bucket
  double total_ = 1.0;
  std::size_t seen_ = 0;
};

class Bayesian final : public SearchStrategy {
 public:
  Bayesian(std::size_t dimensions, std::uint64_t seed)
      : rng_(seed, 13), surrogate_(dimensions, {.one_length = true, .linear = false}) {}

  std::vector<UnitPoint> propose(const SearchHistory& history, std::size_t count) override {
    const auto dimensions = history.dimensions();
    const auto& judged = history.judged();
    std::vector<UnitPoint> points;
    if (judged.size() < kFirst || judged.size() > kMost || history.is_flat()) {
      while (points.size() < count) points.push_back(anywhere(dimensions));
      return points;
    }
    GaussianProcess::Points seen;
    std::vector<double> margins;
    for (const auto number : judged) {
      seen.push_back(&history[number].point);
      margins.push_back(history[number].margin);
    }
    surrogate_.fit(seen, margins);
    while (points.size() < count) {
      points.push_back(best_candidate(history));
      if (points.size() < count) surrogate_.believe(points.back());
    }
    return points;
  }

 private:
  static constexpr std::size_t kFirst = 5, kMost = 200, kCandidates = 200, kSteps = 40;

  UnitPoint anywhere(std::size_t dimensions) {
    UnitPoint point(dimensions);
    for (auto& value : point) value = rng_.uniform();
    return point;
  }
  UnitPoint best_candidate(const SearchHistory& history) {
    UnitPoint best;
    double most = -1.0;
    const auto consider = [&](const UnitPoint& point) {
      const double gain = improvement(point, history[*history.best()].margin);
      if (gain <= most) return;
      most = gain;
      best = point;
    };
    for (std::size_t i = 0; i < kCandidates; ++i) consider(anywhere(history.dimensions()));
    double width = 0.1;  // stands for the local search of its acquisition optimizer
    for (std::size_t i = 0; i < kSteps; ++i, width *= 0.93) {
      auto point = best;
      for (auto& value : point) value = std::clamp(value + width * rng_.normal(), 0.0, 1.0);
      consider(point);
    }
    return best;
  }
  double improvement(const UnitPoint& point, double least) const {
    const auto at = surrogate_.predict(point);
    if (at.deviation <= 0.0) return 0.0;
    const double z = (least - at.mean) / at.deviation;
    return at.deviation * (z * 0.5 * std::erfc(-z / std::numbers::sqrt2) +
                           std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi));
  }

  SearchRng rng_;
  GaussianProcess surrogate_;
};

}  // namespace

std::unique_ptr<SearchStrategy> verifai_cross_entropy(std::size_t dimensions, std::uint64_t seed,
                                                      bool adaptive) {
  return std::make_unique<BucketCrossEntropy>(dimensions, seed, adaptive);
}

std::unique_ptr<SearchStrategy> verifai_bandit(std::size_t dimensions, std::uint64_t seed) {
  return std::make_unique<BucketBandit>(dimensions, seed);
}

std::unique_ptr<SearchStrategy> verifai_bayesian(std::size_t dimensions, std::uint64_t seed) {
  return std::make_unique<Bayesian>(dimensions, seed);
}

}  // namespace parallax::bench
