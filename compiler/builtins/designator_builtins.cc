// Functions on designators. A designator is its own solution: the model determines what it refers
// to.
#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "compiler/builtins/builtin_call.h"
#include "compiler/builtins/unknown_values.h"

namespace parallax::compiler {
namespace {

const Value* designator_at(const BuiltinCall& c, std::size_t index) {
  const auto& value = c.values[c.args[index]];
  return is_designator(value) ? &value : nullptr;
}

DesignatorKind kind_of(const Value& value) {
  return value.kind == ValueKind::kModel ? DesignatorKind::kObject : value.designator;
}

BuiltinResult next_solution(const BuiltinCall& c) {
  // A new sample of a location is the same region in the model: as many as were asked for, which
  // differ in nothing but their number.
  auto value = c.values[c.args[0]];
  const bool location =
      value.kind == ValueKind::kDesignator && value.designator == DesignatorKind::kLocation;
  if (!location) return c.wrong(0, "a location designator");
  std::int64_t number = 0;
  if (const auto last = c.values.key(c.args[0], kSolutionKey)) {
    number = c.values[*last].number.numerator();
    value.keys.pop_back();
  }
  if (number >= c.location_samples) return c.values.nil();
  value.keys.emplace_back(kSolutionKey, c.values.number(Number(number + 1)));
  if (!c.links.identities) return c.values.intern(std::move(value));
  // The next solution describes the same location, and is younger.
  const auto next = c.links.make(c.values, DesignatorKind::kLocation, std::move(value.keys));
  c.links.equate(c.args[0], next);
  return next;
}

/// Resolves a location to its pose, if it has one; every other value is its own reference.
BuiltinResult reference(const BuiltinCall& c) {
  auto id = c.links.current(c.args[0]);
  for (;;) {
    const auto& value = c.values[id];
    const bool location =
        value.kind == ValueKind::kDesignator && value.designator == DesignatorKind::kLocation;
    if (!location) break;
    auto inner = c.values.key(id, "pose");
    if (!inner) inner = c.values.key(id, "location");
    if (!inner) break;
    id = c.links.current(*inner);
  }
  const auto kind = c.values.kind(id);
  const bool pose = kind == ValueKind::kPose || kind == ValueKind::kUnknown;
  return pose ? id : c.links.current(c.args[0]);
}

BuiltinResult property(const BuiltinCall& c) {
  const auto& key = c.values[c.args[1]];
  if (c.values.is_nil(c.args[0])) return c.args[0];
  if (designator_at(c, 0) == nullptr) return c.wrong(0, "a designator");
  if (key.kind != ValueKind::kSymbol) return c.wrong(1, "a key");
  if (const auto value = property_value(c.values, c.args[0], key.text)) return *value;
  // Where an object lies that was found, only the robot knows.
  const bool place = key.text == "pose" || key.text == "transform";
  const bool found = c.values.kind(c.args[0]) == ValueKind::kModel;
  if (found && place) return unknown_value(c.name, c.args, c.values);
  return c.values.nil();
}

BuiltinResult property_values(const BuiltinCall& c) {
  const auto* whole = designator_at(c, 0);
  const auto& key = c.values[c.args[1]];
  if (c.values.is_nil(c.args[0])) return c.args[0];
  if (whole == nullptr) return c.wrong(0, "a designator");
  if (key.kind != ValueKind::kSymbol) return c.wrong(1, "a key");
  std::vector<ValueId> out;
  for (const auto& [name, value] : whole->keys) {
    if (name == key.text) out.push_back(value);
  }
  return c.values.list(out);
}

BuiltinResult properties(const BuiltinCall& c) {
  if (designator_at(c, 0) == nullptr) return c.wrong(0, "a designator");
  return property_list(c.values, c.args[0]);
}

std::variant<DesignatorKeys, BuiltinFailure> keys_at(const BuiltinCall& c, std::size_t index) {
  auto keys = keys_of_list(c.values, c.args[index]);
  if (!keys) return c.wrong(index, "a list of properties ((:key value) ...)");
  return *std::move(keys);
}

BuiltinFailure already_equated() { return {BuiltinError::kRaise, "simple-error"}; }

BuiltinResult equate(const BuiltinCall& c) {
  for (std::size_t i = 0; i < 2; ++i) {
    if (designator_at(c, i) == nullptr) return c.wrong(i, "a designator");
  }
  if (!c.links.equate(c.args[0], c.args[1])) return already_equated();
  return c.args[1];
}

BuiltinResult make_designator(const BuiltinCall& c) {
  const auto& name = c.values[c.args[0]];
  const auto kind = name.kind == ValueKind::kSymbol ? designator_class(name.text) : std::nullopt;
  if (!kind) return c.wrong(0, "a class: :object, :location, :action or :motion");
  auto keys = keys_at(c, 1);
  if (const auto* failure = std::get_if<BuiltinFailure>(&keys)) return *failure;
  const auto made = c.links.make(c.values, *kind, std::get<DesignatorKeys>(std::move(keys)));
  if (c.args.size() < 3 || c.values.is_nil(c.args[2])) return made;
  if (designator_at(c, 2) == nullptr) return c.wrong(2, "a designator");
  if (!c.links.equate(c.args[2], made)) return already_equated();
  return made;
}

/// The properties that get no new value stand before the new ones, the last of them first.
BuiltinResult copy_designator(const BuiltinCall& c) {
  const auto* whole = designator_at(c, 0);
  if (whole == nullptr) return c.wrong(0, "a designator");
  DesignatorKeys keys;
  if (c.args.size() == 3) {
    if (c.values[c.args[1]].text != "new-description") return c.wrong(1, ":new-description");
    auto given = keys_at(c, 2);
    if (const auto* failure = std::get_if<BuiltinFailure>(&given)) return *failure;
    keys = std::get<DesignatorKeys>(std::move(given));
  }
  for (const auto& old : whole->keys) {
    const auto same = [&](const auto& key) { return key.first == old.first; };
    if (std::none_of(keys.begin(), keys.end(), same)) keys.insert(keys.begin(), old);
  }
  const auto kind = kind_of(*whole);
  return c.links.make(c.values, kind, std::move(keys));
}

BuiltinResult extend(const BuiltinCall& c) {
  const auto* whole = designator_at(c, 0);
  if (whole == nullptr) return c.wrong(0, "a designator");
  auto more = keys_at(c, 1);
  if (const auto* failure = std::get_if<BuiltinFailure>(&more)) return *failure;
  auto keys = whole->keys;
  const auto kind = kind_of(*whole);
  if (whole->kind == ValueKind::kModel) keys.emplace_back("name", c.args[0]);
  const auto& added = std::get<DesignatorKeys>(more);
  keys.insert(keys.end(), added.begin(), added.end());
  return c.links.make(c.values, kind, std::move(keys));
}

/// (update-designator-properties new old): lists of properties; each new one replaces the old.
BuiltinResult update_properties(const BuiltinCall& c) {
  auto added = keys_at(c, 0), kept = keys_at(c, 1);
  if (const auto* failure = std::get_if<BuiltinFailure>(&added)) return *failure;
  if (const auto* failure = std::get_if<BuiltinFailure>(&kept)) return *failure;
  auto keys = std::get<DesignatorKeys>(std::move(kept));
  for (const auto& one : std::get<DesignatorKeys>(added)) {
    std::erase_if(keys, [&](const auto& key) { return key.first == one.first; });
    keys.insert(keys.begin(), one);
  }
  std::vector<ValueId> out;
  for (const auto& [key, value] : keys) {
    out.push_back(c.values.list({c.values.keyword(key), value}));
  }
  return c.values.list(out);
}

/// The same designator with this description: the plan has changed a part of it.
BuiltinResult with_description(const BuiltinCall& c) {
  const auto* whole = designator_at(c, 0);
  if (whole == nullptr || whole->kind == ValueKind::kModel) return c.wrong(0, "a designator");
  auto keys = keys_at(c, 1);
  if (const auto* failure = std::get_if<BuiltinFailure>(&keys)) return *failure;
  Value changed = *whole;
  changed.keys = std::get<DesignatorKeys>(std::move(keys));
  return c.values.intern(std::move(changed));
}

BuiltinResult current(const BuiltinCall& c) {
  if (c.values.is_nil(c.args[0])) return c.args[0];
  if (designator_at(c, 0) == nullptr) return c.wrong(0, "a designator");
  return c.links.current(c.args[0]);
}

/// (reset designator): it begins again with its first solution, which is what it means here.
BuiltinResult reset(const BuiltinCall& c) {
  const bool fits = c.values.is_nil(c.args[0]) || designator_at(c, 0) != nullptr;
  if (!fits) return c.wrong(0, "a designator");
  return c.args[0];
}

BuiltinResult first_designator(const BuiltinCall& c) {
  if (designator_at(c, 0) == nullptr) return c.wrong(0, "a designator");
  return c.links.first(c.args[0]);
}

BuiltinResult designators_equal(const BuiltinCall& c) {
  const bool both = designator_at(c, 0) != nullptr && designator_at(c, 1) != nullptr;
  return c.values.boolean(both && c.links.same(c.args[0], c.args[1]));
}

BuiltinResult designator_class_of(const BuiltinCall& c) {
  const auto* whole = designator_at(c, 0);
  if (whole == nullptr) return c.wrong(0, "a designator");
  return c.values.keyword(to_string(kind_of(*whole)));
}

template <DesignatorKind kKind>
BuiltinResult has_class(const BuiltinCall& c) {
  const auto* whole = designator_at(c, 0);
  return c.values.boolean(whole != nullptr && kind_of(*whole) == kKind);
}

BuiltinResult is_any(const BuiltinCall& c) {
  return c.values.boolean(designator_at(c, 0) != nullptr);
}

// --- solutions of `prolog` ----------------------------------------------------------------------

/// (var-value '?x bindings): the value that the variable is bound to; itself if it is free.
BuiltinResult var_value(const BuiltinCall& c) {
  if (c.values.kind(c.args[0]) != ValueKind::kSymbol) return c.wrong(0, "a variable");
  const auto bindings = c.values.elements(c.args[1]);
  if (!bindings) return c.wrong(1, "the bindings of one solution");
  for (const auto binding : *bindings) {
    const auto& pair = c.values[binding];
    if (pair.kind == ValueKind::kCons && pair.head == c.args[0]) return pair.tail;
  }
  return c.args[0];
}

BuiltinResult bound_value(const BuiltinCall& c) {
  auto out = var_value(c);
  const auto* value = std::get_if<ValueId>(&out);
  if (value != nullptr && *value == c.args[0]) return already_equated();
  return out;
}

BuiltinResult solution_part(const BuiltinCall& c, bool head) {
  const auto& value = c.values[c.args[0]];
  if (value.kind == ValueKind::kNil) return c.args[0];
  if (value.kind != ValueKind::kCons) return c.wrong(0, "a list");
  if (!head && c.values.kind(value.tail) == ValueKind::kFurther) {
    return c.wrong(0, "a list that is known; `(force-ll (prolog ...))` is");
  }
  return head ? value.head : value.tail;
}
BuiltinResult lazy_car(const BuiltinCall& c) { return solution_part(c, true); }
BuiltinResult lazy_cdr(const BuiltinCall& c) { return solution_part(c, false); }

BuiltinResult force(const BuiltinCall& c) {
  if (!c.values.elements(c.args[0])) {
    return c.wrong(0, "a list that is known; write the `prolog` form in it");
  }
  return c.args[0];
}

constexpr BuiltinEntry kDesignatorTable[] = {
    {{"next-solution", 1, 1}, next_solution},
    {{"reference", 1, 2}, reference},
    {{"desig-prop-value", 2, 2}, property},
    {{"desig-prop-values", 2, 2}, property_values},
    {{"properties", 1, 1}, properties},
    {{"description", 1, 1}, properties},
    {{"%with-description", 2, 2}, with_description},
    {{"make-designator", 2, 3}, make_designator},
    {{"copy-designator", 1, 3}, copy_designator},
    {{"extend-designator-properties", 2, 2}, extend},
    {{"update-designator-properties", 2, 2}, update_properties},
    {{"equate", 2, 2}, equate},
    {{"desig-equal", 2, 2}, designators_equal},
    {{"current-desig", 1, 1}, current},
    {{"newest-effective-designator", 1, 1}, current},
    {{"first-desig", 1, 1}, first_designator},
    {{"reset", 1, 1}, reset},
    {{"get-desig-class", 1, 1}, designator_class_of},
    {{"designatorp", 1, 1}, is_any},
    {{"object-designator-p", 1, 1}, has_class<DesignatorKind::kObject>},
    {{"location-designator-p", 1, 1}, has_class<DesignatorKind::kLocation>},
    {{"action-designator-p", 1, 1}, has_class<DesignatorKind::kAction>},
    {{"motion-designator-p", 1, 1}, has_class<DesignatorKind::kMotion>},
    {{"var-value", 2, 2}, var_value},
    {{"%bound-value", 2, 2}, bound_value},
    {{"lazy-car", 1, 1}, lazy_car},
    {{"lazy-cdr", 1, 1}, lazy_cdr},
    {{"force-ll", 1, 1}, force},
};

}  // namespace

std::span<const BuiltinEntry> designator_builtins() { return kDesignatorTable; }

}  // namespace parallax::compiler
