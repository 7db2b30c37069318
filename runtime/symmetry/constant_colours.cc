// Colour refinement of the constants of a model (Weisfeiler and Leman 1968, one-dimensional).
//
// In each round a clause gets a colour from those of its atoms, an atom from its clauses and the
// constants in its name, and a constant from the atoms that name it. Sums of hashes forget
// orders, as a symmetry may. A colour depends on the one before it, so what is told apart stays
// so, and the refinement ends with the first round that makes no more colours. Marked constants
// begin with colours of their own. Constants of different colours are exchanged by no symmetry,
// but for a collision of 64-bit hashes; equal colours promise nothing.
//
// Cost: each round is linear in the literals; there are at most as many rounds as atoms and
// constants.

#include "runtime/symmetry/constant_colours.h"

#include <algorithm>

#include "compiler/base/hash.h"

namespace parallax::runtime {

namespace {

std::uint64_t joined(std::uint64_t a, std::uint64_t b) {
  return base::fnv1a64_word(base::fnv1a64_word(base::kFnvStart, a), b);
}

/// The name of a node with its constants blanked.
std::uint64_t kind_of(const NamedAtoms::Node& node) {
  auto kind = base::kFnvStart;
  std::size_t copied = 0;
  for (const auto& place : node.places) {
    kind = base::fnv1a64(std::string_view(node.name).substr(copied, place.begin - copied), kind);
    kind = base::fnv1a64_word(kind, 1);
    copied = place.begin + place.size;
  }
  return base::fnv1a64(std::string_view(node.name).substr(copied), kind);
}

}  // namespace

ConstantColours::ConstantColours(const compiler::CompiledModel& model, const NamedAtoms& atoms,
                                 const PermutationCheck& check)
    : atoms_(atoms) {
  for (const auto& entry : check.entries()) {
    auto tag = joined(static_cast<std::uint64_t>(entry.section),
                      static_cast<std::uint64_t>(model.clause_timepoints[entry.clause]));
    tag = joined(tag, model.clause_is_definition[entry.clause] ? 1 : 0);
    for (const auto literal : model.clauses[entry.clause]) {
      const auto node = node_of(model, literal.var());
      const auto time = literal.var() - static_cast<std::int32_t>(node);  // of its timepoint alone
      places_.push_back({joined(static_cast<std::uint64_t>(time), literal.is_positive()), node});
    }
    clauses_.push_back({tag, places_.size()});
  }
  const auto state = static_cast<ModelNode>(model.base()) + model.state_slots;
  for (ModelNode node = 0; node < atoms.node_count(); ++node) {
    const auto fixed = static_cast<ModelNode>(model.base());
    const std::uint64_t place = node < fixed ? 0 : node < state ? 1 : 2;
    kinds_.push_back(joined(place, kind_of(atoms.node(node))));
  }
}

void ConstantColours::start(std::span<const std::uint32_t> marked) {
  constants_.assign(atoms_.constants().size(), 0);
  for (std::size_t i = 0; i < marked.size(); ++i) constants_[marked[i]] = i + 1;
  nodes_ = kinds_;
}

/// Recolours each atom by the constants that it names and the clauses that it is in, and each
/// constant by the atoms that name it. Sums forget the order of clauses and of literals.
void ConstantColours::refine_once() {
  next_.assign(nodes_.size(), 0);
  std::size_t begin = 0;
  for (const auto& clause : clauses_) {
    auto colour = clause.tag;
    for (auto i = begin; i < clause.end; ++i) {
      colour += joined(places_[i].tag, nodes_[places_[i].node]);
    }
    colour = joined(colour, clause.tag);
    for (auto i = begin; i < clause.end; ++i) {
      next_[places_[i].node] += joined(colour, places_[i].tag);
    }
    begin = clause.end;
  }
  for (ModelNode node = 0; node < nodes_.size(); ++node) {
    auto colour = joined(nodes_[node], next_[node]);
    for (const auto& place : atoms_.node(node).places) {
      colour = joined(colour, constants_[place.constant]);
    }
    nodes_[node] = colour;
  }
  for (std::uint32_t constant = 0; constant < constants_.size(); ++constant) {
    std::uint64_t sum = 0;
    for (const auto node : atoms_.mentions(constant)) {
      const auto& places = atoms_.node(node).places;
      for (std::size_t i = 0; i < places.size(); ++i) {
        if (places[i].constant == constant) sum += joined(nodes_[node], i);
      }
    }
    constants_[constant] = joined(constants_[constant], sum);
  }
  work_ += size() + static_cast<std::int64_t>(nodes_.size());
}

/// Number of different colours of atoms and constants.
std::size_t ConstantColours::count() const {
  std::size_t different = 0;
  for (const auto* all : {&nodes_, &constants_}) {
    auto sorted = *all;
    std::sort(sorted.begin(), sorted.end());
    different +=
        static_cast<std::size_t>(std::unique(sorted.begin(), sorted.end()) - sorted.begin());
  }
  return different;
}

ConstantColours::Colours ConstantColours::refined(std::span<const std::uint32_t> marked,
                                                  std::size_t& rounds) {
  start(marked);
  // A colour determines all colours before it, so that constants once told apart stay so.
  rounds = 0;
  for (std::size_t before = 0, now = count(); before < now; ++rounds) {
    before = now;
    refine_once();
    now = count();
  }
  return constants_;
}

ConstantColours::Colours ConstantColours::after(std::span<const std::uint32_t> marked,
                                                std::size_t rounds) {
  start(marked);
  for (std::size_t i = 0; i < rounds; ++i) refine_once();
  return constants_;
}

}  // namespace parallax::runtime
