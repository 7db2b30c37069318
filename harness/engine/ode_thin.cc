// Fewer contacts where two bodies touch in many points.
//
// The contact solver's time grows with the cube of the rows, and a flat side needs few contacts
// to bear. Contacts are grouped by the pair of bodies, normal and friction. Of a group with more
// than `most`, the one farthest from the middle stays, then always the one farthest from all
// that stay, so that the corners of the side remain. A contact is preferred to an earlier one
// only if it is clearly farther: corners that differ by rounding would else take turns from step
// to step. Quadratic in the contacts at worst.

#include <ode/ode.h>

#include <algorithm>

#include "harness/engine/ode_engine.h"

namespace parallax::harness {
namespace {

constexpr double kSameNormal = 0.9999;  // cosine of the angle between the two
/// A contact is better only if it spans more by this factor. Corners of a ring that differ by
/// rounding alone would otherwise take turns.
constexpr double kBetter = 1.001;

bool same_side(const NewContact& one, const NewContact& other) {
  return info_of(one.a).link == info_of(other.a).link &&
         info_of(one.b).link == info_of(other.b).link && one.friction == other.friction &&
         one.normal_W.dot(other.normal_W) > kSameNormal;
}

/// Marks `most` of `side` to stay: the one farthest from their middle, then always the one farthest
/// from all that stay.
void choose(const std::vector<NewContact>& contacts, const std::vector<std::size_t>& side,
            std::size_t most, std::vector<bool>& stays) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const std::size_t i : side) middle += contacts[i].p_W / static_cast<double>(side.size());
  std::vector<double> distance(side.size());
  for (std::size_t k = 0; k < side.size(); ++k) {
    distance[k] = (contacts[side[k]].p_W - middle).norm();
  }
  for (std::size_t count = 0; count < most; ++count) {
    std::size_t best = side.size();
    for (std::size_t k = 0; k < side.size(); ++k) {
      if (stays[side[k]]) continue;
      if (best == side.size() || distance[k] > kBetter * distance[best]) best = k;
    }
    stays[side[best]] = true;
    for (std::size_t k = 0; k < side.size(); ++k) {
      const double away = (contacts[side[k]].p_W - contacts[side[best]].p_W).norm();
      distance[k] = count == 0 ? away : std::min(distance[k], away);
    }
  }
}

}  // namespace

void thin_out(std::vector<NewContact>& contacts, std::size_t most) {
  if (contacts.size() <= most) return;
  std::vector<bool> stays(contacts.size(), false), seen(contacts.size(), false);
  std::vector<std::size_t> side;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (seen[i]) continue;
    side.clear();
    for (std::size_t j = i; j < contacts.size(); ++j) {
      if (seen[j] || !same_side(contacts[i], contacts[j])) continue;
      seen[j] = true;
      side.push_back(j);
    }
    if (side.size() > most) {
      choose(contacts, side, most, stays);
    } else {
      for (const std::size_t j : side) stays[j] = true;
    }
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (stays[i]) contacts[kept++] = contacts[i];
  }
  contacts.resize(kept);
}

}  // namespace parallax::harness
