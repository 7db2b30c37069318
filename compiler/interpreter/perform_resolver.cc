#include "compiler/interpreter/perform_resolver.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "compiler/base/codes/plans.h"
#include "compiler/base/suggest.h"
#include "compiler/builtins/designator_links.h"

namespace parallax::compiler {

using base::Result;
using base::SourceRange;

namespace {

std::optional<PerformKind> perform_kind(const Value& value) {
  if (value.kind != ValueKind::kDesignator) return std::nullopt;
  if (value.designator == DesignatorKind::kMotion) return PerformKind::kMotion;
  if (value.designator == DesignatorKind::kAction) return PerformKind::kAction;
  return std::nullopt;
}

bool is_undetected(const ValueStore& values, ValueId id) {
  const auto& value = values[id];
  return value.kind == ValueKind::kDesignator && value.designator == DesignatorKind::kObject &&
         !values.key(id, "name");
}

}  // namespace

/// The value of a key by role: `pose` and `location` are both the target.
std::optional<ValueId> PerformResolver::key_value(ValueId designator, std::string_view key) const {
  if (values_.kind(designator) != ValueKind::kDesignator) return std::nullopt;
  for (const auto& [name, value] : values_[designator].keys) {
    if (normalise_key(name) == key) return value;
  }
  return std::nullopt;
}

base::DiagnosticBuilder PerformResolver::unbound(ValueId designator, SourceRange source) {
  const auto& value = values_[designator];
  const auto kind = perform_kind(value);
  if (!kind) {
    return sink_.error(
        codes::kUnboundDesignator, source,
        fmt::format("{}: only motions and actions are performed", values_.print(designator)));
  }
  const auto type = values_.key(designator, "type");
  const bool named = type && values_.kind(*type) == ValueKind::kSymbol;
  const std::string name =
      named ? values_[*type].text : (type ? values_.print(*type) : std::string("(no type)"));
  std::string keys;
  for (const auto& [key, item] : value.keys) {
    if (key != "type") keys += fmt::format(" :{}", normalise_key(key));
  }
  auto error = sink_.error(codes::kUnboundDesignator, source,
                           fmt::format("{} `{}` with the keys ({})", to_string(*kind), name,
                                       keys.empty() ? keys : keys.substr(1)));
  for (const auto& entry : binding_.entries) {
    if (entry.kind != *kind || entry.type != name) continue;
    std::string wanted;
    for (const auto& key : entry.keys) wanted += fmt::format(" :{}", key.key);
    return error.note(entry.source, fmt::format("this binding needs the keys ({})",
                                                wanted.empty() ? wanted : wanted.substr(1)));
  }
  if (const auto near = base::nearest_name(name, binding_.types(*kind), 3)) {
    error.note(fmt::format("the nearest binding is {} `{}`", to_string(*kind), *near));
  }
  return error;
}

const BindingEntry* PerformResolver::matching_entry(ValueId designator) const {
  const auto kind = perform_kind(values_[designator]);
  const auto type = kind ? values_.key(designator, "type") : std::nullopt;
  if (!type) return nullptr;
  for (const auto& entry : binding_.entries) {
    if (entry.kind != *kind || values_[*type].text != entry.type) continue;
    bool complete = true;
    for (const auto& key : entry.keys) complete = complete && key_value(designator, key.key);
    if (complete) return &entry;
  }
  return nullptr;
}

const BindingEntry* PerformResolver::find_entry(ValueId designator, SourceRange source) {
  const auto* entry = matching_entry(designator);
  if (entry == nullptr) unbound(designator, source);
  return entry;
}

const QueryBinding* PerformResolver::find_query(std::string_view name,
                                                std::size_t arguments) const {
  for (const auto& query : binding_.queries) {
    if (query.name == name && query.variables.size() == arguments) return &query;
  }
  return nullptr;
}

base::Result<FormulaTree> PerformResolver::query_formula(const QueryBinding& query,
                                                         std::span<const ValueId> arguments,
                                                         base::SourceRange source) {
  Variables variables;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    variables.emplace(query.variables[i], arguments[i]);
  }
  return fill(query.formula, variables, source);
}

