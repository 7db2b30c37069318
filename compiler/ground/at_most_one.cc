// At most one of many atoms, in fewer clauses than pairs.
//
// An axiom such as `Happens(event1,time) & Happens(event2,time) -> event1=event2` gives a clause
// for each pair. Its exclusions are a graph over atoms; cliques are found greedily, in order of
// atoms: a clique begins with the first atom that has enough exclusions left, and takes each of
// its neighbours that excludes all members so far. The clique's pairs are taken out, and the
// clique is said by blocks in their place. Blocks are made of atoms that differ in numbers alone:
// a block of some of several interchangeable constants would tell them apart.
//
// Cost: for each atom the square of the number of its exclusions, up to a limit, beyond which
// pairs stay pairs.

#include "compiler/ground/at_most_one.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <unordered_set>

#include "compiler/formula/formula.h"

namespace parallax::compiler {
namespace {

constexpr std::size_t kMostLookUps = 20'000'000;

void add_pairs(std::span<const FormulaId> members, FormulaStore& formulas,
               std::vector<FormulaId>& out) {
  for (std::size_t i = 0; i < members.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      out.push_back(~formulas.conjunction(members[i], members[j]));
    }
  }
}

/// The constants in the atom's fluent or event, in order.
std::vector<std::uint32_t> constants_of_atom(FormulaId formula, const GroundModel& model) {
  const auto& atom = model.atom(model.formulas().variable(formula));
  const auto& terms = model.terms();
  std::vector<GroundTermId> todo = {atom.kind == AtomKind::kHappens ? model.events()[atom.index]
                                                                    : model.fluents()[atom.index]};
  std::vector<std::uint32_t> found;
  while (!todo.empty()) {
    const auto term = todo.back();
    todo.pop_back();
    if (terms[term].kind == TermKind::kObject) found.push_back(term.index());
    if (terms[term].kind != TermKind::kApply) continue;
    const auto arguments = terms.arguments(term);
    todo.insert(todo.end(), arguments.rbegin(), arguments.rend());
  }
  return found;
}

/// The exclusions `!(a & b)` of HoldsAt and Happens atoms in one axiom.
class ExclusionGraph {
 public:
  /// False: the formula is none.
  bool add(FormulaId part, const GroundModel& model) {
    const auto& formulas = model.formulas();
    if (!part.negated() || formulas.kind(part) != FormulaNodeKind::kAnd) return false;
    const auto both = formulas.children(part);
    if (both.size() != 2) return false;
    for (const auto atom : both) {
      if (atom.negated() || formulas.kind(atom) != FormulaNodeKind::kAtom) return false;
      const auto kind = model.atom(formulas.variable(atom)).kind;
      if (kind != AtomKind::kHoldsAt && kind != AtomKind::kHappens) return false;
    }
    neighbours_[both[0]].push_back(both[1]);
    neighbours_[both[1]].push_back(both[0]);
    edges_.insert(key(both[0], both[1]));
    return true;
  }
  /// Are there atoms that differ in numbers alone? Others are never in one block.
  bool has_blocks(const GroundModel& model) const {
    std::set<std::vector<std::uint32_t>> seen;
    return std::any_of(neighbours_.begin(), neighbours_.end(), [&](const auto& entry) {
      return !seen.insert(constants_of_atom(entry.first, model)).second;
    });
  }

  /// Takes cliques of so many members or more out.
  std::vector<std::vector<FormulaId>> take_cliques(std::size_t least) {
    std::vector<std::vector<FormulaId>> cliques;
    for (auto& [atom, others] : neighbours_) std::sort(others.begin(), others.end());
    for (const auto& [atom, others] : neighbours_) {
      while (others.size() + 1 >= least && look_ups_ < kMostLookUps) {
        auto clique = clique_of(atom, others);
        if (clique.size() < least) break;
        for (std::size_t i = 0; i < clique.size(); ++i) {
          for (std::size_t j = 0; j < i; ++j) edges_.erase(key(clique[i], clique[j]));
        }
        cliques.push_back(std::move(clique));
      }
    }
    return cliques;
  }

