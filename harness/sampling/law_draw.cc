// Starts of a sampling law from points of the unit cube.
//
// A coordinate with a law of its own takes the quantile of its number, conditioned on its range;
// areas of the plane take two numbers by a map that keeps sizes (area.cc); formulas give further
// values. All other conditions (ranges of formulas, further areas, half-planes, requirements)
// refuse points and change nothing, so uniform points that are let through have the law,
// conditioned on what is demanded (rejection). A law that lets fewer than one in a thousand of
// up to 100,000 fixed points through is refused, at the condition that refuses most.
//
// Cost: linear in values and conditions for each point. The same point always gives the same
// start.

#include "harness/sampling/law_draw.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "compiler/base/codes/scenarios.h"
#include "harness/sampling/sampler.h"

namespace parallax::harness {
namespace {

constexpr std::int64_t kMostProbes = 100'000;
constexpr std::int64_t kEnoughStarts = 100;                  // one in a thousand of them
constexpr std::uint64_t kProbeStream = 0x6c61772070726fULL;  // "law pro": not that of draws

std::string range_text(const Interval& range) {
  return fmt::format("{} to {}", range.lower, range.upper);
}

}  // namespace

/// Puts a LawDraw together.
class LawBinder {
 public:
  LawBinder(const StartCuboid& start, const SamplingLaw& law, double inset,
            base::DiagnosticSink& sink)
      : start_(start),
        out_(std::make_shared<LawDraw>()),
        sink_(sink),
        errors_before_(sink.error_count()) {
    out_->law_ = std::make_shared<const SamplingLaw>(law);
    out_->inset_ = inset;
  }

  base::Result<std::shared_ptr<const LawDraw>> bind() {
    const auto& law = *out_->law_;
    for (const auto& dimension : start_.dimensions) add_coordinate(dimension, true);
    for (const auto& parameter : law.parameters) add_coordinate(parameter, false);
    for (const auto& formula : law.formulas) add_formula_value(formula);
    for (const auto& [variable, value] : law.constants) {
      if (index_.contains(variable)) continue;
      add_value(variable, false);
      out_->constants_.back() = value;
    }
    for (const auto& area : start_.areas) add_area(area);
    for (const auto& area : law.areas) add_area({area.body, area.area, {}, area.source});
    for (const auto& formula : law.formulas) add_formula(formula);
    for (const auto& plane : law.half_planes) add_half_plane(plane);
    for (const auto& wanted : law.requirements) add_requirement(wanted);
    if (sink_.error_count() == errors_before_) probe();
    if (sink_.error_count() != errors_before_) return sink_.already_reported();
    return std::shared_ptr<const LawDraw>(std::move(out_));
  }

 private:
  using Condition = LawDraw::Condition;

  std::size_t add_value(const std::string& variable, bool is_start) {
    out_->values_.push_back({variable, is_start});
    out_->constants_.push_back(0.0);
    const auto index = out_->values_.size() - 1;
    index_.emplace(variable, index);
    return index;
  }

