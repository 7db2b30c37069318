#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "compiler/base/codes/scenarios.h"
#include "harness/config/sections.h"
#include "harness/law/sampling_law.h"

namespace parallax::harness {

namespace {

/// Far beyond what a world has, and sums and squares of them are numbers.
constexpr NumberBounds kValue{-1e12, 1e12, false, false};
constexpr NumberBounds kSpread{0.0, 1e12, true, false};
constexpr std::size_t kMaxChoices = 1000;
constexpr NumberBounds kDistance{-1e6, 1e6, false, false};  // [m]

std::optional<Distribution> read_normal(const YamlNode& node, base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  YamlFields fields(node, key_text(Key::kNormal), sink);
  fields.only({Key::kMean, Key::kSd});
  Distribution law;
  law.kind = Distribution::Kind::kNormal;
  if (fields.require(Key::kMean)) fields.number(Key::kMean, kValue, law.mean);
  if (fields.require(Key::kSd)) fields.number(Key::kSd, kSpread, law.sd);
  if (sink.error_count() != errors_before) return std::nullopt;
  return law;
}

std::optional<Distribution> read_triangular(const YamlNode& node, base::DiagnosticSink& sink) {
  const auto name = key_text(Key::kTriangular);
  if (!node.is_list() || node.items.size() != 3) {
    sink.error(codes::kWrongYamlKind, node.range, name, describe(node),
               "a list of lower bound, mode and upper bound");
    return std::nullopt;
  }
  std::array<double, 3> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto number = read_number(node.items[i], name, kValue, sink);
    if (!number) return std::nullopt;
    numbers[i] = *number;
  }
  for (std::size_t i = 0; i + 1 < numbers.size(); ++i) {
    if (numbers[i] <= numbers[i + 1]) continue;
    sink.error(codes::kReversedSampling, node.items[i].range, name, numbers[i], numbers[i + 1]);
    return std::nullopt;
  }
  Distribution law;
  law.kind = Distribution::Kind::kTriangular;
  law.lower = numbers[0];
  law.mode = numbers[1];
  law.upper = numbers[2];
  if (law.lower < law.upper) return law;
  sink.error(codes::kYamlOutOfBounds, node.range, name, "a single value",
             "wider; a number alone fixes a value");
  return std::nullopt;
}

std::optional<Distribution> read_choice(const YamlNode& node, base::DiagnosticSink& sink) {
  const auto name = key_text(Key::kChoice);
  if (!node.is_map() || node.entries.empty()) {
    sink.error(codes::kWrongYamlKind, node.range, name, describe(node),
               "a map from values to their weights");
    return std::nullopt;
  }
  if (node.entries.size() > kMaxChoices) {
    sink.error(codes::kYamlOutOfBounds, node.range, name,
               fmt::format("of {} values", node.entries.size()),
               fmt::format("of at most {}", kMaxChoices));
    return std::nullopt;
  }
  Distribution law;
  law.kind = Distribution::Kind::kChoice;
  std::set<double> seen;
  for (const auto& entry : node.entries) {
    YamlNode key;
    key.kind = YamlNode::Kind::kScalar;
    key.range = entry.key_range;
    key.text = entry.key;
    const auto value = read_number(key, "a value of " + name, kValue, sink);
    const auto weight =
        read_number(entry.value, fmt::format("the weight of {}", entry.key), kSpread, sink);
    if (!value || !weight) return std::nullopt;
    if (!seen.insert(*value).second) {
      sink.error(codes::kDuplicateKey, entry.key_range, entry.key);
      return std::nullopt;
    }
    law.values.emplace_back(*value, *weight);
  }
  std::sort(law.values.begin(), law.values.end());
  return law;
}

std::optional<Distribution> read_uniform(const YamlNode& node, base::DiagnosticSink& sink) {
  const auto name = key_text(Key::kUniform);
  const auto interval = read_interval(node, name, sink);
  if (!interval) return std::nullopt;
  if (interval->lower > interval->upper) {
    sink.error(codes::kReversedSampling, node.range, name, interval->lower, interval->upper);
    return std::nullopt;
  }
  Distribution law;
  law.lower = interval->lower;
  law.upper = interval->upper;
  return law;
}

/// The whole text of a scalar.
std::optional<Expression> read_expression(const YamlNode& node, std::string_view name,
                                          Expression::Kind kind, base::DiagnosticSink& sink) {
  const auto text = read_text(node, name, sink);
  if (!text) return std::nullopt;
  auto expression = Expression::parse(*text, kind, node.range, sink);
  if (!expression) return std::nullopt;
  return *std::move(expression);
}

/// `within`; none where there is none, or it was reported.
std::optional<Interval> read_within(const YamlFields& fields) {
  const auto* node = given(fields, Key::kWithin);
  if (node == nullptr) return std::nullopt;
  auto interval = read_interval(*node, key_text(Key::kWithin), fields.sink());
  if (interval && interval->lower > interval->upper) {
    fields.sink().error(codes::kReversedSampling, node->range, key_text(Key::kWithin),
                        interval->lower, interval->upper);
    return std::nullopt;
  }
  return interval;
}

void read_body_area(const YamlEntry& entry, SamplingLaw& law, base::DiagnosticSink& sink) {
  YamlFields fields(entry.value, fmt::format("the area of `{}`", entry.key), sink);
  if (!entry.value.is_map()) return;
  std::vector<std::string_view> keys(kAreaKeys.begin(), kAreaKeys.end());
  keys.push_back(Key::kHalfPlanes);
  fields.only(keys);
  const auto* planes = fields.find(Key::kHalfPlanes);
  const bool has_shape = std::any_of(kAreaKeys.begin(), kAreaKeys.end(), [&](std::string_view key) {
    return given(fields, key) != nullptr;
  });
  if (has_shape || planes == nullptr) {
    if (auto area = read_area(fields)) law.areas.push_back({entry.key, area, entry.key_range});
  }
  if (planes == nullptr) return;
  if (!planes->is_list()) {
    sink.error(codes::kWrongYamlKind, planes->range, key_text(Key::kHalfPlanes), describe(*planes),
               "a list");
    return;
  }
  for (const auto& item : planes->items) {
    const auto errors_before = sink.error_count();
    YamlFields plane(item, "a half-plane", sink);
    if (!item.is_map()) continue;
    plane.only({Key::kOf, Key::kTowards, Key::kDistanceM});
    SamplingLaw::HalfPlane out;
    out.body = entry.key;
    out.source = item.range;
    if (plane.require(Key::kOf)) plane.text(Key::kOf, out.of);
    plane.number(Key::kDistanceM, kDistance, out.distance_m);
    const auto* towards = plane.require(Key::kTowards);
    if (towards == nullptr) continue;
    const auto direction = read_point(*towards, key_text(Key::kTowards), sink);
    if (!direction) continue;
    const double length = std::hypot((*direction)[0], (*direction)[1]);
    if (!(length > 0.0)) {
      sink.error(codes::kYamlOutOfBounds, towards->range, key_text(Key::kTowards), "(0, 0)",
                 "a direction");
    }
    if (sink.error_count() != errors_before) continue;
    out.normal = {(*direction)[0] / length, (*direction)[1] / length};
    law.half_planes.push_back(std::move(out));
  }
}

/// Puts each formula behind those that it needs; reports what needs itself.
void sort_formulas(SamplingLaw& law, base::DiagnosticSink& sink) {
  const auto formulas = std::move(law.formulas);
  law.formulas.clear();
  enum class Mark : std::uint8_t { kNew, kOpen, kDone };
  std::vector<Mark> marks(formulas.size(), Mark::kNew);
  const auto find = [&](const std::string& name) {
    const auto found = std::find_if(formulas.begin(), formulas.end(),
                                    [&](const auto& one) { return one.variable == name; });
    return static_cast<std::size_t>(found - formulas.begin());
  };
  struct Visit {
    std::size_t formula, next_name;
  };
  for (std::size_t first = 0; first < formulas.size(); ++first) {
    if (marks[first] != Mark::kNew) continue;
    std::vector<Visit> open = {{first, 0}};
    marks[first] = Mark::kOpen;
    while (!open.empty()) {
      auto& [at, next] = open.back();
      const auto& names = formulas[at].value.names();
      if (next == names.size()) {
        marks[at] = Mark::kDone;
        law.formulas.push_back(formulas[at]);
        open.pop_back();
        continue;
      }
      const auto& name = names[next++];
      const auto needed = find(name.text);
      if (needed == formulas.size() || marks[needed] == Mark::kDone) continue;
      if (marks[needed] == Mark::kOpen) {
        sink.error(codes::kBadFormula, name.source,
                   fmt::format("`{}` needs its own value", name.text));
        return;
      }
      marks[needed] = Mark::kOpen;
      open.push_back({needed, 0});
    }
  }
}

}  // namespace