  /// The exclusions that are left, in order.
  std::vector<FormulaId> rest(FormulaStore& formulas) const {
    std::vector<FormulaId> out;
    for (const auto& [atom, others] : neighbours_) {
      for (const auto other : others) {
        if (other < atom && has(atom, other)) {
          out.push_back(~formulas.conjunction(atom, other));
        }
      }
    }
    return out;
  }

 private:
  static std::uint64_t key(FormulaId a, FormulaId b) {
    return (std::uint64_t{std::min(a, b).bits()} << 32U) | std::max(a, b).bits();
  }
  bool has(FormulaId a, FormulaId b) const { return edges_.contains(key(a, b)); }

  std::vector<FormulaId> clique_of(FormulaId atom, const std::vector<FormulaId>& others) {
    std::vector<FormulaId> clique = {atom};
    for (const auto other : others) {
      const bool fits = std::all_of(clique.begin(), clique.end(), [&](FormulaId member) {
        ++look_ups_;
        return has(member, other);
      });
      if (fits) clique.push_back(other);
    }
    return clique;
  }

  std::map<FormulaId, std::vector<FormulaId>> neighbours_;
  std::unordered_set<std::uint64_t> edges_;
  std::size_t look_ups_ = 0;
};

}  // namespace

std::vector<FormulaId> at_most_one(const std::vector<FormulaId>& members, std::size_t clique,
                                   FormulaStore& formulas) {
  std::vector<FormulaId> out;
  if (members.size() < clique) {
    add_pairs(members, formulas, out);
    return out;
  }
  const auto width = static_cast<std::size_t>(std::sqrt(static_cast<double>(members.size())));
  std::vector<FormulaId> blocks;
  for (std::size_t begin = 0; begin < members.size(); begin += width) {
    const auto block = std::span(members).subspan(begin, std::min(width, members.size() - begin));
    add_pairs(block, formulas, out);
    blocks.push_back(formulas.disjunction({block.begin(), block.end()}));
  }
  add_pairs(blocks, formulas, out);
  return out;
}

std::vector<FormulaId> at_most_one(std::vector<FormulaId> atoms, std::size_t clique,
                                   GroundModel& model) {
  auto& formulas = model.formulas();
  std::vector<FormulaId> out;
  if (atoms.size() < clique) {
    add_pairs(atoms, formulas, out);
    return out;
  }
  // In the order of the model, which is the same for each of several interchangeable constants.
  const auto place = [&](FormulaId atom) {
    const auto& named = model.atom(formulas.variable(atom));
    return std::pair(named.kind, named.index);
  };
  std::sort(atoms.begin(), atoms.end(),
            [&](FormulaId a, FormulaId b) { return place(a) < place(b); });
  std::map<std::vector<std::uint32_t>, std::vector<FormulaId>> classes;
  for (const auto atom : atoms) classes[constants_of_atom(atom, model)].push_back(atom);
  std::vector<FormulaId> heads;
  for (const auto& [constants, members] : classes) {
    const auto within = at_most_one(members, clique, formulas);
    out.insert(out.end(), within.begin(), within.end());
    heads.push_back(formulas.disjunction(members));
  }
  add_pairs(heads, formulas, out);
  return out;
}

void join_exclusions(GroundModel& model, std::size_t clique) {
  auto& formulas = model.formulas();
  for (std::size_t i = 0; i < model.constraints().size(); ++i) {
    const auto constraint = model.constraints()[i];
    if (constraint.width == Constraint::kOnce || constraint.formula.negated() ||
        formulas.kind(constraint.formula) != FormulaNodeKind::kAnd) {
      continue;
    }
    const auto children = formulas.children(constraint.formula);
    if (children.size() < clique) continue;
    ExclusionGraph graph;
    std::vector<FormulaId> parts;
    for (const auto part : children) {
      if (!graph.add(part, model)) parts.push_back(part);
    }
    if (!graph.has_blocks(model)) continue;
    const auto cliques = graph.take_cliques(clique);
    if (cliques.empty()) continue;
    const auto rest = graph.rest(formulas);
    parts.insert(parts.end(), rest.begin(), rest.end());
    for (const auto& members : cliques) {
      const auto joined = at_most_one(members, clique, model);
      parts.insert(parts.end(), joined.begin(), joined.end());
    }
    model.reword(i, formulas.conjunction(std::move(parts)));
  }
}

}  // namespace parallax::compiler
