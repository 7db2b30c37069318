#include "harness/campaign/loop_cover.h"

#include <algorithm>
#include <iterator>

namespace parallax::harness {

LoopCover::LoopCover(CoverWatch& watch, const CriterionSpec& criterion)
    : watch_(watch), epsilon_(criterion.epsilon), shown_(watch.items().size(), false) {
  const auto items = std::ssize(watch.items());
  if (items > 0) bounds_.emplace(items, criterion.confidence_level, criterion.epsilon);
}

void LoopCover::note(const SampleRecord& record, bool admitted) {
  if (!bounds_) return;
  for (const auto item : watch_.shown_by(record, admitted)) shown_[item] = true;
}

void LoopCover::add_drawn() {
  if (bounds_) bounds_->add_run();
}

void LoopCover::add_lost() {
  if (bounds_) bounds_->add_lost();
}

bool LoopCover::is_all_shown() const {
  return std::find(shown_.begin(), shown_.end(), false) == shown_.end();
}

bool LoopCover::is_over() const { return !bounds_ || is_all_shown() || bounds_->is_rare(); }

std::int64_t LoopCover::runs_needed() const { return bounds_ ? bounds_->runs_needed() : 0; }

CoverResult LoopCover::result(bool at_limit) const {
  using End = CoverResult::End;
  CoverResult out;
  out.items = std::ssize(shown_);
  out.unreachable = watch_.unreachable();
  out.epsilon = epsilon_;
  out.end = is_all_shown() ? End::kShown
            : is_over()    ? End::kRare
            : at_limit     ? End::kRunLimit
                           : End::kStopped;
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    if (!shown_[i]) out.left.push_back(watch_.items()[i]);
  }
  if (!bounds_) return out;
  const auto bound = bounds_->bound();
  out.drawn = bounds_->runs();
  out.lost = bounds_->lost();
  out.confidence = bound.confidence_level;
  out.bound = bound.epsilon;
  return out;
}

}  // namespace parallax::harness
