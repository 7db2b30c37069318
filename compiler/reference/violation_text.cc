#include "compiler/reference/reference_evaluator.h"

namespace parallax::compiler {
namespace {

constexpr std::size_t kMaxAtoms = 6;  // quoted in one text

}  // namespace

/// "HoldsAt(F(),1) is true, ..."
std::string ReferenceEvaluator::deciding_atoms(FormulaTrees::Node node,
                                               const Values& values) const {
  const auto atoms = expanded_.trees().atoms_of(node);
  std::string out;
  for (std::size_t i = 0; i < atoms.size() && i < kMaxAtoms; ++i) {
    out += (i > 0 ? ", " : "") + expanded_.atom_text(atoms[i]);
    out += values[atoms[i]] != 0 ? " is true" : " is false";
  }
  if (atoms.size() > kMaxAtoms) {
    out += " and " + std::to_string(atoms.size() - kMaxAtoms) + " more";
  }
  return out.empty() ? "false whatever happens" : out;
}

Violation ReferenceEvaluator::describe(const ReferenceFinding& finding,
                                       const Values& values) const {
  using Rule = ReferenceFinding::Rule;
  const auto t = finding.timepoint;
  const auto at = [&](const std::string& what) { return what + " at " + std::to_string(t); };
  const auto dec = [&] {
    return "DEC" + std::to_string(finding.dec) + " for " + expanded_.fluents()[finding.fluent];
  };
  const auto fluent_source = [&] { return expanded_.symbol_of(finding.fluent).declared; };
  const auto& fluents = expanded_.fluents();
  switch (finding.rule) {
    case Rule::kAxiom: {
      const auto& conjunct = expanded_.conjuncts()[finding.index];
      return {model_.axioms[conjunct.axiom].source, "axiom", t,
              "axiom: " + deciding_atoms(conjunct.formula.node, values)};
    }
    case Rule::kNoninertial: {
      const auto what = "noninertial " + fluents[finding.fluent];
      return {fluent_source(), what, t, at(what + ": not released")};
    }
    case Rule::kReleasedAtStart: {
      const auto what = "released at the start: " + fluents[finding.fluent];
      return {fluent_source(), what, t, what};
    }
    case Rule::kFrame:
      return {fluent_source(), dec(), t,
              at(dec() + ": " + (finding.dec <= 6 ? "it" : "its release") +
                 " changes without an event")};
    case Rule::kEffect: {
      const auto& row = expanded_.rows(finding.fluent, t)[finding.index];
      return {model_.effects[row.effect].source, dec(), t,
              dec() + ": no effect of Happens(" + expanded_.events()[row.event] + "," +
                  std::to_string(t) + ")"};
    }
    case Rule::kTrajectory: {
      const auto& path = expanded_.paths()[finding.index];
      return {model_.trajectories[path.trajectory].source, dec(), t,
              dec() + ": since " + std::to_string(path.begin) + " it leads to HoldsAt(" +
                  fluents[path.target] + "," + std::to_string(path.end) + ")"};
    }
    case Rule::kCompletion: {
      const auto& completed = expanded_.completed()[finding.index];
      const auto what = "completion of " + expanded_.atom_text(completed.atom);
      return {model_.completions[completed.completion].source, what, t, what + ": no reason"};
    }
  }
  return {};
}

}  // namespace parallax::compiler
