// The passes from constraints to numbered clauses; the table at the end lists them in order.
//
// Clauses are made over names first (clause_builder.cc) and get their variables afterwards.
// Every name gets a hash from its text and every auxiliary one from the structure of its
// formula, independent of the order in which formulas were built. What exists at each timepoint
// gets a slot, states before steps; the rest gets a fixed place (slot_table.cc). The variable of
// a slot at timepoint t is base + t * stride + slot, so a section of clauses that holds at every
// timepoint is its first copy and a number. An edit of the model therefore changes few numbers
// of an artifact.
//
// Cost: linear in the formula graph and in the clauses written, and n log n in the names.

#include "compiler/cnf/encoder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "compiler/cnf/clause_builder.h"
#include "compiler/cnf/slot_table.h"
#include "compiler/formula/formula.h"
#include "compiler/ground/ground_model.h"

namespace parallax::compiler {
namespace {

/// Turns constraints into clauses over variables of the formula store, gives every variable its
/// place, and writes the clauses over the places. The passes stand in the table below.
class Encoder {
 public:
  Encoder(GroundModel& model, bool folded)
      : model_(model), formulas_(model.formulas()), constraints_(model.constraints()) {
    out_.folded = folded;
  }

  static std::span<const Pass<Encoder>> passes();
  PassSize size() const;
  CompiledModel take() && { return std::move(out_); }

 private:
  std::string constraint_text(const base::SourceFiles* files) const;
  std::string clause_text(const base::SourceFiles* files) const {
    return clause_lines(model_, *builder_, files);
  }
  std::string hash_text(const base::SourceFiles* files) const;
  std::string place_text(const base::SourceFiles* /*files*/) const { return place_lines(out_); }
  std::string numbered_text(const base::SourceFiles* files) const {
    return numbered_lines(out_, files);
  }

  bool is_impossible(const GroundAtom& atom) const {
    return (atom.kind == AtomKind::kHoldsAt && !model_.may_hold(atom.index)) ||
           (atom.kind == AtomKind::kHappens && !model_.may_happen(atom.index));
  }

  /// Atoms that no trace can make true are false, and have no variable.
  void drop_impossible() {
    RewriteMemo memo;
    for (auto& constraint : constraints_) {
      constraint.formula = rewrite_atoms(
          model_.formulas(), constraint.formula,
          [&](std::int32_t variable) {
            return is_impossible(model_.atom(variable)) ? formulas_.falsity()
                                                        : formulas_.atom(variable);
          },
          memo);
    }
  }

  void build_clauses() {
    builder_.emplace(model_);
    for (const auto& constraint : constraints_) builder_->add(constraint);
  }

  /// A hash for every node that depends on names and structure only.
  void hash_nodes() {
    std::vector<std::uint64_t> names(model_.atom_count());
    for (std::size_t i = 0; i < names.size(); ++i) {
      names[i] = atom_hash(model_.atom(static_cast<std::int32_t>(i + 1)));
    }
    hashes_.resize(formulas_.node_count(), 0);
    for (std::uint32_t node = 0; node < hashes_.size(); ++node) {
      const auto id = formulas_.at(node);
      if (formulas_.kind(id) == FormulaNodeKind::kAtom) {
        hashes_[node] = names[static_cast<std::size_t>(formulas_.variable(id)) - 1];
      } else if (formulas_.kind(id) == FormulaNodeKind::kAnd) {
        // A sum: the order of the children depends on the order of construction.
        std::uint64_t sum = 0;
        for (const auto child : formulas_.children(id)) {
          sum += combine_hashes(hashes_[child.node()], child.negated() ? 1 : 0);
        }
        hashes_[node] = combine_hashes(sum, 2);
      }
    }
  }
  std::uint64_t atom_hash(const GroundAtom& atom) {
    return combine_hashes(symbol_hash(atom), static_cast<std::uint64_t>(atom.time + 1));
  }
  std::uint64_t symbol_hash(const GroundAtom& atom) {
    const auto kind = static_cast<std::uint64_t>(atom.kind) + 1;
    if (atom.kind == AtomKind::kAuxiliary) return combine_hashes(kind, ++unnamed_);
    auto& known = symbol_hashes_[{atom.kind, atom.index}];
    if (known == 0) known = stable_hash(model_.atom_name(atom), kind);
    return known;
  }

