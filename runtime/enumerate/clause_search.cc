#include "runtime/enumerate/clause_search.h"

#include <algorithm>
#include <limits>

namespace parallax::runtime {
namespace {

constexpr std::uint32_t kEnd = std::numeric_limits<std::uint32_t>::max();

}  // namespace

ClauseSearch::ClauseSearch(std::int32_t variables, std::span<const Literal> projected)
    : watches_(2 * static_cast<std::size_t>(variables)),
      values_(static_cast<std::size_t>(variables), 0) {
  std::vector<bool> is_projected(values_.size(), false);
  for (const auto literal : projected) {
    order_.push_back(static_cast<std::uint32_t>(literal.var()) - 1);
    is_projected[order_.back()] = true;
  }
  projected_ = order_.size();
  for (std::uint32_t v = 0; v < values_.size(); ++v) {
    if (!is_projected[v]) order_.push_back(v);
  }
}

void ClauseSearch::add_clause(std::span<const Literal> clause) {
  if (clause.empty()) has_empty_ = true;
  if (clause.size() == 1) units_.push_back(code(clause.front()));
  if (clause.size() < 2) return;
  const auto begin = static_cast<std::uint32_t>(literals_.size());
  for (const auto literal : clause) literals_.push_back(code(literal));
  literals_.push_back(kEnd);
  watches_[literals_[begin]].push_back({begin, literals_[begin + 1]});
  watches_[literals_[begin + 1]].push_back({begin, literals_[begin]});
}

void ClauseSearch::begin(std::span<const Literal> assumptions) {
  levels_.clear();
  undo(0);
  is_found_ = false;
  is_over_ = has_empty_;
  for (const auto unit : units_) is_over_ = is_over_ || !assume(unit);
  for (const auto literal : assumptions) is_over_ = is_over_ || !assume(code(literal));
}

ClauseSearch::Status ClauseSearch::next(std::int64_t budget) {
  if (is_found_) {
    leave_unprojected();
    is_found_ = false;
    is_over_ = !flip();
  }
  while (!is_over_) {
    if (propagate()) {
      if (decide()) continue;
      is_found_ = true;
      return Status::kFound;
    }
    ++conflicts_;
    is_over_ = !flip();
    if (budget-- <= 0) return is_over_ ? Status::kNoMore : Status::kGaveUp;
  }
  return Status::kNoMore;
}

void ClauseSearch::set(Code c) {
  values_[c >> 1U] = (c & 1U) != 0 ? -1 : 1;
  trail_.push_back(c);
}

bool ClauseSearch::assume(Code c) {
  if (is_open(c)) set(c);
  return is_true(c);
}

/// False: a clause is false.
bool ClauseSearch::propagate() {
  while (head_ < trail_.size()) {
    if (!visit(trail_[head_++] ^ 1U)) return false;
  }
  return true;
}

bool ClauseSearch::visit(Code falsified) {
  auto& watches = watches_[falsified];
  std::size_t kept = 0;
  bool is_consistent = true;
  for (std::size_t i = 0; i < watches.size(); ++i) {
    const auto watch = watches[i];
    watches[kept++] = watch;
    if (!is_consistent || is_true(watch.blocker)) continue;
    auto* clause = &literals_[watch.clause];
    if (clause[0] == falsified) std::swap(clause[0], clause[1]);
    const auto other = clause[0];
    watches[kept - 1].blocker = other;
    if (is_true(other)) continue;
    auto* next = clause + 2;
    while (*next != kEnd && !is_open(*next) && !is_true(*next)) ++next;
    if (*next != kEnd) {
      std::swap(clause[1], *next);
      watches_[clause[1]].push_back({watch.clause, other});
      --kept;
    } else if (is_open(other)) {
      set(other);
    } else {
      is_consistent = false;
    }
  }
  watches.resize(kept);
  return is_consistent;
}

void ClauseSearch::undo(std::size_t trail) {
  while (trail_.size() > trail) {
    values_[trail_.back() >> 1U] = 0;
    trail_.pop_back();
  }
  head_ = trail;
}

/// Sets the next open variable false. False: there is none.
bool ClauseSearch::decide() {
  auto next = levels_.empty() ? 0 : levels_.back().decided + 1;
  while (next < order_.size() && values_[order_[next]] != 0) ++next;
  if (next == order_.size()) return false;
  levels_.push_back({trail_.size(), next, false});
  set(2 * order_[next] + 1);
  return true;
}

/// Goes back to the last decision that has another value left, and takes it. False: there is none.
bool ClauseSearch::flip() {
  while (!levels_.empty() && levels_.back().is_second) levels_.pop_back();
  if (levels_.empty()) return false;
  auto& level = levels_.back();
  undo(level.trail);
  level.is_second = true;
  set(2 * order_[level.decided]);
  return true;
}

/// Other values of what is not projected make no other valuation.
void ClauseSearch::leave_unprojected() {
  while (!levels_.empty() && levels_.back().decided >= projected_) levels_.pop_back();
}

}  // namespace parallax::runtime
