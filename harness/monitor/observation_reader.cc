#include "harness/monitor/observation_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "compiler/base/contract.h"
#include "harness/monitor/near_border.h"

namespace parallax::harness {
namespace {

constexpr std::array<const char*, 4> kFrameItems = {"x", "y", "z", "yaw"};
// In this order: of several that have to hold the least one counts.
constexpr std::int8_t kFails = -1, kUnknown = 0, kHolds = 1;

std::optional<double> number_in(const std::optional<Value>& value) {
  if (!value) return std::nullopt;
  if (const auto* real = std::get_if<double>(&*value)) return *real;
  if (const auto* whole = std::get_if<std::int64_t>(&*value)) return static_cast<double>(*whole);
  return std::nullopt;
}

std::optional<bool> flag_in(const std::optional<Value>& value) {
  if (!value) return std::nullopt;
  if (const auto* boolean = std::get_if<bool>(&*value)) return *boolean;
  if (const auto* whole = std::get_if<std::int64_t>(&*value)) return *whole != 0;
  // Drawn values are numbers.
  if (const auto* real = std::get_if<double>(&*value);
      real != nullptr && (*real == 0 || *real == 1)) {
    return *real == 1;
  }
  return std::nullopt;
}

std::int8_t known(bool holds) { return holds ? kHolds : kFails; }

std::size_t place(RegionAxis axis) { return static_cast<std::size_t>(axis); }

}  // namespace

ObservationReader::ObservationReader(const StateMapping& mapping,
                                     const std::vector<GroundFluent>& fluents)
    : mapping_(mapping) {
  std::map<std::string, std::size_t> bodies;
  for (const auto& fluent : fluents) {
    auto& reader = readers_.emplace_back();
    reader.binding = mapping.find(fluent.symbol);
    PARALLAX_REQUIRE(reader.binding != nullptr, "the mapping was checked against the fluents");
    reader.axes.fill(kNone);
    reader.frame.fill(kNone);
    std::visit([&](const auto& kind) { prepare(kind, fluent, reader); }, reader.binding->condition);
    auto outside = mapping.outside_text(fluent);
    if (outside.empty()) continue;
    const auto [entry, added] = bodies.try_emplace(outside, bodies_.size());
    if (added) bodies_.push_back({std::move(outside), true, {}});
    auto& body = bodies_[entry->second];
    body.at_rest_only = body.at_rest_only && reader.binding->at_rest_only;
    body.fluents.push_back(readers_.size() - 1);
  }
}

std::optional<std::size_t> ObservationReader::variable(std::string_view name) const {
  const auto found = numbers_.find(std::string(name));
  if (found == numbers_.end()) return std::nullopt;
  return found->second;
}

bool ObservationReader::fits(std::size_t variable, const Value& value) const {
  switch (kinds_[variable]) {
    case Kind::kNumber:
      return number_in(value).has_value();
    case Kind::kFlag: {
      const auto* whole = std::get_if<std::int64_t>(&value);
      return std::holds_alternative<bool>(value) ||
             (whole != nullptr && (*whole == 0 || *whole == 1));
    }
    case Kind::kText:
      return std::holds_alternative<std::string>(value);
  }
  return false;
}

std::size_t ObservationReader::add(const std::string& name, Kind kind, FluentReader& reader) {
  const auto [entry, added] = numbers_.try_emplace(name, variables_.size());
  if (added) {
    variables_.push_back(name);
    kinds_.push_back(kind);
  }
  auto& own = reader.variables;
  if (std::find(own.begin(), own.end(), entry->second) == own.end()) own.push_back(entry->second);
  return entry->second;
}

void ObservationReader::prepare(const InsideBinding& kind, const GroundFluent& fluent,
                                FluentReader& reader) {
  reader.region = kind.region_of(fluent, mapping_.regions());
  PARALLAX_REQUIRE(reader.region != nullptr, "the mapping was checked against the regions");
  const auto body = with_arguments(kind.body, fluent);
  const bool framed = !reader.region->frame.empty();
  bool needs_height = false;
  for (const auto axis : kRegionAxes) {
    // A point in a turned frame takes both x and y.
    const bool in_plane = axis == RegionAxis::kX || axis == RegionAxis::kY;
    if (!reader.region->on(axis) && !(framed && in_plane)) continue;
    reader.axes[place(axis)] =
        add(fmt::format("{}.{}", body, to_string(axis)), Kind::kNumber, reader);
    needs_height = needs_height || axis == RegionAxis::kZ || axis == RegionAxis::kBottom;
  }
  for (std::size_t i = 0; framed && i < kFrameItems.size(); ++i) {
    if (i == 2 && !needs_height) continue;
    reader.frame[i] =
        add(fmt::format("{}.{}", reader.region->frame, kFrameItems[i]), Kind::kNumber, reader);
  }
  const auto& lying = kind.upright_except;
  if (kind.upright && std::find(lying.begin(), lying.end(), reader.region->name) == lying.end()) {
    reader.upright_rad = *kind.upright;
    reader.roll = add(body + ".roll", Kind::kNumber, reader);
    reader.pitch = add(body + ".pitch", Kind::kNumber, reader);
  }
  if (kind.unless) reader.unless = add(with_arguments(*kind.unless, fluent), Kind::kFlag, reader);
  if (kind.only_if) {
    reader.only_if = add(with_arguments(*kind.only_if, fluent), Kind::kFlag, reader);
  }
}

void ObservationReader::prepare(const FlagBinding& kind, const GroundFluent& fluent,
                                FluentReader& reader) {
  reader.variable = add(with_arguments(kind.variable, fluent), Kind::kFlag, reader);
}

void ObservationReader::prepare(const RangeBinding& kind, const GroundFluent& fluent,
                                FluentReader& reader) {
  reader.variable = add(with_arguments(kind.variable, fluent), Kind::kNumber, reader);
}

void ObservationReader::prepare(const EqualsBinding& kind, const GroundFluent& fluent,
                                FluentReader& reader) {
  reader.variable = add(with_arguments(kind.variable, fluent), Kind::kText, reader);
  reader.text = with_arguments(kind.text, fluent);
}

/// A log need not begin where a start is drawn.
void ObservationReader::prepare(const BorderBinding&, const GroundFluent&, FluentReader&) {}

void ObservationReader::prepare(const IgnoredBinding&, const GroundFluent&, FluentReader&) {}

/// Do the flags let the fluent hold?
std::int8_t ObservationReader::allowed(const FluentReader& reader,
                                       const ReportedValues& values) const {
  std::int8_t out = kHolds;
  for (const auto& [variable, wanted] :
       {std::pair{reader.unless, false}, std::pair{reader.only_if, true}}) {
    if (variable == kNone) continue;
    const auto value = flag_in(values[variable]);
    if (value && *value != wanted) return kFails;
    if (!value) out = kUnknown;
  }
  return out;
}

/// Is the body in the region?
std::int8_t ObservationReader::inside(const FluentReader& reader, const ReportedValues& values,
                                      const ReadingTolerance& tolerance, bool& near) const {
  Point point{};
  for (std::size_t i = 0; i < point.size(); ++i) {
    if (reader.axes[i] == kNone) continue;
    const auto value = number_in(values[reader.axes[i]]);
    if (!value) return kUnknown;
    point[i] = *value;
  }
  if (!reader.region->frame.empty()) {
    std::array<double, kFrameItems.size()> frame{};
    for (std::size_t i = 0; i < frame.size(); ++i) {
      if (reader.frame[i] == kNone) continue;
      const auto value = number_in(values[reader.frame[i]]);
      if (!value) return kUnknown;
      frame[i] = *value;
    }
    const auto [x, y, z, yaw] = frame;
    const double dx = point[place(RegionAxis::kX)] - x, dy = point[place(RegionAxis::kY)] - y;
    point[place(RegionAxis::kX)] = std::cos(yaw) * dx + std::sin(yaw) * dy;
    point[place(RegionAxis::kY)] = std::cos(yaw) * dy - std::sin(yaw) * dx;
    point[place(RegionAxis::kYaw)] -= yaw;
    point[place(RegionAxis::kZ)] -= z;
    point[place(RegionAxis::kBottom)] -= z;
  }
  if (tolerance.is_exact()) return known(mapping_.regions().contains(*reader.region, point));
  // More than the tolerance away from every border it is the same.
  const auto nearness = nearness_of(*reader.region, point, tolerance);
  near = nearness == Nearness::kBorder;
  return near ? kUnknown : known(nearness == Nearness::kInside);
}

/// Does the body lean no more than it may?
std::int8_t ObservationReader::upright(const FluentReader& reader, const ReportedValues& values,
                                       double tolerance_rad, bool& near) {
  if (reader.roll == kNone) return kHolds;
  const auto roll = number_in(values[reader.roll]), pitch = number_in(values[reader.pitch]);
  if (!roll || !pitch) return kUnknown;
  // The cosine of the angle between the two verticals.
  const double cosine = std::cos(*roll) * std::cos(*pitch);
  if (tolerance_rad > 0.0) {
    // Roll and pitch may both be off, which together change the angle by up to their sum.
    const double lean = std::acos(std::clamp(cosine, -1.0, 1.0));
    near = std::abs(lean - reader.upright_rad) <= 2.0 * tolerance_rad;
    if (near) return kUnknown;
  }
  return known(cosine >= std::cos(reader.upright_rad));
}

void ObservationReader::read(const ReportedValues& values, bool at_rest, SeenState& out,
                             const ReadingTolerance& tolerance) const {
  out.fluents.assign(readers_.size(), kUnknown);
  out.neither.clear();
  out.outside.clear();
  out.one_of.clear();
  out.near_border = false;
  std::vector<bool> near(tolerance.is_exact() ? 0 : readers_.size(), false);
  for (std::size_t f = 0; f < readers_.size(); ++f) {
    const auto& reader = readers_[f];
    auto& seen = out.fluents[f];
    if (reader.binding->inside() != nullptr) {
      // All three have to hold; one that fails decides.
      bool leans = false, at_border = false;
      seen = std::min(allowed(reader, values), upright(reader, values, tolerance.rad, leans));
      if (seen != kFails) seen = std::min(seen, inside(reader, values, tolerance, at_border));
      if (seen == kUnknown && (leans || at_border)) near[f] = true;
      continue;
    }
    if (reader.variable == kNone) continue;
    const auto& condition = reader.binding->condition;
    const auto& value = values[reader.variable];
    if (std::holds_alternative<FlagBinding>(condition)) {
      const auto flag = flag_in(value);
      if (flag) seen = known(*flag);
    } else if (const auto* range = std::get_if<RangeBinding>(&condition)) {
      const auto number = number_in(value);
      if (!number) continue;
      const double slack =
          is_angle(variables_[reader.variable]) ? tolerance.rad : std::max(tolerance.m, 0.0);
      const auto within = [&](const Interval& i) {
        return *number >= i.lower - slack && *number <= i.upper + slack;
      };
      if (slack > 0.0) {
        const bool may_hold = within(range->holds), may_fail = within(range->fails);
        const auto exactly = [&](const Interval& i) {
          return *number >= i.lower + slack && *number <= i.upper - slack;
        };
        near[f] = (may_hold || may_fail) && !exactly(range->holds) && !exactly(range->fails);
        if (may_hold && may_fail) continue;
      }
      if (within(range->holds)) {
        seen = kHolds;
      } else if (within(range->fails)) {
        seen = kFails;
      } else if (at_rest || !reader.binding->at_rest_only) {
        out.neither.push_back(f);
      }
    } else if (value && std::holds_alternative<std::string>(*value)) {
      seen = known(std::get<std::string>(*value) == reader.text);
    }
  }
  read_bodies(values, at_rest, near, out);
  for (std::size_t f = 0; f < readers_.size(); ++f) {
    if (!at_rest && readers_[f].binding->at_rest_only) {
      out.fluents[f] = kUnknown;
    } else if (f < near.size() && near[f]) {
      out.near_border = true;
    }
  }
}

/// Finds the bodies that are in none of their regions, and those that may be in one of several.
void ObservationReader::read_bodies(const ReportedValues& values, bool at_rest,
                                    const std::vector<bool>& near, SeenState& out) const {
  for (const auto& body : bodies_) {
    if (body.at_rest_only && !at_rest) continue;
    bool is_somewhere = false, is_asked = false, is_open = false;
    std::vector<std::size_t> at_border;
    for (const auto f : body.fluents) {
      const auto may_hold = allowed(readers_[f], values);
      if (may_hold == kFails) continue;
      is_asked = true;
      is_somewhere = is_somewhere || may_hold != kHolds || out.fluents[f] != kFails;
      // Another region that the body is in for certain, or of which nothing is known, says enough.
      is_open = is_open || may_hold != kHolds || out.fluents[f] == kHolds ||
                (out.fluents[f] == kUnknown && (near.empty() || !near[f]));
      if (f < near.size() && near[f]) at_border.push_back(f);
    }
    if (is_asked && !is_somewhere) out.outside.push_back(body.outside);
    if (is_open || at_border.empty()) continue;
    // No state of a model has the body nowhere, so the only region within the tolerance is it.
    if (at_border.size() == 1) {
      out.fluents[at_border[0]] = kHolds;
    } else {
      out.one_of.push_back(std::move(at_border));
    }
  }
  std::sort(out.outside.begin(), out.outside.end());
}

}  // namespace parallax::harness
