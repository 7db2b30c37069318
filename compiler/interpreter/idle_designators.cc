#include "compiler/interpreter/idle_designators.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/base/codes/plans.h"
#include "compiler/builtins/plan_builtins.h"
#include "compiler/interpreter/fact_base.h"
#include "compiler/interpreter/plan_machine.h"
#include "compiler/interpreter/value_flow.h"

namespace parallax::compiler {
namespace {

/// Functions that something else than a call written in the plan may call, by unit.
class OutsideCalls {
 public:
  OutsideCalls(const LispText& text, const PlanCode& code, const ValueStore& values)
      : text_(text), code_(code), values_(values) {
    for (const auto& unit : code.units) {
      for (const auto& one : unit.code) {
        if (one.op == PlanOp::kConstant) note_value(ValueId(one.a));
      }
    }
    for (const auto form : text.forms) {
      if (is_fact_group(text.data, form)) note_rules(form);
    }
  }

  std::set<std::uint32_t> units() const {
    std::set<std::uint32_t> out;
    for (const auto& [key, unit] : code_.functions) {
      const auto colon = key.rfind(':');
      const auto name = colon == std::string::npos ? key : key.substr(colon + 1);
      if (names_.contains(key) || names_.contains(name)) out.insert(unit);
    }
    return out;
  }

 private:
  /// A symbol in a quoted datum may be called where the plan runs.
  void note_value(ValueId value) {
    std::vector<ValueId> open = {value};
    while (!open.empty()) {
      const auto id = open.back();
      open.pop_back();
      if (!seen_.insert(id.index()).second) continue;
      const auto& one = values_[id];
      if (one.kind == ValueKind::kSymbol && !one.keyword) names_.insert(one.text);
      if (one.kind == ValueKind::kCons) open.insert(open.end(), {one.head, one.tail});
    }
  }

  void note_rules(DatumId form) {
    std::vector<DatumId> open = {form};
    while (!open.empty()) {
      const auto datum = open.back();
      open.pop_back();
      const auto items = text_.data.children(datum);
      open.insert(open.end(), items.begin(), items.end());
      if (text_.data.is_symbol(datum)) names_.insert(text_.data.name(datum));
    }
  }

  const LispText& text_;
  const PlanCode& code_;
  const ValueStore& values_;
  std::set<std::uint32_t> seen_;
  std::set<std::string, std::less<>> names_;
};

/// The kind of designator that the instruction makes, if it is one to be performed.
std::optional<DesignatorKind> performable(const LispData& data, const PlanInstruction& one) {
  if (one.op == PlanOp::kDesignator) {
    const auto kind = static_cast<DesignatorKind>(one.a);
    const bool acts = kind == DesignatorKind::kAction || kind == DesignatorKind::kMotion;
    return acts ? std::optional(kind) : std::nullopt;
  }
  // With a third argument `make-designator` equates, which has an effect of its own.
  const auto parts = data.children(one.source);
  if (one.op != PlanOp::kBuiltin || plan_builtins()[one.a].name != "make-designator" ||
      data.head(one.source) != "make-designator" || parts.size() != 3) {
    return std::nullopt;
  }
  if (!data.is_keyword(parts[1])) return std::nullopt;
  if (data.name(parts[1]) == "action") return DesignatorKind::kAction;
  if (data.name(parts[1]) == "motion") return DesignatorKind::kMotion;
  return std::nullopt;
}

/// The designator as written, or its beginning.
std::string short_text(const LispData& data, DatumId form, DesignatorKind kind) {
  constexpr std::size_t kLongest = 60;
  auto whole = print_datum(data, form);
  if (whole.size() <= kLongest) return whole;
  std::string out;
  for (const auto part : data.children(form).first(std::min<std::size_t>(3, data[form].count))) {
    out += (out.empty() ? "" : " ") + print_datum(data, part);
  }
  if (out.size() <= kLongest) return fmt::format("({} ...)", out);
  return kind == DesignatorKind::kMotion ? "(a motion ...)" : "(an action ...)";
}

}  // namespace

void warn_of_idle_designators(const LispText& text, const PlanCode& code,
                              const PlanBinding& binding, const ValueStore& values,
                              base::DiagnosticSink& sink) {
  struct Found {
    DesignatorKind kind = DesignatorKind::kAction;
    bool used = false;  // in one of the places that the form is compiled for
    std::vector<std::uint32_t> returned;
  };
  ValueFlow flow(code);
  for (const auto unit : OutsideCalls(text, code, values).units()) flow.note_unknown_caller(unit);
  for (const auto& entry : binding.entries) {
    if (!entry.plan) continue;
    const auto full = code.function_names.find(*entry.plan);
    const auto function =
        code.functions.find(full == code.function_names.end() ? *entry.plan : full->second);
    if (function != code.functions.end()) flow.note_performed(function->second);
  }
  std::map<DatumId, Found> all;
  for (std::uint32_t unit = 0; unit < code.units.size(); ++unit) {
    const auto& instructions = code.units[unit].code;
    for (std::uint32_t pc = 0; pc < instructions.size(); ++pc) {
      const auto& one = instructions[pc];
      const auto kind = performable(text.data, one);
      if (!kind || text.data.in_library(one.source)) continue;
      auto& found = all[one.source];
      found.kind = *kind;
      if (found.used) continue;
      const auto top = flow.height(unit, pc + 1) - 1;
      found.used = flow.may_be_used({unit, pc + 1, top}, found.returned);
    }
  }
  for (const auto& [form, found] : all) {
    if (found.used) continue;
    auto report =
        sink.warning(codes::kIdleDesignator, text.data.source(form), to_string(found.kind));
    if (!found.returned.empty()) {
      const auto& unit = code.units[found.returned.front()];
      report.note(text.data.source(unit.source),
                  fmt::format("`{}` returns it, and no call uses what it returns", unit.name));
    }
    note_macro_calls(report, text.data, form);
    report.fix(fmt::format("write `(perform {})`", short_text(text.data, form, found.kind)));
  }
}

}  // namespace parallax::compiler
