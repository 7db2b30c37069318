#include "harness/geometry_proof/geometric_check.h"

#include <cmath>

namespace parallax::harness {
namespace {

/// The influence of other questions on the choice of the variable to halve, relative to the
/// question that is farthest from clear.
constexpr double kOtherInfluence = 0.01;
/// The rest of a form comes from missing knowledge and from nonlinearity in the box. At least this
/// share of it is attributed to missing knowledge once it exceeds all that the box can sway.
constexpr double kBlurred = 0.8;

}  // namespace

std::string_view to_string(BoxVerdict verdict) {
  switch (verdict) {
    case BoxVerdict::kSafe:
      return "safe";
    case BoxVerdict::kRefuted:
      return "refuted";
    case BoxVerdict::kOpen:
      return "open";
  }
  return "";
}

bool GeometricCheck::Finding::settle(std::uint32_t question, const AffineForm& margin, double room,
                                     const std::string& refused_as) {
  if (margin.lower() > room) return true;
  culprit = refused_as;
  if (margin.upper() < -room) {
    verdict = BoxVerdict::kRefuted;
    return false;
  }
  open.push_back(question);
  for (std::size_t i = 0; i < influence.size(); ++i) influence[i] += std::abs(margin.slope(i));
  return true;
}

bool OpenRooms::add(const AffineForm& room, bool may_be_hit) {
  double sway = 0.0;
  for (std::size_t i = 0; i < finding_.influence.size(); ++i) {
    finding_.influence[i] += kOtherInfluence * std::abs(room.slope(i));
    sway += std::abs(room.slope(i));
  }
  any_may_refute_ = any_may_refute_ || (may_be_hit && room.center() - sway < 0.0);
  // Apart at no start of the box, whatever share of the rest is due to its size.
  any_blurred_ = any_blurred_ || room.center() + sway < kBlurred * room.rest();
  if (least_ && room.center() >= least_->center()) return false;
  least_ = room;
  return true;
}

void OpenRooms::close() {
  if (finding_.open.empty()) {
    finding_.verdict = BoxVerdict::kSafe;
    return;
  }
  finding_.is_hopeless = any_blurred_ && !any_may_refute_;
  for (std::size_t i = 0; i < finding_.influence.size(); ++i) {
    finding_.influence[i] += std::abs(least_->slope(i));
  }
}

}  // namespace parallax::harness