  const SamplingLaw::Marginal* marginal_of(const std::string& variable) const {
    const auto& all = out_->law_->marginals;
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const auto& one) { return one.variable == variable; });
    return found == all.end() ? nullptr : &*found;
  }
  bool is_formula(const std::string& variable) const {
    const auto& all = out_->law_->formulas;
    return std::any_of(all.begin(), all.end(),
                       [&](const auto& one) { return one.variable == variable; });
  }

  void add_coordinate(const SampledDimension& dimension, bool is_start) {
    const auto& [variable, interval] = dimension;
    add_value(variable, is_start);
    LawDraw::Coordinate coordinate;
    coordinate.range = interval;
    const bool fixed = interval.lower == interval.upper;
    const auto* marginal = marginal_of(variable);
    const bool is_choice = marginal != nullptr && marginal->law.kind == Distribution::Kind::kChoice;
    if (!fixed && !is_choice && is_start) {
      coordinate.range.lower += out_->inset_;
      coordinate.range.upper -= out_->inset_;
    }
    coordinate.is_drawn = !is_formula(variable);
    coordinate.is_free = coordinate.is_drawn && !fixed;
    if (marginal != nullptr && coordinate.is_drawn) {
      // A value that a state fixes has to be one of those that are drawn from.
      if (!fixed || is_choice) {
        coordinate.law = ConditionedLaw::make(marginal->law, coordinate.range);
      }
      const auto support = marginal->law.support();
      const bool outside = fixed && !is_choice &&
                           !(interval.lower >= support.lower && interval.lower <= support.upper);
      if (outside || ((!fixed || is_choice) && !coordinate.law)) {
        sink_.error(codes::kLawWithoutMass, marginal->source, variable, marginal->law.text(),
                    range_text(interval));
      }
      const bool narrower =
          !is_choice && (interval.lower > support.lower || interval.upper < support.upper);
      say(fmt::format("{} {}{}", variable, marginal->law.text(),
                      fixed      ? fmt::format(", here {}", interval.lower)
                      : narrower ? " within " + range_text(interval)
                                 : ""));
    } else if (!is_start) {
      say(fmt::format("{} uniform in {}", variable, range_text(interval)));
    }
    out_->coordinates_.push_back(std::move(coordinate));
  }

  void say(std::string words) { out_->words_.push_back(std::move(words)); }

  std::optional<std::size_t> value_of(const std::string& variable,
                                      const base::SourceRange& source) {
    const auto found = index_.find(variable);
    if (found != index_.end()) return found->second;
    sink_.error(codes::kNoFormulaValue, source, variable);
    return std::nullopt;
  }

  std::size_t add_condition(Condition condition) {
    out_->conditions_.push_back(std::move(condition));
    return out_->conditions_.size() - 1;
  }

  void add_range(std::size_t value, const Interval& range, const base::SourceRange& source) {
    Condition condition;
    condition.kind = Condition::Kind::kRange;
    condition.text = fmt::format("{} in {}", out_->values_[value].variable, range_text(range));
    condition.source = source;
    condition.values = {value};
    condition.range = range;
    add_condition(std::move(condition));
  }

  void add_area(const StartArea& area) {
    const auto x = value_of(area.body + ".x", area.source);
    const auto y = value_of(area.body + ".y", area.source);
    if (!x || !y) return;
    Condition condition;
    condition.text = fmt::format("{} in {}", area.body, area.area->text(area.offset));
    condition.source = area.source;
    say(condition.text);
    const auto maps = [&](std::size_t value) {
      return value < out_->coordinates_.size() && out_->coordinates_[value].is_free &&
             out_->coordinates_[value].is_drawn && !out_->coordinates_[value].law;
    };
    if (maps(*x) && maps(*y)) {
      // Later areas of the body condition what this one draws.
      out_->coordinates_[*x].is_drawn = out_->coordinates_[*y].is_drawn = false;
      out_->areas_.push_back({*x, *y, area.area, area.offset, add_condition(std::move(condition))});
      return;
    }
    condition.kind = Condition::Kind::kArea;
    condition.values = {*x, *y};
    condition.area = area.area;
    condition.offset = area.offset;
    add_condition(std::move(condition));
  }

  void add_formula_value(const SamplingLaw::Formula& formula) {
    if (!index_.contains(formula.variable)) add_value(formula.variable, !formula.is_parameter);
  }

  std::vector<std::size_t> arguments_of(const Expression& expression) {
    std::vector<std::size_t> out;
    for (const auto& name : expression.names()) {
      if (const auto value = value_of(name.text, name.source)) out.push_back(*value);
    }
    return out;
  }

  void add_formula(const SamplingLaw::Formula& formula) {
    const auto value = index_.at(formula.variable);
    Condition given;
    given.text = fmt::format("{} = {} has a value", formula.variable, formula.value.text());
    given.source = formula.source;
    out_->formulas_.push_back(
        {value, &formula.value, arguments_of(formula.value), add_condition(std::move(given))});
    say(fmt::format("{} = {}", formula.variable, formula.value.text()));
    if (formula.within) {
      add_range(value, *formula.within, formula.source);
      say("given " + out_->conditions_.back().text);
    }
    if (value < start_.dimensions.size()) {
      add_range(value, out_->coordinates_[value].range, formula.source);
      say("given " + out_->conditions_.back().text);
    }
  }

  void add_half_plane(const SamplingLaw::HalfPlane& plane) {
    Condition condition;
    condition.kind = Condition::Kind::kHalfPlane;
    condition.source = plane.source;
    condition.offset = plane.normal;
    condition.distance_m = plane.distance_m;
    condition.text = fmt::format("{} at least {:g} m from {} towards ({:g}, {:g})", plane.body,
                                 plane.distance_m, plane.of, plane.normal[0], plane.normal[1]);
    for (const auto& [body, axis] : {std::pair{&plane.body, ".x"}, std::pair{&plane.body, ".y"},
                                     std::pair{&plane.of, ".x"}, std::pair{&plane.of, ".y"}}) {
      if (const auto value = value_of(*body + axis, plane.source)) {
        condition.values.push_back(*value);
      }
    }
    // A body that has no heading does not turn.
    const auto yaw = index_.find(plane.of + ".yaw");
    if (yaw != index_.end()) condition.values.push_back(yaw->second);
    say("given " + condition.text);
    add_condition(std::move(condition));
  }

  void add_requirement(const SamplingLaw::Requirement& wanted) {
    Condition condition;
    condition.kind = Condition::Kind::kTruth;
    condition.text = wanted.condition.text();
    condition.source = wanted.source;
    condition.values = arguments_of(wanted.condition);
    condition.expression = &wanted.condition;
    say("given " + condition.text);
    add_condition(std::move(condition));
  }

  /// Are there starts at all? The points are always the same, so that a scenario is refused or not
  /// whatever the seed.
  void probe() const {
    const auto& conditions = out_->conditions_;
    if (conditions.empty()) return;
    std::vector<std::int64_t> refusals(conditions.size());
    std::vector<double> point(out_->coordinates());
    std::int64_t found = 0;
    for (std::int64_t i = 0; i < kMostProbes && found < kEnoughStarts; ++i) {
      const CounterRng rng(
          {.campaign_seed = kProbeStream, .sample = static_cast<std::uint64_t>(i)});
      for (std::size_t k = 0; k < point.size(); ++k) point[k] = rng.uniform(k);
      if (out_->start_at(point, &refusals)) ++found;
    }
    if (found >= kEnoughStarts) return;
    const auto most = static_cast<std::size_t>(std::max_element(refusals.begin(), refusals.end()) -
                                               refusals.begin());
    const auto& culprit = conditions[most];
    sink_.error(codes::kStartsRefused, culprit.source, kMostProbes - found, kMostProbes,
                culprit.text, refusals[most]);
  }

  const StartCuboid& start_;
  std::shared_ptr<LawDraw> out_;
  base::DiagnosticSink& sink_;
  std::size_t errors_before_;
  std::map<std::string, std::size_t> index_;
};