const BindingEntry* PerformResolver::find_plan(ValueId designator) const {
  const auto* entry = matching_entry(designator);
  return entry != nullptr && entry->plan ? entry : nullptr;
}

Result<std::string> PerformResolver::model_name(const ModelNames& names, std::string_view name,
                                                SourceRange source) {
  if (auto found = names.find(name)) return *std::move(found);
  auto error = sink_.error(codes::kUnknownPlanConstant, source, name);
  if (const auto near = names.nearest(name)) error.fix(fmt::format("name `{}`", *near));
  return error;
}

Result<FormulaTree> PerformResolver::constant(ValueId id, std::string_view what,
                                              SourceRange source) {
  const auto& value = values_[id];
  const auto wrong = [&](std::string_view text) -> Result<FormulaTree> {
    return sink_.error(codes::kDesignatorValue, source, "performed", what, text);
  };
  switch (value.kind) {
    case ValueKind::kSymbol:
    case ValueKind::kString: {
      if (value.text.empty()) return wrong("an empty name");
      const auto name = model_name(constants_, value.text, source);
      if (!name) return sink_.already_reported();
      return constant_term(*name);
    }
    case ValueKind::kNumber:
      if (value.number.is_integer()) {
        return constant_term(fmt::format("{}", value.number.numerator()));
      }
      return wrong("a number that is no integer; the model has no such constants");
    case ValueKind::kModel:
      return register_term(graph_.values[value.model].name, value.model);
    case ValueKind::kDesignator:
      if (const auto name = values_.key(id, "name")) return constant(*name, what, source);
      if (value.designator == DesignatorKind::kLocation) {
        if (const auto object = target(id).object) return constant(*object, what, source);
      }
      return wrong(
          "a designator without a name; name it, detect it first, or say in an `object` entry of "
          "the "
          "binding table what it can mean");
    case ValueKind::kPose:
      return wrong(
          "a pose where a name is needed; map it with `region`, `place` "
          "or `gaze`");
    case ValueKind::kNil:
      if (constants_.has("nil")) return constant_term("nil");
      return wrong("nil, and the model has no constant of that name");
    case ValueKind::kNotGiven:
    case ValueKind::kFunction:
    case ValueKind::kValues:
    case ValueKind::kCell:
    case ValueKind::kNetwork:
      return wrong(values_.print(id));
    case ValueKind::kCons:
    case ValueKind::kVector:
    case ValueKind::kQuaternion:
    case ValueKind::kTransform:
    case ValueKind::kUnknown:
    case ValueKind::kFailure:
    case ValueKind::kCounter:
    case ValueKind::kFurther:
      return wrong(values_.print(id));
  }
  return wrong("nothing");
}

/// Where a value points: at a pose, or at an object that it is in, on or of.
PerformResolver::Target PerformResolver::target(ValueId id) const {
  // Every step goes into a part of a finite value.
  for (;;) {
    const auto& value = values_[id];
    if (value.kind == ValueKind::kPose) return {value.pose, {}};
    const bool location =
        value.kind == ValueKind::kDesignator && value.designator == DesignatorKind::kLocation;
    if (!location) return {std::nullopt, id};
    const auto leading = leading_key(value);
    if (!leading) return {};
    id = value.keys[*leading].second;
  }
}

