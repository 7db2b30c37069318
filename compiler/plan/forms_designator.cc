#include <fmt/core.h>

#include <utility>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/plan/plan_compiler.h"

namespace parallax::compiler {
namespace {

using base::DiagnosticCode;

std::optional<DesignatorKind> designator_kind(std::string_view article, std::string_view noun) {
  if (article == "all") {
    if (noun == "object" || noun == "objects") return DesignatorKind::kAllObjects;
    return std::nullopt;
  }
  if (noun == "motion") return DesignatorKind::kMotion;
  if (noun == "action") return DesignatorKind::kAction;
  if (noun == "object") return DesignatorKind::kObject;
  if (noun == "location") return DesignatorKind::kLocation;
  return std::nullopt;
}

bool is_article(std::string_view word) { return word == "a" || word == "an" || word == "all"; }

bool is_pose_constructor(std::string_view word) {
  return word.starts_with("make-pose") || word == "make-identity-pose" ||
         word == "pose->pose-stamped";
}

}  // namespace

/// (a|an motion|action|object|location (key value)...), (all objects (key value)...).
void PlanCompiler::form_designator(DatumId form, Items items) {
  const bool named = items.size() > 1 && !data_.is_list(items[1]) &&
                     (data_.is_symbol(items[1]) || data_.is_keyword(items[1]));
  const auto kind =
      named ? designator_kind(data_.name(items[0]), data_.name(items[1])) : std::nullopt;
  if (!kind) {
    malformed(form, "expected motion, action, object or location");
    return emit_constant(values_.nil(), form);
  }
  if (*kind == DesignatorKind::kAllObjects) {
    sink_.warning(DiagnosticCode::kAllDesignator, data_.source(form));
  }
  emit(PlanOp::kDesignator, static_cast<std::uint32_t>(*kind), 0, form);
  adjust(1);
  for (const auto pair : items.subspan(2)) designator_pair(pair);
}

void PlanCompiler::designator_pair(DatumId pair) {
  const auto parts = data_.children(pair);
  if (data_.head(pair) == "when" && parts.size() >= 2) {
    compile(parts[1]);
    const auto skip = emit_jump(PlanOp::kJumpIfNil, pair);
    for (const auto inner : parts.subspan(2)) designator_pair(inner);
    patch_jump(skip);
    return;
  }
  const bool keyed = parts.size() == 2 && (data_.is_symbol(parts[0]) || data_.is_keyword(parts[0]));
  if (!keyed) return malformed(pair, "a property is (key value)");
  designator_value(parts[1]);
  emit(PlanOp::kAddKey, string_index(data_.name(parts[0])), 0, pair);
  adjust(-1);
}

/// Plain symbols stand for themselves; variables and nested designators are evaluated.
void PlanCompiler::designator_value(DatumId value) {
  if (data_.is_symbol(value)) {
    const auto& name = data_.name(value);
    const bool special = name.size() > 2 && name.front() == '*' && name.back() == '*';
    if (name.front() == '?' || special) return compile(value);
    return emit_constant(datum_value(value), value);
  }
  const auto items = data_.children(value);
  if (items.empty()) return emit_constant(datum_value(value), value);
  const auto head = data_.head(value).value_or("");
  if (is_article(head) || is_pose_constructor(head) || head == "quote" || head == "quasiquote") {
    return compile(value);
  }
  for (const auto item : items) designator_value(item);
  emit_builtin("list", static_cast<std::uint32_t>(items.size()), value);
}

void PlanCompiler::form_perform(DatumId form, Items items) {
  if (items.size() != 2) {
    malformed(form, "expected one designator");
    return emit_constant(values_.nil(), form);
  }
  compile(items[1]);
  emit(PlanOp::kPerform, 0, 0, form);
}

}  // namespace parallax::compiler
