#include "harness/campaign/loop_tally.h"

#include "harness/campaign/loop_counts.h"
#include "harness/campaign/loop_samples.h"
#include "harness/campaign/run_setup.h"

namespace parallax::harness {

/// Counts the draws of its start, and those chosen by a guide.
void LoopTally::add_start(const SampleRecord& record, const Sampler& sampler) {
  if (record.visit) return;
  stream_.rejected += record.rejected;
  law_.add(sampler, campaign_seed_, loop_start_stream(), record);
  if (is_drawn(record)) {
    tally_.add_rejected(record.rejected);
  } else {
    stream_.loop->guided = stream_.loop->guided.value_or(0) + 1;
  }
}

/// Counts an execution that came to a result. Is it one of those that rates are about?
bool LoopTally::note(const SampleRecord& record, bool admitted) {
  if (cover_) cover_->note(record, admitted);
  echo_.add(record);
  if (!record.visit) {
    if (record.retries > 0) ++stream_.retried;
    count_path(record, *stream_.loop);
  }
  if (!is_drawn(record)) return false;
  if (cover_) cover_->add_drawn();
  return rated_.next();
}

void LoopTally::add_lost(const SampleRecord& record, const Sampler& sampler) {
  add_start(record, sampler);
  if (!record.visit) count_loss(record, stream_);
  if (!is_drawn(record)) return;
  tally_.add_lost();
  if (cover_) cover_->add_lost();
  (void)rated_.next();  // it has its place, but what it would have shown is not known
}

void LoopTally::add_admitted(const SampleRecord& record, const Sampler& sampler,
                             const std::string& unfinished) {
  add_start(record, sampler);
  const bool is_rated = note(record, true);
  auto& loop = *stream_.loop;
  if (unfinished.empty()) {
    if (is_drawn(record)) tally_.add_clean_elsewhere();
    if (is_rated) ++loop.causes_runs;
    if (!record.visit) ++stream_.clean;
  } else {
    if (is_drawn(record)) ++drawn_unfinished_;
    if (loop.unfinished++ == 0) loop.why_unfinished = unfinished;
  }
}

bool LoopTally::add_mismatch(const SampleRecord& record, const Sampler& sampler) {
  add_start(record, sampler);
  const bool is_rated = note(record, false);
  if (is_drawn(record)) tally_.add_mismatch();
  if (is_rated) ++stream_.loop->causes_runs;
  return is_rated;
}

}  // namespace parallax::harness
