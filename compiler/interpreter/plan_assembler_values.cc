// Function values. What a function uses of the code around it goes along with it if it never
// changes; everything else it shares, and must not outlive.
#include <algorithm>
#include <utility>

#include "compiler/interpreter/plan_assembler.h"

namespace parallax::compiler {

PlanAssembler::Suspended PlanAssembler::suspend() {
  return {std::exchange(frames_, {}), std::exchange(scope_, {}), std::exchange(uses_, {})};
}

void PlanAssembler::resume(Suspended outside) {
  frames_ = std::move(outside.frames);
  scope_ = std::move(outside.scope);
  uses_ = std::move(outside.uses);
}

void PlanAssembler::enter_function_value(std::uint32_t unit) {
  enter_unit(unit);
  frames_.back().is_value = true;
  values_made_.emplace(unit, static_cast<std::uint32_t>(code_.functions_made.size()));
  code_.functions_made.push_back({});
  code_.functions_made.back().unit = unit;
}

void PlanAssembler::function_value(std::uint32_t unit, DatumId source) {
  emit(PlanOp::kFunction, values_made_.at(unit), 0, source);
  adjust(1);
}

void PlanAssembler::function_value(FunctionTemplate made, DatumId source) {
  emit(PlanOp::kFunction, static_cast<std::uint32_t>(code_.functions_made.size()), 0, source);
  code_.functions_made.push_back(std::move(made));
  adjust(1);
}

void PlanAssembler::local_function_value(const LexicalBinding& local, DatumId source) {
  note_use(local, local.height, false);
  FunctionTemplate made;
  made.unit = local.index;
  made.level = level_of(local);
  made.shared = {{*made.level, local.height}};
  function_value(std::move(made), source);
}

void PlanAssembler::call_value(std::uint32_t arguments, bool spread, DatumId source) {
  emit(PlanOp::kCallValue, arguments, spread ? 1 : 0, source);
  adjust(-static_cast<int>(arguments));
}

/// Notes the outer variables that a function value uses; nothing where no function value is in
/// between.
void PlanAssembler::note_use(const LexicalBinding& binding, std::uint32_t index, bool is_load) {
  OuterUse use;
  for (auto frame = std::size_t{binding.frame} + 1; frame < frames_.size(); ++frame) {
    if (!frames_[frame].is_value) continue;
    use.values.push_back({frames_[frame].unit, static_cast<std::uint32_t>(frame)});
  }
  if (use.values.empty()) return;
  use.unit = frames_.back().unit;
  use.at = code_.units[use.unit].code.size();
  use.depth = depth();
  use.frame = binding.frame;
  use.index = index;
  if (is_load) use.serial = binding.serial;
  uses_.push_back(std::move(use));
}

/// The outermost unit is complete: it is known which of its variables change.
void PlanAssembler::resolve_uses() {
  for (const auto& use : std::exchange(uses_, {})) {
    if (use.serial && !changed_.contains(*use.serial)) {
      keep(use);
      continue;
    }
    for (const auto& value : use.values) {
      auto& made = code_.functions_made[values_made_.at(value.unit)];
      made.level = 0;
      made.shared.push_back({value.depth - 1 - use.frame, use.index});
    }
  }
}

/// Every function value around the load keeps the variable, each taking it from the next one out.
void PlanAssembler::keep(const OuterUse& use) {
  // Below its parameters: the first one just below.
  const auto place = [](std::uint32_t slot) { return std::uint32_t{0} - 1 - slot; };
  std::optional<ValueFrame> around;
  std::uint32_t slot = 0;
  for (const auto& value : use.values) {
    auto& made = code_.functions_made[values_made_.at(value.unit)];
    const auto from = around ? FramePlace{value.depth - 1 - around->depth, place(slot)}
                             : FramePlace{value.depth - 1 - use.frame, use.index};
    const auto next = static_cast<std::uint32_t>(made.kept.size());
    const auto [entry, added] = kept_.try_emplace({value.unit, *use.serial}, next);
    if (added) {
      made.kept.push_back(from);
      ++code_.units[value.unit].kept;
    }
    slot = entry->second;
    around = value;
  }
  auto& load = code_.units[use.unit].code[use.at];
  load.a = use.depth - around->depth;
  load.b = place(slot);
}

}  // namespace parallax::compiler
