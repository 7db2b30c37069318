#include <fmt/format.h>

#include <algorithm>

#include "compiler/base/codes/scenarios.h"
#include "harness/region/state_mapping.h"

namespace parallax::harness {
namespace {

/// The demands of the discrete state on one body: the fluents that put it into a region or keep it
/// out.
struct BodyDemand {
  struct Entry {
    const Region* region;
    std::string fluent;
  };
  std::vector<Entry> inside, outside;
};
using Demands = std::map<std::string, BodyDemand>;

struct Problem {
  std::string text;
  base::SourceRange binding;
  std::string fluent;  // whose binding it is
};

std::string variable(const std::string& body, RegionAxis axis) {
  return fmt::format("{}.{}", body, to_string(axis));
}

std::string span_text(const Interval& interval) {
  return interval.lower == interval.upper ? fmt::format("{}", interval.lower)
                                          : fmt::format("{} to {}", interval.lower, interval.upper);
}

/// Sorts fluents by body. At a reset every flag is false, so that `only_if` makes a fluent false
/// and `unless` says nothing; a fluent that needs a flag is a problem.
class DemandCollector {
 public:
  DemandCollector(const StateMapping& mapping, bool at_reset)
      : mapping_(mapping), at_reset_(at_reset) {}

  void add(const GroundFluent& fluent, bool wanted) {
    const FluentBinding* binding = mapping_.find(fluent.symbol);
    PARALLAX_REQUIRE(binding != nullptr, "the mapping was checked against the model's fluents");
    if (at_reset_) {
      if (const auto conflict = binding->reset_conflict(fluent, wanted)) {
        problems_.push_back({*conflict, binding->source, fluent.symbol});
      }
    }
    if (const auto* inside = binding->inside()) add_inside(fluent, wanted, *inside);
    const auto* border = std::get_if<BorderBinding>(&binding->condition);
    if (border != nullptr && at_reset_ && border->concerns(fluent)) {
      sides_.push_back(
          {with_arguments(border->variable, fluent), border->side(wanted), fluent.text});
    }
    const auto* flag = std::get_if<FlagBinding>(&binding->condition);
    if (flag == nullptr || !at_reset_ || !flag->drawn.value_or(false)) return;
    flags_.push_back({with_arguments(flag->variable, fluent),
                      {wanted ? 1.0 : 0.0, wanted ? 1.0 : 0.0},
                      fluent.text});
  }
  /// A variable that a start sets, to what, and for which fluent.
  struct Flag {
    std::string variable;
    Interval value;
    std::string fluent;
  };
  const std::vector<Flag>& flags() const { return flags_; }
  /// Variables that begin on a side of a border.
  const std::vector<Flag>& sides() const { return sides_; }
  const Demands& demands() const { return demands_; }
  const std::vector<Problem>& problems() const { return problems_; }

 private:
  void add_inside(const GroundFluent& fluent, bool wanted, const InsideBinding& inside) {
    // A false fluent says where the body is not only if no flag can be the reason for it.
    if (!wanted && (inside.only_if || (inside.unless && !at_reset_))) return;
    if (!inside.drawn && at_reset_) return;
    const Region* region = inside.region_of(fluent, mapping_.regions());
    PARALLAX_REQUIRE(region != nullptr, "the mapping was checked against the regions");
    auto& demand = demands_[with_arguments(inside.body, fluent)];
    (wanted ? demand.inside : demand.outside).push_back({region, fluent.text});
  }

  const StateMapping& mapping_;
  bool at_reset_;
  Demands demands_;
  std::vector<Flag> flags_, sides_;
  std::vector<Problem> problems_;
};

DemandCollector collect(const StateMapping& mapping, const std::vector<GroundFluent>& fluents,
                        const std::set<std::string>& true_fluents, bool at_reset) {
  std::map<std::string, GroundFluent> by_text;
  for (const auto& fluent : fluents) by_text.emplace(fluent.text, fluent);
  for (const auto& text : true_fluents) by_text.emplace(text, ground_fluent(text));
  DemandCollector collector(mapping, at_reset);
  for (const auto& entry : by_text) {
    collector.add(entry.second, true_fluents.contains(entry.first));
  }
  return collector;
}

/// Narrows the dimensions of a start body by body.
class StartBuilder {
 public:
  explicit StartBuilder(const std::vector<SampledDimension>& extra) {
    for (const auto& dimension : extra) {
      const auto [at, fresh] = dimensions_.emplace(dimension.variable, dimension.interval);
      if (!fresh) narrow(dimension.variable, dimension.interval, "another range");
    }
  }

