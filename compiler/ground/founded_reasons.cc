// Founded completion: no completed atom is true merely because atoms in a circle with it are.
//
// Completion asks a reason of every true atom, and under `A -> B` and `B -> A` each atom is the
// reason of the other. With foundedness an atom also needs a derivation: a reason whose completed
// atoms of the same circle are derived before it. What is derived is the least fixpoint of the
// reasons (the reduct's least model, Gelfond and Lifschitz 1988); together with completion that
// excludes the unfounded loops of Lin and Zhao (2004). The fixpoint is written as a formula, by
// unfolding the reasons as often as a circle has atoms, and each atom implies its own. So there
// are no new atoms, nothing to count twice, and nothing that a proof checker need know.
//
// A circle is a strongly connected component of the completed atoms, each needing those that are
// positive in its reasons. First events, fluents and predicates are looked at without their
// timepoints. If all reasons of a component hold at every timepoint, one formula serves for all;
// else it is searched once more with a node for each timepoint.
//
// The traces are the models that are minimal in the completed atoms, all else fixed
// (circumscription; Ferraris, Lee and Lifschitz 2011), if no two atoms of a circle stand in one
// disjunction: reasons that ask for the absence of the other, as pointwise circumscription makes
// them, are then too strong (Ben-Eliyahu and Dechter 1994). Such a circle is refused.
//
// Cost: linear in the reasons for the graph; a circle of n atoms makes up to n times as many
// formulas as its reasons have, within a limit.

#include "compiler/ground/founded_reasons.h"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>
#include <variant>

#include "compiler/base/codes/grounding.h"
#include "compiler/formula/formula.h"
#include "compiler/ground/components.h"

