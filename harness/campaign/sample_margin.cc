// How close a simulation was to a discrepancy: one number from many distances.
//
// The parts are the distances of bodies and joints from the borders of the expected cells, and
// the margins that controllers report; of a part that is read several times the least value
// counts. Parts about the start alone are left out, those of bodies that have not moved since.
// Parts have different units, so each is divided by its greatest value in the first runs that
// have it, and the least quotient is the margin. A part that was below zero in a run that went
// as predicted tells nothing about discrepancies and is left out, for earlier runs too, as is
// one that never varied. The verdict decides the sign: a discrepancy is below zero, every other
// run above.
//
// Cost: linear in the fluents and timepoints for a run's parts, and in the parts for its margin.

#include "harness/campaign/sample_margin.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "harness/region/fluent_margin.h"

namespace parallax::harness {
namespace {

constexpr int kScaleRuns = 8;  // the greatest value of a part in these runs is its unit
constexpr double kTouching = 1e-9;
constexpr double kUnmoved = 0.01;  // widths of a cell

/// Margins that tell where something was, not how much was left.
constexpr std::array<std::string_view, 2> kNoMargins = {"grasp_offset", "free_way"};

void take_least(MarginParts& parts, const std::string& name, double value) {
  if (!std::isfinite(value)) return;
  const auto [at, is_new] = parts.emplace(name, value);
  if (!is_new) at->second = std::min(at->second, value);
}

}  // namespace

MarginParts margin_parts(const StateMapping& mapping, const ModelFluents& fluents,
                         const CampaignTrace& trace, Comparison comparison,
                         const SampleRecord& record) {
  MarginParts parts;
  const std::size_t last = record.observations.size() - 1;
  // The start itself is what is chosen.
  const std::size_t first = comparison == Comparison::kFinal ? last : 1;
  for (std::size_t t = std::max<std::size_t>(first, 1); t <= last; ++t) {
    for (std::size_t i = 0; i < fluents.ground().size(); ++i) {
      const auto& fluent = fluents.ground()[i];
      const auto* binding = mapping.find(fluent.symbol);
      if (binding == nullptr || binding->at_start_only() || binding->is_ignored()) continue;
      if (binding->at_rest_only && t != last) continue;
      const bool predicted = runtime::contains(trace.points[t].holds, fluents.id(i));
      const auto margin = fluent_margin(mapping, fluent, predicted, record.observations[t]);
      if (!margin) continue;
      // The margin of a body that has not moved since the start is about the start alone.
      const auto before = fluent_margin(mapping, fluent, predicted, record.observations[0]);
      if (before && std::abs(*margin - *before) < kUnmoved) continue;
      take_least(parts, fluent.text, *margin);
    }
  }
  for (std::size_t t = 0; t < record.outcomes.size(); ++t) {
    const auto& outcome = record.outcomes[t];
    for (const auto& [name, value] : outcome.margins) {
      if (std::find(kNoMargins.begin(), kNoMargins.end(), name) != kNoMargins.end()) continue;
      const auto* real = std::get_if<double>(&value);
      const auto* whole = std::get_if<std::int64_t>(&value);
      if (real == nullptr && whole == nullptr) continue;
      const double number = real != nullptr ? *real : static_cast<double>(*whole);
      take_least(parts, fmt::format("{}: {}", trace.event(t), name), number);
    }
  }
  return parts;
}

void MarginScale::add(MarginParts parts, bool discrepancy) {
  for (const auto& [name, value] : parts) {
    auto& part = parts_[name];
    if (part.seen == 0) part.first = value;
    part.varies = part.varies || value != part.first;
    if (part.seen < kScaleRuns) part.unit = std::max(part.unit, std::abs(value));
    ++part.seen;
    if (!discrepancy && value < 0.0) contradicting_.insert(name);
  }
  runs_.push_back({std::move(parts), discrepancy});
}

std::optional<std::pair<std::string, double>> MarginScale::least(const MarginParts& parts) const {
  std::optional<std::pair<std::string, double>> out;
  for (const auto& [name, value] : parts) {
    const auto part = parts_.find(name);
    if (part == parts_.end() || !part->second.varies || contradicting_.contains(name)) continue;
    if (part->second.unit <= 0.0) continue;
    const double scaled = value / part->second.unit;
    if (!out || scaled < out->second) out.emplace(name, scaled);
  }
  return out;
}

std::optional<double> MarginScale::margin_of(const MarginParts& parts, bool discrepancy) const {
  const auto part = least(parts);
  // A discrepancy in flags or words may leave every distance above zero.
  if (discrepancy) return part ? std::min(part->second, -kTouching) : -1.0;
  if (!part) return std::nullopt;
  return std::max(part->second, kTouching);
}

std::optional<double> MarginScale::margin(std::size_t run) const {
  return margin_of(runs_[run].parts, runs_[run].discrepancy);
}

std::string MarginScale::part_of(std::size_t run) const {
  const auto part = least(runs_[run].parts);
  return part ? part->first : std::string();
}

}  // namespace parallax::harness