std::optional<SampledValue> read_sampled_value(const YamlEntry& entry, base::DiagnosticSink& sink) {
  const auto name = fmt::format("`{}`", entry.key);
  SampledValue out;
  if (!entry.value.is_map()) {
    const auto interval = read_interval(entry.value, name, sink);
    if (!interval) return std::nullopt;
    if (interval->lower > interval->upper) {
      sink.error(codes::kReversedSampling, entry.key_range, name, interval->lower, interval->upper);
    }
    out.interval = *interval;
    return out;
  }
  static constexpr std::array<std::string_view, 6> kKeys = {
      Key::kUniform, Key::kNormal, Key::kTriangular, Key::kChoice, Key::kFormula, Key::kWithin};
  const auto errors_before = sink.error_count();
  YamlFields fields(entry.value, fmt::format("the law of {}", name), sink);
  fields.only(kKeys);
  std::string_view key;
  for (const auto one : kKeys) {
    if (one == Key::kWithin || given(fields, one) == nullptr) continue;
    if (!key.empty()) {
      sink.error(codes::kYamlOutOfBounds, fields.find(one)->range, key_text(one),
                 "given besides " + key_text(key), "alone");
      return std::nullopt;
    }
    key = one;
  }
  if (key.empty()) {
    if (sink.error_count() == errors_before) fields.require(Key::kUniform);
    return std::nullopt;
  }
  const auto within = read_within(fields);
  const auto& node = *fields.find(key);
  if (key == Key::kFormula) {
    auto expression = read_expression(node, key_text(key), Expression::Kind::kNumber, sink);
    if (!expression || sink.error_count() != errors_before) return std::nullopt;
    out.formula = std::move(expression);
    out.within = within;
    return out;
  }
  auto law = key == Key::kNormal       ? read_normal(node, sink)
             : key == Key::kTriangular ? read_triangular(node, sink)
             : key == Key::kChoice     ? read_choice(node, sink)
                                       : read_uniform(node, sink);
  if (!law || sink.error_count() != errors_before) return std::nullopt;
  const auto before = law->text();
  if (within && law->kind == Distribution::Kind::kChoice) {
    std::erase_if(law->values, [&](const auto& value) {
      return value.first < within->lower || value.first > within->upper;
    });
  }
  const bool is_empty = law->kind == Distribution::Kind::kChoice && law->values.empty();
  if (!is_empty) out.interval = law->support();
  if (within && law->kind != Distribution::Kind::kChoice) {
    const bool is_tail =
        law->kind == Distribution::Kind::kNormal &&
        (within->lower >= out.interval.upper || within->upper <= out.interval.lower);
    out.interval = is_tail ? Interval{within->lower, within->upper, false}
                           : Interval{std::max(out.interval.lower, within->lower),
                                      std::min(out.interval.upper, within->upper), false};
  }
  const bool is_fixed = out.interval.lower == out.interval.upper;
  const bool has_mass =
      !is_empty && out.interval.lower <= out.interval.upper &&
      (is_fixed ? !within || law->lower == law->upper || law->kind == Distribution::Kind::kChoice
                : ConditionedLaw::make(*law, out.interval).has_value());
  if (!has_mass) {
    sink.error(codes::kLawWithoutMass, within ? fields.find(Key::kWithin)->range : node.range,
               entry.key, before,
               within ? fmt::format("{} to {}", within->lower, within->upper) : "its range");
    return std::nullopt;
  }
  if (law->kind != Distribution::Kind::kUniform) out.law = std::move(law);
  return out;
}