  /// Atoms other than those of fluents and events have a variable if some clause mentions them.
  void find_mentioned() {
    std::vector<bool> mentioned(model_.atom_count() + 1, false);
    const auto note = [&](const std::vector<OpenClause>& clauses) {
      for (const auto& clause : clauses) {
        for (const auto& literal : clause.literals) {
          if (!literal.is_auxiliary) mentioned[literal.index] = true;
        }
      }
    };
    for (const auto& objective : model_.objectives()) {
      for (const auto& term : objective.terms) {
        if (formulas_.kind(term.formula) != FormulaNodeKind::kAtom) continue;
        mentioned[static_cast<std::size_t>(formulas_.variable(term.formula))] = true;
      }
    }
    note(builder_->once());
    for (const auto& [width, clauses] : builder_->repeated()) note(clauses);
    for (std::size_t i = 1; i < mentioned.size(); ++i) {
      if (mentioned[i] && !has_slot(model_.atom(static_cast<std::int32_t>(i)))) {
        fixed_atoms_.push_back(static_cast<std::int32_t>(i));
      }
    }
  }
  static bool has_slot(const GroundAtom& atom) {
    return atom.kind == AtomKind::kHoldsAt || atom.kind == AtomKind::kReleasedAt ||
           (atom.kind == AtomKind::kHappens && !atom.last);
  }

  void number_slots() {
    out_.horizon = model_.horizon();
    const auto& builder = *builder_;
    const auto fluents = static_cast<std::uint32_t>(model_.fluents().size());
    const auto events = static_cast<std::uint32_t>(model_.events().size());
    // First the slots of states: fluents, releases, auxiliaries of state axioms.
    std::vector<std::uint64_t> state, step;
    for (std::uint32_t f = 0; f < fluents; ++f) {
      if (model_.may_hold(f)) state.push_back(symbol_hash({AtomKind::kHoldsAt, f, 0, false}));
    }
    for (std::uint32_t f = 0; f < fluents; ++f) {
      if (model_.can_be_released(f))
        state.push_back(symbol_hash({AtomKind::kReleasedAt, f, 0, false}));
    }
    for (std::uint32_t e = 0; e < events; ++e) {
      if (model_.may_happen(e)) step.push_back(symbol_hash({AtomKind::kHappens, e, 0, false}));
    }
    for (const auto& auxiliary : builder.auxiliaries()) {
      if (!auxiliary.moves) continue;
      auto& part = builder.needed(auxiliary.formula) == 0 ? state : step;
      part.push_back(hashes_[auxiliary.formula.node()]);
    }
    const auto state_layout = lay_out(state);
    const auto step_layout = lay_out(step);
    out_.state_slots = state_layout.capacity;
    out_.slots.resize(state_layout.capacity + step_layout.capacity);

    std::size_t next_state = 0, next_step = 0;
    const auto take_state = [&] { return state_layout.place[next_state++]; };
    const auto take_step = [&] { return state_layout.capacity + step_layout.place[next_step++]; };
    for (std::uint32_t f = 0; f < fluents; ++f) {
      GroundName named{model_.terms().text(model_.fluents()[f], model_.typed()), std::nullopt};
      if (model_.may_hold(f)) {
        named.slot = take_state();
        out_.slots[*named.slot] = {AtomKind::kHoldsAt, named.name};
      }
      out_.fluents.push_back(std::move(named));
    }
    for (std::uint32_t f = 0; f < fluents; ++f) {
      out_.release_slots.emplace_back();
      if (!model_.can_be_released(f)) continue;
      out_.release_slots.back() = take_state();
      out_.slots[*out_.release_slots.back()] = {AtomKind::kReleasedAt, out_.fluents[f].name};
    }
    for (std::uint32_t e = 0; e < events; ++e) {
      GroundName named{model_.terms().text(model_.events()[e], model_.typed()), std::nullopt};
      if (model_.may_happen(e)) {
        named.slot = take_step();
        out_.slots[*named.slot] = {AtomKind::kHappens, named.name};
      }
      out_.events.push_back(std::move(named));
    }
    auxiliary_places_.resize(builder.auxiliaries().size(), 0);
    for (std::size_t i = 0; i < builder.auxiliaries().size(); ++i) {
      const auto& auxiliary = builder.auxiliaries()[i];
      if (!auxiliary.moves) continue;
      const bool of_state = builder.needed(auxiliary.formula) == 0;
      auxiliary_places_[i] = of_state ? take_state() : take_step();
      out_.slots[auxiliary_places_[i]] = {AtomKind::kAuxiliary, ""};
    }
  }