Result<FormulaTree> PerformResolver::mapped(std::string_view function, ValueId value,
                                            std::string_view key, SourceRange source) {
  const auto where = target(value);
  if (where.object && values_.kind(*where.object) == ValueKind::kUnknown) {
    return sink_.error(
        codes::kDesignatorValue, source, "performed", key,
        fmt::format("a pose {}; write the pose in numbers, or name the object that the target is "
                    "in or on",
                    values_.print(*where.object)));
  }
  if (where.object && values_.kind(*where.object) == ValueKind::kTransform) {
    return sink_.error(codes::kDesignatorValue, source, "performed", key,
                       "a transform, not a pose; `strip-transform-stamped` makes a pose of it");
  }
  if (where.pose && where.pose->frame != "map" && where.pose->frame != "/map") {
    const auto& frame = where.pose->frame;
    return sink_.error(codes::kDesignatorValue, source, "performed", key,
                       frame.empty() ? std::string("a pose whose frame the plan does not say; give "
                                                   "it one with `pose->pose-stamped`")
                                     : fmt::format("a pose in the frame `{}`; the regions are in "
                                                   "`map`, so give it in that frame",
                                                   frame));
  }
  if (where.pose) {
    if (auto region = locator_.region_of(function, *where.pose)) {
      return constant_term(*region);
    }
    const auto& pose = *where.pose;
    auto error =
        sink_.error(codes::kPoseOutsideRegions, source, pose.x_m, pose.y_m, pose.z_m, function);
    if (const auto near = locator_.nearest(function, pose)) {
      error.note(fmt::format("the nearest is `{}`, {:.4g} m away{}", near->region, near->distance_m,
                             near->outside.empty() ? "" : " (" + near->outside + ")"));
    }
    return error;
  }
  if (!where.object) {
    return sink_.error(codes::kDesignatorValue, source, "performed", key,
                       "no pose and no object to go by");
  }
  const auto object = constant(*where.object, key, source);
  if (!object) return sink_.already_reported();
  return constant_term(object->text);  // a location in or on an object is the object itself
}

Result<ValueId> PerformResolver::variable(const BindingEntry& entry, ValueId designator,
                                          std::string_view name, SourceRange source) {
  for (const auto& key : entry.keys) {
    if (key.variable != name) continue;
    const auto value = key_value(designator, key.key);
    PARALLAX_REQUIRE(value.has_value(), "the entry was chosen because its keys are there");
    if (!key.property) return *value;
    if (is_designator(values_[*value])) {
      if (const auto property = property_value(values_, *value, *key.property)) return *property;
    }
    return sink_.error(codes::kDesignatorValue, source, to_string(entry.kind), key.key,
                       fmt::format("no `{}`", *key.property));
  }
  PARALLAX_REQUIRE(false, "the variables of a binding were checked when it was read");
  return designator;
}

/// The formula of an entry with the values of the designator's keys.
Result<FormulaTree> PerformResolver::fill(const BindingEntry& entry, const FormulaTree& formula,
                                          ValueId designator, SourceRange source) {
  Variables variables;
  for (const auto& parameter : formula.parameters) {
    if (parameter.variable.empty() || variables.contains(parameter.variable)) continue;
    const auto value = variable(entry, designator, parameter.variable, source);
    if (!value) return sink_.already_reported();
    variables.emplace(parameter.variable, *value);
  }
  return fill(formula, variables, source);
}

Result<PlanLocation> PerformResolver::resolve(const BindingEntry& entry, ValueId designator,
                                              SourceRange source) {
  PlanLocation location;
  location.source = source;
  location.event_symbol = entry.event_symbol;
  std::vector<FormulaTree> event_arguments;
  for (const auto& argument : entry.event_arguments) {
    auto filled = fill(entry, argument, designator, source);
    if (!filled) return sink_.already_reported();
    event_arguments.push_back(*std::move(filled));
  }
  location.event = application(entry.event_symbol, event_arguments);
  auto formula = fill(entry, entry.formula, designator, source);
  if (!formula) return sink_.already_reported();
  location.success = {*std::move(formula), entry.time_offset, entry.formula_source};
  const auto failure = classes_.canonical(entry.failure_class);
  if (!failure) {
    return sink_.error(codes::kUnknownFailureClass, entry.failure_source, entry.failure_class);
  }
  location.failure_class = *failure;
  location.binding = entry.source;
  for (const auto& bound : entry.reasons) {
    const auto known = classes_.canonical(bound.failure_class);
    if (!known) {
      return sink_.error(codes::kUnknownFailureClass, bound.source, bound.failure_class);
    }
    auto& ways = location.failures;
    const auto same = std::find_if(ways.begin(), ways.end(), [&](const FailureWay& way) {
      return way.failure_class == *known;
    });
    auto& way = same == ways.end() ? ways.emplace_back(FailureWay{*known, {}}) : *same;
    way.reasons.push_back(bound.reason);
  }
  location.arguments = arguments(designator);
  return location;
}

