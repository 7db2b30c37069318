#include "compiler/plan/plan_compiler.h"

#include <fmt/core.h>

#include <utility>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/suggest.h"
#include "compiler/plan/plan_builtins.h"

namespace parallax::compiler {

using base::DiagnosticCode;

// --- emitting -----------------------------------------------------------------------------------

std::size_t PlanCompiler::emit(PlanOp op, std::uint32_t a, std::uint32_t b, DatumId source) {
  auto& code = code_.units[frame().unit].code;
  code.push_back({op, a, b, source});
  return code.size() - 1;
}

void PlanCompiler::adjust(int change) {
  frame().height = static_cast<std::uint32_t>(static_cast<int>(frame().height) + change);
}

void PlanCompiler::emit_constant(ValueId value, DatumId source) {
  emit(PlanOp::kConstant, value.index(), 0, source);
  adjust(1);
}

/// A jump whose target is not known yet; a conditional one takes its test off the stack.
std::size_t PlanCompiler::emit_jump(PlanOp op, DatumId source) {
  if (op == PlanOp::kJumpIfNil) adjust(-1);
  return emit(op, 0, 0, source);
}

void PlanCompiler::patch_jump(std::size_t at) { code_.units[frame().unit].code[at].a = here(); }

std::uint32_t PlanCompiler::here() const {
  return static_cast<std::uint32_t>(code_.units[frames_.back().unit].code.size());
}

std::uint32_t PlanCompiler::string_index(std::string_view text) {
  const auto found = string_ids_.find(text);
  if (found != string_ids_.end()) return found->second;
  const auto index = static_cast<std::uint32_t>(code_.strings.size());
  code_.strings.emplace_back(text);
  string_ids_.emplace(std::string(text), index);
  return index;
}

void PlanCompiler::emit_builtin(std::string_view name, std::uint32_t arguments, DatumId source) {
  const auto builtin = find_builtin(name);
  PARALLAX_REQUIRE(builtin.has_value(), "the compiler only uses built-ins that exist");
  emit(PlanOp::kBuiltin, *builtin, arguments, source);
  adjust(1 - static_cast<int>(arguments));
}

// --- units and scopes
// -----------------------------------------------------------------------------

std::uint32_t PlanCompiler::declare_unit(std::string_view name, DatumId source,
                                         std::uint32_t parameters) {
  PlanUnit unit;
  unit.name = name;
  unit.source = source;
  unit.parameters = parameters;
  code_.units.push_back(std::move(unit));
  return static_cast<std::uint32_t>(code_.units.size() - 1);
}

void PlanCompiler::enter_unit(std::uint32_t unit) {
  frames_.push_back({unit, code_.units[unit].parameters, 0});
}

void PlanCompiler::leave_unit(PlanOp last, DatumId source) {
  emit(last, 0, 0, source);
  frames_.pop_back();
}

/// Names the value on top; it stays a variable until the scope is cut back and it is squeezed out.
void PlanCompiler::bind_variable(std::string_view name) {
  const auto depth = static_cast<std::uint32_t>(frames_.size() - 1);
  scope_.push_back({BindingKind::kVariable, std::string(name), depth, frame().height - 1});
}

const PlanCompiler::LexicalBinding* PlanCompiler::lookup(BindingKind kind,
                                                         std::string_view name) const {
  for (auto binding = scope_.rbegin(); binding != scope_.rend(); ++binding) {
    if (binding->kind == kind && binding->name == name) return &*binding;
  }
  return nullptr;
}

std::uint32_t PlanCompiler::level_of(const LexicalBinding& binding) const {
  return static_cast<std::uint32_t>(frames_.size() - 1) - binding.frame;
}

void PlanCompiler::emit_variable(PlanOp op, const LexicalBinding& binding, DatumId source) {
  emit(op, level_of(binding), binding.index, source);
  if (op == PlanOp::kLoad) adjust(1);
}

void PlanCompiler::emit_local(PlanOp op, std::uint32_t place, DatumId source) {
  emit(op, 0, place, source);
  if (op == PlanOp::kLoad) adjust(1);
}

void PlanCompiler::store_and_drop(std::uint32_t place, DatumId source) {
  emit_local(PlanOp::kStore, place, source);
  emit(PlanOp::kPop, 0, 0, source);
  adjust(-1);
}

PlanCompiler::Block PlanCompiler::open_block(std::string_view name) {
  const Block block{static_cast<std::uint32_t>(code_.exits.size()), scope_.size()};
  code_.exits.push_back({0, frame().height, frame().guards});
  const auto depth = static_cast<std::uint32_t>(frames_.size() - 1);
  scope_.push_back({BindingKind::kBlock, std::string(name), depth, block.exit});
  return block;
}

/// The block ends here, one value higher than it began: that of its form.
void PlanCompiler::close_block(const Block& block) {
  code_.exits[block.exit].pc = here();
  scope_.resize(block.scope);
}

void PlanCompiler::emit_exit(const LexicalBinding& target, DatumId source) {
  emit(PlanOp::kExit, level_of(target), target.index, source);
}

// --- dispatch
// -------------------------------------------------------------------------------------

void PlanCompiler::compile(DatumId form) {
  switch (data_[form].kind) {
    case DatumKind::kSymbol:
      return compile_symbol(form);
    case DatumKind::kKeyword:
    case DatumKind::kNumber:
    case DatumKind::kString:
    case DatumKind::kCharacter:
      return emit_constant(datum_value(form), form);
    case DatumKind::kList:
      return compile_list(form);
  }
}

void PlanCompiler::compile_symbol(DatumId symbol) {
  const auto& name = data_.name(symbol);
  if (name == "nil" || name == "t") return emit_constant(datum_value(symbol), symbol);
  if (const auto* binding = lookup(BindingKind::kVariable, name)) {
    return emit_variable(PlanOp::kLoad, *binding, symbol);
  }
  if (const auto global = globals_.find(name); global != globals_.end()) {
    emit(PlanOp::kLoadGlobal, global->second, 0, symbol);
    return adjust(1);
  }
  failed_ = true;
  std::vector<std::string> names;
  for (const auto& binding : scope_) {
    if (binding.kind == BindingKind::kVariable) names.push_back(binding.name);
  }
  for (const auto& [global, index] : globals_) names.push_back(global);
  auto error = sink_.error(DiagnosticCode::kUnboundPlanVariable, data_.source(symbol), name);
  if (const auto near = base::nearest_name(name, names)) {
    error.fix(fmt::format("replace `{}` with `{}`", name, *near));
  }
  emit_constant(values_.nil(), symbol);
}

void PlanCompiler::compile_list(DatumId form) {
  const auto items = data_.children(form);
  if (items.empty()) return emit_constant(values_.nil(), form);
  const auto head = data_.head(form);
  if (!head) {
    malformed(form, "a form starts with a name");
    return emit_constant(values_.nil(), form);
  }
  if (const auto callee = find_callee(*head); callee && callee->function != nullptr) {
    return call(form, *head, *callee, items.subspan(1));
  }
  const auto known = forms().find(*head);
  if (known != forms().end()) {
    const auto height = frame().height;
    (this->*known->second)(form, items);
    PARALLAX_ASSERT(failed_ || frame().height == height + 1);
    // A form that reported an error may have stopped half-way; what follows is still checked.
    frame().height = height + 1;
    return;
  }
  if (const auto callee = find_callee(*head)) return call(form, *head, *callee, items.subspan(1));
  if (head->starts_with("check-") && head->ends_with("-collisions")) {
    return form_projection_check(form, items);
  }
  unknown_form(form, *head);
  emit_constant(values_.nil(), form);
}

void PlanCompiler::compile_body(Items body) {
  if (body.empty()) return emit_constant(values_.nil(), text_.forms.front());
  for (std::size_t i = 0; i < body.size(); ++i) {
    compile(body[i]);
    if (i + 1 == body.size()) return;
    emit(PlanOp::kPop, 0, 0, body[i]);
    adjust(-1);
  }
}

// --- the whole plan
// -------------------------------------------------------------------------------

void PlanCompiler::compile_main(const std::optional<std::string>& entry) {
  code_.main = declare_unit("the plan", text_.forms.front(), 0);
  enter_unit(code_.main);
  std::optional<std::string> name = entry;
  if (!name && bare_forms_.empty() && !function_order_.empty()) name = function_order_.back();
  if (!name) {
    compile_body(bare_forms_);
  } else if (const auto found = functions_.find(*name); found == functions_.end()) {
    std::vector<std::string> names = function_order_;
    failed_ = true;
    auto error = sink_.error(DiagnosticCode::kNoPlanEntry, data_.source(text_.forms.front()),
                             fmt::format("no function `{}`", *name));
    if (const auto near = base::nearest_name(*name, names)) {
      error.fix(fmt::format("name `{}`", *near));
    }
  } else if (Callee callee;
             !found->second.parameters.empty() && !found->second.parameters.front().optional) {
    failed_ = true;
    sink_
        .error(DiagnosticCode::kNoPlanEntry, data_.source(found->second.source),
               fmt::format("`{}` needs arguments", *name))
        .fix(fmt::format("call it at top level: ({} ...)", *name));
  } else {
    callee.function = &found->second;
    call(found->second.source, *name, callee, {});
  }
  leave_unit(PlanOp::kDone, text_.forms.front());
}

base::Result<PlanCode> PlanCompiler::compile(const std::optional<std::string>& entry) {
  collect_definitions();
  if (text_.forms.empty() || (bare_forms_.empty() && functions_.empty())) {
    const auto where = text_.forms.empty() ? base::SourceRange{} : data_.source(text_.forms[0]);
    if (text_.forms.empty()) {
      return sink_.error(DiagnosticCode::kNoPlanEntry, base::SourceRange{text_.file, 0, 0},
                         "the file has no forms");
    }
    return sink_.error(DiagnosticCode::kNoPlanEntry, where, "only definitions of variables");
  }
  compile_functions();
  compile_main(entry);
  if (failed_) return sink_.already_reported();
  return std::move(code_);
}

}  // namespace parallax::compiler
