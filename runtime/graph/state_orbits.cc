// States of a layered graph up to the symmetries of its model.
//
// From a state and from its image under a symmetry equally many traces go on, so a graph that
// counts needs one of the two. A generator is a list of moves of bits; it is kept only if it
// maps fixed values onto themselves and takes every bit of a state to a bit of a state. A state
// is represented by applying generators as long as one leads to an earlier state (false before
// true). That ends, as states only get earlier, in a state of the same orbit; an orbit may keep
// several such states, which costs nodes but never changes the count. Symmetries of the model
// without its initial state serve all later states.
//
// Cost: linear in the bits that generators move, for each improvement.

#include "runtime/graph/state_orbits.h"

#include <algorithm>
#include <limits>

namespace parallax::runtime {
namespace {

constexpr auto kNowhere = std::numeric_limits<std::uint32_t>::max();

/// By slot: its place in the list.
std::vector<std::uint32_t> places(const std::vector<std::uint32_t>& slots, std::uint32_t count) {
  std::vector<std::uint32_t> out(count, kNowhere);
  for (std::uint32_t i = 0; i < slots.size(); ++i) out[slots[i]] = i;
  return out;
}

/// By fixed variable - 1: 1 and -1 of those that have a value in every trace.
std::vector<std::int8_t> fixed_values(const CompiledModel& model, const LayeredModel& layered) {
  std::vector<std::int8_t> values(static_cast<std::size_t>(model.base()), -1);
  for (const auto v : layered.true_fixed) values[static_cast<std::size_t>(v) - 1] = 1;
  for (const auto v : layered.open_fixed) values[static_cast<std::size_t>(v) - 1] = 0;
  return values;
}

Bits moved(const Bits& bits, const std::vector<std::pair<std::uint32_t, std::uint32_t>>& moves) {
  auto out = bits;
  for (const auto& [to, from] : moves) out[to] = bits[from];
  return out;
}

/// Where each named node stands in a state; kNowhere: it is an event, or no part of a state.
class StatePlaces {
 public:
  StatePlaces(const CompiledModel& model, const LayeredModel& layered)
      : base_(static_cast<ModelNode>(model.base())),
        own_(model.state_slots),
        observed_(places(layered.observed, layered.state_slots)),
        hidden_(places(layered.hidden, layered.state_slots)),
        carried_(base_, kNowhere) {
    for (std::uint32_t k = 0; k < layered.carried.size(); ++k) {
      const auto v = static_cast<std::size_t>(layered.carried[k]) - 1;
      if (v < carried_.size()) carried_[v] = hidden_[own_ + k];
    }
  }
  std::uint32_t observed(ModelNode node) const { return of(observed_, node); }
  std::uint32_t hidden(ModelNode node) const {
    return node < base_ ? carried_[node] : of(hidden_, node);
  }

 private:
  std::uint32_t of(const std::vector<std::uint32_t>& by_slot, ModelNode node) const {
    return node < base_ || node - base_ >= own_ ? kNowhere : by_slot[node - base_];
  }

