#include <set>
#include <string_view>

#include "compiler/interpreter/form_compiler.h"
#include "compiler/interpreter/lisp_macros.h"

namespace parallax::compiler {
namespace {

bool is_comma(std::string_view head) { return head == "unquote" || head == "unquote-splicing"; }

using DatumSet = std::set<std::uint32_t>;

/// The lists of a template that depend on something. Nested backquotes count as if they did.
bool find_open(const LispData& data, DatumId datum, DatumSet& open) {
  bool found = is_comma(data.head(datum).value_or(""));
  for (const auto item : data.children(datum)) found = find_open(data, item, open) || found;
  if (found) open.insert(datum.index());
  return found;
}

void form_quote(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() != 2) c.malformed(form, "expected one datum");
  c.code.constant(items.size() == 2 ? c.quoted_value(items[1]) : c.values.nil(), form);
}

/// Pushes the value of the template `datum`, which has `depth` backquotes around it. A list of a
/// macro's text remembers its place.
void quasiquote(FormCompiler& c, DatumId datum, int depth, const DatumSet& open) {
  const auto items = c.data.children(datum);
  if (!open.contains(datum.index())) return c.code.constant(c.quoted_value(datum), datum);
  const auto head = c.data.head(datum).value_or("");
  if (depth == 1 && is_comma(head)) {
    if (head == "unquote" && items.size() == 2) return c.compile(items[1]);
    return c.refuse(datum, "`,@` stands for the parts of a list, in a list");
  }
  const auto inner = head == "quasiquote" ? depth + 1 : (is_comma(head) ? depth - 1 : depth);
  const bool dotted = c.data.is_dotted(datum);
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const auto parts = c.data.children(items[i]);
    const auto word = c.data.head(items[i]).value_or("");
    ++count;
    if (dotted && i + 1 == items.size()) {
      quasiquote(c, items[i], inner, open);
    } else if (inner == 1 && is_comma(word)) {
      // (unquote a b), which an inner `,,@` makes, stands for both.
      if (parts.size() < 2) c.malformed(items[i], "expected a form");
      for (std::size_t part = 1; part < parts.size(); ++part) {
        c.compile(parts[part]);
        if (word == "unquote") c.code.builtin("list", 1, items[i]);
        if (part > 1) ++count;
      }
      if (parts.size() < 2) c.nil(items[i]);
    } else {
      quasiquote(c, items[i], inner, open);
      c.code.builtin("list", 1, items[i]);
    }
  }
  c.code.builtin("append", count, datum);
  if (c.in_macro) c.code.emit(PlanOp::kStamp, datum.index(), 0, datum);
}

void form_quasiquote(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() != 2) return c.refuse(form, "expected one datum");
  DatumSet open;
  find_open(c.data, items[1], open);
  quasiquote(c, items[1], 1, open);
}

}  // namespace

std::span<const FormEntry> quotation_forms() {
  static constexpr FormEntry kForms[] = {
      {"quote", form_quote},
      {"quasiquote", form_quasiquote},
  };
  return kForms;
}

}  // namespace parallax::compiler
