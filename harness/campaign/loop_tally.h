#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "harness/campaign/campaign_result.h"
#include "harness/campaign/cover_watch.h"
#include "harness/campaign/loop_cover.h"
#include "harness/campaign/sample_record.h"
#include "harness/campaign/start_echo.h"
#include "harness/campaign/start_law.h"
#include "harness/confidence/criterion.h"
#include "harness/confidence/item_bounds.h"
#include "harness/sampling/sampler.h"

namespace parallax::harness {

/// Counts executions of a plan for what is said of them: claims and bounds, which are about drawn
/// starts alone, rates of causes, and what was shown.
class LoopTally {
 public:
  /// Counts into `stream` too, which has a loop and outlives the object. `planned`: the number of
  /// executions that rates are about.
  LoopTally(std::int64_t planned, std::uint64_t campaign_seed, TraceResult& stream)
      : tally_(RegressionFrame{}),
        rated_(planned),
        campaign_seed_(campaign_seed),
        stream_(stream) {}

  /// The run goes on until everything was shown that `watch` looks for.
  void watch(CoverWatch& watch, const CriterionSpec& criterion) {
    cover_.emplace(watch, criterion);
  }

  // One of these for each execution. `sampler`: of its initial state.
  void add_lost(const SampleRecord& record, const Sampler& sampler);
  /// Counts one that the model admits. `unfinished`: why it did not end; empty if it did.
  void add_admitted(const SampleRecord& record, const Sampler& sampler,
                    const std::string& unfinished);
  /// Counts one that the model does not admit. Is it one of those that rates are about?
  bool add_mismatch(const SampleRecord& record, const Sampler& sampler);

  const Tally& runs() const { return tally_; }
  /// The executions with a start that was drawn.
  std::int64_t executions() const { return tally_.runs() + drawn_unfinished_; }
  bool is_covered() const { return !cover_ || cover_->is_over(); }
  const std::optional<LoopCover>& cover() const { return cover_; }
  const LawCounter& law() const { return law_; }
  const StartEcho& echo() const { return echo_; }
  const FixedCount& rated() const { return rated_; }

 private:
  void add_start(const SampleRecord& record, const Sampler& sampler);
  bool note(const SampleRecord& record, bool admitted);

  Tally tally_;
  LawCounter law_;
  StartEcho echo_;
  FixedCount rated_;
  std::optional<LoopCover> cover_;
  std::int64_t drawn_unfinished_ = 0;
  std::uint64_t campaign_seed_;
  TraceResult& stream_;
};

}  // namespace parallax::harness
