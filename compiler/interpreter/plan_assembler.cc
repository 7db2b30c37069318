#include "compiler/interpreter/plan_assembler.h"

#include <utility>

#include "compiler/base/result.h"
#include "compiler/builtins/plan_builtins.h"

namespace parallax::compiler {

std::size_t PlanAssembler::emit(PlanOp op, std::uint32_t a, std::uint32_t b, DatumId source) {
  auto& code = code_.units[frames_.back().unit].code;
  code.push_back({op, a, b, source});
  return code.size() - 1;
}

void PlanAssembler::adjust(int change) {
  set_height(static_cast<std::uint32_t>(static_cast<int>(height()) + change));
}

void PlanAssembler::constant(ValueId value, DatumId source) {
  emit(PlanOp::kConstant, value.index(), 0, source);
  adjust(1);
}

void PlanAssembler::builtin(std::string_view name, std::uint32_t arguments, DatumId source) {
  const auto found = find_builtin(name);
  PARALLAX_REQUIRE(found.has_value(), "the compiler only uses built-ins that exist");
  emit(PlanOp::kBuiltin, *found, arguments, source);
  adjust(1 - static_cast<int>(arguments));
}

void PlanAssembler::drop(DatumId source) {
  emit(PlanOp::kPop, 0, 0, source);
  adjust(-1);
}

void PlanAssembler::squeeze(std::uint32_t count, DatumId source) {
  emit(PlanOp::kSqueeze, count, 0, source);
  adjust(-static_cast<int>(count));
}

void PlanAssembler::fail(std::string_view failure_class, DatumId source) {
  emit(PlanOp::kFail, string_index(failure_class), 0, source);
  adjust(1);
}

std::uint32_t PlanAssembler::string_index(std::string_view text) {
  const auto found = string_ids_.find(text);
  if (found != string_ids_.end()) return found->second;
  const auto index = static_cast<std::uint32_t>(code_.strings.size());
  code_.strings.emplace_back(text);
  string_ids_.emplace(std::string(text), index);
  return index;
}

// --- jumps and exits ----------------------------------------------------------------------------

std::uint32_t PlanAssembler::here() const {
  return static_cast<std::uint32_t>(code_.units[frames_.back().unit].code.size());
}

std::size_t PlanAssembler::jump(PlanOp op, DatumId source) {
  if (op == PlanOp::kJumpIfNil) adjust(-1);
  return emit(op, 0, 0, source);
}

void PlanAssembler::patch_jump(std::size_t at) {
  code_.units[frames_.back().unit].code[at].a = here();
}

std::uint32_t PlanAssembler::open_exit() {
  code_.exits.push_back({frames_.back().unit, 0, height(), frames_.back().guards});
  return static_cast<std::uint32_t>(code_.exits.size() - 1);
}

void PlanAssembler::leave_to(const LexicalBinding& target, DatumId source) {
  note_use(target, code_.exits[target.index].height, false);
  emit(PlanOp::kExit, level_of(target), target.index, source);
}

PlanAssembler::Block PlanAssembler::open_block(std::string_view name) {
  const Block block{open_exit(), scope_.size()};
  show(named(BindingKind::kBlock, name, block.exit));
  return block;
}

void PlanAssembler::close_block(const Block& block) {
  set_exit(block.exit);
  cut_scope(block.scope);
}

// --- failures -----------------------------------------------------------------------------------

std::uint32_t PlanAssembler::add_handlers(std::vector<HandlerClause> table) {
  code_.handlers.push_back(std::move(table));
  return static_cast<std::uint32_t>(code_.handlers.size() - 1);
}

void PlanAssembler::push_handlers(std::uint32_t table, DatumId source) {
  emit(PlanOp::kPushHandlers, table, 0, source);
  ++frames_.back().guards;
}

void PlanAssembler::push_cleanup(std::uint32_t unit, DatumId source) {
  emit(PlanOp::kPushCleanup, unit, 0, source);
  ++frames_.back().guards;
}

std::size_t PlanAssembler::open_task(DatumId source) {
  emit(PlanOp::kPushTask, 0, 0, source);
  ++frames_.back().guards;
  const auto scope = scope_.size();
  show(named(BindingKind::kTask, "", 0));
  return scope;
}

void PlanAssembler::close_task(std::size_t scope, DatumId source) {
  pop_guard(source);
  cut_scope(scope);
}

void PlanAssembler::bind_special(std::uint32_t global, std::uint32_t place, DatumId source) {
  emit(PlanOp::kBindSpecial, global, place, source);
  ++frames_.back().guards;
}

void PlanAssembler::pop_guard(DatumId source) {
  emit(PlanOp::kPopGuard, 0, 0, source);
  --frames_.back().guards;
}

// --- units --------------------------------------------------------------------------------------

std::uint32_t PlanAssembler::declare_unit(std::string_view name, DatumId source,
                                          std::uint32_t parameters) {
  PlanUnit unit;
  unit.name = name;
  unit.source = source;
  unit.parameters = parameters;
  code_.units.push_back(std::move(unit));
  return static_cast<std::uint32_t>(code_.units.size() - 1);
}

void PlanAssembler::enter_unit(std::uint32_t unit) {
  if (!frames_.empty()) code_.units[unit].around = frames_.back().unit;
  frames_.push_back({unit, code_.units[unit].parameters, 0, false});
}

void PlanAssembler::leave_unit(PlanOp last, DatumId source) {
  emit(last, 0, 0, source);
  code_.units[frames_.back().unit].ready = true;
  frames_.pop_back();
  if (frames_.empty()) resolve_uses();
}

void PlanAssembler::par(std::vector<std::uint32_t> units, bool pursue, DatumId source) {
  const auto exit = pursue ? std::optional(open_exit()) : std::nullopt;
  emit(PlanOp::kPar, static_cast<std::uint32_t>(code_.pars.size()), 0, source);
  code_.pars.push_back({std::move(units), exit});
  if (exit) set_exit(*exit);
  adjust(1);
}

// --- names --------------------------------------------------------------------------------------

LexicalBinding PlanAssembler::named(BindingKind kind, std::string_view name,
                                    std::uint32_t index) const {
  return {kind, std::string(name), depth(), index, height(), 0};
}

void PlanAssembler::show(const std::vector<LexicalBinding>& bindings) {
  for (const auto& binding : bindings) show(binding);
}

const LexicalBinding* PlanAssembler::lookup(BindingKind kind, std::string_view name) const {
  for (auto binding = scope_.rbegin(); binding != scope_.rend(); ++binding) {
    if (binding->kind == kind && binding->name == name) return &*binding;
  }
  return nullptr;
}

bool PlanAssembler::in_other_task(const LexicalBinding& binding) const {
  for (auto inner = scope_.rbegin(); inner != scope_.rend() && &*inner != &binding; ++inner) {
    if (inner->kind == BindingKind::kTask) return true;
  }
  return false;
}

std::uint32_t PlanAssembler::level_of(const LexicalBinding& binding) const {
  return depth() - binding.frame;
}

void PlanAssembler::load(const LexicalBinding& binding, DatumId source) {
  note_use(binding, binding.index, binding.kind == BindingKind::kVariable);
  emit(PlanOp::kLoad, level_of(binding), binding.index, source);
  adjust(1);
}

void PlanAssembler::store(const LexicalBinding& binding, DatumId source) {
  note_change(binding);
  note_use(binding, binding.index, false);
  code_.units[frames_[binding.frame].unit].assigned.insert(binding.index);
  emit(PlanOp::kStore, level_of(binding), binding.index, source);
}

void PlanAssembler::load(std::uint32_t place, DatumId source) {
  emit(PlanOp::kLoad, 0, place, source);
  adjust(1);
}

void PlanAssembler::store(std::uint32_t place, DatumId source) {
  emit(PlanOp::kStore, 0, place, source);
}

void PlanAssembler::store_and_drop(std::uint32_t place, DatumId source) {
  store(place, source);
  drop(source);
}

}  // namespace parallax::compiler
