#include <fmt/core.h>

#include <algorithm>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "compiler/builtins/builtin_call.h"

namespace parallax::compiler {
namespace {

constexpr std::string_view kAlike = "equal things taken for one thing";

template <bool kStructure>
BuiltinResult same(const BuiltinCall& c) {
  if (kStructure ? is_equal(c, c.args[0], c.args[1]) : is_same(c, c.args[0], c.args[1])) {
    // `eq` may tell numbers apart that are not small.
    const auto* number = c.number(0);
    const bool large = number != nullptr && !number->is_integer() && !number->is_float();
    if (c.name == "eq" && (large || (number != nullptr && number->kind() == Number::Kind::kDouble)))
      c.values.doubt(kAlike);
    return c.values.truth();
  }
  const auto left = c.values.kind(c.args[0]);
  const auto right = c.values.kind(c.args[1]);
  const auto comparable = [](ValueKind kind) {
    return kind == ValueKind::kModel || kind == ValueKind::kSymbol;
  };
  const bool asks_model = left == ValueKind::kModel || right == ValueKind::kModel;
  if (asks_model && comparable(left) && comparable(right)) {
    return ModelEquality{c.args[0], c.args[1]};
  }
  return c.values.nil();
}

BuiltinResult is_null(const BuiltinCall& c) { return c.values.boolean(c.values.is_nil(c.args[0])); }
BuiltinResult list(const BuiltinCall& c) { return c.values.list({c.args.begin(), c.args.end()}); }
BuiltinResult cons(const BuiltinCall& c) { return c.values.cons(c.args[0], c.args[1]); }

BuiltinResult part(const BuiltinCall& c, bool head) {
  const auto& value = c.values[c.args[0]];
  if (value.kind == ValueKind::kNil) return c.args[0];
  if (value.kind != ValueKind::kCons) return c.wrong(0, "a list");
  return head ? value.head : value.tail;
}
BuiltinResult car(const BuiltinCall& c) { return part(c, true); }
BuiltinResult cdr(const BuiltinCall& c) { return part(c, false); }

BuiltinResult element(const BuiltinCall& c, std::size_t list_index, std::size_t position) {
  const auto items = c.values.elements(c.args[list_index]);
  if (!items) return c.wrong(list_index, "a list");
  return position < items->size() ? (*items)[position] : c.values.nil();
}
template <std::size_t kPosition>
BuiltinResult nth_fixed(const BuiltinCall& c) {
  return element(c, 0, kPosition);
}

BuiltinResult nth(const BuiltinCall& c) {
  const auto* number = c.number(0);
  if (number == nullptr || !number->is_integer() || number->numerator() < 0) {
    return c.wrong(0, "a natural number");
  }
  return element(c, 1, static_cast<std::size_t>(number->numerator()));
}

BuiltinResult length(const BuiltinCall& c) {
  const auto& value = c.values[c.args[0]];
  if (value.kind == ValueKind::kString) {
    return c.values.number(Number(static_cast<std::int64_t>(value.text.size())));
  }
  auto items = c.values.elements(c.args[0]);
  if (const auto whole = c.links.heap.content(c.values, c.args[0]);
      whole && value.text == "array") {
    items = c.values.elements(c.values[*whole].tail);
  }
  if (!items) return c.wrong(0, "a list");
  return c.values.number(Number(static_cast<std::int64_t>(items->size())));
}

BuiltinResult append(const BuiltinCall& c) {
  if (c.args.empty()) return c.values.nil();
  std::vector<ValueId> all;
  for (std::size_t i = 0; i + 1 < c.args.size(); ++i) {
    const auto items = c.values.elements(c.args[i]);
    if (!items) return c.wrong(i, "a list");
    all.insert(all.end(), items->begin(), items->end());
  }
  // The last one is the tail as it stands, which need not be a list.
  auto out = c.args.back();
  for (auto item = all.rbegin(); item != all.rend() && !c.values.full(); ++item) {
    out = c.values.cons(*item, out);
  }
  return out;
}

BuiltinResult reverse(const BuiltinCall& c) {
  auto items = c.values.elements(c.args[0]);
  if (!items) return c.wrong(0, "a list");
  std::reverse(items->begin(), items->end());
  return c.values.list(*items);
}

/// The list of argument 1 if the search for argument 0 in it needs no model.
std::variant<std::vector<ValueId>, BuiltinFailure> searched(const BuiltinCall& c) {
  auto items = c.values.elements(c.args[1]);
  if (!items) return c.wrong(1, "a list");
  const auto is_model = [&](ValueId id) { return c.values.kind(id) == ValueKind::kModel; };
  const bool same_only = items->size() == 1 && items->front() == c.args[0];
  if (!same_only && (is_model(c.args[0]) || std::any_of(items->begin(), items->end(), is_model))) {
    return BuiltinFailure{BuiltinError::kModelList, "a search among values of the model"};
  }
  return *std::move(items);
}

BuiltinResult member(const BuiltinCall& c) {
  auto found = searched(c);
  if (auto* failure = std::get_if<BuiltinFailure>(&found)) return *failure;
  const auto& items = std::get<0>(found);
  const auto at = std::find_if(items.begin(), items.end(),
                               [&](ValueId item) { return is_same(c, item, c.args[0]); });
  return c.values.list({at, items.end()});
}

BuiltinResult find(const BuiltinCall& c) {
  auto found = searched(c);
  if (auto* failure = std::get_if<BuiltinFailure>(&found)) return *failure;
  const auto& items = std::get<0>(found);
  const bool has = std::any_of(items.begin(), items.end(),
                               [&](ValueId item) { return is_same(c, item, c.args[0]); });
  return has ? c.args[0] : c.values.nil();
}

BuiltinResult remove(const BuiltinCall& c) {
  auto found = searched(c);
  if (auto* failure = std::get_if<BuiltinFailure>(&found)) return *failure;
  auto items = std::get<0>(found);
  std::erase_if(items, [&](ValueId item) { return is_same(c, item, c.args[0]); });
  return c.values.list(items);
}

BuiltinResult assoc(const BuiltinCall& c) {
  const auto items = c.values.elements(c.args[1]);
  if (!items) return c.wrong(1, "a list");
  for (const auto item : *items) {
    const auto& pair = c.values[item];
    if (pair.kind == ValueKind::kCons && is_same(c, pair.head, c.args[0])) return item;
  }
  return c.values.nil();
}

constexpr BuiltinEntry kListTable[] = {
    {{"eq", 2, 2}, same<false>},
    {{"eql", 2, 2}, same<false>},
    {{"%same", 2, 2}, same<false>},
    {{"equal", 2, 2}, same<true>},
    {{"null", 1, 1}, is_null},
    {{"not", 1, 1}, is_null},
    {{"identity", 1, 1}, first_argument},
    {{"list", 0, kAnyNumber}, list},
    {{"cons", 2, 2}, cons},
    {{"car", 1, 1}, car},
    {{"cdr", 1, 1}, cdr},
    {{"first", 1, 1}, car},
    {{"rest", 1, 1}, cdr},
    {{"second", 1, 1}, nth_fixed<1>},
    {{"cadr", 1, 1}, nth_fixed<1>},
    {{"third", 1, 1}, nth_fixed<2>},
    {{"caddr", 1, 1}, nth_fixed<2>},
    {{"fourth", 1, 1}, nth_fixed<3>},
    {{"fifth", 1, 1}, nth_fixed<4>},
    {{"nth", 2, 2}, nth},
    {{"length", 1, 1}, length},
    {{"append", 0, kAnyNumber}, append},
    {{"reverse", 1, 1}, reverse},
    {{"member", 2, 2}, member},
    {{"find", 2, 2}, find},
    {{"remove", 2, 2}, remove},
    {{"assoc", 2, 2}, assoc},
};

}  // namespace

std::span<const BuiltinEntry> list_builtins() { return kListTable; }

bool is_same(const BuiltinCall& c, ValueId a, ValueId b) {
  if (!c.values.same(a, b)) return false;
  if (c.values.may_be_two(a, false)) c.values.doubt(kAlike);
  return true;
}

bool is_equal(const BuiltinCall& c, ValueId a, ValueId b) {
  if (!c.values.equal(a, b)) return false;
  if (c.values.may_be_two(a, true)) c.values.doubt(kAlike);
  return true;
}

}  // namespace parallax::compiler
