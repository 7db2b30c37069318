// Where an error of the machine is shown: at a form of the plan, with the macro calls around it.
#include <fmt/core.h>

#include <vector>

#include "compiler/interpreter/plan_machine.h"

namespace parallax::compiler {

void note_macro_calls(base::DiagnosticBuilder& report, const LispData& data, DatumId form) {
  std::vector<DatumId> calls;
  for (auto call = data.macro_call(form); call; call = data.macro_call(*call)) {
    const bool same = !calls.empty() && data.source(calls.back()) == data.source(*call);
    if (!same) calls.push_back(*call);
  }
  // The nearest ones and the one that the plan wrote.
  constexpr std::size_t kNearest = 2;
  for (std::size_t i = 0; i < calls.size(); ++i) {
    if (i >= kNearest && i + 1 < calls.size()) continue;
    const auto name = data.head(calls[i]).value_or("a macro");
    report.note(data.source(calls[i]), fmt::format("in the expansion of this call of `{}`", name));
  }
}

DatumId PlanMachine::place_of(DatumId form) const {
  if (blame_ && form == blame_->own) return blame_->call;
  if (!data_.in_library(form) || running_ == nullptr) return form;
  for (auto frame = running_->frames.size(); frame-- > 0;) {
    const auto& at = running_->frames[frame];
    const auto& code = code_.units[at.unit].code;
    if (at.pc == 0 || at.pc > code.size()) continue;
    if (!data_.in_library(code[at.pc - 1].source)) return code[at.pc - 1].source;
  }
  return form;
}

/// Which macro calls made the form, and which is being expanded.
base::DiagnosticBuilder PlanMachine::note_blame(base::DiagnosticBuilder report, DatumId at) const {
  note_macro_calls(report, data_, place_of(at));
  if (!blame_) return report;
  const auto& call = data_.source(blame_->call);
  if (at == blame_->own) return report.note(data_.source(at), "the macro is defined here");
  return report.note(call, fmt::format("while `{}` is expanded here", name_at(blame_->call)));
}

}  // namespace parallax::compiler
