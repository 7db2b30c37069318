#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "compiler/base/ascii.h"
#include "compiler/base/codes/scenarios.h"
#include "harness/config/sections.h"

namespace parallax::harness {

namespace {

/// [rad]; a body that leans more than a right angle stands on its head.
constexpr NumberBounds kLean{0.0, 1.5707, true, false};

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

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
      fields.sink().error(codes::kWrongYamlKind, bounds->range, name, describe(*bounds),
                          "a list of a lower and an upper bound");
    } else if (const auto interval = read_interval(*bounds, name, fields.sink())) {
      region.on(axis) = *interval;
    }
  }
}

bool has_area(const YamlFields& fields) {
  return std::any_of(kAreaKeys.begin(), kAreaKeys.end(),
                     [&](std::string_view key) { return given(fields, key) != nullptr; });
}

/// A region with a shape needs no bounds of x and y: those of the shape are the least.
void bound_by(const Area& area, Region& region) {
  const auto [lower, upper] = area.bounds();
  const std::array<RegionAxis, 2> axes = {RegionAxis::kX, RegionAxis::kY};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    auto& bounds = region.on(axes[i]);
    if (!bounds) bounds = Interval{lower[i], upper[i]};
  }
}

/// Where starts are drawn: numbers or lists of two, within the bounds, or a shape.
void read_start(const YamlNode& node, Region& region, base::DiagnosticSink& sink) {
  YamlFields fields(node, fmt::format("`{}` of the region `{}`", Key::kStart, region.name), sink);
  auto keys = axis_keys();
  keys.insert(keys.end(), kAreaKeys.begin(), kAreaKeys.end());
  fields.only(keys);
  if (has_area(fields)) region.start_area = read_area(fields);
  for (const auto axis : kRegionAxes) {
    const auto* range = fields.find(to_string(axis));
    if (range == nullptr) continue;
    const auto name = fmt::format("`{}` of the start in `{}`", to_string(axis), region.name);
    const auto interval = read_interval(*range, name, sink);
    if (!interval) continue;
    if (interval->lower > interval->upper) {
      sink.error(codes::kReversedSampling, range->range, name, interval->lower, interval->upper);
      continue;
    }
    if (axis == RegionAxis::kYaw && !check_radians(*interval, *range, name, sink)) continue;
    const auto& bound = region.on(axis);
    if (bound && bound->lower > bound->upper) continue;  // reported with the regions
    if (bound && (interval->lower < bound->lower || interval->upper > bound->upper)) {
      sink.error(codes::kYamlOutOfBounds, range->range, name,
                 fmt::format("from {} to {}", interval->lower, interval->upper),
                 fmt::format("within the region, {} to {}", bound->lower, bound->upper));
    }
    region.start[static_cast<std::size_t>(axis)] = *interval;
  }
}

void read_frame(const YamlFields& fields, const RegionWorld& world, Region& region) {
  auto& sink = fields.sink();
  fields.text(Key::kFrame, region.frame);
  const auto& bodies = world.spec.bodies;
  const auto body = std::find_if(bodies.begin(), bodies.end(),
                                 [&](const BodySpec& b) { return b.name == region.frame; });
  if (const auto* place = fields.find(Key::kFrameAtM);
      place != nullptr && (region.frame.empty() || !world.is_external || body != bodies.end())) {
    sink.error(codes::kYamlOutOfBounds, place->range, key_text(Key::kFrameAtM), "given",
               region.frame.empty() ? "beside a `frame`"
                                    : "absent: `world` says where the body stands at first");
    return;
  }
  if (region.frame.empty()) return;
  if (body == bodies.end() && world.is_external) {
    if (fields.require(Key::kFrameAtM) == nullptr) return;
    const auto at = fields.numbers(Key::kFrameAtM, 3);
    if (at) region.frame_start = {(*at)[0], (*at)[1], (*at)[2]};
    return;
  }
  if (body == bodies.end()) {
    std::vector<std::string> known;
    for (const auto& each : bodies) known.push_back(each.name);
    auto error = sink.error(codes::kYamlUnknownChoice, fields.find(Key::kFrame)->range,
                            region.frame, Key::kBody);
    add_suggestion(error, region.frame, known, "bodies");
    return;
  }
  if (body->yaw_rad != 0.0) {
    sink.error(codes::kYamlOutOfBounds, fields.find(Key::kFrame)->range, key_text(Key::kFrame),
               "a body that is turned at the start", "one with yaw_rad 0");
  }
  region.frame_start = {body->p_WB.x(), body->p_WB.y(), body->p_WB.z()};
}