  void add(const std::string& body, const BodyDemand& demand) {
    if (demand.inside.empty()) {
      check_outside(body, demand);
      return;
    }
    const auto& first = demand.inside.front();
    for (const auto& entry : demand.inside) {
      if (entry.region == first.region) continue;
      problems_.push_back(
          fmt::format("`{}` and `{}` hold, but the regions `{}` and `{}` are disjoint",
                      first.fluent, entry.fluent, first.region->name, entry.region->name));
      return;
    }
    for (const auto& entry : demand.outside) {
      if (entry.region != first.region) continue;
      problems_.push_back(
          fmt::format("`{}` holds and `{}` does not, but both mean that `{}` is in `{}`",
                      first.fluent, entry.fluent, body, first.region->name));
    }
    for (const RegionAxis axis : kRegionAxes) {
      if (const auto range = start_range(*first.region, axis)) {
        narrow(variable(body, axis), *range, fmt::format("region `{}`", first.region->name));
      }
    }
    for (const auto& area : {first.region->start_area, first.region->area}) {
      const auto& at = first.region->frame_start;
      if (area) areas_.push_back({body, area, {at[0], at[1]}, first.region->source});
    }
  }

  void set(const std::string& variable, const Interval& value, const std::string& fluent) {
    narrow(variable, value, fmt::format("what `{}` asks for", fluent));
  }

  /// Narrows what something else draws; a fixed value has to lie there.
  void keep_to(const std::string& variable, const Interval& side, const std::string& fluent) {
    if (!dimensions_.contains(variable)) {
      problems_.push_back(
          fmt::format("`{}` asks for a side of `{}`, which nothing draws", fluent, variable));
      return;
    }
    narrow(variable, side, fmt::format("what `{}` asks for", fluent));
  }

  const std::vector<std::string>& problems() const { return problems_; }
  StartCuboid cuboid() const {
    StartCuboid result;
    for (const auto& [name, interval] : dimensions_) result.dimensions.push_back({name, interval});
    result.areas = areas_;
    return result;
  }

 private:
  /// In the world at a reset.
  static std::optional<Interval> start_range(const Region& region, RegionAxis axis) {
    const auto& narrower = region.start[static_cast<std::size_t>(axis)];
    if (!narrower && !region.on(axis)) return std::nullopt;
    Interval range = narrower ? *narrower : *region.on(axis);
    double shift = 0.0;
    if (axis == RegionAxis::kX) shift = region.frame_start[0];
    if (axis == RegionAxis::kY) shift = region.frame_start[1];
    if (axis == RegionAxis::kZ || axis == RegionAxis::kBottom) shift = region.frame_start[2];
    range.lower += shift;
    range.upper += shift;
    return range;
  }

  void narrow(const std::string& name, const Interval& by, const std::string& what) {
    const auto [at, fresh] = dimensions_.emplace(name, by);
    if (fresh) return;
    Interval& now = at->second;
    if (now.lower == now.upper) {
      const bool same_point = by.lower == by.upper && by.lower == now.lower;
      if (same_point || by.contains(now.lower)) return;
    } else if (by.lower == by.upper) {
      if (now.contains(by.lower)) {
        now = by;
        return;
      }
    } else if (std::max(now.lower, by.lower) < std::min(now.upper, by.upper)) {
      const bool keep = now.upper < by.upper;
      now.closed = keep ? now.closed : by.closed;
      now.upper = keep ? now.upper : by.upper;
      now.lower = std::max(now.lower, by.lower);
      return;
    }
    problems_.push_back(fmt::format("`{}` is sampled from {}, outside {} ({})", name,
                                    span_text(now), what, span_text(by)));
  }

