#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/campaign/sample_record.h"
#include "harness/confidence/criterion.h"
#include "harness/sampling/sampler.h"

namespace parallax::harness {

/// The law that starts were drawn by, where they are not uniform in a cuboid, and what its
/// conditions did.
struct LawResult {
  struct Condition {
    std::string text;
    std::int64_t refused = 0;  // candidates; one may be refused by several
  };
  std::vector<std::string> words;  // "box.mass normal with mean 1 and sd 0.05"
  std::int64_t drawn = 0;          // starts
  std::int64_t refused = 0;        // candidates
  std::vector<Condition> conditions;

  /// The share of all candidates that was refused.
  double refused_share() const;
  /// "box.mass normal with mean 1 and sd 0.05; given box.x < 1"
  std::string text() const;
  /// "30 of 120 candidates (25 %): `a < b` 20, `c < d` 15"; empty: there is no condition.
  std::string refused_text() const;
};

/// The part of the start region that is never drawn, for a claim: "its rim (`inset_m`: 0.05)".
/// Empty if there is none, or for the default inset and less than a thousandth of the region: the
/// figures of a claim have three digits.
std::string left_out_text(const Sampler& sampler);

/// Counts over samples, which are drawn once more for it.
class LawCounter {
 public:
  /// Counts the draws of `record`, whose key was made from these.
  void add(const Sampler& sampler, std::uint64_t campaign_seed, std::uint64_t trace_key,
           const SampleRecord& record);
  /// Says the law of starts of which there may be no sample.
  void name(const Sampler& sampler);
  /// None: all starts are uniform in their cuboids.
  const std::optional<LawResult>& result() const { return result_; }
  /// The law of all starts, for a claim about them.
  DrawnStarts drawn() const { return {result_ ? result_->text() : std::string(), left_out_}; }

 private:
  std::string left_out_;
  std::optional<LawResult> result_;
};

}  // namespace parallax::harness