Region read_region(const YamlEntry& entry, const RegionWorld& world, base::DiagnosticSink& sink) {
  Region region;
  region.name = entry.key;
  region.source = entry.key_range;
  YamlFields fields(entry.value, fmt::format("the region `{}`", entry.key), sink);
  auto keys = axis_keys();
  keys.insert(keys.end(), {Key::kFrame, Key::kFrameAtM, Key::kStart});
  keys.insert(keys.end(), kAreaKeys.begin(), kAreaKeys.end());
  fields.only(keys);
  read_bounds(fields, region);
  if (has_area(fields)) region.area = read_area(fields);
  if (region.area) bound_by(*region.area, region);
  read_frame(fields, world, region);
  if (const auto* start = fields.find(Key::kStart)) read_start(*start, region, sink);
  return region;
}

RegionSection read_section(YamlFields& fields, std::string name, const RegionWorld& world,
                           base::DiagnosticSink& sink) {
  static constexpr std::array<std::string_view, 2> kGaps = {"error", "allowed"};
  RegionSection section;
  section.name = std::move(name);
  section.gaps_allowed =
      fields.choice(Key::kGaps, "value of " + key_text(Key::kGaps), kGaps, 0) == std::size_t{1};
  fields.texts(Key::kFor, section.functions);
  const auto* cells = fields.require(Key::kCells);
  if (cells == nullptr) return section;
  const YamlFields all(*cells, key_text(Key::kCells), sink);
  for (const auto& entry : cells->entries) {
    section.regions.push_back(read_region(entry, world, sink));
  }
  return section;
}

void read_flag_name(const YamlFields& fields, std::string_view key, const SymbolPattern& pattern,
                    std::optional<std::string>& out) {
  fields.text(key, out);
  if (out) out = with_positions(*out, pattern, fields.find(key)->range, fields.sink());
}

InsideBinding read_inside(const YamlFields& fields, const SymbolPattern& pattern) {
  InsideBinding binding;
  auto& sink = fields.sink();
  std::string parameter;
  fields.text(Key::kInside, parameter);
  const auto& names = pattern.parameters;
  const auto found = std::find(names.begin(), names.end(), parameter);
  if (found != names.end()) {
    binding.region_argument = static_cast<std::size_t>(found - names.begin());
  } else if (!parameter.empty()) {
    auto error = sink.error(codes::kUnknownPatternParameter, fields.find(Key::kInside)->range,
                            parameter, pattern.symbol);
    add_suggestion(error, parameter, names, "parameters");
  }
  if (const auto* body = fields.require(Key::kBody)) {
    fields.text(Key::kBody, binding.body);
    binding.body = with_positions(binding.body, pattern, body->range, sink);
  }
  read_flag_name(fields, Key::kUnless, pattern, binding.unless);
  read_flag_name(fields, Key::kOnlyIf, pattern, binding.only_if);
  fields.boolean(Key::kDrawn, binding.drawn);
  fields.number(Key::kUpright, kLean, binding.upright);
  fields.texts(Key::kUprightExcept, binding.upright_except);
  return binding;
}

/// The text under `key`, with the names of parameters replaced by their positions.
std::string read_pattern_text(const YamlFields& fields, std::string_view key,
                              const SymbolPattern& pattern) {
  std::string text;
  fields.text(key, text);
  const auto* node = fields.find(key);
  return node == nullptr ? text : with_positions(text, pattern, node->range, fields.sink());
}

FlagBinding read_flag(YamlFields& fields, const SymbolPattern& pattern) {
  fields.only({Key::kFlag, Key::kAtStart, Key::kDrawn, Key::kCompare});
  FlagBinding binding;
  binding.variable = read_pattern_text(fields, Key::kFlag, pattern);
  fields.boolean(Key::kAtStart, binding.at_start);
  fields.boolean(Key::kDrawn, binding.drawn);
  return binding;
}

