// Built-ins that patterns, parameter lists and macros are compiled into.
#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/builtins/builtin_call.h"

namespace parallax::compiler {
namespace {

/// (%expect-length list n): the list, which must have n elements.
BuiltinResult expect_length(const BuiltinCall& c) {
  const auto items = c.values.elements(c.args[0]);
  if (!items) return c.wrong(0, "a list");
  const auto wanted = c.number(1)->numerator();
  if (static_cast<std::int64_t>(items->size()) == wanted) return c.args[0];
  if (wanted == 0) {
    return BuiltinFailure{
        BuiltinError::kValue,
        fmt::format("the list has {} parts more than the pattern", items->size())};
  }
  return BuiltinFailure{BuiltinError::kValue, fmt::format("the pattern has {} parts, the list {}",
                                                          wanted, items->size())};
}

/// (%next list): its first element; there must be one.
BuiltinResult next(const BuiltinCall& c) {
  const auto& value = c.values[c.args[0]];
  if (value.kind == ValueKind::kCons) return value.head;
  if (value.kind != ValueKind::kNil) return c.wrong(0, "a list");
  return BuiltinFailure{BuiltinError::kValue, "the list has fewer parts than the pattern"};
}

/// (par-loop-list list): the list, which must have an element.
BuiltinResult nonempty(const BuiltinCall& c) {
  const auto kind = c.values.kind(c.args[0]);
  if (kind == ValueKind::kCons) return c.args[0];
  if (kind != ValueKind::kNil) return c.wrong(0, "a list");
  return BuiltinFailure{BuiltinError::kValue,
                        "the list is empty, and nothing runs; guard it with `when`"};
}

BuiltinResult given(const BuiltinCall& c) {
  return c.values.boolean(c.values.kind(c.args[0]) != ValueKind::kNotGiven);
}

/// The value behind `key` in a list of pairs.
std::optional<ValueId> behind(const BuiltinCall& c, const std::vector<ValueId>& items,
                              ValueId key) {
  for (std::size_t i = 0; i + 1 < items.size(); i += 2) {
    if (c.values.same(items[i], key)) return items[i + 1];
  }
  return std::nullopt;
}

/// (%argument list :key): the value after the key, or the mark that there is none.
BuiltinResult argument(const BuiltinCall& c) {
  const auto items = c.values.elements(c.args[0]);
  if (!items) return c.wrong(0, "a list");
  return behind(c, *items, c.args[1]).value_or(c.values.not_given());
}

/// (%expect-keys list keys): the list, which must consist of pairs of such keys and values.
BuiltinResult expect_keys(const BuiltinCall& c) {
  const auto items = c.values.elements(c.args[0]);
  if (!items) return c.wrong(0, "a list");
  if (items->size() % 2 != 0) {
    return BuiltinFailure{BuiltinError::kValue, "the keyword arguments are no pairs"};
  }
  const auto others = behind(c, *items, c.values.keyword("allow-other-keys"));
  if (others && !c.values.is_nil(*others)) return c.args[0];
  const auto known = *c.values.elements(c.args[1]);
  const auto allowed = c.values.keyword("allow-other-keys");
  for (std::size_t i = 0; i < items->size(); i += 2) {
    const auto key = (*items)[i];
    if (key == allowed || std::find(known.begin(), known.end(), key) != known.end()) continue;
    return BuiltinFailure{BuiltinError::kValue,
                          fmt::format("unexpected argument `{}`", c.values.print(key))};
  }
  return c.args[0];
}

BuiltinResult getf(const BuiltinCall& c) {
  const auto items = c.values.elements(c.args[0]);
  if (!items) return c.wrong(0, "a list");
  const auto otherwise = c.args.size() > 2 ? c.args[2] : c.values.nil();
  return behind(c, *items, c.args[1]).value_or(otherwise);
}

constexpr BuiltinEntry kPatternTable[] = {
    {{"%expect-length", 2, 2}, expect_length},
    {{"%next", 1, 1}, next},
    {{"par-loop-list", 1, 1}, nonempty},
    {{"%given", 1, 1}, given},
    {{"%argument", 2, 2}, argument},
    {{"%expect-keys", 2, 2}, expect_keys},
    {{"getf", 2, 3}, getf},
};

}  // namespace

std::span<const BuiltinEntry> pattern_builtins() { return kPatternTable; }

}  // namespace parallax::compiler