void read_law(const YamlFields& fields, const WorldSpec& world, SamplingLaw& law,
              base::DiagnosticSink& sink) {
  if (const auto* parameters = fields.find(Key::kParameters)) {
    const YamlFields all(*parameters, key_text(Key::kParameters), sink);
    for (const auto& entry : parameters->entries) {
      auto value = read_sampled_value(entry, sink);
      if (!value) continue;
      if (value->formula) {
        law.formulas.push_back(
            {entry.key, *std::move(value->formula), value->within, true, entry.key_range});
        continue;
      }
      law.parameters.push_back({entry.key, value->interval});
      if (value->law) law.marginals.push_back({entry.key, *std::move(value->law), entry.key_range});
    }
    std::sort(law.parameters.begin(), law.parameters.end(),
              [](const auto& a, const auto& b) { return a.variable < b.variable; });
  }
  if (const auto* areas = fields.find(Key::kAreas)) {
    const YamlFields all(*areas, key_text(Key::kAreas), sink);
    for (const auto& entry : areas->entries) read_body_area(entry, law, sink);
  }
  if (const auto* require = fields.find(Key::kRequire)) {
    const auto items = require->is_list() ? require->items : std::vector<YamlNode>{*require};
    for (const auto& item : items) {
      auto wanted = read_expression(item, key_text(Key::kRequire), Expression::Kind::kTruth, sink);
      if (wanted) law.requirements.push_back({*std::move(wanted), item.range});
    }
  }
  sort_formulas(law, sink);
  if (law.is_plain()) return;
  for (const auto& body : world.bodies) {
    law.constants.emplace(body.name + ".x", body.p_WB.x());
    law.constants.emplace(body.name + ".y", body.p_WB.y());
    law.constants.emplace(body.name + ".z", body.p_WB.z());
    law.constants.emplace(body.name + ".yaw", body.yaw_rad);
    law.constants.emplace(body.name + ".mass", body.mass_kg);
  }
}

