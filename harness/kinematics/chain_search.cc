// A way between two postures of a chain (RRT-Connect, Kuffner and LaValle 2000).
//
// Two trees of postures grow from the start and from the goal. In turns, one grows from its
// nearest node a bounded step towards a sampled posture; where it arrives, the other grows
// towards that as far as it can, and if it gets there the trees are joined. The samples are an
// even sequence over the joint ranges, always the same, so that the answer is the same as well.
// Branches are tested every `step`. The way found is shortened: from each posture the farthest
// one that can be reached evenly comes next.
//
// Cost: for each round a look at all nodes of a tree and the tests of a branch; rounds are
// limited.

#include "harness/kinematics/chain_search.h"

#include <algorithm>
#include <cstddef>

#include "harness/kinematics/inverse.h"

namespace parallax::harness {
namespace {

struct Branch {
  JointVector q;
  std::size_t before = 0;  // itself: the root
};
using Tree = std::vector<Branch>;

enum class Growth : std::uint8_t { kNone, kSome, kThere };

class SwingSearch {
 public:
  SwingSearch(const SerialChain& chain, const PostureTest& test, const ChainSearchOptions& options)
      : chain_(chain), test_(test), options_(options) {}

  std::vector<JointVector> run(const JointVector& start, const JointVector& goal) const {
    if (!test_(start) || !test_(goal)) return {};
    if (is_free(start, goal)) return {start, goal};
    Tree from_start = {{start, 0}}, from_goal = {{goal, 0}};
    for (int round = 1; round <= options_.rounds; ++round) {
      Tree& one = round % 2 == 1 ? from_start : from_goal;
      Tree& other = round % 2 == 1 ? from_goal : from_start;
      if (grow(one, spread_positions(chain_, round)) == Growth::kNone) continue;
      const JointVector met = one.back().q;
      Growth growth = Growth::kSome;
      while (growth == Growth::kSome) growth = grow(other, met);
      if (growth == Growth::kThere) return shortened(joined(from_start, from_goal));
    }
    return {};
  }

 private:
  bool is_free(const JointVector& a, const JointVector& b) const {
    const ChainWay way = swing_way(a, b, options_.step);
    return std::all_of(way.samples.begin() + 1, way.samples.end(), test_);
  }

  Growth grow(Tree& tree, const JointVector& towards) const {
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < tree.size(); ++i) {
      if ((tree[i].q - towards).squaredNorm() < (tree[nearest].q - towards).squaredNorm()) {
        nearest = i;
      }
    }
    const JointVector way = towards - tree[nearest].q;
    const double length = way.norm();
    if (length == 0.0) {
      tree.push_back({towards, nearest});
      return Growth::kThere;
    }
    const bool there = length <= options_.grow;
    const JointVector next =
        there ? towards : JointVector(tree[nearest].q + way * (options_.grow / length));
    if (!is_free(tree[nearest].q, next)) return Growth::kNone;
    tree.push_back({next, nearest});
    return there ? Growth::kThere : Growth::kSome;
  }

  static std::vector<JointVector> to_root(const Tree& tree) {
    std::vector<JointVector> all;
    for (std::size_t i = tree.size() - 1;; i = tree[i].before) {
      all.push_back(tree[i].q);
      if (tree[i].before == i) return all;
    }
  }

  /// The last branches of both trees are the same posture.
  static std::vector<JointVector> joined(const Tree& from_start, const Tree& from_goal) {
    std::vector<JointVector> all = to_root(from_start);
    std::reverse(all.begin(), all.end());
    const std::vector<JointVector> rest = to_root(from_goal);
    all.insert(all.end(), rest.begin() + 1, rest.end());
    return all;
  }

  std::vector<JointVector> shortened(const std::vector<JointVector>& way) const {
    std::vector<JointVector> out = {way.front()};
    for (std::size_t at = 0; at + 1 < way.size();) {
      std::size_t next = way.size() - 1;
      while (next > at + 1 && !is_free(way[at], way[next])) --next;
      out.push_back(way[next]);
      at = next;
    }
    return out;
  }

  const SerialChain& chain_;
  const PostureTest& test_;
  const ChainSearchOptions& options_;
};

}  // namespace

std::vector<JointVector> search_swings(const SerialChain& chain, const JointVector& start,
                                       const JointVector& goal, const PostureTest& test,
                                       const ChainSearchOptions& options) {
  return SwingSearch(chain, test, options).run(start, goal);
}

}  // namespace parallax::harness
