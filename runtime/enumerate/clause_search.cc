// All valuations of some variables by conflict-driven search, without blocking clauses.
//
// Variables are decided in a fixed order, false first, with unit propagation; conflicts teach
// clauses (first unique implication point, Marques-Silva and Sakallah 1999). After an answer the
// search returns to the last projected variable that has its other value left. A level whose
// second value is being searched must not be left by a conflict before that value is exhausted,
// or answers would be lost: backjumps stop there, and a conflict on the level itself flips the
// last decision that has a value left (Gebser, Kaufmann and Schaub 2009). Learned clauses follow
// from the clauses alone, never from earlier answers, so they stay valid for later searches;
// half of them, those of the most levels, are forgotten now and then (Audemard and Simon 2009).
//
// Answers come in lexicographic order, and one costs the same however many came before. Cost:
// exponential in the worst case; the caller gives a budget of conflicts or assignments.

#include "runtime/enumerate/clause_search.h"

#include <algorithm>

namespace parallax::runtime {
namespace {

/// Learned clauses of at most this many levels are short or close to it, and are kept (Audemard and
/// Simon 2009).
constexpr std::uint32_t kFewLevels = 2;
constexpr std::size_t kNoDecision = static_cast<std::size_t>(-1);

}  // namespace

ClauseSearch::ClauseSearch(std::int32_t variables, std::span<const Literal> projected,
                           std::size_t most_learned)
    : state_(variables),
      most_learned_(most_learned),
      level_of_(state_.variables(), 0),
      seen_(state_.variables(), false) {
  std::vector<bool> is_projected(state_.variables(), false);
  for (const auto literal : projected) {
    order_.push_back(static_cast<std::uint32_t>(literal.var()) - 1);
    is_projected[order_.back()] = true;
  }
  projected_ = order_.size();
  for (std::uint32_t v = 0; v < is_projected.size(); ++v) {
    if (!is_projected[v]) order_.push_back(v);
  }
}

void ClauseSearch::add_clause(std::span<const Literal> clause) {
  std::vector<Code> codes;
  codes.reserve(clause.size());
  for (const auto literal : clause) codes.push_back(ClausePropagation::code(literal));
  if (codes.empty()) has_empty_ = true;
  if (codes.size() == 1) units_.push_back(codes.front());
  if (codes.size() > 1) state_.add(codes);
  first_learned_ = state_.end();
}

void ClauseSearch::begin(std::span<const Literal> assumptions) {
  levels_.clear();
  state_.undo(0);
  noted_ = 0;
  is_found_ = false;
  is_over_ = has_empty_;
  for (const auto unit : units_) is_over_ = is_over_ || !state_.assume(unit);
  is_over_ = is_over_ || !assume_learned();
  if (assumptions.empty()) return;
  enter(kNoDecision, true);
  for (const auto literal : assumptions) {
    is_over_ = is_over_ || !state_.assume(ClausePropagation::code(literal));
  }
}

ClauseSearch::Status ClauseSearch::next(std::int64_t conflicts, std::int64_t assignments) {
  if (is_found_) {
    leave_unprojected();
    is_found_ = false;
    is_over_ = !flip();
  }
  while (!is_over_) {
    if (state_.propagate()) {
      if (state_.assignments() >= assignments) return Status::kGaveUp;
      if (decide()) continue;
      is_found_ = true;
      return Status::kFound;
    }
    ++conflicts_;
    is_over_ = !resolve_conflict();
    if (conflicts-- <= 0) return is_over_ ? Status::kNoMore : Status::kGaveUp;
  }
  return Status::kNoMore;
}

void ClauseSearch::enter(std::size_t decided, bool is_second) {
  note_levels();
  levels_.push_back({state_.trail().size(), decided, is_second});
}

/// The levels behind the first `level` ones are left.
void ClauseSearch::back_to(std::size_t level) {
  if (level >= levels_.size()) return;
  state_.undo(levels_[level].trail);
  noted_ = std::min(noted_, state_.trail().size());
  levels_.resize(level);
}

void ClauseSearch::note_levels() {
  const auto& trail = state_.trail();
  for (; noted_ < trail.size(); ++noted_) {
    level_of_[trail[noted_] >> 1U] = static_cast<std::uint32_t>(levels_.size());
  }
}

/// Sets the next open variable false. False: there is none.
bool ClauseSearch::decide() {
  auto next = levels_.empty() ? 0 : levels_.back().decided + 1;
  while (next < order_.size() && !state_.is_open(2 * order_[next])) ++next;
  if (next == order_.size()) return false;
  enter(next, false);
  state_.set(2 * order_[next] + 1);
  return true;
}

/// Goes back to the last decision that has another value left, and takes it. False: there is none.
bool ClauseSearch::flip() {
  while (true) {
    auto level = levels_.size();
    while (level > 0 && levels_[level - 1].is_second) --level;
    if (level == 0) return false;
    const auto decided = levels_[level - 1].decided;
    back_to(level - 1);
    // Learned units may have been set on a level that was left.
    if (!assume_learned()) continue;
    const auto other = 2 * order_[decided];
    if (!state_.is_open(other)) {
      if (state_.is_true(other)) return true;
      continue;
    }
    enter(decided, true);
    state_.set(other);
    return true;
  }
}

/// Sets the learned units. False: the values set before admit nothing.
bool ClauseSearch::assume_learned() {
  for (const auto unit : learned_units_) {
    const auto literal = *state_.literals(unit);
    if (state_.is_open(literal)) state_.set(literal, unit);
  }
  return state_.propagate();
}

/// Other values of variables that are not projected make no other valuation.
void ClauseSearch::leave_unprojected() {
  auto level = levels_.size();
  while (level > 0 && levels_[level - 1].decided != kNoDecision &&
         levels_[level - 1].decided >= projected_) {
    --level;
  }
  back_to(level);
}

/// Goes back to where the search goes on. False: nowhere.
bool ClauseSearch::resolve_conflict() {
  if (levels_.empty()) return false;
  note_levels();
  const bool is_spent = levels_.back().is_second;
  const auto learned = learn();
  if (is_spent) {
    // It follows from the values set before, but those have been searched with this value only.
    if (!flip()) return false;
  } else {
    std::size_t bound = levels_.size();
    while (bound > 0 && !levels_[bound - 1].is_second) --bound;
    const auto* second = state_.literals(learned) + 1;
    const std::size_t implied = *second == ClausePropagation::kEnd ? 0 : level_of_[*second >> 1U];
    back_to(std::max(bound, implied));
  }
  assert_if_unit(learned);
  if (learned_.size() > most_learned_) forget();
  return true;
}

/// The first literal of `clause` becomes true if the others are false.
void ClauseSearch::assert_if_unit(Clause clause) {
  const auto* literals = state_.literals(clause);
  if (!state_.is_open(*literals)) return;
  for (const auto* at = literals + 1; *at != ClausePropagation::kEnd; ++at) {
    if (state_.is_open(*at) || state_.is_true(*at)) return;
  }
  state_.set(*literals, clause);
}

/// The first literal is the one of the last level that alone leads to the conflict; the second one
/// is of the last level among the others.
ClauseSearch::Clause ClauseSearch::learn() {
  const auto current = static_cast<std::uint32_t>(levels_.size());
  made_.assign(1, 0);
  std::vector<std::uint32_t> touched;
  std::size_t open = 0;
  const auto meet = [&](Code c) {
    const auto v = c >> 1U;
    if (seen_[v] || level_of_[v] == 0) return;
    seen_[v] = true;
    touched.push_back(v);
    if (level_of_[v] == current) {
      ++open;
    } else {
      made_.push_back(c);
    }
  };
  const auto meet_all = [&](Clause clause, Code except) {
    for (const auto* at = state_.literals(clause); *at != ClausePropagation::kEnd; ++at) {
      if (*at != except) meet(*at);
    }
  };
  meet_all(state_.conflict(), ClausePropagation::kEnd);
  auto at = state_.trail().size();
  while (true) {
    while (!seen_[state_.trail()[at - 1] >> 1U]) --at;
    const auto literal = state_.trail()[--at];
    made_.front() = literal ^ 1U;
    // Assumptions and the decision of a level have no reason.
    if (open == 1 || state_.reason(literal) == ClausePropagation::kNone) break;
    --open;
    seen_[literal >> 1U] = false;
    meet_all(state_.reason(literal), literal);
  }
  if (open > 1) {
    // Several assumptions of one level: they end the search, and nothing is learned from that.
    for (const auto v : touched) seen_[v] = false;
    return ClausePropagation::kNone;
  }
  std::erase_if(made_, [&](Code c) { return c != made_.front() && is_implied(c); });
  for (const auto v : touched) seen_[v] = false;
  if (made_.size() > 1) {
    std::iter_swap(made_.begin() + 1,
                   std::max_element(made_.begin() + 1, made_.end(), [&](Code a, Code b) {
                     return level_of_[a >> 1U] < level_of_[b >> 1U];
                   }));
  }
  std::vector<std::uint32_t> levels;
  for (const auto c : made_) levels.push_back(level_of_[c >> 1U]);
  std::sort(levels.begin(), levels.end());
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
  const auto clause = state_.add(made_);
  learned_.push_back({clause, static_cast<std::uint32_t>(levels.size())});
  if (made_.size() == 1) learned_units_.push_back(clause);
  return clause;
}

/// Is it false because others of the learned clause are (Sörensson and Biere 2009, not
/// recursively)?
bool ClauseSearch::is_implied(Code c) const {
  const auto reason = state_.reason(c);
  if (reason == ClausePropagation::kNone) return false;
  for (const auto* at = state_.literals(reason); *at != ClausePropagation::kEnd; ++at) {
    if ((*at >> 1U) != (c >> 1U) && !seen_[*at >> 1U] && level_of_[*at >> 1U] != 0) return false;
  }
  return true;
}

/// Drops the half of the learned clauses that have the most levels, the older first. Clauses that
/// are reasons stay, and so do clauses of few levels.
void ClauseSearch::forget() {
  std::vector<Learned> ranked = learned_;
  std::stable_sort(ranked.begin(), ranked.end(), [](const Learned& a, const Learned& b) {
    return a.levels != b.levels ? a.levels < b.levels : a.clause > b.clause;
  });
  std::vector<Clause> locked;
  for (const auto c : state_.trail()) {
    const auto reason = state_.reason(c);
    if (reason != ClausePropagation::kNone && reason >= first_learned_) locked.push_back(reason);
  }
  std::sort(locked.begin(), locked.end());
  std::vector<Learned> kept;
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    if (i < ranked.size() / 2 || ranked[i].levels <= kFewLevels ||
        std::binary_search(locked.begin(), locked.end(), ranked[i].clause)) {
      kept.push_back(ranked[i]);
    }
  }
  std::sort(kept.begin(), kept.end(),
            [](const Learned& a, const Learned& b) { return a.clause < b.clause; });
  std::vector<Clause> places;
  for (const auto& learned : kept) places.push_back(learned.clause);
  const auto moved = state_.retain(first_learned_, places);
  for (auto& unit : learned_units_) {
    const auto found = std::lower_bound(places.begin(), places.end(), unit);
    unit = moved[static_cast<std::size_t>(found - places.begin())];
  }
  for (std::size_t i = 0; i < kept.size(); ++i) kept[i].clause = moved[i];
  learned_ = std::move(kept);
  most_learned_ = std::max(most_learned_ + most_learned_ / 8, 2 * learned_.size());
}

}  // namespace parallax::runtime