/// The formula with values of the plan in the place of its parameters.
Result<FormulaTree> PerformResolver::fill(const FormulaTree& formula, const Variables& variables,
                                          SourceRange source) {
  bool failed = false;
  auto out = with_leaves(formula, [&](const FormulaNode& node) -> std::optional<FormulaTree> {
    if (node.leaf != LeafKind::kParameter || failed) return std::nullopt;
    const auto& [variable, function] = formula.parameters[node.number];
    const auto bound = variables.find(variable);
    PARALLAX_REQUIRE(bound != variables.end(), "the keys of a binding bind its variables");
    auto term = function.empty() ? constant(bound->second, variable, source)
                                 : mapped(function, bound->second, variable, source);
    if (term) return *std::move(term);
    failed = true;
    return std::nullopt;
  });
  if (failed) return sink_.already_reported();
  out.parameters.clear();
  return out;
}

Result<FormulaTree> PerformResolver::question(ValueId list, SourceRange source) {
  const auto items = values_.elements(list);
  if (!items || items->empty() || values_.kind(items->front()) != ValueKind::kSymbol) {
    return sink_.error(codes::kPlanValue, source, "holds",
                       "expected a quoted fluent such as '(holding left box)");
  }
  const auto& head = values_[items->front()].text;
  if (const auto* query = find_query(head, items->size() - 1)) {
    return query_formula(*query, std::span(*items).subspan(1), source);
  }
  const auto name = model_name(fluents_, head, source);
  if (!name) return sink_.already_reported();
  std::vector<FormulaTree> arguments;
  for (std::size_t i = 1; i < items->size(); ++i) {
    auto argument = constant((*items)[i], "holds", source);
    if (!argument) return sink_.already_reported();
    arguments.push_back(*std::move(argument));
  }
  return application(*name, arguments);
}

base::DiagnosticBuilder PerformResolver::unbound_query(std::string_view name, std::size_t arguments,
                                                       SourceRange source) {
  auto error = sink_.error(codes::kUnboundDesignator, source,
                           fmt::format("query `{}` with {} arguments", name, arguments));
  std::vector<std::string> names;
  for (const auto& query : binding_.queries) names.push_back(query.name);
  if (const auto near = base::nearest_name(name, names, 3)) {
    error.note(fmt::format("the nearest query is `{}`", *near));
  }
  return error;
}

std::optional<std::size_t> leading_key(const Value& location) {
  for (std::size_t i = 0; i < location.keys.size(); ++i) {
    if (normalise_key(location.keys[i].first) == "target") return i;
  }
  for (std::size_t i = 0; i < location.keys.size(); ++i) {
    const auto& key = location.keys[i].first;
    const bool narrows = key == "side" || key == "reachable-for" || key == "visible-for";
    if (!narrows && key != kSolutionKey) return i;
  }
  return std::nullopt;
}

