#include "harness/geometry_proof/certificate.h"

namespace parallax::harness {

double volume_share(const StartBox& box, const StartBox& region) {
  double share = 1.0;
  for (std::size_t i = 0; i < box.size(); ++i) {
    share *= (box[i].upper - box[i].lower) / (region[i].upper - region[i].lower);
  }
  return share;
}

void add_share(const DecidedBox& box, const StartBox& region, TestCertificate& test) {
  double& share = box.verdict == BoxVerdict::kSafe      ? test.safe
                  : box.verdict == BoxVerdict::kRefuted ? test.refuted
                                                        : test.open;
  share += volume_share(box.bounds, region);
}

std::vector<ActionCertificate> certify(const std::vector<ProvableAction>& actions,
                                       const SubdivisionLimits& limits) {
  std::vector<ActionCertificate> all;
  for (const ProvableAction& action : actions) {
    ActionCertificate one{
        action.number, action.event, action.controller, {}, action.left_to_simulation};
    for (const auto& test : action.tests) {
      const StartBox whole = test->scene().whole();
      ProofResult result = prove(test->check(), whole, limits);
      TestCertificate made{
          test->check().test(),   test->state().assumed, result.examined, 0, 0.0, 0.0, 0.0,
          std::move(result.boxes)};
      for (DecidedBox& box : made.boxes) {
        const bool stopped = limits.stop != nullptr && limits.stop->load();
        if (box.verdict != BoxVerdict::kOpen &&
            (stopped || !test->second().confirms(box.bounds, box.verdict, kSecondEffort))) {
          box.verdict = BoxVerdict::kOpen;
          ++made.unconfirmed;
        }
        add_share(box, whole, made);
      }
      one.tests.push_back(std::move(made));
    }
    all.push_back(std::move(one));
  }
  return all;
}

namespace {

/// More halvings than any search makes.
constexpr int kMostHalvings = 2000;

bool fills(std::vector<const StartBox*> boxes, const StartBox& region, int halvings) {
  if (halvings > kMostHalvings) return false;
  if (boxes.size() == 1) {
    for (std::size_t i = 0; i < region.size(); ++i) {
      const Bounds1& one = (*boxes.front())[i];
      if (one.lower != region[i].lower || one.upper != region[i].upper) return false;
    }
    return true;
  }
  for (std::size_t axis = 0; axis < region.size(); ++axis) {
    const double middle = 0.5 * region[axis].lower + 0.5 * region[axis].upper;
    std::vector<const StartBox*> low, high;
    for (const StartBox* box : boxes) {
      if ((*box)[axis].upper <= middle) low.push_back(box);
      if ((*box)[axis].lower >= middle) high.push_back(box);
    }
    if (low.empty() || high.empty() || low.size() + high.size() != boxes.size()) continue;
    StartBox left = region, right = region;
    left[axis].upper = right[axis].lower = middle;
    boxes = {};  // not to be kept through the recursion
    return fills(std::move(low), left, halvings + 1) && fills(std::move(high), right, halvings + 1);
  }
  return false;
}

}  // namespace

bool fill(const std::vector<DecidedBox>& boxes, const StartBox& region) {
  std::vector<const StartBox*> all;
  for (const DecidedBox& box : boxes) {
    if (box.bounds.size() != region.size()) return false;
    all.push_back(&box.bounds);
  }
  return !all.empty() && fills(std::move(all), region, 0);
}

}  // namespace parallax::harness
