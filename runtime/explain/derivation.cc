#include "runtime/explain/derivation.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace parallax::runtime {

using compiler::AtomKind;
using compiler::Literal;
using compiler::OriginKind;
using compiler::Timepoint;

namespace {

std::size_t place(Literal literal) {
  return 2 * (static_cast<std::size_t>(literal.var()) - 1) + (literal.is_positive() ? 0 : 1);
}

/// States of timepoint t: 2t; its events: 2t + 1.
std::uint32_t stage_of(AtomKind kind, Timepoint t) {
  return 2 * static_cast<std::uint32_t>(t) + (kind == AtomKind::kHappens ? 1 : 0);
}

std::uint8_t phase_of(OriginKind kind, bool is_definition, std::size_t size) {
  if (is_definition || kind == OriginKind::kEffectAxiom || kind == OriginKind::kTrajectoryAxiom) {
    return 0;
  }
  if (kind == OriginKind::kFrameAxiom) return 1;
  if (kind == OriginKind::kCompletion) return 4;
  return size == 1 ? 2 : 3;
}

}  // namespace

Derivation::Derivation(const compiler::CompiledModel& model, Timepoint n, std::vector<bool> values)
    : model_(model), n_(n), values_(std::move(values)) {
  PARALLAX_REQUIRE(values_.size() == static_cast<std::size_t>(model.variable_count()),
                   "a value for every variable");
  derived_.assign(values_.size(), 0);
  reasons_.assign(values_.size(), kChosen);
  ranks_.assign(values_.size(), SIZE_MAX);
  find_stages();
  sort_clauses();
  index_occurrences();
  run();
}

void Derivation::find_stages() {
  stages_.assign(values_.size(), kNoStage);
  model_.for_each_atom([&](const compiler::AtomRef& atom) {
    if (!atom.time) return;
    stages_[static_cast<std::size_t>(atom.variable) - 1] = stage_of(atom.kind, *atom.time);
  });
  for (std::size_t v = 0; v < model_.fixed.size(); ++v) {
    const auto& atom = model_.fixed[v];
    if (atom.time && atom.kind != AtomKind::kAuxiliary)
      stages_[v] = stage_of(atom.kind, *atom.time);
  }
}

/// By stage of the latest atom. An untimed atom of a predicate belongs to the first stage at which
/// it meets an atom with a time.
void Derivation::sort_clauses() {
  const auto last = stage_of(AtomKind::kHappens, n_);
  clause_stages_.assign(model_.clauses.size(), kNoStage);
  phases_.assign(model_.clauses.size(), 0);
  std::vector<std::uint32_t> meets(model_.fixed.size(), last);
  for (std::size_t i = 0; i < model_.clauses.size(); ++i) {
    const auto kind = model_.origins[model_.clause_origins[i]].kind;
    if (model_.clause_timepoints[i] > n_ || kind == OriginKind::kInvariant) continue;
    std::uint32_t stage = 0;
    for (const auto literal : model_.clauses[i]) {
      const auto own = stages_[static_cast<std::size_t>(literal.var()) - 1];
      if (own != kNoStage) stage = std::max(stage, own);
    }
    clause_stages_[i] = stage;
    phases_[i] = phase_of(kind, model_.clause_is_definition[i], model_.clauses[i].size());
    schedule_.push_back(i);
    for (const auto literal : model_.clauses[i]) {
      const auto v = static_cast<std::size_t>(literal.var()) - 1;
      if (v < meets.size()) meets[v] = std::min(meets[v], stage);
    }
  }
  std::stable_sort(schedule_.begin(), schedule_.end(), [&](std::size_t a, std::size_t b) {
    return std::tuple(clause_stages_[a], phases_[a]) < std::tuple(clause_stages_[b], phases_[b]);
  });
  for (std::size_t v = 0; v < meets.size(); ++v) {
    if (model_.fixed[v].kind == AtomKind::kPredicate && stages_[v] == kNoStage) {
      stages_[v] = meets[v];
    }
  }
  choices_at_.resize(last + 1);
  for (std::size_t v = 0; v < stages_.size(); ++v) {
    if (stages_[v] <= last) choices_at_[stages_[v]].push_back(static_cast<std::int32_t>(v + 1));
  }
}