RangeBinding read_range(YamlFields& fields, const SymbolPattern& pattern) {
  fields.only({Key::kRange, Key::kHolds, Key::kFails, Key::kAtStart, Key::kCompare});
  RangeBinding binding;
  binding.variable = read_pattern_text(fields, Key::kRange, pattern);
  for (const auto& [key, interval] :
       {std::pair{Key::kHolds, &binding.holds}, std::pair{Key::kFails, &binding.fails}}) {
    const auto* node = fields.require(key);
    if (node == nullptr) continue;
    if (const auto read = read_interval(*node, fmt::format("`{}`", key), fields.sink())) {
      *interval = *read;
    }
    if (interval->lower > interval->upper) {
      fields.sink().error(codes::kReversedSampling, node->range, fmt::format("`{}`", key),
                          interval->lower, interval->upper);
    }
  }
  if (binding.holds.lower <= binding.fails.upper && binding.fails.lower <= binding.holds.upper &&
      fields.find(Key::kFails) != nullptr) {
    fields.sink().error(codes::kYamlOutOfBounds, fields.find(Key::kFails)->range,
                        key_text(Key::kFails), "an interval that meets " + key_text(Key::kHolds),
                        "apart from it");
  }
  fields.number(Key::kAtStart, kAnyNumber, binding.at_start);
  return binding;
}

EqualsBinding read_equals(YamlFields& fields, const SymbolPattern& pattern) {
  fields.only({Key::kEquals, Key::kText, Key::kCompare});
  EqualsBinding binding;
  binding.variable = read_pattern_text(fields, Key::kEquals, pattern);
  fields.require(Key::kText);
  binding.text = read_pattern_text(fields, Key::kText, pattern);
  return binding;
}

BorderBinding read_border(YamlFields& fields, const SymbolPattern& pattern) {
  fields.only({Key::kStart, Key::kAbove, Key::kUpTo, Key::kOnly});
  BorderBinding binding;
  binding.variable = read_pattern_text(fields, Key::kStart, pattern);
  const auto* above = fields.find(Key::kAbove);
  const auto* up_to = fields.find(Key::kUpTo);
  if (above != nullptr && up_to != nullptr) {
    fields.sink().error(codes::kYamlOutOfBounds, up_to->range, key_text(Key::kUpTo),
                        "given besides " + key_text(Key::kAbove), "alone");
  }
  if (above == nullptr && up_to == nullptr) fields.require(Key::kAbove);
  binding.above = above != nullptr;
  std::optional<double> border;
  fields.number(binding.above ? Key::kAbove : Key::kUpTo, kAnyNumber, border);
  binding.border = border.value_or(binding.border);
  fields.texts(Key::kOnly, binding.only);
  return binding;
}

std::optional<FluentBinding> read_binding(const YamlEntry& entry, base::DiagnosticSink& sink) {
  const auto pattern = read_pattern(entry, sink);
  if (!pattern) return std::nullopt;
  FluentBinding binding;
  binding.fluent = pattern->symbol;
  binding.arity = pattern->parameters.size();
  binding.source = entry.key_range;
  const auto& value = entry.value;
  if (value.is_scalar() && value.text == "ignored") {
    ReadLog::text(value);
    binding.condition = IgnoredBinding{};
    return binding;
  }
  YamlFields fields(value, fmt::format("the mapping of `{}`", pattern->symbol), sink);
  if (!value.is_map()) return std::nullopt;
  if (fields.find(Key::kIgnored) != nullptr) {
    fields.only({Key::kIgnored});
    IgnoredBinding ignored;
    fields.text(Key::kIgnored, ignored.why);
    binding.condition = ignored;
    return binding;
  }
  if (fields.find(Key::kStart) != nullptr) {
    binding.condition = read_border(fields, *pattern);
    return binding;
  }
  // Where an observation makes sense at rest only.
  const auto comparison = read_comparison(fields);
  binding.at_rest_only = comparison == Comparison::kFinal;
  binding.asks_for_every_step = comparison == Comparison::kEveryStep;
  if (fields.find(Key::kFlag) != nullptr) {
    binding.condition = read_flag(fields, *pattern);
    return binding;
  }
  if (fields.find(Key::kRange) != nullptr) {
    binding.condition = read_range(fields, *pattern);
    return binding;
  }
  if (fields.find(Key::kEquals) != nullptr) {
    binding.condition = read_equals(fields, *pattern);
    return binding;
  }
  fields.only({Key::kInside, Key::kBody, Key::kUnless, Key::kOnlyIf, Key::kDrawn, Key::kUpright,
               Key::kUprightExcept, Key::kFlag, Key::kRange, Key::kEquals, Key::kStart,
               Key::kCompare, Key::kIgnored});
  if (fields.require(Key::kInside) == nullptr) return std::nullopt;
  binding.condition = read_inside(fields, *pattern);
  return binding;
}

