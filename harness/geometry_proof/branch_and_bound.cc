// Proof over a whole region by cutting it into boxes.
//
// A check answers for a box: safe throughout, refused throughout, or open. Open boxes wait in a
// queue, the largest and of these the oldest first, and are halved in the middle along the
// variable that sways the open questions most, seen over the box. A half inherits only the
// questions that were open for the whole. It ends when the share that is not decided is small
// enough or the limits are met. Boxes are halved in their middles only, so shares are powers of
// two, and a list of boxes can be checked to fill the region.
//
// Cost: one check for each box, exponential in the variables that matter in the worst case; the
// number of boxes is limited. The result depends on the input alone.

#include "harness/geometry_proof/branch_and_bound.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <queue>
#include <utility>

namespace parallax::harness {
namespace {

struct OpenBox {
  StartBox bounds;
  std::vector<std::uint32_t> questions;
  std::vector<double> influence;
  std::string culprit;
  int halvings = 0;  // its share of the volume is 2^-halvings
  std::int64_t number = 0;
};

/// The largest first, of these the oldest.
struct Later {
  bool operator()(const OpenBox& a, const OpenBox& b) const {
    if (a.halvings != b.halvings) return a.halvings > b.halvings;
    return a.number > b.number;
  }
};

double share_of(int halvings) { return std::ldexp(1.0, -halvings); }

/// The variable to halve: what sways the open question most, seen over the box; where nothing
/// does, the one that is widest against its range. None if all are too narrow.
std::optional<std::size_t> widest(const OpenBox& node, const StartBox& whole, double finest) {
  std::optional<std::size_t> best;
  double most = -1.0;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const double width =
        (node.bounds[i].upper - node.bounds[i].lower) / (whole[i].upper - whole[i].lower);
    if (width < finest) continue;
    const double weight = i < node.influence.size() ? node.influence[i] : 0.0;
    const double score = weight > 0.0 ? weight : 1e-12 * width;
    if (score > most) most = score, best = i;
  }
  return best;
}

}  // namespace

const DecidedBox* box_of(const std::vector<DecidedBox>& boxes, const std::vector<double>& start) {
  for (const DecidedBox& box : boxes) {
    bool inside = true;
    for (std::size_t i = 0; i < start.size() && inside; ++i) {
      inside = start[i] >= box.bounds[i].lower && start[i] <= box.bounds[i].upper;
    }
    if (inside) return &box;
  }
  return nullptr;
}

ProofResult prove(const GeometricCheck& check, const StartBox& whole,
                  const SubdivisionLimits& limits) {
  ProofResult result;
  std::priority_queue<OpenBox, std::vector<OpenBox>, Later> open;
  std::int64_t numbers = 0;
  const auto give_up = [&](const OpenBox& node) {
    result.open += share_of(node.halvings);
    result.boxes.push_back({node.bounds, BoxVerdict::kOpen, node.culprit});
  };
  const auto examine = [&](OpenBox node) {
    const auto finding = check.examine(node.bounds, node.questions);
    ++result.examined;
    const double share = share_of(node.halvings);
    if (finding.verdict == BoxVerdict::kOpen) {
      node.questions = finding.open;
      node.influence = finding.influence;
      node.culprit = finding.culprit;
      if (finding.is_hopeless) return give_up(node);
      node.number = numbers++;
      open.push(std::move(node));
      return;
    }
    (finding.verdict == BoxVerdict::kSafe ? result.safe : result.refuted) += share;
    result.boxes.push_back({std::move(node.bounds), finding.verdict, finding.culprit});
  };
  examine({whole, check.questions(), {}, {}, 0, 0});
  while (!open.empty()) {
    result.stopped = limits.stop != nullptr && limits.stop->load();
    const double undecided = 1.0 - result.safe - result.refuted - result.open;
    const bool enough = result.examined + 2 > limits.boxes || undecided <= limits.open_share;
    if (result.stopped || enough) break;
    OpenBox node = open.top();
    open.pop();
    const auto axis = widest(node, whole, limits.finest);
    if (!axis) {
      give_up(node);
      continue;
    }
    const Bounds1 range = node.bounds[*axis];
    const double middle = 0.5 * range.lower + 0.5 * range.upper;
    OpenBox low = node, high = std::move(node);
    low.bounds[*axis].upper = middle;
    high.bounds[*axis].lower = middle;
    ++low.halvings, ++high.halvings;
    examine(std::move(low));
    examine(std::move(high));
    if (limits.progress && result.examined % 512 < 2) limits.progress(result.examined, undecided);
  }
  for (; !open.empty(); open.pop()) give_up(open.top());
  std::sort(result.boxes.begin(), result.boxes.end(), [](const auto& a, const auto& b) {
    for (std::size_t i = 0; i < a.bounds.size(); ++i) {
      if (a.bounds[i].lower != b.bounds[i].lower) return a.bounds[i].lower < b.bounds[i].lower;
    }
    return false;
  });
  return result;
}

}  // namespace parallax::harness
