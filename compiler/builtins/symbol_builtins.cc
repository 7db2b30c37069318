// Names and texts. Lisp folds what is written in a plan to upper case, this program to lower case;
// what a plan sees of a name as a text is what Lisp would show.
#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

#include "compiler/base/ascii.h"
#include "compiler/builtins/builtin_call.h"

namespace parallax::compiler {
namespace {

std::string upper(std::string text) {
  for (auto& letter : text) {
    if (letter >= 'a' && letter <= 'z') letter = static_cast<char>(letter - 'a' + 'A');
  }
  return text;
}

std::string lower(std::string text) {
  for (auto& letter : text) letter = base::to_lower(letter);
  return text;
}

bool has_upper(std::string_view text) {
  return std::any_of(text.begin(), text.end(), [](char c) { return base::is_upper(c); });
}

/// The name of a symbol as Lisp shows it. One with a capital was written between bars.
std::string shown(std::string_view name) {
  if (name.starts_with("#:")) name.remove_prefix(2);
  return has_upper(name) ? std::string(name) : upper(std::string(name));
}

/// The name that a symbol has here if Lisp calls it `text`.
std::string folded_text(const std::string& text) {
  const bool mixed =
      std::any_of(text.begin(), text.end(), [](char c) { return c >= 'a' && c <= 'z'; });
  return mixed ? text : lower(text);
}

/// A string, or the name of a symbol.
std::optional<std::string> text_of(const BuiltinCall& c, std::size_t index) {
  const auto& value = c.values[c.args[index]];
  if (value.kind == ValueKind::kString) return value.text;
  if (value.kind == ValueKind::kSymbol) return shown(value.text);
  if (value.kind == ValueKind::kNil) return "NIL";
  return std::nullopt;
}

ValueId symbol_called(const BuiltinCall& c, const std::string& text) {
  const auto name = folded_text(text);
  return name == "nil" ? c.values.nil() : c.values.symbol(name);
}

BuiltinResult symbol_name(const BuiltinCall& c) {
  const auto kind = c.values.kind(c.args[0]);
  const auto text = text_of(c, 0);
  if (!text || kind == ValueKind::kString) return c.wrong(0, "a symbol");
  return c.values.string(*text);
}

BuiltinResult string_of(const BuiltinCall& c) {
  const auto text = text_of(c, 0);
  if (!text) return c.wrong(0, "a string or a symbol");
  return c.values.string(*text);
}

/// (intern "NAME"), (intern "NAME" :keyword); another package gives the plain symbol.
BuiltinResult intern(const BuiltinCall& c) {
  const auto& value = c.values[c.args[0]];
  if (value.kind != ValueKind::kString) return c.wrong(0, "a string");
  const auto package = c.args.size() > 1 ? text_of(c, 1) : std::optional<std::string>("");
  if (!package) return c.wrong(1, "the name of a package");
  if (lower(*package) == "keyword") return c.values.keyword(folded_text(value.text));
  return symbol_called(c, value.text);
}

BuiltinResult make_keyword(const BuiltinCall& c) {
  const auto text = text_of(c, 0);
  if (!text) return c.wrong(0, "a string or a symbol");
  return c.values.keyword(folded_text(*text));
}

BuiltinResult gensym(const BuiltinCall& c) {
  const auto prefix = c.args.empty() ? std::optional<std::string>("g") : text_of(c, 0);
  return c.values.gensym(lower(prefix.value_or("g")));
}

template <bool kFold>
BuiltinResult equal_texts(const BuiltinCall& c) {
  auto left = text_of(c, 0);
  auto right = text_of(c, 1);
  if (!left) return c.wrong(0, "a string or a symbol");
  if (!right) return c.wrong(1, "a string or a symbol");
  if (kFold) return c.values.boolean(lower(*left) == lower(*right));
  return c.values.boolean(*left == *right);
}

template <std::string (*kChange)(std::string)>
BuiltinResult change_case(const BuiltinCall& c) {
  const auto text = text_of(c, 0);
  if (!text) return c.wrong(0, "a string or a symbol");
  return c.values.string(kChange(*text));
}

/// Words begin with a capital.
std::string capitalized(std::string text) {
  bool inside = false;
  for (auto& letter : text) {
    const auto small = base::to_lower(letter);
    const bool in_word = (small >= 'a' && small <= 'z') || (small >= '0' && small <= '9');
    letter = in_word && !inside ? upper(std::string(1, small)).front() : small;
    inside = in_word;
  }
  return text;
}

/// (string-trim characters text), and of one end only.
template <bool kLeft, bool kRight>
BuiltinResult trim(const BuiltinCall& c) {
  const auto& characters = c.values[c.args[0]];
  if (characters.kind != ValueKind::kString) return c.wrong(0, "a string of characters");
  auto text = text_of(c, 1);
  if (!text) return c.wrong(1, "a string or a symbol");
  if (kRight) text->erase(text->find_last_not_of(characters.text) + 1);
  if (kLeft) text->erase(0, text->find_first_not_of(characters.text));
  return c.values.string(*text);
}

/// (string< a b) and its like: where they differ first, if they stand in that order.
template <bool kLess>
BuiltinResult ordered_texts(const BuiltinCall& c) {
  const auto left = text_of(c, 0);
  const auto right = text_of(c, 1);
  if (!left) return c.wrong(0, "a string or a symbol");
  if (!right) return c.wrong(1, "a string or a symbol");
  if (!(kLess ? *left < *right : *left > *right)) return c.values.nil();
  const auto length = std::min(left->size(), right->size());
  const auto [at, other] = std::mismatch(
      left->begin(), left->begin() + static_cast<std::ptrdiff_t>(length), right->begin());
  return c.values.number(Number(at - left->begin()));
}

/// (parse-integer text): a Lisp error if it is none.
BuiltinResult parse_integer(const BuiltinCall& c) {
  const auto& text = c.values[c.args[0]];
  if (text.kind != ValueKind::kString) return c.wrong(0, "a string");
  // Blanks around the digits do not count; other spellings of numbers do not belong to it.
  constexpr std::string_view kBlanks = " \t\n\r\f";
  std::string_view digits = text.text;
  digits.remove_prefix(std::min(digits.find_first_not_of(kBlanks), digits.size()));
  digits = digits.substr(0, digits.find_last_not_of(kBlanks) + 1);
  const auto first = digits.substr(digits.starts_with('-') || digits.starts_with('+') ? 1 : 0);
  const bool whole = !first.empty() && first.find_first_not_of("0123456789") == first.npos;
  Number number;
  if (!whole || Number::parse(digits, number) != Number::Parse::kNumber || !number.is_integer()) {
    return BuiltinFailure{BuiltinError::kRaise, "simple-error"};
  }
  return c.values.number(number);
}

/// (concatenate 'string a b ...), (concatenate 'list a b ...)
BuiltinResult concatenate(const BuiltinCall& c) {
  const auto& type = c.values[c.args[0]];
  if (type.kind == ValueKind::kSymbol && type.text == "list") {
    std::vector<ValueId> all;
    for (std::size_t i = 1; i < c.args.size(); ++i) {
      const auto items = c.values.elements(c.args[i]);
      if (!items) return c.wrong(i, "a list");
      all.insert(all.end(), items->begin(), items->end());
    }
    return c.values.list(all);
  }
  if (type.kind != ValueKind::kSymbol || (type.text != "string" && type.text != "simple-string")) {
    return c.wrong(0, "`string` or `list`");
  }
  std::string out;
  for (std::size_t i = 1; i < c.args.size(); ++i) {
    const auto& part = c.values[c.args[i]];
    if (part.kind != ValueKind::kString) return c.wrong(i, "a string");
    out += part.text;
    if (out.size() > kMaxPlanText) break;  // the store is full with this one, and the plan ends
  }
  return c.values.string(out);
}

/// As `princ` or, with `exact`, as `prin1` shows it; false for what only the model knows and the
/// like. Texts double with each level of a shared list: no more than kMost is written.
constexpr std::size_t kMost = 10000;
bool show(const BuiltinCall& c, ValueId id, bool exact, std::string& out, int depth = 0) {
  const auto& value = c.values[id];
  if (out.size() > kMost || depth > 100) return false;
  switch (value.kind) {
    case ValueKind::kNil:
      out += "NIL";
      return true;
    case ValueKind::kSymbol:
      if (exact && value.keyword) out += ':';
      out += shown(value.text);
      return true;
    case ValueKind::kString:
      out += exact ? fmt::format("\"{}\"", value.text) : value.text;
      return true;
    case ValueKind::kNumber: {
      out += value.number.to_string();
      return true;
    }
    case ValueKind::kFailure:
      out += upper(value.text);
      return true;
    case ValueKind::kCons:
      break;
    case ValueKind::kVector:
    case ValueKind::kQuaternion:
    case ValueKind::kPose:
    case ValueKind::kDesignator:
    case ValueKind::kModel:
    case ValueKind::kCounter:
    case ValueKind::kNotGiven:
    case ValueKind::kFurther:
    case ValueKind::kTransform:
    case ValueKind::kUnknown:
    case ValueKind::kFunction:
    case ValueKind::kValues:
    case ValueKind::kCell:
    case ValueKind::kNetwork:
      return false;
  }
  out += '(';
  auto at = id;
  for (; c.values.kind(at) == ValueKind::kCons; at = c.values[at].tail) {
    if (at != id) out += ' ';
    if (!show(c, c.values[at].head, exact, out, depth + 1)) return false;
  }
  if (!c.values.is_nil(at)) {
    out += " . ";
    if (!show(c, at, exact, out, depth + 1)) return false;
  }
  out += ')';
  return true;
}

/// (%format "text" value...): ~a ~s ~d ~% ~& ~~ ~( ~); a directive that has nothing to show stays.
BuiltinResult format(const BuiltinCall& c) {
  const auto& pattern = c.values[c.args[0]].text;
  std::string out;
  constexpr auto kNone = std::string::npos;
  std::size_t folded_from = kNone;
  std::size_t next = 1;
  for (std::size_t i = 0; i < pattern.size() && out.size() <= kMost; ++i) {
    if (pattern[i] != '~' || i + 1 == pattern.size()) {
      out += pattern[i];
      continue;
    }
    const char word = base::to_lower(pattern[++i]);
    if (word == '%' || word == '&') {
      if (word == '%' || (!out.empty() && out.back() != '\n')) out += '\n';
    } else if (word == '~') {
      out += '~';
    } else if (word == '(') {
      folded_from = out.size();
    } else if (word == ')' && folded_from != kNone) {
      out = out.substr(0, folded_from) + lower(out.substr(folded_from));
      folded_from = kNone;
    } else if ((word == 'a' || word == 's' || word == 'd') && next < c.args.size()) {
      std::string part;
      const bool known = show(c, c.args[next++], word == 's', part);
      out += known ? part : fmt::format("~{}", pattern[i]);
    } else {
      out += fmt::format("~{}", pattern[i]);
    }
  }
  return c.values.string(out);
}

template <bool kExact>
BuiltinResult to_text(const BuiltinCall& c) {
  std::string out;
  if (!show(c, c.args[0], kExact, out)) return c.wrong(0, "something with a text");
  return c.values.string(out);
}

constexpr BuiltinEntry kSymbolTable[] = {
    {{"symbol-name", 1, 1}, symbol_name},
    {{"string", 1, 1}, string_of},
    {{"intern", 1, 2}, intern},
    {{"make-symbol", 1, 1}, gensym},
    {{"make-keyword", 1, 1}, make_keyword},
    {{"gensym", 0, 1}, gensym},
    {{"string=", 2, 2}, equal_texts<false>},
    {{"string-equal", 2, 2}, equal_texts<true>},
    {{"string-upcase", 1, 1}, change_case<upper>},
    {{"string-downcase", 1, 1}, change_case<lower>},
    {{"string-capitalize", 1, 1}, change_case<capitalized>},
    {{"string-trim", 2, 2}, trim<true, true>},
    {{"string-left-trim", 2, 2}, trim<true, false>},
    {{"string-right-trim", 2, 2}, trim<false, true>},
    {{"string<", 2, 2}, ordered_texts<true>},
    {{"string>", 2, 2}, ordered_texts<false>},
    {{"parse-integer", 1, 1}, parse_integer},
    {{"concatenate", 1, kAnyNumber}, concatenate},
    {{"%format", 1, kAnyNumber}, format},
    {{"princ-to-string", 1, 1}, to_text<false>},
    {{"prin1-to-string", 1, 1}, to_text<true>},
};

}  // namespace

std::span<const BuiltinEntry> symbol_builtins() { return kSymbolTable; }

}  // namespace parallax::compiler