  void number_fixed() {
    find_mentioned();
    const auto& builder = *builder_;
    std::vector<std::uint64_t> hashes;
    for (const auto variable : fixed_atoms_) hashes.push_back(atom_hash(model_.atom(variable)));
    for (const auto& auxiliary : builder.auxiliaries()) {
      if (!auxiliary.moves) hashes.push_back(hashes_[auxiliary.formula.node()]);
    }
    const auto layout = lay_out(hashes);
    out_.fixed.resize(layout.capacity);
    fixed_places_.resize(model_.atom_count() + 1, 0);
    std::size_t next = 0;
    for (const auto variable : fixed_atoms_) {
      const auto& atom = model_.atom(variable);
      const auto place = layout.place[next++];
      fixed_places_[static_cast<std::size_t>(variable)] = place;
      out_.fixed[place] = model_.described(atom);
    }
    for (std::size_t i = 0; i < builder.auxiliaries().size(); ++i) {
      if (builder.auxiliaries()[i].moves) continue;
      auxiliary_places_[i] = layout.place[next++];
      out_.fixed[auxiliary_places_[i]] = {AtomKind::kAuxiliary, "", std::nullopt, {}};
    }
    moves_.resize(builder.auxiliaries().size());
    for (std::size_t i = 0; i < moves_.size(); ++i) moves_[i] = builder.auxiliaries()[i].moves;
  }

  /// The literal with timepoints as they stand in the formula.
  Literal number(const OpenLiteral& open) const {
    std::int32_t variable = 0;
    if (open.is_auxiliary) {
      const auto place = auxiliary_places_[open.index];
      variable =
          moves_[open.index] ? out_.variable(place, 0) : static_cast<std::int32_t>(place) + 1;
    } else {
      const auto& atom = model_.atom(static_cast<std::int32_t>(open.index));
      if (!has_slot(atom)) {
        variable = static_cast<std::int32_t>(fixed_places_[open.index]) + 1;
      } else if (atom.kind == AtomKind::kHoldsAt) {
        variable = out_.variable(*out_.fluents[atom.index].slot, atom.time);
      } else if (atom.kind == AtomKind::kReleasedAt) {
        variable = out_.variable(*out_.release_slots[atom.index], atom.time);
      } else {
        variable = out_.variable(*out_.events[atom.index].slot, atom.time);
      }
    }
    const auto literal = Literal::positive(variable);
    return open.negated ? ~literal : literal;
  }

  void write_clauses() {
    out_.origins = model_.origins();
    write(builder_->once(), Constraint::kOnce);
    for (const auto& [width, clauses] : builder_->repeated()) write(clauses, width);
    for (const auto& objective : model_.objectives()) write(objective);
  }

  void write(const GroundObjective& objective) {
    auto& out = out_.objectives.emplace_back(Objective{objective.text, {}});
    for (const auto& term : objective.terms) {
      ObjectiveTerm written{term.weight, std::nullopt, term.needed};
      if (formulas_.kind(term.formula) == FormulaNodeKind::kAtom) {
        const auto variable = formulas_.variable(term.formula);
        if (is_impossible(model_.atom(variable))) {
          if (!term.formula.negated()) continue;
        } else {
          written.literal =
              number({false, term.formula.negated(), static_cast<std::uint32_t>(variable)});
        }
      }
      out.terms.push_back(written);
    }
  }