/// A symbol may have one entry only, whatever its parameters are called.
template <typename Bindings, typename Name>
void refuse_repeated(Bindings& bindings, Name name, base::DiagnosticSink& sink) {
  std::map<std::string, base::SourceRange> seen;
  for (const auto& binding : bindings) {
    const auto [at, fresh] = seen.emplace(name(binding), binding.source);
    if (fresh) continue;
    sink.error(codes::kDuplicateKey, binding.source, at->first)
        .note(at->second, "first given here");
  }
}

std::optional<SymbolPattern> parse_pattern(std::string_view text) {
  SymbolPattern pattern;
  const auto open = text.find('(');
  const auto symbol = trimmed(text.substr(0, open));
  if (!base::is_identifier(symbol)) return std::nullopt;
  pattern.symbol = std::string(symbol);
  if (open == std::string_view::npos) return pattern;
  text = trimmed(text.substr(open));
  if (text.size() < 2 || text.back() != ')') return std::nullopt;
  auto rest = trimmed(text.substr(1, text.size() - 2));
  while (!rest.empty()) {
    const auto comma = rest.find(',');
    const auto word = trimmed(rest.substr(0, comma));
    if (!base::is_identifier(word)) return std::nullopt;
    const auto& known = pattern.parameters;
    if (std::find(known.begin(), known.end(), word) != known.end()) return std::nullopt;
    pattern.parameters.emplace_back(word);
    if (comma == std::string_view::npos) return pattern;
    rest = trimmed(rest.substr(comma + 1));
    if (rest.empty()) return std::nullopt;  // a comma at the end
  }
  return pattern;
}

}  // namespace

std::optional<SymbolPattern> read_pattern(const YamlEntry& entry, base::DiagnosticSink& sink) {
  auto pattern = parse_pattern(entry.key);
  if (!pattern) sink.error(codes::kBadPattern, entry.key_range, entry.key);
  return pattern;
}

std::string with_positions(const std::string& text, const SymbolPattern& pattern,
                           base::SourceRange range, base::DiagnosticSink& sink) {
  std::string out;
  std::size_t at = 0;
  for (;;) {
    const auto open = text.find('{', at);
    const auto close = text.find('}', at);
    if (open == std::string::npos && close == std::string::npos) return out + text.substr(at);
    const auto inner = open == std::string::npos ? open : text.find('{', open + 1);
    if (open == std::string::npos || close < open || close == std::string::npos || inner < close) {
      sink.error(codes::kUnbalancedBrace, range, open < close ? '{' : '}', text);
      return out + text.substr(at);
    }
    const auto name = text.substr(open + 1, close - open - 1);
    const auto& names = pattern.parameters;
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      auto error = sink.error(codes::kUnknownPatternParameter, range, name, pattern.symbol);
      add_suggestion(error, name, names, "parameters");
    }
    out += text.substr(at, open - at) + '{' + std::to_string(found - names.begin()) + '}';
    at = close + 1;
  }
}

std::vector<RegionSection> read_regions(const YamlNode& node, const RegionWorld& world,
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

std::vector<FluentBinding> read_mapping(const YamlNode& node, base::DiagnosticSink& sink) {
  std::vector<FluentBinding> bindings;
  const YamlFields all(node, key_text(Key::kMapping), sink);
  for (const auto& entry : node.entries) {
    if (auto binding = read_binding(entry, sink)) bindings.push_back(std::move(*binding));
  }
  refuse_repeated(
      bindings, [](const FluentBinding& b) { return b.fluent; }, sink);
  return bindings;
}

}  // namespace parallax::harness