  /// A body that is in no region has no cuboid of its own: the sampling ranges must give one, and
  /// it must keep clear of the regions that the body is not in.
  void check_outside(const std::string& body, const BodyDemand& demand) {
    for (const auto& entry : demand.outside) {
      bool overlaps = true;
      for (const RegionAxis axis : kRegionAxes) {
        if (!entry.region->on(axis)) continue;
        if (!entry.region->frame.empty()) {
          overlaps = false;  // where the frame is, only the first observation shows
          break;
        }
        const auto found = dimensions_.find(variable(body, axis));
        if (found == dimensions_.end()) {
          problems_.push_back(
              fmt::format("`{}` is in none of its regions, and nothing says where `{}` is instead",
                          body, variable(body, axis)));
          return;
        }
        overlaps = overlaps && meets(found->second, *entry.region->on(axis));
      }
      if (!overlaps) continue;
      problems_.push_back(
          fmt::format("`{}` does not hold, but the sampling range of `{}` reaches into `{}`",
                      entry.fluent, body, entry.region->name));
    }
  }

  static bool meets(const Interval& range, const Interval& region) {
    if (range.lower == range.upper) return region.contains(range.lower);
    return std::max(range.lower, region.lower) < std::min(range.upper, region.upper);
  }

  std::map<std::string, Interval> dimensions_;
  std::vector<StartArea> areas_;
  std::vector<std::string> problems_;
};

}  // namespace

base::Result<StartCuboid> StateMapping::start_cuboid(const std::vector<GroundFluent>& fluents,
                                                     const std::set<std::string>& true_fluents,
                                                     const std::vector<SampledDimension>& extra,
                                                     base::SourceRange blame,
                                                     base::DiagnosticSink& sink) const {
  const auto errors_before = sink.error_count();
  const auto collected = collect(*this, fluents, true_fluents, true);
  for (const auto& problem : collected.problems()) {
    sink.error(codes::kStartNotSampleable, blame, problem.text)
        .note(problem.binding, fmt::format("`{}` is mapped here", problem.fluent));
  }
  StartBuilder builder(extra);
  for (const auto& [body, demand] : collected.demands()) builder.add(body, demand);
  for (const auto& flag : collected.flags()) builder.set(flag.variable, flag.value, flag.fluent);
  for (const auto& side : collected.sides()) {
    builder.keep_to(side.variable, side.value, side.fluent);
  }
  for (const auto& problem : builder.problems()) {
    sink.error(codes::kStartNotSampleable, blame, problem);
  }
  if (sink.error_count() != errors_before) return sink.already_reported();
  return builder.cuboid();
}

std::map<std::string, Interval> StateMapping::cells(
    const std::vector<GroundFluent>& fluents, const std::set<std::string>& true_fluents) const {
  std::map<std::string, Interval> result;
  const auto collected = collect(*this, fluents, true_fluents, false);
  for (const auto& [body, demand] : collected.demands()) {
    if (demand.inside.empty()) continue;
    const Region* region = demand.inside.front().region;
    if (!region->frame.empty()) continue;  // its bounds move
    for (const RegionAxis axis : kRegionAxes) {
      if (region->on(axis)) result.emplace(variable(body, axis), *region->on(axis));
    }
  }
  return result;
}

std::vector<std::string> StateMapping::wrong_at_start(const std::vector<GroundFluent>& fluents,
                                                      const std::set<std::string>& true_fluents,
                                                      State start) const {
  std::vector<std::string> wrong;
  for (const auto& fluent : fluents) {
    const FluentBinding* binding = find(fluent.symbol);
    PARALLAX_REQUIRE(binding != nullptr, "the mapping was checked against the model's fluents");
    binding->add_reset_values(fluent, regions_, start);
    if (const auto* inside = binding->inside(); inside != nullptr && !inside->drawn) continue;
    const auto observed = holds(fluent, start);
    if (observed && *observed != true_fluents.contains(fluent.text)) wrong.push_back(fluent.text);
  }
  return wrong;
}

}  // namespace parallax::harness