  ModelNode base_;
  std::uint32_t own_;
  std::vector<std::uint32_t> observed_, hidden_;  // by slot
  std::vector<std::uint32_t> carried_;            // by fixed variable - 1
};

/// Do only atoms with names remain hidden in a state? Auxiliaries move with their formulas, and
/// copies of atoms of other timepoints are no atoms.
bool is_named(const CompiledModel& model, const LayeredModel& layered) {
  const auto is_of_model = [&](std::int32_t v) { return v <= model.base(); };
  if (!std::all_of(layered.carried.begin(), layered.carried.end(), is_of_model)) return false;
  return std::none_of(layered.hidden.begin(), layered.hidden.end(), [&](std::uint32_t slot) {
    if (slot < model.state_slots) return model.slots[slot].kind == compiler::AtomKind::kAuxiliary;
    const auto v = static_cast<std::size_t>(layered.carried[slot - model.state_slots]) - 1;
    return model.fixed[v].kind == compiler::AtomKind::kAuxiliary;
  });
}

}  // namespace

std::optional<StateOrbits::Generator> StateOrbits::generator(const CompiledModel& model,
                                                             const LayeredModel& layered,
                                                             const NodeMap& symmetry) {
  const StatePlaces places(model, layered);
  const auto values = fixed_values(model, layered);
  Generator out;
  for (const auto& [from, to] : symmetry) {
    if (from < values.size() && values[from] != values[to]) return std::nullopt;
    const auto observed = std::pair(places.observed(to), places.observed(from));
    const auto hidden = std::pair(places.hidden(to), places.hidden(from));
    // A bit that only one of the two states has would be lost.
    if ((observed.first == kNowhere) != (observed.second == kNowhere)) return std::nullopt;
    if ((hidden.first == kNowhere) != (hidden.second == kNowhere)) return std::nullopt;
    if (observed.first != kNowhere) out.observed.push_back(observed);
    if (hidden.first != kNowhere) out.hidden.push_back(hidden);
  }
  if (out.observed.empty() && out.hidden.empty()) return std::nullopt;
  std::sort(out.observed.begin(), out.observed.end());
  std::sort(out.hidden.begin(), out.hidden.end());
  return out;
}

StateOrbits::StateOrbits(const CompiledModel& model, const LayeredModel& layered,
                         std::span<const NodeMap> symmetries) {
  if (!is_named(model, layered)) return;
  for (const auto& symmetry : symmetries) {
    auto acting = generator(model, layered, symmetry);
    if (acting) generators_.push_back(std::move(*acting));
  }
}

bool StateOrbits::apply_if_earlier(const Generator& generator, GraphNode& node) {
  const auto& moves = generator.observed;
  const auto first = std::find_if(moves.begin(), moves.end(), [&](const auto& move) {
    return node.observed[move.first] != node.observed[move.second];
  });
  if (first != moves.end() && node.observed[first->first] == false) return false;
  std::vector<Bits> hidden;
  hidden.reserve(node.hidden.size());
  for (const auto& bits : node.hidden) hidden.push_back(moved(bits, generator.hidden));
  std::sort(hidden.begin(), hidden.end());
  if (first == moves.end() && node.hidden <= hidden) return false;
  node.observed = moved(node.observed, moves);
  node.hidden = std::move(hidden);
  return true;
}

void StateOrbits::represent(GraphNode& node) const {
  for (bool is_moved = true; is_moved;) {
    is_moved = false;
    for (const auto& generator : generators_) {
      while (apply_if_earlier(generator, node)) is_moved = true;
    }
  }
}

CompiledModel model_after_start(const CompiledModel& model) {
  const auto is_of_start = [&](std::span<const Literal> clause) {
    bool any = false;
    for (const auto literal : clause) {
      if (literal.var() <= model.base()) continue;
      if (literal.var() > model.base() + static_cast<std::int32_t>(model.state_slots)) return false;
      any = true;
    }
    return any;
  };
  CompiledModel out = model;
  out.clauses = {};
  out.clause_timepoints.clear();
  out.clause_origins.clear();
  out.clause_is_definition.clear();
  for (auto& section : out.sections) {
    const auto begin = section.begin;
    const auto end = begin + section.clauses * static_cast<std::size_t>(section.copies);
    section.begin = out.clauses.size();
    for (auto c = begin; c < end; ++c) {
      if (!section.repeated && is_of_start(model.clauses[c])) continue;
      out.clauses.add(model.clauses[c]);
      out.clause_timepoints.push_back(model.clause_timepoints[c]);
      out.clause_origins.push_back(model.clause_origins[c]);
      out.clause_is_definition.push_back(model.clause_is_definition[c]);
    }
    if (!section.repeated) section.clauses = out.clauses.size() - section.begin;
  }
  for (auto& origin : out.origins) {
    if (origin.kind == compiler::OriginKind::kInvariant) origin.kind = compiler::OriginKind::kAxiom;
  }
  return out;
}

GraphOrbits GraphOrbits::of(const CompiledModel& model, const LayeredModel& layered) {
  const ModelSymmetry whole(model, SymmetryEffort::kQuick);
  const ModelSymmetry after(model_after_start(model), SymmetryEffort::kQuick);
  std::vector<NodeMap> either(after.all().begin(), after.all().end());
  either.insert(either.end(), whole.all().begin(), whole.all().end());
  return {{model, layered, whole.all()}, {model, layered, either}};
}

}  // namespace parallax::runtime
