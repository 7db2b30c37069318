#include "compiler/artifact/atom.h"

#include "compiler/base/whole_number.h"

namespace parallax::compiler {
namespace {

/// The number in `L3` for ("L", ""), or in `CHOICE(3)` for ("CHOICE(", ")"). None if it is written
/// in another way than it would be printed.
std::optional<std::uint32_t> number_within(std::string_view text, std::string_view before,
                                           std::string_view behind) {
  if (text.size() < before.size() + behind.size() || !text.starts_with(before) ||
      !text.ends_with(behind)) {
    return std::nullopt;
  }
  const auto digits = text.substr(before.size(), text.size() - before.size() - behind.size());
  const auto number = base::whole_number<std::uint32_t>(digits);
  return number && std::to_string(*number) == digits ? number : std::nullopt;
}

struct PlanAtomPrinter {
  std::string operator()(std::monostate) const { return {}; }
  std::string operator()(PlanStepId step) const { return 'L' + std::to_string(step.index()); }
  std::string operator()(PlanCutId cut) const {
    return "BOUND(" + std::to_string(cut.index()) + ')';
  }
  std::string operator()(PlanChoiceId choice) const {
    return "CHOICE(" + std::to_string(choice.index()) + ')';
  }
  std::string operator()(const PlanEnd& end) const { return end.text; }
  std::string operator()(const ReturnedObject& returned) const { return returned.object; }
  std::string operator()(const RegisterValue& value) const {
    return value.name + '=' + value.object;
  }
};

}  // namespace

bool is_of_plan(AtomKind kind) {
  return kind == AtomKind::kLocation || kind == AtomKind::kHit || kind == AtomKind::kRunning ||
         kind == AtomKind::kSucceeded || kind == AtomKind::kResult || kind == AtomKind::kRegister;
}

std::string to_string(AtomKind kind, const PlanAtom& plan) {
  if (std::holds_alternative<std::monostate>(plan)) {
    if (kind == AtomKind::kHit) return "hit";
    if (kind == AtomKind::kRunning) return "running";
  }
  return std::visit(PlanAtomPrinter{}, plan);
}

PlanAtom plan_atom(AtomKind kind, std::string_view text) {
  if (kind == AtomKind::kResult) return ReturnedObject{std::string(text)};
  const bool says_all = kind == AtomKind::kHit || kind == AtomKind::kRunning;
  if (says_all && text == to_string(kind, {})) return {};
  if (kind == AtomKind::kLocation || kind == AtomKind::kSucceeded) {
    if (const auto step = number_within(text, "L", "")) return PlanStepId(*step);
  }
  if (kind == AtomKind::kLocation) {
    if (const auto cut = number_within(text, "BOUND(", ")")) return PlanCutId(*cut);
    if (const auto choice = number_within(text, "CHOICE(", ")")) return PlanChoiceId(*choice);
  }
  const auto equals = text.find('=');
  if (kind == AtomKind::kRegister && equals != std::string_view::npos) {
    return RegisterValue{std::string(text.substr(0, equals)), std::string(text.substr(equals + 1))};
  }
  return PlanEnd{std::string(text)};
}

std::string printed(const Atom& atom) {
  return is_of_plan(atom.kind) ? to_string(atom.kind, atom.plan) : atom.name;
}

}  // namespace parallax::compiler
