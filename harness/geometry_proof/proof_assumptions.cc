#include "harness/geometry_proof/proof_assumptions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace parallax::harness {
namespace {

constexpr AssumptionField kFields[] = {
    {"drift", &ProofAssumptions::drift_m},     {"drift-rad", &ProofAssumptions::drift_rad},
    {"sliding", &ProofAssumptions::sliding_m}, {"sliding-rad", &ProofAssumptions::sliding_rad},
    {"goal", &ProofAssumptions::goal_m},       {"goal-rad", &ProofAssumptions::goal_rad},
    {"parked", &ProofAssumptions::parked_m},   {"held", &ProofAssumptions::held_m},
    {"held-rad", &ProofAssumptions::held_rad}, {"held-height", &ProofAssumptions::held_height_m},
    {"lean", &ProofAssumptions::lean_rad}};

std::string wrong_slider(const std::string& name, const Bounds1& range, const WorldLayout& layout) {
  const JointSpec* joint = nullptr;
  for (std::size_t i = 0; i < layout.sliders.size(); ++i) {
    const JointSpec& one = layout.sliders[layout.sliders.id_at(i)];
    if (one.name + ".q" == name) joint = &one;
  }
  if (joint == nullptr) return fmt::format("`{}` is no slider of the world", name);
  const bool is_range =
      std::isfinite(range.lower) && std::isfinite(range.upper) && range.lower <= range.upper;
  if (!is_range) return fmt::format("`{}` has no range LOW:HIGH", name);
  const bool is_beyond = (joint->low_m && range.upper < *joint->low_m) ||
                         (joint->high_m && range.lower > *joint->high_m);
  if (!is_beyond) return {};
  return fmt::format("`{}` is never {:g} to {:g} m: its stops do not let it go there", name,
                     range.lower, range.upper);
}

}  // namespace

std::span<const AssumptionField> assumption_fields() { return kFields; }

std::string wrong_assumption(double value) {
  if (value >= 0.0 && value <= kMostAssumed) return {};  // NaN is neither
  return fmt::format("is no number from 0 to {:g}", kMostAssumed);
}

std::string wrong_assumptions(const ProofAssumptions& assumptions, const WorldLayout& layout) {
  for (const AssumptionField& field : kFields) {
    const double value = assumptions.*field.value;
    const auto why = wrong_assumption(value);
    if (!why.empty()) return fmt::format("`{}`, {}, {}", field.name, value, why);
  }
  std::set<std::string> named;
  for (const auto& [name, range] : assumptions.sliders) {
    if (!named.insert(name).second) return fmt::format("`{}` is given twice", name);
    auto why = wrong_slider(name, range, layout);
    if (!why.empty()) return why;
  }
  return {};
}

std::vector<std::string> assumption_lines(const ProofAssumptions& assumptions) {
  const ProofAssumptions usual;
  std::vector<std::string> out;
  std::string rest;
  for (const AssumptionField& field : kFields) {
    const double value = assumptions.*field.value, own = usual.*field.value;
    if (value != own) {
      out.push_back(fmt::format("{}={} (default {})", field.name, value, own));
    } else {
      rest += fmt::format("{}{}={}", rest.empty() ? "" : ", ", field.name, value);
    }
  }
  for (const auto& [name, range] : assumptions.sliders) {
    out.push_back(fmt::format("{}={}:{} (not by default)", name, range.lower, range.upper));
  }
  if (!rest.empty()) out.push_back("by default " + rest);
  return out;
}

}  // namespace parallax::harness