namespace parallax::compiler {
namespace {

constexpr std::size_t kMostConjuncts = 1'000;  // made of the disjunctions of one axiom

Timepoint width_of(AtomKind kind) { return kind == AtomKind::kHappens ? 1 : 0; }

bool is_circle(const std::vector<std::size_t>& component,
               const std::vector<std::vector<std::size_t>>& needs) {
  if (component.size() > 1) return true;
  const auto& own = needs[component.front()];
  return std::find(own.begin(), own.end(), component.front()) != own.end();
}

}  // namespace

std::vector<FormulaId> separate_conjuncts(FormulaStore& formulas, FormulaId formula) {
  const auto children_of = [&](FormulaId id) {
    const auto span = formulas.children(id);
    return std::vector<FormulaId>(span.begin(), span.end());
  };
  const auto is_conjunction = [&](FormulaId id) {
    return formulas.kind(id) == FormulaNodeKind::kAnd && !id.negated();
  };
  std::vector<FormulaId> done;
  std::size_t made = 0;
  std::vector<FormulaId> todo = {formula};
  while (!todo.empty()) {
    const auto part = todo.back();
    todo.pop_back();
    if (is_conjunction(part)) {
      for (const auto child : children_of(part)) todo.push_back(child);
      continue;
    }
    if (formulas.kind(part) != FormulaNodeKind::kAnd || formulas.is_kept(part)) {
      done.push_back(part);
      continue;
    }
    // A disjunction of the negated children: one of these may be a conjunction.
    auto children = children_of(part);
    const auto inner = std::find_if(children.begin(), children.end(), [&](FormulaId child) {
      return is_conjunction(~child) && !formulas.is_kept(child);
    });
    const auto conjuncts = inner == children.end() ? std::vector<FormulaId>{} : children_of(*inner);
    if (conjuncts.empty() || made + conjuncts.size() > kMostConjuncts) {
      done.push_back(part);
      continue;
    }
    made += conjuncts.size();
    for (const auto conjunct : conjuncts) {
      *inner = ~conjunct;
      todo.push_back(~formulas.conjunction(children));
    }
  }
  return done;
}

void FoundedReasons::add(AtomKind kind, std::uint32_t index, const AtomReasons& reasons,
                         std::uint32_t origin) {
  const auto [entry, added] = numbers_.try_emplace({kind, index}, definitions_.size());
  if (added) definitions_.push_back({kind, index, {}, origin});
  auto& definition = definitions_[entry->second];
  definition.reasons.push_back(&reasons);
  definition.origin = origin;
}

std::optional<std::size_t> FoundedReasons::definition_of(const GroundAtom& atom) const {
  const auto found = numbers_.find({atom.kind, atom.index});
  if (found == numbers_.end()) return std::nullopt;
  return found->second;
}

void FoundedReasons::write() {
  const auto needs = needs_of_definitions();
  for (const auto& component : strong_components(needs)) {
    if (!is_circle(component, needs)) continue;
    if (is_uniform(component)) {
      write_uniform(component);
    } else {
      write_unfolded(component);
    }
  }
}

/// The definitions that each needs at some timepoint.
FoundedReasons::Graph FoundedReasons::needs_of_definitions() const {
  Graph needs;
  for (const auto& definition : definitions_) {
    auto& own = needs.emplace_back();
    const auto look_at = [&](const std::vector<FormulaId>& reasons) {
      for (const auto reason : reasons) {
        for (const auto variable : positive_atoms(model_.formulas(), reason)) {
          if (const auto other = definition_of(model_.atom(variable))) own.push_back(*other);
        }
      }
    };
    for (const auto* reasons : definition.reasons) {
      look_at(reasons->always);
      for (const auto& [t, list] : reasons->single) look_at(list);
    }
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
  }
  return needs;
}

/// Do all reasons hold at every timepoint, and speak of completed atoms of that timepoint? A
/// reason of an event may speak of fluents at the next one.
bool FoundedReasons::is_uniform(const std::vector<std::size_t>& component) const {
  const auto width = width_of(definitions_[component.front()].kind);
  return std::all_of(component.begin(), component.end(), [&](std::size_t member) {
    const auto& definition = definitions_[member];
    return width_of(definition.kind) == width && definition.kind != AtomKind::kPredicate &&
           std::all_of(definition.reasons.begin(), definition.reasons.end(),
                       [](const AtomReasons* reasons) { return reasons->single.empty(); });
  });
}

std::vector<FormulaId> FoundedReasons::reasons_at(const Definition& definition, Timepoint t) {
  std::vector<FormulaId> found;
  for (const auto* reasons : definition.reasons) {
    const auto single = reasons->single.find(t);
    if (single != reasons->single.end()) {
      found.insert(found.end(), single->second.begin(), single->second.end());
    }
    for (const auto reason : reasons->always) {
      found.push_back(model_.shifted(reason, t));
      const auto source = sources_.find({definition.kind, definition.index, reason.bits()});
      if (source == sources_.end()) continue;
      sources_.try_emplace({definition.kind, definition.index, found.back().bits()},
                           source->second);
    }
  }
  return found;
}

FormulaId FoundedReasons::atom_at(const Definition& definition, Timepoint t) {
  if (definition.kind == AtomKind::kHappens) return model_.happens(definition.index, t);
  if (definition.kind == AtomKind::kHoldsAt) return model_.holds(definition.index, t);
  if (definition.kind == AtomKind::kReleasedAt) return model_.released(definition.index, t);
  return model_.predicate(GroundTermId(definition.index));
}

void FoundedReasons::write_uniform(const std::vector<std::size_t>& component) {
  std::vector<Member> members;
  for (const auto number : component) {
    const auto& definition = definitions_[number];
    members.push_back({atom_at(definition, 0), number, reasons_at(definition, 0)});
  }
  write_circle(members, width_of(definitions_[component.front()].kind));
}

void FoundedReasons::write_unfolded(const std::vector<std::size_t>& component) {
  std::vector<Member> members;
  std::unordered_map<std::int32_t, std::size_t> member_of;  // by variable; look-up only
  for (const auto number : component) {
    const auto& definition = definitions_[number];
    const bool timed = definition.kind != AtomKind::kPredicate;
    const auto last = timed ? model_.horizon() - width_of(definition.kind) : 0;
    for (Timepoint t = 0; t <= last; ++t) {
      auto reasons = reasons_at(definition, timed ? t : GroundAtom::kUntimed);
      if (reasons.empty()) continue;
      const auto atom = atom_at(definition, t);
      member_of.emplace(model_.formulas().variable(atom), members.size());
      members.push_back({atom, number, std::move(reasons)});
    }
  }
  Graph needs;
  for (const auto& member : members) {
    auto& own = needs.emplace_back();
    for (const auto reason : member.reasons) {
      for (const auto variable : positive_atoms(model_.formulas(), reason)) {
        const auto found = member_of.find(variable);
        if (found != member_of.end()) own.push_back(found->second);
      }
    }
  }
  for (const auto& part : strong_components(needs)) {
    if (!is_circle(part, needs)) continue;
    std::vector<Member> circle;
    for (const auto member : part) circle.push_back(members[member]);
    write_circle(circle, Constraint::kOnce);
  }
}

void FoundedReasons::write_circle(const std::vector<Member>& members, Timepoint width) {
  auto& formulas = model_.formulas();
  FixpointSystem system;
  for (const auto& member : members) {
    system.unknown_of.emplace(formulas.variable(member.atom), system.definitions.size());
    system.definitions.push_back(formulas.disjunction(member.reasons));
  }
  for (const auto& member : members) {
    if (is_refused(member, system)) return;
  }
  const auto result = least_fixpoint(formulas, system, max_nodes_);
  const auto* derived = std::get_if<std::vector<FormulaId>>(&result);
  if (derived == nullptr) {
    refuse(members.front(), origin_of(members.front()),
           fmt::format("a circle of {} atoms takes more than {} formulas", members.size(),
                       max_nodes_));
    return;
  }
  for (std::size_t i = 0; i < members.size(); ++i) {
    const auto said = formulas.implication(members[i].atom, (*derived)[i]);
    const auto origin = definitions_[members[i].definition].origin;
    if (width == Constraint::kOnce) {
      model_.require(said, origin);
    } else {
      model_.require_always(said, origin, width);
    }
  }
}

base::SourceRange FoundedReasons::origin_of(const Member& member) const {
  return model_.origins()[definitions_[member.definition].origin].source;
}

void FoundedReasons::refuse(const Member& member, base::SourceRange source,
                            const std::string& why) {
  sink_.error(codes::kNotFounded, source,
              atom_text(model_, model_.formulas().variable(member.atom)), why);
}

/// Completed twice, or with a reason that asks for the absence of an atom of its circle?
bool FoundedReasons::is_refused(const Member& member, const FixpointSystem& circle) {
  const auto& definition = definitions_[member.definition];
  if (definition.reasons.size() > 1) {
    refuse(member, origin_of(member),
           "it is completed more than once, and is in a circle of reasons");
    return true;
  }
  for (const auto reason : member.reasons) {
    for (const auto variable : positive_atoms(model_.formulas(), ~reason)) {
      if (!circle.unknown_of.contains(variable)) continue;
      const auto found = sources_.find({definition.kind, definition.index, reason.bits()});
      refuse(member, found == sources_.end() ? origin_of(member) : found->second,
             fmt::format("it is derived here where `{}` is false, which is in a circle with it",
                         atom_text(model_, variable)));
      return true;
    }
  }
  return false;
}

}  // namespace parallax::compiler
