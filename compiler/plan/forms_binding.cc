#include <fmt/core.h>

#include <utility>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/plan/plan_compiler.h"

namespace parallax::compiler {
using base::DiagnosticCode;

/// Quoted data as a value.
ValueId PlanCompiler::datum_value(DatumId datum) {
  switch (data_[datum].kind) {
    case DatumKind::kSymbol:
      return data_.is_nil(datum) ? values_.nil() : values_.symbol(data_.name(datum));
    case DatumKind::kKeyword:
      return values_.symbol(data_.name(datum));
    case DatumKind::kNumber:
      return values_.number(data_.number(datum));
    case DatumKind::kString:
      return values_.string(data_.name(datum));
    case DatumKind::kCharacter:
      unsupported(datum, "characters have no use in a plan");
      return values_.nil();
    case DatumKind::kList: {
      std::vector<ValueId> items;
      for (const auto item : data_.children(datum)) items.push_back(datum_value(item));
      return values_.list(items);
    }
  }
  return values_.nil();
}

void PlanCompiler::form_quote(DatumId form, Items items) {
  if (items.size() != 2) malformed(form, "expected one datum");
  emit_constant(items.size() == 2 ? datum_value(items[1]) : values_.nil(), form);
}

void PlanCompiler::form_quasiquote(DatumId form, Items items) {
  if (items.size() == 2) return quasiquote(items[1]);
  malformed(form, "expected one datum");
  emit_constant(values_.nil(), form);
}

void PlanCompiler::quasiquote(DatumId datum) {
  const auto items = data_.children(datum);
  const auto head = data_.head(datum).value_or("");
  if (items.empty()) return emit_constant(datum_value(datum), datum);
  if (head == "unquote" && items.size() == 2) return compile(items[1]);
  if (head == "quasiquote") {
    unsupported(datum, "nested backquotes");
    return emit_constant(values_.nil(), datum);
  }
  for (const auto item : items) {
    const auto parts = data_.children(item);
    if (data_.head(item) == "unquote-splicing" && parts.size() == 2) {
      compile(parts[1]);
    } else {
      quasiquote(item);
      emit_builtin("list", 1, item);
    }
  }
  emit_builtin("append", static_cast<std::uint32_t>(items.size()), datum);
}

void PlanCompiler::form_let(DatumId form, Items items) { let(form, items, false); }
void PlanCompiler::form_let_star(DatumId form, Items items) { let(form, items, true); }

void PlanCompiler::let(DatumId form, Items items, bool sequential) {
  if (items.size() < 2 || (!data_.is_list(items[1]) && !data_.is_nil(items[1]))) {
    malformed(form, "expected a list of bindings");
    return emit_constant(values_.nil(), form);
  }
  const auto scope = scope_.size();
  std::vector<LexicalBinding> bound;
  const auto depth = static_cast<std::uint32_t>(frames_.size() - 1);
  std::uint32_t count = 0;
  for (const auto binding : data_.children(items[1])) {
    const auto parts = data_.children(binding);
    const auto name = parts.empty() ? binding : parts.front();
    if (!data_.is_symbol(name) || parts.size() > 2) {
      malformed(form, "a binding is a name or (name value)");
      continue;
    }
    if (parts.size() == 2) {
      compile(parts[1]);
    } else {
      emit_constant(values_.nil(), binding);
    }
    ++count;
    bound.push_back({BindingKind::kVariable, data_.name(name), depth, frame().height - 1});
    if (sequential) scope_.push_back(bound.back());
  }
  if (!sequential) scope_.insert(scope_.end(), bound.begin(), bound.end());
  compile_body(skip_declarations(items.subspan(2)));
  emit(PlanOp::kSqueeze, count, 0, form);
  adjust(-static_cast<int>(count));
  scope_.resize(scope);
}

/// The lexical variable that a form may change, or a report of why it may not.
const PlanCompiler::LexicalBinding* PlanCompiler::assignable(DatumId form, DatumId place) {
  if (data_.is_symbol(place) && !data_.is_nil(place)) {
    if (const auto* binding = lookup(BindingKind::kVariable, data_.name(place))) return binding;
    if (!globals_.contains(data_.name(place))) {
      compile_symbol(place);  // reports it
      emit(PlanOp::kPop, 0, 0, place);
      adjust(-1);
      return nullptr;
    }
  }
  failed_ = true;
  auto error = sink_.error(DiagnosticCode::kHeapWrite, data_.source(place), form_name(form),
                           print_datum(data_, place));
  if (const auto global = globals_.find(data_.is_symbol(place) ? data_.name(place) : "");
      global != globals_.end()) {
    error.note(data_.source(code_.globals[global->second].source),
               "it is a global constant, defined here");
  }
  return nullptr;
}

void PlanCompiler::form_setf(DatumId form, Items items) {
  if (items.size() % 2 == 0) malformed(form, "expected pairs of a place and a value");
  if (items.size() < 3) return emit_constant(values_.nil(), form);
  for (std::size_t i = 1; i + 1 < items.size(); i += 2) {
    if (i > 1) {
      emit(PlanOp::kPop, 0, 0, form);
      adjust(-1);
    }
    compile(items[i + 1]);
    const auto* target = assignable(form, items[i]);
    if (target != nullptr) emit_variable(PlanOp::kStore, *target, form);
  }
}

void PlanCompiler::form_incf(DatumId form, Items items) {
  if (items.size() < 2 || items.size() > 3) {
    malformed(form, "expected a variable and perhaps a step");
    return emit_constant(values_.nil(), form);
  }
  const auto* target = assignable(form, items[1]);
  if (target == nullptr) return emit_constant(values_.nil(), form);
  const LexicalBinding place = *target;  // compiling may grow the scope
  emit_variable(PlanOp::kLoad, place, form);
  if (items.size() == 3) {
    compile(items[2]);
  } else {
    emit_constant(values_.number(Number(1)), form);
  }
  emit_builtin(form_name(form) == "decf" ? "-" : "+", 2, form);
  emit_variable(PlanOp::kStore, place, form);
}

void PlanCompiler::form_push(DatumId form, Items items) {
  if (items.size() != 3) {
    malformed(form, "expected a value and a variable");
    return emit_constant(values_.nil(), form);
  }
  compile(items[1]);
  const auto* target = assignable(form, items[2]);
  if (target == nullptr) return;
  const LexicalBinding place = *target;
  emit_variable(PlanOp::kLoad, place, form);
  emit_builtin("cons", 2, form);
  emit_variable(PlanOp::kStore, place, form);
}

/// Binds the names of `pattern` to the elements of the list at `place`; the new variables stay on
/// the stack.
void PlanCompiler::destructure(DatumId form, DatumId pattern, std::uint32_t place) {
  const auto items = data_.children(pattern);
  emit_local(PlanOp::kLoad, place, form);
  emit_constant(values_.number(Number(static_cast<std::int64_t>(items.size()))), form);
  emit_builtin("%expect-length", 2, form);
  store_and_drop(place, form);
  for (std::size_t i = 0; i < items.size(); ++i) {
    emit_constant(values_.number(Number(static_cast<std::int64_t>(i))), form);
    emit_local(PlanOp::kLoad, place, form);
    emit_builtin("nth", 2, form);
    if (data_.is_list(items[i])) {
      destructure(form, items[i], frame().height - 1);
    } else if (data_.is_symbol(items[i]) && !data_.name(items[i]).starts_with("&")) {
      bind_variable(data_.name(items[i]));
    } else {
      unsupported(items[i], "a pattern consists of names");
    }
  }
}

void PlanCompiler::form_destructuring_bind(DatumId form, Items items) {
  if (items.size() < 3 || !data_.is_list(items[1])) {
    malformed(form, "expected a pattern and a list");
    return emit_constant(values_.nil(), form);
  }
  const auto scope = scope_.size();
  const auto height = frame().height;
  compile(items[2]);
  emit(PlanOp::kExpectList, 0, 0, form);
  destructure(form, items[1], height);
  compile_body(skip_declarations(items.subspan(3)));
  const auto count = frame().height - 1 - height;
  emit(PlanOp::kSqueeze, count, 0, form);
  adjust(-static_cast<int>(count));
  scope_.resize(scope);
}

}  // namespace parallax::compiler
