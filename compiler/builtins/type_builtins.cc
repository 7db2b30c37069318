#include <algorithm>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/builtins/builtin_call.h"
#include "compiler/builtins/designator_links.h"

namespace parallax::compiler {
namespace {

using Test = bool (*)(const Value& value);

constexpr std::string_view kNamed = "whether a detected object or its name is meant";

bool is(const Value& value, ValueKind kind) { return value.kind == kind; }
bool is_symbol(const Value& v) { return is(v, ValueKind::kSymbol) || is(v, ValueKind::kNil); }
bool is_list(const Value& v) { return is(v, ValueKind::kCons) || is(v, ValueKind::kNil); }
bool is_number(const Value& v) { return is(v, ValueKind::kNumber); }
bool is_float(const Value& v) { return is_number(v) && (v.number.is_float() || !v.number.exact()); }
template <Number::Kind kKind>
bool is_kind(const Value& v) {
  return is_number(v) && v.number.kind() == kKind;
}
bool is_rational(const Value& v) { return is_number(v) && !is_float(v); }
bool is_integer(const Value& v) { return is_rational(v) && v.number.is_integer(); }
bool is_keyword(const Value& v) { return is(v, ValueKind::kSymbol) && v.keyword; }
bool is_boolean(const Value& v) {
  return is(v, ValueKind::kNil) || (is(v, ValueKind::kSymbol) && !v.keyword && v.text == "t");
}

/// A cell, by the first letter of the word for it.
template <char kFirst>
bool is_thing(const Value& v) {
  return is(v, ValueKind::kCell) && v.text.front() == kFirst;
}

const std::map<std::string_view, Test>& types() {
  static const std::map<std::string_view, Test> table = {
      {"t", [](const Value&) { return true; }},
      {"nil", [](const Value&) { return false; }},
      {"null", [](const Value& v) { return is(v, ValueKind::kNil); }},
      {"list", is_list},
      {"cons", [](const Value& v) { return is(v, ValueKind::kCons); }},
      {"atom", [](const Value& v) { return !is(v, ValueKind::kCons); }},
      {"symbol", is_symbol},
      {"keyword", is_keyword},
      {"boolean", is_boolean},
      {"string", [](const Value& v) { return is(v, ValueKind::kString); }},
      {"simple-string", [](const Value& v) { return is(v, ValueKind::kString); }},
      {"sequence", [](const Value& v) { return is_list(v) || is(v, ValueKind::kString); }},
      {"number", is_number},
      {"real", is_number},
      {"rational", is_rational},
      {"ratio", [](const Value& v) { return is_rational(v) && !is_integer(v); }},
      {"integer", is_integer},
      {"fixnum", is_integer},
      {"unsigned-byte", [](const Value& v) { return is_integer(v) && v.number.numerator() >= 0; }},
      {"float", is_float},
      {"single-float", is_kind<Number::Kind::kSingle>},
      {"double-float", is_kind<Number::Kind::kDouble>},
      {"fluent", is_fluent},
      {"value-fluent", is_fluent},
      {"hash-table", is_thing<'h'>},
      {"array", is_thing<'a'>},
      {"vector", is_thing<'a'>},
      {"function", [](const Value& v) { return is(v, ValueKind::kFunction); }},
  };
  return table;
}

/// Is the number between the bounds of (integer low high) and its like? `*` is no bound.
std::optional<bool> in_bounds(const BuiltinCall& c, const Value& value,
                              const std::vector<ValueId>& parts) {
  for (std::size_t i = 1; i < parts.size() && i < 3; ++i) {
    const auto& bound = c.values[parts[i]];
    if (bound.kind == ValueKind::kSymbol && bound.text == "*") continue;
    if (bound.kind != ValueKind::kNumber) return std::nullopt;
    const auto order = compare(value.number, bound.number);
    if (i == 1 ? order < 0 : order > 0) return false;
  }
  return true;
}

/// None: that is no type. As deep as the type is written.
std::optional<bool> has_type(const BuiltinCall& c, ValueId id, ValueId type) {
  const auto& wanted = c.values[type];
  const auto& value = c.values[id];
  if (wanted.kind == ValueKind::kNil) return false;
  if (wanted.kind == ValueKind::kSymbol) {
    if (const auto known = types().find(wanted.text); known != types().end()) {
      return known->second(value);
    }
    if (const auto holds = has_designator_type(value, wanted.text)) return holds;
    if (c.classes.has_structure(wanted.text)) {
      return is(value, ValueKind::kCell) &&
             value.text.find(' ' + wanted.text + ' ') != std::string::npos;
    }
    const auto failure = c.classes.canonical(wanted.text);
    if (!failure) return std::nullopt;
    return value.kind == ValueKind::kFailure && c.classes.is_a(value.text, *failure);
  }
  const auto parts = c.values.elements(type);
  if (!parts || parts->empty()) return std::nullopt;
  const auto& head = c.values[parts->front()];
  const std::string_view word = head.kind == ValueKind::kSymbol ? std::string_view(head.text) : "";
  if (word == "or" || word == "and") {
    bool result = word == "and";
    for (std::size_t i = 1; i < parts->size(); ++i) {
      const auto part = has_type(c, id, (*parts)[i]);
      if (!part) return std::nullopt;
      result = word == "or" ? (result || *part) : (result && *part);
    }
    return result;
  }
  if (word == "not" && parts->size() == 2) {
    const auto part = has_type(c, id, (*parts)[1]);
    if (!part) return std::nullopt;
    return !*part;
  }
  if (word == "eql" && parts->size() == 2) return is_same(c, id, (*parts)[1]);
  if (word == "member") {
    return std::any_of(parts->begin() + 1, parts->end(),
                       [&](ValueId item) { return is_same(c, id, item); });
  }
  const bool number = word == "integer" || word == "float" || word == "real" ||
                      word == "rational" || word == "number" || word == "single-float" ||
                      word == "double-float";
  if (!number) return std::nullopt;
  const auto kind = has_type(c, id, parts->front());
  if (!kind || !*kind) return kind;
  return in_bounds(c, value, *parts);
}

/// A detected object is also its name, which is a symbol or a string. None: that is no type.
std::optional<bool> has_type_as_name(const BuiltinCall& c) {
  const auto symbol = has_type(c, c.values.keyword("name"), c.args[1]);
  const auto string = has_type(c, c.values.string("name"), c.args[1]);
  if (!symbol || !string) return std::nullopt;
  return *symbol || *string;
}

bool is_model(const BuiltinCall& c) { return c.values.kind(c.args[0]) == ValueKind::kModel; }

BuiltinResult typep(const BuiltinCall& c) {
  const auto holds = has_type(c, c.args[0], c.args[1]);
  if (!holds) return c.wrong(1, "a type");
  if (is_model(c) && has_type_as_name(c) != holds) c.values.doubt(kNamed);
  return c.values.boolean(*holds);
}

/// Nil only if the value certainly has another type: declarations name types that we do not know.
BuiltinResult may_be(const BuiltinCall& c) {
  if (c.values.kind(c.args[0]) == ValueKind::kUnknown) return c.values.truth();
  const bool named = is_model(c) && has_type_as_name(c).value_or(true);
  return c.values.boolean(named || has_type(c, c.args[0], c.args[1]).value_or(true));
}

/// (%failure class keyword value...): a condition with slots.
BuiltinResult make_failure(const BuiltinCall& c) {
  Value value;
  value.kind = ValueKind::kFailure;
  value.text = c.values[c.args[0]].text;
  for (std::size_t i = 1; i + 1 < c.args.size(); i += 2) {
    value.keys.emplace_back(c.values[c.args[i]].text, c.args[i + 1]);
  }
  return c.values.intern(std::move(value));
}

/// (%slot condition initargs initial)
BuiltinResult slot(const BuiltinCall& c) {
  const auto& value = c.values[c.args[0]];
  if (value.kind != ValueKind::kFailure) return c.wrong(0, "a condition");
  const auto initargs = c.values.elements(c.args[1]).value_or(std::vector<ValueId>());
  for (const auto& [name, item] : value.keys) {
    const auto is_name = [&](ValueId initarg) { return c.values[initarg].text == name; };
    if (std::any_of(initargs.begin(), initargs.end(), is_name)) return item;
  }
  return c.args[2];
}

/// A predicate by the name of the type that it tests.
template <Test kTest>
BuiltinResult is_of(const BuiltinCall& c) {
  const bool holds = kTest(c.values[c.args[0]]);
  const auto symbol = c.values.keyword("name"), string = c.values.string("name");
  const bool named = kTest(c.values[symbol]) || kTest(c.values[string]);
  if (is_model(c) && named != holds) c.values.doubt(kNamed);
  return c.values.boolean(holds);
}
bool is_string(const Value& v) { return is(v, ValueKind::kString); }
bool is_cons(const Value& v) { return is(v, ValueKind::kCons); }
bool is_atom(const Value& v) { return !is(v, ValueKind::kCons); }
bool is_function(const Value& v) { return is(v, ValueKind::kFunction); }

BuiltinResult endp(const BuiltinCall& c) {
  if (!is_list(c.values[c.args[0]])) return c.wrong(0, "a list");
  return c.values.boolean(c.values.is_nil(c.args[0]));
}

constexpr BuiltinEntry kTypeTable[] = {
    {{"typep", 2, 2}, typep},
    {{"%may-be", 2, 2}, may_be},
    {{"%failure", 1, 100}, make_failure},
    {{"%slot", 3, 3}, slot},
    {{"listp", 1, 1}, is_of<is_list>},
    {{"consp", 1, 1}, is_of<is_cons>},
    {{"atom", 1, 1}, is_of<is_atom>},
    {{"endp", 1, 1}, endp},
    {{"symbolp", 1, 1}, is_of<is_symbol>},
    {{"keywordp", 1, 1}, is_of<is_keyword>},
    {{"stringp", 1, 1}, is_of<is_string>},
    {{"numberp", 1, 1}, is_of<is_number>},
    {{"realp", 1, 1}, is_of<is_number>},
    {{"rationalp", 1, 1}, is_of<is_rational>},
    {{"integerp", 1, 1}, is_of<is_integer>},
    {{"floatp", 1, 1}, is_of<is_float>},
    {{"functionp", 1, 1}, is_of<is_function>},
};

}  // namespace

std::span<const BuiltinEntry> type_builtins() { return kTypeTable; }

}  // namespace parallax::compiler
