#include "compiler/interpreter/form_compiler.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "compiler/base/codes/plans.h"
#include "compiler/base/suggest.h"
#include "compiler/builtins/plan_builtins.h"
#include "compiler/builtins/unknown_values.h"
#include "compiler/interpreter/function_calls.h"
#include "compiler/interpreter/lisp_macros.h"
#include "compiler/interpreter/plan_machine.h"
#include "compiler/interpreter/variables.h"
#include "compiler/interpreter/world_forms.h"

namespace parallax::compiler {

namespace {

constexpr std::size_t kMaxSuggestions = 50;

struct Hint {
  std::string_view form;
  std::string_view text;
};

/// Reactive forms and how to write it instead.
constexpr Hint kReactive[] = {
    {"partial-order", "write the steps in one of the orders, in a `seq`"},
    {"with-policy", "write the body alone, in a `progn`, and check the policy after its performs"},
    {"with-policies", "write the body alone, in a `progn`, and check them after its performs"},
    {"with-named-policy", "write the body alone, in a `progn`, and check it after its performs"},
    {"with-named-policies",
     "write the body alone, in a `progn`, and check them after its performs"},
    {"suspend", "leave it out: tasks are no values here"},
    {"wake-up", "leave it out: tasks are no values here"},
    {"evaporate", "let the branch of a `pursue` end or fail, which ends the others"},
    {"with-task-suspended", "write the body alone, in a `progn`"},
    {"with-task", "write the body alone, in a `progn`"},
    {"fl-funcall", "write the function on fluents: `fl-and`, `fl-or`, `fl-not`, `fl<` ..."},
    {"fl-pulsed", "wait for the fluent's value"},
    {"pulsed", "wait for the fluent's value"},
};

constexpr Hint kRejected[] = {
    {"defstruct", "structures are defined at top level"},
    {"defclass", "classes are defined at top level"},
    {"defmethod", "methods are defined at top level"},
    {"defgeneric", "generic functions are defined at top level"},
    {"call-next-method", "write the other method's body out"},
    {"catch", "use `block`"},
    {"throw", "use `return-from`"},
    {"restart-case", "use `block`: a handler may leave it by `return-from`"},
    {"with-simple-restart", "use `block`: a handler may leave it by `return-from`"},
    {"restart-bind", "use `flet`: a handler may call the function"},
    {"invoke-restart", "use `return-from` with a `block` in place of the restart"},
    {"find-restart", "use `return-from` with a `block` in place of the restart"},
    {"unquote", "a comma needs a backquote around it"},
    {"unquote-splicing", "a comma needs a backquote around it"},
    {"defmacro", "macros are defined at top level; use `macrolet`"},
    {"define-compiler-macro", "leave it out; it changes nothing"},
    {"symbol-macrolet", "write the form out"},
    {"define-symbol-macro", "write the form out"},
    {"defun", "functions are defined at top level"},
    {"def-cram-function", "functions are defined at top level"},
    {"def-top-level-cram-function", "functions are defined at top level"},
    {"defparameter", "global constants are defined at top level"},
    {"defvar", "global constants are defined at top level"},
    {"defconstant", "global constants are defined at top level"},
    {"define-condition", "failure classes are defined at top level"},
};

template <std::size_t kSize>
const Hint* find_hint(const Hint (&table)[kSize], std::string_view form) {
  for (const auto& hint : table) {
    if (hint.form == form) return &hint;
  }
  return nullptr;
}

/// Does a variable or a pattern of variables follow this word of `loop`?
bool is_loop_variable(std::string_view word) {
  return word == "for" || word == "as" || word == "with" || word == "and";
}

}  // namespace

const std::map<std::string_view, FormFunction>& plan_forms() {
  static const auto table = [] {
    std::map<std::string_view, FormFunction> out;
    for (const auto part :
         {binding_forms(), quotation_forms(), value_forms(), control_forms(), loop_forms(),
          loop_form(), mapping_forms(), failure_forms(), type_forms(), designator_forms(),
          prolog_forms(), call_forms(), local_forms(), world_forms()}) {
      for (const auto& entry : part) out.emplace(entry.name, entry.compile);
    }
    return out;
  }();
  return table;
}

FormCompiler::FormCompiler(LispText& text, ValueStore& store, base::DiagnosticSink& sink,
                           bool par_by_turns)
    : data(text.data),
      values(store),
      interleave(par_by_turns),
      text_(text),
      sink_(sink),
      expander_(std::make_unique<MacroExpander>(*this)) {}

FormCompiler::~FormCompiler() = default;

base::DiagnosticBuilder FormCompiler::note_calls(base::DiagnosticBuilder report, DatumId at) const {
  note_macro_calls(report, data, at);
  return report;
}

void FormCompiler::compile(DatumId form) {
  // The reader's limit for written forms also holds for the expansions of macros.
  if (depth_ >= kMaxLispDepth) {
    if (expander_->stop()) {
      error(codes::kMacroLimit, form, kMaxLispDepth, "nested forms");
    }
    return nil(form);
  }
  ++depth_;
  compile_datum(form);
  --depth_;
}

void FormCompiler::compile_datum(DatumId form) {
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

void FormCompiler::compile_list(DatumId form) {
  const auto items = data.children(form);
  if (items.empty()) return nil(form);
  const auto head = data.head(form);
  if (tags > 0 && items.size() > 2 && data.is_keyword(items[0]) && data.name(items[0]) == "tag") {
    const auto scope = code.open_task(form);
    compile_body(items.subspan(2));
    return code.close_task(scope, form);
  }
  if (!head) {
    if (data.head(items.front()) == "lambda") return compile_lambda_call(*this, form, items);
    return refuse(form, "a form starts with a name");
  }
  if (data.is_dotted(form)) return refuse(form, "a dotted list is data: quote it");
  if (const auto* macro = find_macro(items.front())) return compile_expansion(form, *macro);
  if (const auto callee = find_callee(*this, items.front());
      callee && callee->function != nullptr) {
    return compile_call(*this, form, *head, *callee, items.subspan(1));
  }
  const auto known = plan_forms().find(*head);
  if (known != plan_forms().end()) {
    const auto height = code.height();
    known->second(*this, form, items);
    PARALLAX_ASSERT(failed_ || code.height() == height + 1);
    // A form that reported an error may have stopped half-way; the forms after it are still
    // checked.
    code.set_height(height + 1);
    return;
  }
  if (const auto reader = defined.readers.find(data.key(items.front()));
      reader != defined.readers.end() && items.size() == 2) {
    return compile_reader(*this, form, reader->second, items[1]);
  }
  if (const auto callee = find_callee(*this, items.front()))
    return compile_call(*this, form, *head, *callee, items.subspan(1));
  if (is_ignored_call(data.package(items.front()), *head)) {
    check_no_perform(form);
    return nil(form);
  }
  if (head->starts_with("check-") && head->ends_with("-collisions")) {
    warning(codes::kProjectionIgnored, form, form_name(form));
    code.code().gaps.push_back(
        {fmt::format("what `{}` finds", form_name(form)), form, GapKind::kMeaning});
    check_no_perform(form);
    return nil(form);
  }
  unknown_form(form, items.front());
  nil(form);
}

void FormCompiler::compile_expansion(DatumId form, const PlanMacro& macro) {
  const auto expansion = expand(macro, form);
  if (!expansion) return nil(form);
  check_dots(*expansion);
  compile(*expansion);
}

void FormCompiler::check_dots(DatumId form) {
  std::vector<std::pair<DatumId, bool>> open = {{form, false}};  // in a template?
  while (!open.empty()) {
    const auto [datum, is_data] = open.back();
    open.pop_back();
    const auto head = data.head(datum).value_or("");
    const auto items = data.children(datum);
    if (head == "quote" || head == "def-fact-group" || head == "defmacro" || head == "macrolet")
      continue;
    if (!is_data && !head.empty() && find_macro(items.front()) != nullptr) continue;
    if (!is_data && data.is_dotted(datum)) {
      malformed(datum, "a dotted list is data: quote it");
      return;
    }
    const bool inside = (is_data && head != "unquote" && head != "unquote-splicing") ||
                        (!is_data && head == "quasiquote");
    // Patterns of variables may have dots.
    const bool pattern = !is_data && head == "destructuring-bind" && items.size() > 1;
    for (std::size_t i = 0; i < items.size(); ++i) {
      const bool variable = !is_data && head == "loop" && i > 0 && !data.is_list(items[i - 1]) &&
                            !data.is_number(items[i - 1]) &&
                            is_loop_variable(data.name(items[i - 1]));
      if (!variable && !(pattern && i == 1)) open.emplace_back(items[i], inside);
    }
  }
}

std::optional<DatumId> FormCompiler::expand(const PlanMacro& macro, DatumId call) {
  auto out = expander_->expand(macro, call);
  if (!out) failed_ = true;
  return out;
}

const PlanMacro* FormCompiler::find_macro(DatumId symbol) const {
  if (defined.macros.empty() && defined.local_macros.empty()) return nullptr;
  const auto& name = data.name(symbol);
  for (auto binding = code.scope().rbegin(); binding != code.scope().rend(); ++binding) {
    if (binding->name != name) continue;
    if (binding->kind == BindingKind::kFunction) return nullptr;
    if (binding->kind == BindingKind::kMacro) return &defined.local_macros.at(binding->index);
  }
  const auto found = defined.macros.find(data.key(symbol));
  return found == defined.macros.end() ? nullptr : &found->second;
}

bool FormCompiler::complete(std::uint32_t unit) {
  const auto found = defined.unwritten.find(unit);
  if (found == defined.unwritten.end()) return code.code().units[unit].ready;
  const auto errors = sink_.error_count();
  const auto source = std::move(found->second);
  defined.unwritten.erase(found);
  auto outside = code.suspend();
  const auto outer_tags = std::exchange(tags, 0);
  const bool was_in_function = std::exchange(in_function, true);
  const bool was_in_macro = std::exchange(in_macro, source.macro.has_value());
  const auto outer_position = std::exchange(position, source.position);
  if (source.macro) {
    compile_macro(*this, *source.macro, source.body);
  } else {
    compile_function(*this, source.function, source.block, source.body);
  }
  tags = outer_tags;
  in_function = was_in_function;
  in_macro = was_in_macro;
  position = outer_position;
  code.resume(std::move(outside));
  // Code that was refused half-way must not run, not even in an expansion.
  const bool good = sink_.error_count() == errors;
  if (!good) code.code().units[unit].ready = false;
  return good;
}

void FormCompiler::compile_body(FormItems body) {
  if (body.empty()) return nil(text_.forms.front());
  for (std::size_t i = 0; i < body.size(); ++i) {
    compile(body[i]);
    if (i + 1 == body.size()) return;
    code.drop(body[i]);
  }
}

void FormCompiler::otherwise_nil(const std::vector<std::size_t>& to_else, DatumId source) {
  const auto to_end = code.jump(PlanOp::kJump, source);
  code.adjust(-1);
  for (const auto jump : to_else) code.patch_jump(jump);
  nil(source);
  code.patch_jump(to_end);
}

ValueId FormCompiler::datum_value(DatumId datum) {
  switch (data[datum].kind) {
    case DatumKind::kSymbol:
      return data.is_nil(datum) ? values.nil() : values.symbol(data.name(datum));
    case DatumKind::kKeyword:
      return values.keyword(data.name(datum));
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
      if (!data.is_dotted(datum)) return values.list(items);
      auto out = items.back();
      items.pop_back();
      for (auto item = items.rbegin(); item != items.rend() && !values.full(); ++item) {
        out = values.cons(*item, out);
      }
      return out;
    }
  }
  return values.nil();
}

ValueId FormCompiler::quoted_value(DatumId datum) {
  return in_macro ? expander_->value_of(datum, true) : datum_value(datum);
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
  auto report = error(codes::kUnknownFailureClass, datum, data.name(datum));
  if (const auto near = base::nearest_name(data.name(datum), names, 4)) {
    report.fix(fmt::format("replace `{}` with `{}`", data.name(datum), *near));
  }
  return std::nullopt;
}

std::optional<std::string> FormCompiler::handled_class(DatumId datum, bool idle) {
  auto known = failure_class(datum);
  if (idle || (known != "condition" && known != "t")) return known;
  error(codes::kUnsupportedPlanForm, datum, *known,
        "on the robot its handler also hears signals of the scheduler, at any time; name "
        "`plan-failure` or `error`");
  return std::nullopt;
}

std::string FormCompiler::form_name(DatumId form) const {
  if (const auto head = data.head(form)) return std::string(*head);
  if (!data.is_list(form)) return print_datum(data, form);
  return "(...)";
}

void FormCompiler::malformed(DatumId form, std::string_view text) {
  error(codes::kMalformedForm, form, form_name(form), text);
}

void FormCompiler::refuse(DatumId form, std::string_view text) {
  malformed(form, text);
  nil(form);
}

void FormCompiler::always_fails(DatumId form, std::string_view why) {
  warning(codes::kAlwaysFails, form, form_name(form), why);
  code.fail("simple-error", form);
}

void FormCompiler::unsupported(DatumId form, std::string_view text) {
  error(codes::kUnsupportedPlanForm, form, form_name(form), text);
}

void FormCompiler::note_other_package(base::DiagnosticBuilder& report, DatumId symbol) const {
  for (const auto& [full, key] : text_.keys) {
    if (!full.ends_with("::" + data.name(symbol))) continue;
    report.note(fmt::format("`{}` is another symbol; export and use it, or write it so", full));
    return;
  }
}

void FormCompiler::unknown_form(DatumId form, DatumId symbol) {
  const auto& name = data.name(symbol);
  if (const auto* hint = find_hint(kReactive, name)) {
    error(codes::kReactiveForm, form, name).note(std::string(hint->text));
    return;
  }
  if (const auto* hint = find_hint(kRejected, name)) {
    error(codes::kUnsupportedPlanForm, form, name, hint->text);
    return;
  }
  auto report = error(codes::kUnknownPlanForm, form, name);
  note_other_package(report, symbol);
  // Looking for the nearest name is the expensive part; nobody reads the thousandth suggestion.
  if (sink_.error_count() > kMaxSuggestions) return;
  std::vector<std::string> names;
  for (const auto& [known, function] : defined.functions) {
    if (known.front() != '%') names.push_back(known);
  }
  for (const auto& [known, macro] : defined.macros) names.push_back(known);
  for (const auto& [known, function] : plan_forms()) names.emplace_back(known);
  for (const auto& builtin : plan_builtins()) {
    if (builtin.name.front() != '%') names.emplace_back(builtin.name);
  }
  // Half the word may be wrong: naming the nearest form helps more than naming none.
  const auto near = base::nearest_name(name, names, std::max<std::size_t>(2, name.size() / 2));
  if (near) report.note(fmt::format("the nearest form of the subset is `{}`", *near));
}

void FormCompiler::check_no_perform(DatumId form) {
  std::vector<DatumId> open = {form};
  while (!open.empty()) {
    const auto datum = open.back();
    open.pop_back();
    const auto items = data.children(datum);
    if (data.head(datum) == "perform") {
      error(codes::kUnsupportedPlanForm, datum, "perform",
            fmt::format("the arguments of `{}` are not evaluated", form_name(form)));
      return;
    }
    open.insert(open.end(), items.begin(), items.end());
  }
}

ListLoop begin_list_loop(FormCompiler& c, DatumId variable, DatumId source) {
  ListLoop loop;
  c.code.emit(PlanOp::kExpectList, 0, 0, source);
  loop.list = c.code.height() - 1;
  c.nil(source);
  loop.item = c.code.height() - 1;
  loop.scope = c.code.scope().size();
  bind_top(c, variable, source);
  loop.top = c.code.here();
  c.code.load(loop.list, source);
  loop.end_jump = c.code.jump(PlanOp::kJumpIfNil, source);
  c.code.load(loop.list, source);
  c.code.builtin("car", 1, source);
  c.code.store_and_drop(loop.item, source);
  c.code.load(loop.list, source);
  c.code.builtin("cdr", 1, source);
  c.code.store_and_drop(loop.list, source);
  return loop;
}

void end_list_loop(FormCompiler& c, const ListLoop& loop, DatumId source) {
  c.code.drop(source);
  c.code.jump_back(loop.top, source);
  c.code.patch_jump(loop.end_jump);
  c.nil(source);
  c.code.store_and_drop(loop.item, source);
}

}  // namespace parallax::compiler
