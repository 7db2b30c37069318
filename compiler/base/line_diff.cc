// The fewest deleted and added lines between two texts (Myers 1986, section 4).
//
// Common lines at the front and at the back are cut off. A diagonal d is the set of places x - y
// = d in the grid of both texts. For 0, 1, 2, ... edits the search keeps the furthest x on each
// diagonal that so many edits reach; a step takes an edit from a neighbour diagonal and then
// follows equal lines for nothing. The ends are kept for each number of edits, so that the way
// can be walked back from the end. Stretches of changes then slide down over equal lines, which
// makes the choice between equally short answers unique.
//
// Cost: O((N + M) D) time and O(D^2) space for D edits; beyond 3000 edits the middle counts as
// one change.

#include "compiler/base/line_diff.h"

#include <algorithm>
#include <cstddef>

namespace parallax::base {
namespace {

using Index = std::ptrdiff_t;
using Lines = std::span<const std::string_view>;

constexpr Index kMaxEdits = 3000;  // 36 MB of saved ends

/// The lines of either side that are not part of the longest common subsequence.
class LineComparison {
 public:
  LineComparison(Lines a, Lines b)
      : a_(a), b_(b), a_changed_(a.size(), false), b_changed_(b.size(), false) {
    const auto shorter = std::min(count(a), count(b));
    while (front_ < shorter && same(front_, front_)) ++front_;
    Index back = 0;
    while (back < shorter - front_ && same(count(a) - 1 - back, count(b) - 1 - back)) {
      ++back;
    }
    a_end_ = count(a) - back;
    b_end_ = count(b) - back;
    walk_back(reach_end());
    slide(a_, a_changed_);
    slide(b_, b_changed_);
  }
  bool a_changed(std::size_t i) const { return i < a_changed_.size() && a_changed_[i]; }
  bool b_changed(std::size_t i) const { return i < b_changed_.size() && b_changed_[i]; }

 private:
  static Index count(Lines lines) { return static_cast<Index>(lines.size()); }
  bool same(Index x, Index y) const {
    return a_[static_cast<std::size_t>(x)] == b_[static_cast<std::size_t>(y)];
  }
  /// The furthest x that `edits` edits reach on the diagonal x - y; nothing was reached: -1.
  Index end_of(Index edits, Index diagonal) const {
    if (diagonal < -edits || diagonal > edits) return -1;
    return ends_[static_cast<std::size_t>(edits)][static_cast<std::size_t>(diagonal + edits)];
  }
  Index start_of(Index edits, Index diagonal) const {
    return std::max(end_of(edits - 1, diagonal - 1) < 0 ? -1 : end_of(edits - 1, diagonal - 1) + 1,
                    end_of(edits - 1, diagonal + 1));
  }

  /// Fills `ends_` until the end of both sides is reached; the number of edits, or -1 for too many.
  Index reach_end() {
    for (Index edits = 0; edits <= kMaxEdits; ++edits) {
      ends_.emplace_back(static_cast<std::size_t>(2 * edits + 1), -1);
      for (Index d = -edits; d <= edits; ++d) {
        auto x = edits == 0 ? front_ : start_of(edits, d);
        if (x < front_ || x > a_end_ || x - d > b_end_ || x - d < front_) continue;
        while (x < a_end_ && x - d < b_end_ && same(x, x - d)) ++x;
        ends_.back()[static_cast<std::size_t>(d + edits)] = x;
        if (x == a_end_ && x - d == b_end_) return edits;
      }
    }
    return -1;
  }

  void walk_back(Index edits) {
    if (edits < 0) {
      for (auto x = front_; x < a_end_; ++x) a_changed_[static_cast<std::size_t>(x)] = true;
      for (auto y = front_; y < b_end_; ++y) b_changed_[static_cast<std::size_t>(y)] = true;
      return;
    }
    for (auto d = a_end_ - b_end_; edits > 0; --edits) {
      const auto added = end_of(edits - 1, d + 1);
      const bool deletes = end_of(edits - 1, d - 1) >= 0 && end_of(edits - 1, d - 1) + 1 > added;
      if (deletes) {
        a_changed_[static_cast<std::size_t>(end_of(edits - 1, --d))] = true;
      } else {
        b_changed_[static_cast<std::size_t>(added - ++d)] = true;
      }
    }
  }

  /// Moves every stretch of changes as far down as equal lines let it.
  static void slide(Lines lines, std::vector<bool>& changed) {
    for (auto i = lines.size(); i-- > 0;) {
      if (!changed[i]) continue;
      auto end = i + 1;
      while (end < lines.size() && changed[end]) ++end;
      auto begin = i;
      while (begin > 0 && changed[begin - 1]) --begin;
      i = begin;
      while (end < lines.size() && !changed[end] && lines[begin] == lines[end]) {
        changed[begin++] = false;
        changed[end++] = true;
        while (end < lines.size() && changed[end]) ++end;
      }
    }
  }

  Lines a_, b_;
  std::vector<bool> a_changed_, b_changed_;
  Index front_ = 0, a_end_ = 0, b_end_ = 0;
  std::vector<std::vector<Index>> ends_;  // by edits, then by diagonal + edits
};

/// "5" or "5,7" for the lines [begin, end), counted from 1; of none, the one before.
std::string range_text(std::size_t begin, std::size_t end) {
  if (end <= begin + 1) return std::to_string(end);
  return std::to_string(begin + 1) + "," + std::to_string(end);
}

}  // namespace

std::vector<LineChange> line_changes(Lines a, Lines b) {
  const LineComparison comparison(a, b);
  std::vector<LineChange> changes;
  std::size_t i = 0, j = 0;
  while (i < a.size() || j < b.size()) {
    LineChange change{i, i, j, j};
    while (comparison.a_changed(change.a_end)) ++change.a_end;
    while (comparison.b_changed(change.b_end)) ++change.b_end;
    i = change.a_end + 1;
    j = change.b_end + 1;
    if (change.a_begin == change.a_end && change.b_begin == change.b_end) continue;
    changes.push_back(change);
  }
  return changes;
}

std::string normal_diff(const std::vector<std::string>& before,
                        const std::vector<std::string>& after) {
  const std::vector<std::string_view> a(before.begin(), before.end());
  const std::vector<std::string_view> b(after.begin(), after.end());
  std::string out;
  for (const auto& change : line_changes(a, b)) {
    const bool adds = change.a_begin == change.a_end, deletes = change.b_begin == change.b_end;
    const char command = adds ? 'a' : deletes ? 'd' : 'c';
    out += range_text(change.a_begin, change.a_end) + command +
           range_text(change.b_begin, change.b_end) + '\n';
    for (auto k = change.a_begin; k < change.a_end; ++k) out += "< " + before[k] + '\n';
    if (command == 'c') out += "---\n";
    for (auto k = change.b_begin; k < change.b_end; ++k) out += "> " + after[k] + '\n';
  }
  return out;
}

}  // namespace parallax::base