void check_law(const Scenario& scenario, const std::vector<Parameter>& parameters,
               base::DiagnosticSink& sink) {
  const auto& law = scenario.law;
  std::set<std::string> own;
  for (const auto& parameter : law.parameters) own.insert(parameter.variable);
  for (const auto& formula : law.formulas) {
    if (formula.is_parameter) own.insert(formula.variable);
  }
  std::vector<std::string> known(own.begin(), own.end());
  std::set<std::string> settable;
  for (const auto& parameter : parameters) {
    known.push_back(parameter.name);
    if (parameter.settable) settable.insert(parameter.name);
    if (!own.contains(parameter.name)) continue;
    sink.error(codes::kYamlOutOfBounds, scenario.sampled_at(parameter.name),
               fmt::format("`{}` of {}", parameter.name, key_text(Key::kParameters)),
               "a variable of the simulator", "under " + key_text(Key::kVariables));
  }
  for (const auto& constant : law.constants) {
    if (std::find(known.begin(), known.end(), constant.first) == known.end()) {
      known.push_back(constant.first);
    }
  }
  const auto check_name = [&](const std::string& name, const base::SourceRange& source) {
    if (std::find(known.begin(), known.end(), name) != known.end()) return true;
    auto error = sink.error(codes::kUnknownSimVariable, source, name);
    add_suggestion(error, name, known, "variables");
    return false;
  };
  for (const auto& formula : law.formulas) {
    if (!formula.is_parameter) {
      if (check_name(formula.variable, formula.source) && !settable.contains(formula.variable)) {
        sink.error(codes::kVariableNotSettable, formula.source, formula.variable);
      }
    }
    for (const auto& name : formula.value.names()) (void)check_name(name.text, name.source);
  }
  for (const auto& wanted : law.requirements) {
    for (const auto& name : wanted.condition.names()) (void)check_name(name.text, name.source);
  }
  // One message for a body.
  const auto check_body = [&](const std::string& body, const base::SourceRange& source) {
    return check_name(body + ".x", source) && check_name(body + ".y", source);
  };
  for (const auto& area : law.areas) (void)check_body(area.body, area.source);
  for (const auto& plane : law.half_planes) {
    if (check_body(plane.body, plane.source)) (void)check_body(plane.of, plane.source);
  }
}

}  // namespace parallax::harness
