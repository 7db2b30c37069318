#include "compiler/ground/ground_text.h"

#include "compiler/artifact/atom.h"

namespace parallax::compiler {
namespace {

std::string_view word(EffectKind kind) {
  switch (kind) {
    case EffectKind::kInitiates:
      return "Initiates";
    case EffectKind::kTerminates:
      return "Terminates";
    case EffectKind::kReleases:
      return "Releases";
  }
  return "?";
}

std::string row_line(const GroundModel& model, const EffectRow& row, const std::string& time,
                     FormulaText& formulas, const base::SourceFiles* files) {
  const auto name = [&](GroundTermId term) { return model.terms().text(term, model.typed()); };
  auto line = origin_text(model.origins()[row.origin], files) + ": " + std::string(word(row.kind)) +
              '(' + name(model.events()[row.event]) + ',' + name(model.fluents()[row.fluent]) +
              ',' + time + ')';
  if (row.condition != model.formulas().truth()) line += " if " + formulas.text(row.condition);
  return line + '\n';
}

}  // namespace

std::string atom_text(const GroundModel& model, std::int32_t variable) {
  const auto& atom = model.atom(variable);
  if (is_nameless(atom.kind)) return "aux" + std::to_string(variable);
  if (atom.kind == AtomKind::kPredicate) return model.atom_name(atom);
  auto text = std::string(to_string(atom.kind)) + '(' + model.atom_name(atom);
  if (atom.time != GroundAtom::kUntimed) text += ',' + std::to_string(atom.time);
  return text + ')';
}

FormulaText formula_text(const GroundModel& model) {
  return {model.formulas(), [&model](std::int32_t variable) { return atom_text(model, variable); }};
}

std::string origin_text(const Origin& origin, const base::SourceFiles* files) {
  const std::string word(to_string(origin.kind));
  if (files == nullptr || origin.source.end == 0) return word;
  return files->place(origin.source) + ' ' + word;
}

std::string constraint_lines(const GroundModel& model, std::span<const Constraint> constraints,
                             FormulaText& formulas, const base::SourceFiles* files) {
  std::string out;
  for (const auto& constraint : constraints) {
    out += origin_text(model.origins()[constraint.origin], files);
    if (constraint.width != Constraint::kOnce) {
      out += " (every timepoint, width " + std::to_string(constraint.width) + ')';
    }
    out += ": " + formulas.text(constraint.formula) + '\n';
  }
  return out;
}

std::string ground_text(const GroundModel& model, const EffectRows& rows,
                        const base::SourceFiles* files) {
  auto formulas = formula_text(model);
  for (const auto& row : rows.always()) formulas.count(row.condition);
  for (const auto& [t, list] : rows.single()) {
    for (const auto& row : list) formulas.count(row.condition);
  }
  for (const auto& constraint : model.constraints()) formulas.count(constraint.formula);

  std::string out = "; fluents\n";
  for (std::uint32_t f = 0; f < model.fluents().size(); ++f) {
    out += model.terms().text(model.fluents()[f], model.typed());
    out += model.may_hold(f) ? "\n" : " never holds\n";
  }
  out += "; events\n";
  for (std::uint32_t e = 0; e < model.events().size(); ++e) {
    out += model.terms().text(model.events()[e], model.typed());
    out += model.may_happen(e) ? "\n" : " never happens\n";
  }
  out += "; effects\n";
  for (const auto& row : rows.always()) out += row_line(model, row, "time", formulas, files);
  for (const auto& [t, list] : rows.single()) {
    for (const auto& row : list) out += row_line(model, row, std::to_string(t), formulas, files);
  }
  out += "; constraints\n" + constraint_lines(model, model.constraints(), formulas, files);
  return out + "; parts\n" + formulas.definitions();
}

}  // namespace parallax::compiler
