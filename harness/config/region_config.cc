#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "compiler/base/diagnostic_codes.h"
#include "harness/config/sections.h"

namespace parallax::harness {
namespace {

using base::DiagnosticCode;

/// The axes under their own names.
std::vector<std::string_view> axis_keys() {
  std::vector<std::string_view> keys;
  for (const auto axis : kRegionAxes) keys.push_back(to_string(axis));
  return keys;
}

/// Bounds of a region, each a list of two numbers.
void read_bounds(const YamlFields& fields, Region& region) {
  for (const auto axis : kRegionAxes) {
    const auto* bounds = fields.find(to_string(axis));
    if (bounds == nullptr) continue;
    const auto name = fmt::format("`{}` of the region `{}`", to_string(axis), region.name);
    if (!bounds->is_list()) {
      fields.sink().error(DiagnosticCode::kWrongYamlKind, bounds->range, name, describe(*bounds),
                          "a list of a lower and an upper bound");
    } else if (const auto interval = read_interval(*bounds, name, fields.sink())) {
      region.on(axis) = *interval;
    }
  }
}

/// Where starts are drawn: numbers or lists of two, within the bounds.
void read_start(const YamlNode& node, Region& region, base::DiagnosticSink& sink) {
  YamlFields fields(node, fmt::format("`{}` of the region `{}`", Key::kStart, region.name), sink);
  fields.only(axis_keys());
  for (const auto axis : kRegionAxes) {
    const auto* range = fields.find(to_string(axis));
    if (range == nullptr) continue;
    const auto name = fmt::format("`{}` of the start in `{}`", to_string(axis), region.name);
    const auto interval = read_interval(*range, name, sink);
    if (!interval) continue;
    if (interval->lower > interval->upper) {
      sink.error(DiagnosticCode::kReversedSampling, range->range, name, interval->lower,
                 interval->upper);
      continue;
    }
    const auto& bound = region.on(axis);
    if (bound && bound->lower > bound->upper) continue;  // reported with the regions
    if (bound && (interval->lower < bound->lower || interval->upper > bound->upper)) {
      sink.error(DiagnosticCode::kYamlOutOfBounds, range->range, name,
                 fmt::format("from {} to {}", interval->lower, interval->upper),
                 fmt::format("within the region, {} to {}", bound->lower, bound->upper));
    }
    region.start[static_cast<std::size_t>(axis)] = *interval;
  }
}

void read_frame(const YamlFields& fields, const WorldSpec& world, Region& region) {
  fields.text(Key::kFrame, region.frame);
  if (region.frame.empty()) return;
  const auto body = std::find_if(world.bodies.begin(), world.bodies.end(),
                                 [&](const BodySpec& b) { return b.name == region.frame; });
  if (body == world.bodies.end()) {
    std::vector<std::string> known;
    for (const auto& each : world.bodies) known.push_back(each.name);
    auto error = fields.sink().error(DiagnosticCode::kYamlUnknownChoice,
                                     fields.find(Key::kFrame)->range, region.frame, Key::kBody);
    add_suggestion(error, region.frame, known, "bodies");
    return;
  }
  if (body->yaw_rad != 0.0) {
    fields.sink().error(DiagnosticCode::kYamlOutOfBounds, fields.find(Key::kFrame)->range,
                        key_text(Key::kFrame), "a body that is turned at the start",
                        "one with yaw_rad 0");
  }
  region.frame_start = {body->p_WB.x(), body->p_WB.y(), body->p_WB.z()};
}

Region read_region(const YamlEntry& entry, const WorldSpec& world, base::DiagnosticSink& sink) {
  Region region;
  region.name = entry.key;
  region.source = entry.key_range;
  YamlFields fields(entry.value, fmt::format("the region `{}`", entry.key), sink);
  auto keys = axis_keys();
  keys.insert(keys.end(), {Key::kFrame, Key::kStart});
  fields.only(keys);
  read_bounds(fields, region);
  read_frame(fields, world, region);
  if (const auto* start = fields.find(Key::kStart)) read_start(*start, region, sink);
  return region;
}

RegionSection read_section(YamlFields& fields, std::string name, const WorldSpec& world,
                           base::DiagnosticSink& sink) {
  static constexpr std::array<std::string_view, 2> kGaps = {"error", "allowed"};
  RegionSection section;
  section.name = std::move(name);
  section.gaps_allowed =
      fields.choice(Key::kGaps, "value of " + key_text(Key::kGaps), kGaps) == std::size_t{1};
  fields.texts(Key::kFor, section.functions);
  const auto* cells = fields.require(Key::kCells);
  if (cells == nullptr) return section;
  const YamlFields all(*cells, key_text(Key::kCells), sink);
  for (const auto& entry : cells->entries) {
    section.regions.push_back(read_region(entry, world, sink));
  }
  return section;
}

}  // namespace

std::vector<RegionSection> read_regions(const YamlNode& node, const WorldSpec& world,
                                        base::DiagnosticSink& sink) {
  std::vector<RegionSection> sections;
  YamlFields fields(node, key_text(Key::kRegions), sink);
  const auto* sets = fields.find(Key::kSets);
  if (sets == nullptr) {
    fields.only({Key::kCells, Key::kGaps, Key::kFor});
    sections.push_back(read_section(fields, {}, world, sink));
    return sections;
  }
  fields.only({Key::kSets});
  const YamlFields all(*sets, key_text(Key::kSets), sink);
  for (const auto& entry : sets->entries) {
    YamlFields inner(entry.value, fmt::format("the set `{}`", entry.key), sink);
    inner.only({Key::kCells, Key::kGaps, Key::kFor});
    sections.push_back(read_section(inner, entry.key, world, sink));
  }
  return sections;
}

}  // namespace parallax::harness