base::Result<std::shared_ptr<const LawDraw>> LawDraw::make(const StartCuboid& start,
                                                           const SamplingLaw& law, double inset,
                                                           base::DiagnosticSink& sink) {
  return LawBinder(start, law, inset, sink).bind();
}

std::vector<std::string> LawDraw::conditions() const {
  std::vector<std::string> out;
  for (const auto& condition : conditions_) out.push_back(condition.text);
  return out;
}

bool LawDraw::holds(const Condition& condition, std::span<const double> values) const {
  const auto at = [&](std::size_t i) { return values[condition.values[i]]; };
  switch (condition.kind) {
    case Condition::Kind::kGiven:
      return true;  // decided where the value is made
    case Condition::Kind::kRange:
      return at(0) >= condition.range.lower && at(0) <= condition.range.upper;
    case Condition::Kind::kArea:
      return condition.area->contains({at(0) - condition.offset[0], at(1) - condition.offset[1]});
    case Condition::Kind::kHalfPlane: {
      const double yaw = condition.values.size() > 4 ? at(4) : 0.0;
      const double nx = std::cos(yaw) * condition.offset[0] - std::sin(yaw) * condition.offset[1];
      const double ny = std::sin(yaw) * condition.offset[0] + std::cos(yaw) * condition.offset[1];
      return (at(0) - at(2)) * nx + (at(1) - at(3)) * ny >= condition.distance_m;
    }
    case Condition::Kind::kTruth:
      break;
  }
  std::vector<double> arguments;
  for (const auto value : condition.values) arguments.push_back(values[value]);
  return condition.expression->value(arguments) == 1.0;
}

std::optional<State> LawDraw::start_at(std::span<const double> point,
                                       std::vector<std::int64_t>* refusals) const {
  PARALLAX_REQUIRE(point.size() == coordinates_.size(), "a number for each coordinate");
  const auto refuse = [&](std::size_t condition) {
    if (refusals != nullptr) ++(*refusals)[condition];
    return std::optional<State>();
  };
  std::vector<double> values = constants_;
  for (std::size_t i = 0; i < coordinates_.size(); ++i) {
    const auto& [range, law, is_free, is_drawn] = coordinates_[i];
    if (!is_drawn) continue;
    if (law) {
      values[i] = law->at(point[i]);
    } else if (range.lower == range.upper) {
      values[i] = range.lower;
    } else {
      const double value = range.lower + point[i] * (range.upper - range.lower);
      values[i] = std::min(value, std::nextafter(range.upper, range.lower));
    }
  }
  for (const auto& one : areas_) {
    const auto place = one.area->at(point[one.x], point[one.y]);
    if (!place) return refuse(one.condition);
    for (const auto& [index, axis] : {std::pair{one.x, std::size_t{0}}, {one.y, std::size_t{1}}}) {
      const double value = (*place)[axis] + one.offset[axis];
      const auto& range = coordinates_[index].range;
      if (!(value >= range.lower && value < range.upper)) return refuse(one.condition);
      values[index] = value;
    }
  }
  std::vector<double> arguments;
  for (const auto& formula : formulas_) {
    arguments.clear();
    for (const auto value : formula.arguments) arguments.push_back(values[value]);
    values[formula.value] = formula.expression->value(arguments);
    if (!std::isfinite(values[formula.value])) return refuse(formula.condition);
  }
  bool fine = true;
  for (std::size_t i = 0; i < conditions_.size(); ++i) {
    if (holds(conditions_[i], values)) continue;
    refuse(i);
    fine = false;
  }
  if (!fine) return std::nullopt;
  State state;
  for (std::size_t i = 0; i < values_.size(); ++i) {
    if (values_[i].is_start) state.emplace(values_[i].variable, values[i]);
  }
  return state;
}

}  // namespace parallax::harness
