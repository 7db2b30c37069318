// Clauses from a graph of formulas, with auxiliaries for shared parts (Plaisted and Greenbaum
// 1986).
//
// Conjunctions at the top are split, a disjunction becomes one clause, and a part below it
// becomes an auxiliary. The auxiliary is defined only in the polarity in which it is used, each
// polarity once, so the number of clauses is linear in the graph. Formulas are made of negations
// and conjunctions only. A constraint that holds at every timepoint is encoded once, at
// timepoint 0: its auxiliaries move with it, except those of parts that mention no timepoint,
// which are the same at all.
//
// A part needs the latest timepoint that its atoms mention; nodes are made after their children,
// so one pass in order of ids finds all of these. Cost: linear in nodes and edges.

#include "compiler/cnf/clause_builder.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "compiler/artifact/atom.h"
#include "compiler/ground/ground_model.h"

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

/// Nodes are made after their children, so one pass in order of ids is enough.
ClauseBuilder::ClauseBuilder(const GroundModel& model)
    : model_(model), formulas_(model.formulas()) {
  const auto count = static_cast<std::uint32_t>(formulas_.node_count());
  needed_.resize(count, 0);
  timed_.resize(count, false);
  known_.resize(count);
  for (std::uint32_t node = 0; node < count; ++node) {
    const auto id = formulas_.at(node);
    if (formulas_.kind(id) == FormulaNodeKind::kAtom) {
      const auto& atom = model.atom(formulas_.variable(id));
      needed_[node] = atom.needed_horizon();
      timed_[node] = atom.time != GroundAtom::kUntimed;
    } else if (formulas_.kind(id) == FormulaNodeKind::kAnd) {
      for (const auto child : formulas_.children(id)) {
        needed_[node] = std::max(needed_[node], needed_[child.node()]);
        if (timed_[child.node()]) timed_[node] = true;
      }
    }
  }
}

void ClauseBuilder::add(const Constraint& constraint) {
  origin_ = constraint.origin;
  const bool moves = constraint.width != Constraint::kOnce;
  std::vector<FormulaId> todo = {constraint.formula};
  while (!todo.empty()) {
    const auto id = todo.back();
    todo.pop_back();
    if (formulas_.kind(id) == FormulaNodeKind::kAnd && !id.negated()) {
      const auto children = formulas_.children(id);
      todo.insert(todo.end(), children.rbegin(), children.rend());
      continue;
    }
    if (id == formulas_.truth()) continue;
    OpenClause clause{{}, origin_, false, needed_[id.node()]};
    if (formulas_.kind(id) == FormulaNodeKind::kAnd) {
      for (const auto child : formulas_.children(id)) clause.literals.push_back(use(~child, moves));
    } else if (id != formulas_.falsity()) {
      clause.literals.push_back(use(id, moves));
    }
    // The empty clause: whatever asserted it is contradictory.
    emit(std::move(clause), constraint.width);
  }
  define_pending();
}

/// A literal that implies `id`; its definition is queued if this polarity has none yet.
OpenLiteral ClauseBuilder::use(FormulaId id, bool moves) {
  if (formulas_.kind(id) == FormulaNodeKind::kAtom) {
    return {false, id.negated(), static_cast<std::uint32_t>(formulas_.variable(id))};
  }
  // A formula that mentions no timepoint has one auxiliary for all timepoints.
  const bool copies = moves && timed_[id.node()];
  auto& known = known_[id.node()];
  if (known.auxiliary[copies] == 0) {
    auxiliaries_.push_back({id.negated() ? ~id : id, copies});
    known.auxiliary[copies] = static_cast<std::uint32_t>(auxiliaries_.size());
  }
  const std::uint8_t polarity = id.negated() ? 2 : 1;
  if ((known.defined[copies] & polarity) == 0) {
    known.defined[copies] = static_cast<std::uint8_t>(known.defined[copies] | polarity);
    pending_.emplace_back(id, copies);
  }
  return {true, id.negated(), known.auxiliary[copies] - 1};
}

void ClauseBuilder::define_pending() {
  while (!pending_.empty()) {
    const auto [id, moves] = pending_.back();
    pending_.pop_back();
    const OpenLiteral self{true, false, known_[id.node()].auxiliary[moves] - 1};
    const auto needed = needed_[id.node()];
    const auto width = moves ? needed : Constraint::kOnce;
    if (!id.negated()) {
      for (const auto child : formulas_.children(id)) {
        auto not_self = self;
        not_self.negated = true;
        emit({{not_self, use(child, moves)}, origin_, true, needed}, width);
      }
    } else {
      OpenClause clause{{self}, origin_, true, needed};
      for (const auto child : formulas_.children(id)) clause.literals.push_back(use(~child, moves));
      emit(std::move(clause), width);
    }
  }
}

void ClauseBuilder::emit(OpenClause clause, Timepoint width) {
  if (width == Constraint::kOnce) {
    once_.push_back(std::move(clause));
  } else {
    clause.needed = width;
    repeated_[width].push_back(std::move(clause));
  }
}

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
