#include "compiler/plan/form_compiler.h"

#include <fmt/core.h>

#include <utility>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/suggest.h"
#include "compiler/plan/function_calls.h"

namespace parallax::compiler {

using base::DiagnosticCode;

const std::map<std::string_view, FormFunction>& plan_forms() {
  static const auto table = [] {
    std::map<std::string_view, FormFunction> out;
    for (const auto part : {binding_forms(), control_forms(), loop_forms(), failure_forms(),
                            try_forms(), designator_forms(), call_forms()}) {
      for (const auto& entry : part) out.emplace(entry.name, entry.compile);
    }
    return out;
  }();
  return table;
}

void FormCompiler::compile(DatumId form) {
  switch (data[form].kind) {
    case DatumKind::kSymbol:
      return compile_symbol(form);
    case DatumKind::kKeyword:
    case DatumKind::kNumber:
    case DatumKind::kString:
    case DatumKind::kCharacter:
      return code.constant(datum_value(form), form);
    case DatumKind::kList:
      return compile_list(form);
  }
}

void FormCompiler::compile_symbol(DatumId symbol) {
  const auto& name = data.name(symbol);
  if (name == "nil" || name == "t") return code.constant(datum_value(symbol), symbol);
  if (const auto* binding = code.lookup(BindingKind::kVariable, name)) {
    return code.load(*binding, symbol);
  }
  if (const auto global = defined.globals.find(name); global != defined.globals.end()) {
    code.emit(PlanOp::kLoadGlobal, global->second, 0, symbol);
    return code.adjust(1);
  }
  std::vector<std::string> names;
  for (const auto& binding : code.scope()) {
    if (binding.kind == BindingKind::kVariable) names.push_back(binding.name);
  }
  for (const auto& [global, index] : defined.globals) names.push_back(global);
  auto report = error(DiagnosticCode::kUnboundPlanVariable, symbol, name);
  if (const auto near = base::nearest_name(name, names)) {
    report.fix(fmt::format("replace `{}` with `{}`", name, *near));
  }
  nil(symbol);
}

void FormCompiler::compile_list(DatumId form) {
  const auto items = data.children(form);
  if (items.empty()) return nil(form);
  const auto head = data.head(form);
  if (!head) {
    return refuse(form, "a form starts with a name");
  }
  if (const auto callee = find_callee(*this, *head); callee && callee->function != nullptr) {
    return compile_call(*this, form, *head, *callee, items.subspan(1));
  }
  const auto known = plan_forms().find(*head);
  if (known != plan_forms().end()) {
    const auto height = code.height();
    known->second(*this, form, items);
    PARALLAX_ASSERT(failed_ || code.height() == height + 1);
    // A form that reported an error may have stopped half-way; what follows is
    // still checked.
    code.set_height(height + 1);
    return;
  }
  if (const auto callee = find_callee(*this, *head))
    return compile_call(*this, form, *head, *callee, items.subspan(1));
  if (head->starts_with("check-") && head->ends_with("-collisions")) {
    warning(DiagnosticCode::kProjectionIgnored, form, form_name(form));
    check_no_perform(form);
    return nil(form);
  }
  unknown_form(form, *head);
  nil(form);
}

void FormCompiler::compile_body(FormItems body) {
  if (body.empty()) return nil(text_.forms.front());
  for (std::size_t i = 0; i < body.size(); ++i) {
    compile(body[i]);
    if (i + 1 == body.size()) return;
    code.drop(body[i]);
  }
}

ValueId FormCompiler::datum_value(DatumId datum) {
  switch (data[datum].kind) {
    case DatumKind::kSymbol:
      return data.is_nil(datum) ? values.nil() : values.symbol(data.name(datum));
    case DatumKind::kKeyword:
      return values.symbol(data.name(datum));
    case DatumKind::kNumber:
      return values.number(data.number(datum));
    case DatumKind::kString:
      return values.string(data.name(datum));
    case DatumKind::kCharacter:
      unsupported(datum, "characters have no use in a plan");
      return values.nil();
    case DatumKind::kList: {
      std::vector<ValueId> items;
      for (const auto item : data.children(datum)) items.push_back(datum_value(item));
      return values.list(items);
    }
  }
  return values.nil();
}

FormItems FormCompiler::skip_declarations(FormItems body) const {
  while (!body.empty()) {
    const bool docstring = data.is_string(body.front()) && body.size() > 1;
    if (!docstring && data.head(body.front()) != "declare") break;
    body = body.subspan(1);
  }
  return body;
}

std::optional<std::string> FormCompiler::failure_class(DatumId datum) {
  if (data.head(datum) == "quote" && data[datum].count == 2) datum = data.children(datum)[1];
  if (!data.is_symbol(datum)) {
    malformed(datum, "expected the name of a failure class");
    return std::nullopt;
  }
  if (auto known = code.code().classes.canonical(data.name(datum))) return known;
  const auto names = code.code().classes.names();
  auto report = error(DiagnosticCode::kUnknownFailureClass, datum, data.name(datum));
  if (const auto near = base::nearest_name(data.name(datum), names, 4)) {
    report.fix(fmt::format("replace `{}` with `{}`", data.name(datum), *near));
  }
  return std::nullopt;
}

}  // namespace parallax::compiler
