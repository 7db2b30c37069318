#include "compiler/cnf/clause_text.h"

#include <vector>

#include "compiler/artifact/atom.h"
#include "compiler/ground/ground_text.h"

namespace parallax::compiler {
namespace {

std::string line(const GroundModel& model, const OpenClause& clause,
                 const base::SourceFiles* files) {
  auto text = origin_text(model.origins()[clause.origin], files) + ':';
  for (const auto& literal : clause.literals) {
    text += literal.negated ? " !" : " ";
    text += literal.is_auxiliary ? '#' + std::to_string(literal.index + 1)
                                 : atom_text(model, static_cast<std::int32_t>(literal.index));
  }
  return text + (clause.is_definition ? " (definition)\n" : "\n");
}

std::string place_line(std::size_t place, AtomKind kind, const std::string& name,
                       std::optional<Timepoint> time) {
  if (kind == AtomKind::kUnused) return {};
  auto text = std::to_string(place) + ' ' + std::string(to_string(kind));
  if (!name.empty()) text += ' ' + name;
  return text + (time ? " at " + std::to_string(*time) : "") + '\n';
}

}  // namespace

std::string clause_lines(const GroundModel& model, const ClauseBuilder& clauses,
                         const base::SourceFiles* files) {
  std::string out = "; clauses\n";
  for (const auto& clause : clauses.once()) out += line(model, clause, files);
  for (const auto& [width, repeated] : clauses.repeated()) {
    out += "; clauses at every timepoint, width " + std::to_string(width) + '\n';
    for (const auto& clause : repeated) out += line(model, clause, files);
  }
  return out;
}

std::string place_lines(const CompiledModel& model) {
  std::string out = "; slots\n";
  for (std::size_t i = 0; i < model.slots.size(); ++i) {
    out += place_line(i, model.slots[i].kind, model.slots[i].name, std::nullopt);
  }
  out += "; fixed places\n";
  for (std::size_t i = 0; i < model.fixed.size(); ++i) {
    out += place_line(i, model.fixed[i].kind, printed(model.fixed[i]), model.fixed[i].time);
  }
  return out;
}

std::string numbered_lines(const CompiledModel& model, const base::SourceFiles* files) {
  std::string out;
  for (const auto& section : model.sections) {
    out += section.repeated ? "; section of width " + std::to_string(section.width) + ", " +
                                  std::to_string(section.copies) + " blocks\n"
                            : "; section\n";
    for (auto i = section.begin; i < section.begin + section.clauses; ++i) {
      out += origin_text(model.origins[model.clause_origins[i]], files) + ':';
      for (const auto literal : model.clauses[i]) {
        out += ' ' + std::to_string(literal.dimacs());
      }
      out += '\n';
    }
  }
  return out;
}

}  // namespace parallax::compiler