  void write(const std::vector<OpenClause>& clauses, Timepoint width) {
    if (clauses.empty()) return;
    const bool repeated = width != Constraint::kOnce;
    std::vector<std::vector<Literal>> numbered;
    for (const auto& clause : clauses) {
      auto& literals = numbered.emplace_back();
      for (const auto& open : clause.literals) literals.push_back(number(open));
      // The auxiliary that a definition defines stays in front.
      std::sort(literals.begin() + (clause.is_definition ? 1 : 0), literals.end(),
                [](Literal a, Literal b) { return a.var() < b.var(); });
    }
    Section section{out_.clauses.size(), clauses.size(), 1, repeated, 0};
    if (repeated) {
      section.width = width;
      section.copies = model_.horizon() - width + 1;
    }
    std::vector<Literal> moved;
    for (Timepoint s = 0; s < out_.stored_copies(section); ++s) {
      for (std::size_t i = 0; i < clauses.size(); ++i) {
        moved.clear();
        for (const auto literal : numbered[i]) moved.push_back(out_.moved(literal, s));
        out_.clauses.add(moved);
        out_.clause_timepoints.push_back(clauses[i].needed + s);
        out_.clause_origins.push_back(clauses[i].origin);
        out_.clause_is_definition.push_back(clauses[i].is_definition);
      }
    }
    out_.sections.push_back(section);
  }

  GroundModel& model_;
  FormulaStore& formulas_;
  std::vector<Constraint> constraints_;
  std::optional<ClauseBuilder> builder_;  // from `clauses` on
  CompiledModel out_;
  std::vector<std::uint64_t> hashes_;  // by node
  std::map<std::pair<AtomKind, std::uint32_t>, std::uint64_t> symbol_hashes_;
  std::uint64_t unnamed_ = 0;
  std::vector<std::int32_t> fixed_atoms_;        // variables of the store without a slot
  std::vector<std::uint32_t> fixed_places_;      // by variable of the store
  std::vector<std::uint32_t> auxiliary_places_;  // slot or fixed place
  std::vector<bool> moves_;                      // by auxiliary
};

std::span<const Pass<Encoder>> Encoder::passes() {
  using E = Encoder;
  static constexpr std::array<Pass<E>, 6> kPasses = {{
      {{"impossible-atoms", "atoms that no trace makes true become false"},
       &E::drop_impossible,
       &E::constraint_text},
      {{"clauses", "formulas become clauses, parts of them auxiliaries"},
       &E::build_clauses,
       &E::clause_text},
      {{"hashes", "a hash for every atom and part, from names and structure"},
       &E::hash_nodes,
       &E::hash_text},
      {{"slots", "places in a block: fluents, releases, events, parts that move"},
       &E::number_slots,
       &E::place_text},
      {{"fixed-places", "places of everything that does not move"},
       &E::number_fixed,
       &E::place_text},
      {{"numbering", "clauses over variables, a section for each width"},
       &E::write_clauses,
       &E::numbered_text},
  }};
  return kPasses;
}

PassSize Encoder::size() const {
  PassSize size{model_.atom_count(), formulas_.node_count(), constraints_.size(), 0};
  if (!builder_) return size;
  size.clauses = builder_->once().size();
  for (const auto& [width, clauses] : builder_->repeated()) size.clauses += clauses.size();
  return size;
}

std::string Encoder::constraint_text(const base::SourceFiles* files) const {
  auto formulas = formula_text(model_);
  for (const auto& constraint : constraints_) formulas.count(constraint.formula);
  const auto lines = constraint_lines(model_, constraints_, formulas, files);
  return "; constraints\n" + lines + "; parts\n" + formulas.definitions();
}

std::string Encoder::hash_text(const base::SourceFiles* /*files*/) const {
  std::string out;
  const auto add = [&](const std::string& what, std::uint64_t hash) {
    out += fmt::format("{:016x} {}\n", hash, what);
  };
  for (std::uint32_t node = 0; node < hashes_.size(); ++node) {
    const auto id = formulas_.at(node);
    if (formulas_.kind(id) == FormulaNodeKind::kAtom) {
      add(atom_text(model_, formulas_.variable(id)), hashes_[node]);
    }
  }
  const auto& auxiliaries = builder_->auxiliaries();
  for (std::size_t i = 0; i < auxiliaries.size(); ++i) {
    add(fmt::format("#{}{}", i + 1, auxiliaries[i].moves ? " (moves)" : ""),
        hashes_[auxiliaries[i].formula.node()]);
  }
  return out;
}

}  // namespace

std::vector<PassInfo> encode_passes() { return infos_of(Encoder::passes()); }

CompiledModel encode(GroundModel& model, PassLog* log, bool folded) {
  Encoder encoder(model, folded);
  run_passes(Encoder::passes(), encoder, log);
  return std::move(encoder).take();
}

}  // namespace parallax::compiler
