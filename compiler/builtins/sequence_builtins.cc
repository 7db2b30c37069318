#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "compiler/builtins/builtin_call.h"

namespace parallax::compiler {
namespace {

BuiltinFailure bad(std::string text) { return {BuiltinError::kValue, std::move(text)}; }

/// Argument `index` as a natural number.
std::optional<std::size_t> natural(const BuiltinCall& c, std::size_t index) {
  const auto* number = c.number(index);
  if (number == nullptr || !number->is_integer() || number->numerator() < 0) return std::nullopt;
  return static_cast<std::size_t>(number->numerator());
}

/// [begin, end) of a sequence from arguments 1 and 2; the last one may be left out or nil.
std::variant<std::pair<std::size_t, std::size_t>, BuiltinFailure> bounds(const BuiltinCall& c,
                                                                         std::size_t size) {
  const auto begin = natural(c, 1);
  if (!begin) return c.wrong(1, "a natural number");
  auto end = std::optional(size);
  if (c.args.size() > 2 && !c.values.is_nil(c.args[2])) end = natural(c, 2);
  if (!end) return c.wrong(2, "a natural number");
  if (*begin > *end || *end > size) {
    return bad(fmt::format("from {} to {} is no part of {} elements", *begin, *end, size));
  }
  return std::pair(*begin, *end);
}

BuiltinResult subseq(const BuiltinCall& c) {
  const auto& value = c.values[c.args[0]];
  const auto items = c.values.elements(c.args[0]);
  const bool text = value.kind == ValueKind::kString;
  if (!items && !text) return c.wrong(0, "a list");
  const auto part = bounds(c, text ? value.text.size() : items->size());
  if (const auto* failure = std::get_if<BuiltinFailure>(&part)) return *failure;
  const auto [begin, end] = std::get<0>(part);
  if (text) return c.values.string(std::string(value.text.substr(begin, end - begin)));
  if (begin == 0 && end == items->size()) return c.args[0];
  return c.values.list({items->begin() + static_cast<std::ptrdiff_t>(begin),
                        items->begin() + static_cast<std::ptrdiff_t>(end)});
}

BuiltinResult elt(const BuiltinCall& c) {
  const auto items = c.values.elements(c.args[0]);
  if (!items) return c.wrong(0, "a list");
  const auto at = natural(c, 1);
  if (!at) return c.wrong(1, "a natural number");
  if (*at >= items->size()) return bad(fmt::format("there is no element {}", *at));
  return (*items)[*at];
}

BuiltinResult nthcdr(const BuiltinCall& c) {
  const auto count = natural(c, 0);
  if (!count) return c.wrong(0, "a natural number");
  auto out = c.args[1];
  for (std::size_t i = 0; i < *count && c.values.kind(out) == ValueKind::kCons; ++i) {
    out = c.values[out].tail;
  }
  const auto kind = c.values.kind(out);
  if (kind != ValueKind::kCons && kind != ValueKind::kNil) return c.wrong(1, "a list");
  return out;
}

/// The last `count` elements, or all but those.
BuiltinResult cut(const BuiltinCall& c, bool keep_end) {
  const auto items = c.values.elements(c.args[0]);
  if (!items) return c.wrong(0, "a list");
  const auto count = c.args.size() > 1 ? natural(c, 1) : std::optional<std::size_t>(1);
  if (!count) return c.wrong(1, "a natural number");
  const auto kept = items->size() - std::min(*count, items->size());
  const auto middle = items->begin() + static_cast<std::ptrdiff_t>(kept);
  if (keep_end) return c.values.list({middle, items->end()});
  return c.values.list({items->begin(), middle});
}
BuiltinResult last(const BuiltinCall& c) { return cut(c, true); }
BuiltinResult butlast(const BuiltinCall& c) { return cut(c, false); }

BuiltinResult copy_list(const BuiltinCall& c) {
  if (!c.values.elements(c.args[0])) return c.wrong(0, "a list");
  return c.args[0];  // nothing changes a list
}

/// (list* a b list)
BuiltinResult list_star(const BuiltinCall& c) {
  auto out = c.args.back();
  for (auto i = c.args.size() - 1; i-- > 0;) out = c.values.cons(c.args[i], out);
  return out;
}

BuiltinResult acons(const BuiltinCall& c) {
  return c.values.cons(c.values.cons(c.args[0], c.args[1]), c.args[2]);
}

BuiltinResult adjoin(const BuiltinCall& c) {
  const auto items = c.values.elements(c.args[1]);
  if (!items) return c.wrong(1, "a list");
  const auto is_model = [&](ValueId id) { return c.values.kind(id) == ValueKind::kModel; };
  bool open = is_model(c.args[0]) && !items->empty();
  for (const auto item : *items) {
    if (is_same(c, item, c.args[0])) return c.args[1];
    open = open || is_model(item);
  }
  if (open) return BuiltinFailure{BuiltinError::kModelList, "a search among values of the model"};
  return c.values.cons(c.args[0], c.args[1]);
}

/// (%append-reversed done list): the elements of the list on those that were collected, the last
/// first.
BuiltinResult append_reversed(const BuiltinCall& c) {
  const auto items = c.values.elements(c.args[1]);
  if (!items) return c.wrong(1, "a list");
  auto out = c.args[0];
  for (const auto item : *items) out = c.values.cons(item, out);
  return out;
}

/// (make-list n :initial-element x)
BuiltinResult make_list(const BuiltinCall& c) {
  const auto count = natural(c, 0);
  if (!count || *count > kMaxPlanValues) return c.wrong(0, "a natural number");
  auto element = c.values.nil();
  if (c.args.size() == 3 && c.args[1] == c.values.keyword("initial-element")) {
    element = c.args[2];
  } else if (c.args.size() > 1) {
    return c.wrong(1, "`:initial-element` with a value");
  }
  return c.values.list(std::vector<ValueId>(*count, element));
}

BuiltinResult ensure_list(const BuiltinCall& c) {
  const auto kind = c.values.kind(c.args[0]);
  if (kind == ValueKind::kNil || kind == ValueKind::kCons) return c.args[0];
  return c.values.list({c.args[0]});
}

BuiltinResult reversed(const BuiltinCall& c) {
  auto items = c.values.elements(c.args[0]);
  if (!items) return c.wrong(0, "a list");
  std::reverse(items->begin(), items->end());
  return c.values.list(*items);
}

/// c[ad]{2,4}r: the letters from the last one on.
BuiltinResult walk(const BuiltinCall& c, std::string_view letters) {
  auto at = c.args[0];
  for (auto i = letters.size(); i-- > 0;) {
    const auto& value = c.values[at];
    if (value.kind == ValueKind::kNil) continue;
    if (value.kind != ValueKind::kCons) return c.wrong(0, "a list that is deep enough");
    at = letters[i] == 'a' ? value.head : value.tail;
  }
  return at;
}
BuiltinResult caar(const BuiltinCall& c) { return walk(c, "aa"); }
BuiltinResult cdar(const BuiltinCall& c) { return walk(c, "da"); }
BuiltinResult cddr(const BuiltinCall& c) { return walk(c, "dd"); }
BuiltinResult cdddr(const BuiltinCall& c) { return walk(c, "ddd"); }
BuiltinResult cadar(const BuiltinCall& c) { return walk(c, "ada"); }
BuiltinResult caadr(const BuiltinCall& c) { return walk(c, "aad"); }
BuiltinResult cddar(const BuiltinCall& c) { return walk(c, "dda"); }
BuiltinResult cdadr(const BuiltinCall& c) { return walk(c, "dad"); }
BuiltinResult cadddr(const BuiltinCall& c) { return walk(c, "addd"); }

constexpr BuiltinEntry kSequenceTable[] = {
    {{"subseq", 2, 3}, subseq},
    {{"elt", 2, 2}, elt},
    {{"nthcdr", 2, 2}, nthcdr},
    {{"last", 1, 2}, last},
    {{"butlast", 1, 2}, butlast},
    {{"copy-list", 1, 1}, copy_list},
    {{"copy-tree", 1, 1}, first_argument},
    {{"list*", 1, kAnyNumber}, list_star},
    {{"acons", 3, 3}, acons},
    {{"adjoin", 2, 2}, adjoin},
    {{"make-list", 1, 3}, make_list},
    {{"ensure-list", 1, 1}, ensure_list},
    {{"nreverse", 1, 1}, reversed},
    {{"%append-reversed", 2, 2}, append_reversed},
    {{"caar", 1, 1}, caar},
    {{"cdar", 1, 1}, cdar},
    {{"cddr", 1, 1}, cddr},
    {{"cdddr", 1, 1}, cdddr},
    {{"cadar", 1, 1}, cadar},
    {{"caadr", 1, 1}, caadr},
    {{"cddar", 1, 1}, cddar},
    {{"cdadr", 1, 1}, cdadr},
    {{"cadddr", 1, 1}, cadddr},
};

}  // namespace

std::span<const BuiltinEntry> sequence_builtins() { return kSequenceTable; }

}  // namespace parallax::compiler
