#include "harness/campaign/trace_family.h"

#include <algorithm>
#include <utility>

namespace parallax::harness {

base::Result<std::optional<CampaignTrace>> TraceFamily::next() {
  std::optional<CampaignTrace> trace;
  if (ahead_.empty() && !look_at_next()) {
    if (failed_) return sink_.already_reported();
    return trace;
  }
  trace = std::move(ahead_.front());
  ahead_.pop_front();
  ++given_;
  return trace;
}

std::optional<double> TraceFamily::share() {
  if (family_ == Family::kPerTrace) return 1.0;
  if (!looked_) find_rule();
  if (!rule_) return std::nullopt;
  return rule_->share(given_);
}

/// False if there is none.
bool TraceFamily::look_at_next() {
  if (ended_) return false;
  auto trace = feed_.next();
  failed_ = !trace;
  ended_ = failed_ || !*trace;
  if (!ended_) ahead_.push_back(std::move(**trace));
  if (ended_ && !failed_) exploration_ = feed_.exploration();
  return !ended_;
}

void TraceFamily::find_rule() {
  looked_ = true;
  const bool is_limited = max_traces_ > 0 && max_traces_ <= kMostTracesAhead;
  const auto most = is_limited ? max_traces_ : kMostTracesAhead + 1;
  while (seen() < most && look_at_next()) {
  }
  // An error is a trace that cannot be simulated, and nobody knows what would follow it.
  if (failed_ || (!is_limited && seen() == most)) {
    rule_.emplace(std::nullopt);
  } else if (!ended_ || exploration_ != "stopped") {
    rule_.emplace(seen());
  }
}

}  // namespace parallax::harness
