#include "compiler/base/codes/plans.h"
#include "compiler/builtins/designator_links.h"
#include "compiler/interpreter/form_compiler.h"

namespace parallax::compiler {
namespace {

std::optional<DesignatorKind> designator_kind(std::string_view article, std::string_view noun) {
  if (article == "all") {
    if (noun == "object" || noun == "objects") return DesignatorKind::kAllObjects;
    return std::nullopt;
  }
  return designator_class(noun);
}

bool is_article(std::string_view word) { return word == "a" || word == "an" || word == "all"; }

bool is_pose_constructor(std::string_view word) {
  return word.starts_with("make-pose") || word == "make-identity-pose" ||
         word == "pose->pose-stamped";
}

/// Plain symbols stand for themselves; variables and nested designators are evaluated.
void designator_value(FormCompiler& c, DatumId value) {
  if (c.data.is_symbol(value)) {
    const auto& name = c.data.name(value);
    const bool special = name.size() > 2 && name.front() == '*' && name.back() == '*';
    const auto global = c.defined.globals.find(c.data.key(value));
    if (special && global != c.defined.globals.end()) {
      // CRAM's macro takes the value that the global has when the plan is loaded.
      c.code.emit(PlanOp::kLoadGlobal, global->second, 1, value);
      return c.code.adjust(1);
    }
    if (name.front() == '?' || special) return c.compile(value);
    // CRAM makes keywords of plain symbols in a designator.
    if (name == "nil" || name == "t") return c.compile(value);
    return c.code.constant(c.values.keyword(name), value);
  }
  const auto items = c.data.children(value);
  if (items.empty()) return c.code.constant(c.datum_value(value), value);
  const auto head = c.data.head(value).value_or("");
  if (is_article(head) || is_pose_constructor(head) || head == "quote" || head == "quasiquote") {
    return c.compile(value);
  }
  for (const auto item : items) designator_value(c, item);
  c.code.builtin("list", static_cast<std::uint32_t>(items.size()), value);
}

void designator_pair(FormCompiler& c, DatumId pair) {
  const auto parts = c.data.children(pair);
  if (c.data.head(pair) == "when" && parts.size() >= 2) {
    c.compile(parts[1]);
    const auto skip = c.code.jump(PlanOp::kJumpIfNil, pair);
    for (const auto inner : parts.subspan(2)) designator_pair(c, inner);
    c.code.patch_jump(skip);
    return;
  }
  const bool keyed =
      parts.size() == 2 && (c.data.is_symbol(parts[0]) || c.data.is_keyword(parts[0]));
  if (!keyed) return c.malformed(pair, "a property is (key value)");
  designator_value(c, parts[1]);
  c.code.emit(PlanOp::kAddKey, c.code.string_index(c.data.name(parts[0])), 0, pair);
  c.code.adjust(-1);
}

/// (a|an motion|action|object|location (key value)...), (all objects (key value)...).
void form_designator(FormCompiler& c, DatumId form, FormItems items) {
  const bool named = items.size() > 1 && !c.data.is_list(items[1]) &&
                     (c.data.is_symbol(items[1]) || c.data.is_keyword(items[1]));
  const auto kind =
      named ? designator_kind(c.data.name(items[0]), c.data.name(items[1])) : std::nullopt;
  if (!kind) {
    return c.refuse(form, "expected motion, action, object or location");
  }
  if (*kind == DesignatorKind::kAllObjects) {
    c.warning(codes::kAllDesignator, form);
  }
  c.code.emit(PlanOp::kDesignator, static_cast<std::uint32_t>(*kind), 0, form);
  c.code.adjust(1);
  for (const auto pair : items.subspan(2)) designator_pair(c, pair);
}

void form_perform(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() != 2) {
    return c.refuse(form, "expected one designator");
  }
  c.compile(items[1]);
  c.code.emit(PlanOp::kPerform, 0, 0, form);
}

}  // namespace

std::span<const FormEntry> designator_forms() {
  static constexpr FormEntry kForms[] = {
      {"a", form_designator},
      {"an", form_designator},
      {"all", form_designator},
      {"perform", form_perform},
  };
  return kForms;
}

}  // namespace parallax::compiler