void Derivation::index_occurrences() {
  first_.assign(2 * values_.size() + 1, 0);
  for (const auto i : schedule_) {
    for (const auto literal : model_.clauses[i]) ++first_[place(literal) + 1];
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  occurrences_.resize(first_.back());
  auto next = first_;
  for (const auto i : schedule_) {
    for (const auto literal : model_.clauses[i]) occurrences_[next[place(literal)]++] = i;
  }
  open_.assign(model_.clauses.size(), 0);
  for (const auto i : schedule_) open_[i] = static_cast<std::uint32_t>(model_.clauses[i].size());
  active_.assign(model_.clauses.size(), false);
}

void Derivation::run() {
  std::size_t next = 0;
  for (std::uint32_t stage = 0; stage < choices_at_.size(); ++stage) {
    for (std::uint8_t phase = 0; phase <= 4; ++phase) {
      while (next < schedule_.size() && clause_stages_[schedule_[next]] == stage &&
             phases_[schedule_[next]] == phase) {
        activate(schedule_[next++]);
      }
      propagate();
    }
    choose(stage);
  }
}

void Derivation::activate(std::size_t clause) {
  active_[clause] = true;
  if (open_[clause] == 1) fire(clause);
}

void Derivation::fire(std::size_t clause) {
  for (const auto literal : model_.clauses[clause]) {
    if (known(literal) > 0) return;
    if (known(literal) == 0) return derive(literal, clause);
  }
}

void Derivation::derive(Literal literal, std::size_t reason) {
  const auto v = static_cast<std::size_t>(literal.var()) - 1;
  derived_[v] = literal.is_positive() ? 1 : -1;
  reasons_[v] = reason;
  ranks_[v] = order_.size();
  order_.push_back(literal);
}

void Derivation::propagate() {
  while (head_ < order_.size()) {
    const auto falsified = place(~order_[head_++]);
    for (auto i = first_[falsified]; i < first_[falsified + 1]; ++i) {
      const auto clause = occurrences_[i];
      if (--open_[clause] == 1 && active_[clause]) fire(clause);
    }
  }
}

/// What is true is chosen before what is false: an event rather than the absence of the others.
void Derivation::choose(std::uint32_t stage) {
  for (const bool wanted : {true, false}) {
    for (const auto variable : choices_at_[stage]) {
      const auto positive = Literal::positive(variable);
      if (known(positive) != 0 || is_true(positive) != wanted) continue;
      derive(wanted ? positive : ~positive, kChosen);
      propagate();
    }
  }
}

std::vector<std::size_t> Derivation::other_reasons(Literal literal) const {
  std::vector<std::size_t> found;
  const auto stage = stages_[static_cast<std::size_t>(literal.var()) - 1];
  for (auto i = first_[place(literal)]; i < first_[place(literal) + 1]; ++i) {
    const auto clause = occurrences_[i];
    if (model_.clause_is_definition[clause] || clause == reason(literal.var())) continue;
    const auto literals = model_.clauses[clause];
    const bool forces = std::all_of(literals.begin(), literals.end(), [&](Literal other) {
      if (other == literal) return true;
      const auto own = stages_[static_cast<std::size_t>(other.var()) - 1];
      return known(other) < 0 && (own < stage || rank(other.var()) < rank(literal.var()));
    });
    if (forces) found.push_back(clause);
  }
  return found;
}

std::vector<std::size_t> Derivation::supports(Literal literal, std::size_t rank) const {
  std::vector<std::size_t> found;
  for (auto i = first_[place(literal)]; i < first_[place(literal) + 1]; ++i) {
    const auto literals = model_.clauses[occurrences_[i]];
    const bool supports = std::all_of(literals.begin(), literals.end(), [&](Literal other) {
      return other == literal || (known(other) < 0 && this->rank(other.var()) < rank);
    });
    if (supports) found.push_back(occurrences_[i]);
  }
  return found;
}

std::vector<Literal> Derivation::choices_before(Literal literal) const {
  std::vector<Literal> choices;
  for (std::size_t i = 0; i < rank(literal.var()); ++i) {
    if (reason(order_[i].var()) == kChosen) choices.push_back(order_[i]);
  }
  return choices;
}

}  // namespace parallax::runtime
