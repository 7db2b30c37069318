#pragma once

#include <string>
#include <string_view>

#include "compiler/sema/typed_model.h"

namespace parallax::test {

/// Typed terms, formulas and axioms as text with every operator in parentheses.
class TypedText {
 public:
  explicit TypedText(const compiler::TypedModel& model) : model_(model) {}

  std::string term(compiler::TermId id) const {
    using compiler::TermKind;
    const auto& t = model_.terms[id];
    switch (t.kind) {
      case TermKind::kVariable:
        return model_.variables[t.variable].name;
      case TermKind::kObject:
        return model_.objects[t.object].name;
      case TermKind::kInteger:
        return std::to_string(t.integer);
      case TermKind::kApply:
        return model_.symbols[t.symbol].name + "(" + terms(t.arguments) + ")";
      case TermKind::kArithmetic: {
        static constexpr std::string_view kOps = "+-*/%";
        return "(" + term(t.arguments[0]) + kOps[static_cast<std::size_t>(t.op)] +
               term(t.arguments[1]) + ")";
      }
    }
    return {};
  }

  std::string formula(compiler::TypedFormulaId id) const {
    using compiler::FormulaKind;
    const auto& f = model_.formulas[id];
    switch (f.kind) {
      case FormulaKind::kTrue:
        return "true";
      case FormulaKind::kFalse:
        return "false";
      case FormulaKind::kAtom:
        return model_.symbols[f.predicate].name + "(" + terms(f.terms) + ")";
      case FormulaKind::kCompare: {
        static constexpr const char* kOps[] = {"=", "!=", "<", "<=", ">", ">="};
        return term(f.terms[0]) + kOps[static_cast<std::size_t>(f.compare)] + term(f.terms[1]);
      }
      case FormulaKind::kNot:
        return "!" + formula(f.children[0]);
      case FormulaKind::kAnd:
        return joined(f, " & ");
      case FormulaKind::kOr:
        return joined(f, " | ");
      case FormulaKind::kImplies:
        return joined(f, " -> ");
      case FormulaKind::kIff:
        return joined(f, " <-> ");
      case FormulaKind::kForall:
        return "[" + names(f.variables) + "]" + formula(f.children[0]);
      case FormulaKind::kExists:
        return "{" + names(f.variables) + "}" + formula(f.children[0]);
      case FormulaKind::kAggregate: {
        static constexpr const char* kOps[] = {"=", "!=", "<", "<=", ">", ">="};
        const auto weight = f.terms.size() == 2 ? term(f.terms[1]) + ":" : std::string();
        return (weight.empty() ? "count{" : "sum{") + names(f.variables) + ":" + weight +
               formula(f.children[0]) + "}" + kOps[static_cast<std::size_t>(f.compare)] +
               term(f.terms[0]);
      }
      case FormulaKind::kTemporal:
        return joined(f, " temporal ");
    }
    return {};
  }

  std::string effect(const compiler::EffectAxiom& axiom) const {
    static constexpr const char* kNames[] = {"Initiates", "Terminates", "Releases"};
    return label(axiom.label) + "[" + names(axiom.variables) + "] " + formula(axiom.condition) +
           " => " + kNames[static_cast<std::size_t>(axiom.kind)] + "(" + term(axiom.event) + "," +
           term(axiom.fluent) + "," + term(axiom.time) + ")";
  }

  std::string trajectory(const compiler::TrajectoryAxiom& axiom) const {
    const bool anti = axiom.kind == compiler::TrajectoryKind::kAntiTrajectory;
    return label(axiom.label) + "[" + names(axiom.variables) + "] " + formula(axiom.condition) +
           " => " + (anti ? "AntiTrajectory(" : "Trajectory(") + term(axiom.fluent) + "," +
           term(axiom.time) + "," + term(axiom.target) + "," + term(axiom.offset) + ")";
  }

  std::string axiom(const compiler::Axiom& axiom) const {
    return label(axiom.label) + formula(axiom.formula);
  }

 private:
  static std::string label(const std::string& text) { return text.empty() ? "" : text + ": "; }

  std::string terms(const std::vector<compiler::TermId>& ids) const {
    std::string out;
    for (const auto id : ids) out += (out.empty() ? "" : ",") + term(id);
    return out;
  }
  std::string names(const std::vector<compiler::VariableId>& ids) const {
    std::string out;
    for (const auto id : ids) out += (out.empty() ? "" : ",") + model_.variables[id].name;
    return out;
  }
  std::string joined(const compiler::TypedFormula& f, const std::string& op) const {
    std::string out = "(";
    for (std::size_t i = 0; i < f.children.size(); ++i) {
      out += (i == 0 ? "" : op) + formula(f.children[i]);
    }
    return out + ")";
  }

  const compiler::TypedModel& model_;
};

}  // namespace parallax::test