std::optional<PerformResolver::Reference> PerformResolver::reference(const BindingEntry& entry,
                                                                     ValueId designator) const {
  const auto& keys = values_[designator].keys;
  for (const auto& wanted : entry.keys) {
    if (wanted.property) continue;  // of the designator itself, as `:object type ?y`
    std::size_t at = 0;
    while (at < keys.size() && normalise_key(keys[at].first) != wanted.key) ++at;
    if (at == keys.size()) continue;
    Reference out;
    out.path.emplace_back(designator, at);
    out.object = keys[at].second;
    // Every step goes into a part of a finite value.
    while (values_.kind(out.object) == ValueKind::kDesignator &&
           values_[out.object].designator == DesignatorKind::kLocation) {
      const auto next = leading_key(values_[out.object]);
      if (!next) break;
      out.path.emplace_back(out.object, *next);
      out.object = values_[out.object].keys[*next].second;
    }
    if (!is_undetected(values_, out.object)) continue;
    for (const auto& binding : binding_.objects) {
      bool fits = true;
      for (const auto& key : binding.keys) fits = fits && key_value(out.object, key.key);
      if (!fits) continue;
      out.binding = &binding;
      return out;
    }
  }
  return std::nullopt;
}

base::Result<FormulaTree> PerformResolver::candidate(const Reference& reference,
                                                     std::string_view name,
                                                     base::SourceRange source) {
  Variables variables;
  for (const auto& key : reference.binding->keys) {
    variables.emplace(key.variable, *key_value(reference.object, key.key));
  }
  variables.emplace(reference.binding->variable, values_.symbol(name));
  return fill(reference.binding->formula, variables, source);
}

void PerformResolver::flatten(const std::string& name, ValueId id, PlanArguments& out) const {
  const auto& value = values_[id];
  const auto pose = target(id).pose;
  if (pose) {
    out.emplace(name + ".x", pose->x_m);
    out.emplace(name + ".y", pose->y_m);
    out.emplace(name + ".z", pose->z_m);
    out.emplace(name + ".yaw", yaw_rad(*pose));
    if (const auto sample = values_.key(id, kSolutionKey))
      flatten(name + ".solution", *sample, out);
    return;
  }
  switch (value.kind) {
    case ValueKind::kSymbol:
      out.emplace(name, constants_.find(value.text).value_or(value.text));
      return;
    case ValueKind::kString:
      out.emplace(name, value.text);
      return;
    case ValueKind::kNumber:
      if (value.number.is_integer()) {
        out.emplace(name, value.number.numerator());
      } else {
        out.emplace(name, value.number.value());
      }
      return;
    case ValueKind::kModel:
      out.emplace(name, value.model);
      return;
    case ValueKind::kDesignator:
      for (const auto& [key, item] : value.keys) {
        flatten(key == "name" ? name : fmt::format("{}.{}", name, key), item, out);
      }
      return;
    case ValueKind::kVector:
      out.emplace(name + ".x", value.pose.x_m);
      out.emplace(name + ".y", value.pose.y_m);
      out.emplace(name + ".z", value.pose.z_m);
      return;
    case ValueKind::kCons: {
      std::size_t index = 0;
      for (const auto item : values_.elements(id).value_or(std::vector<ValueId>())) {
        flatten(fmt::format("{}.{}", name, index++), item, out);
      }
      return;
    }
    case ValueKind::kNotGiven:
    case ValueKind::kFunction:
    case ValueKind::kValues:
    case ValueKind::kCell:
    case ValueKind::kNetwork:
    case ValueKind::kNil:
    case ValueKind::kQuaternion:
    case ValueKind::kPose:
    case ValueKind::kTransform:
    case ValueKind::kUnknown:
    case ValueKind::kFailure:
    case ValueKind::kCounter:
    case ValueKind::kFurther:
      return;
  }
}

/// Every key but the type. Of two keys with one role the second keeps its own name.
PlanArguments PerformResolver::arguments(ValueId designator) const {
  PlanArguments out;
  std::vector<std::string> roles;
  for (const auto& [key, value] : values_[designator].keys) {
    if (key == "type") continue;
    auto role = normalise_key(key);
    for (const auto& taken : roles) {
      if (taken == role) role = key;
    }
    roles.push_back(role);
    flatten(role, value, out);
  }
  return out;
}

}  // namespace parallax::compiler
