// Why an atom is true in a trace: a derivation forwards in time.
//
// Literals that are true in the trace are derived stage by stage, the state of a timepoint and
// then its events, by unit propagation over the clauses whose latest atom lies in the stage:
// nothing is explained by its future. Within a stage, effects come before inertia, stated facts,
// other axioms and completion. What is still open is a choice, true atoms first. Each literal
// keeps the one clause that derived it. The chain behind a fact follows these clauses backwards;
// auxiliaries are replaced by the facts that decided them, and inertia is told once, from the
// timepoint since which the fact has held. A choice is tested with one solver call: do the
// choices before it admit the opposite, or is it forced by what comes later?
//
// Cost: linear in the clauses, and one call for each choice in the chain.

#include "runtime/explain/why.h"

#include <algorithm>
#include <map>
#include <memory>
#include <numeric>
#include <set>
#include <tuple>

#include "runtime/solver/sat_solver.h"

namespace parallax::runtime {

using compiler::AtomKind;
using compiler::CompiledModel;
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

class Explainer {
 public:
  Explainer(const CompiledModel& model, Timepoint n, const std::vector<bool>& values,
            const WhyOptions& options)
      : model_(model), n_(n), options_(options), index_(model), derivation_(model, n, values) {}

  std::vector<WhyStep> run(Literal fact) {
    open_ = {fact};
    while (!open_.empty()) {
      const auto next = open_.back();
      open_.pop_back();
      if (!steps_.contains(next.var())) tell(next);
    }
    std::vector<WhyStep> chain;
    for (auto& [variable, step] : steps_) chain.push_back(std::move(step));
    std::sort(chain.begin(), chain.end(), [&](const WhyStep& a, const WhyStep& b) {
      return derivation_.rank(a.fact.var()) < derivation_.rank(b.fact.var());
    });
    return chain;
  }

 private:
  OriginKind kind(std::size_t clause) const {
    return model_.origins[model_.clause_origins[clause]].kind;
  }
  bool is_effect(std::size_t clause) const {
    return kind(clause) == OriginKind::kEffectAxiom || kind(clause) == OriginKind::kTrajectoryAxiom;
  }
  bool is_inertia(Literal fact) const {
    const auto reason = derivation_.reason(fact.var());
    const auto atom = model_.atom(fact.var());
    return reason != Derivation::kChosen && kind(reason) == OriginKind::kFrameAxiom &&
           atom.time.value_or(0) > 0 && !premises(reason, fact).empty();
  }

  /// The facts that make the other literals of a clause false. An auxiliary is replaced by the
  /// facts that decided it.
  std::vector<Literal> premises(std::size_t clause, Literal fact) const {
    std::vector<Literal> found;
    std::set<std::int32_t> seen = {fact.var()};
    std::vector<std::pair<std::size_t, Literal>> open = {{clause, fact}};
    while (!open.empty()) {
      const auto [index, concluded] = open.back();
      open.pop_back();
      for (const auto literal : model_.clauses[index]) {
        if (literal == concluded || !seen.insert(literal.var()).second) continue;
        if (model_.atom(literal.var()).kind != AtomKind::kAuxiliary) {
          found.push_back(~literal);
        } else {
          open.emplace_back(reason_of(~literal, fact), ~literal);
        }
      }
    }
    std::sort(found.begin(), found.end(), [&](Literal a, Literal b) {
      return derivation_.rank(a.var()) < derivation_.rank(b.var());
    });
    return found;
  }

  /// The clause that decided an auxiliary. That an event did not happen is a better reason than
  /// that it would have had no effect.
  std::size_t reason_of(Literal auxiliary, Literal fact) const {
    for (const auto clause : derivation_.supports(auxiliary, derivation_.rank(fact.var()))) {
      const auto literals = model_.clauses[clause];
      const bool absent = std::all_of(literals.begin(), literals.end(), [&](Literal literal) {
        return literal == auxiliary ||
               (literal.is_positive() && model_.atom(literal.var()).kind == AtomKind::kHappens);
      });
      if (absent && literals.size() == 2) return clause;
    }
    return derivation_.reason(auxiliary.var());
  }

  void tell(Literal fact) {
    WhyStep step{fact, WhyKind::kChosen, std::nullopt, {}, 0, {}, {}};
    const auto reason = derivation_.reason(fact.var());
    if (reason == Derivation::kChosen) {
      step.kind = kind_of_choice(fact);
      if (const auto released = release_of(fact)) step.premises.push_back(*released);
    } else if (is_inertia(fact)) {
      follow_inertia(fact, step);
    } else {
      step.origin = model_.clause_origins[reason];
      step.premises = premises(reason, fact);
      step.kind = kind_of(reason, step);
      note_others(fact, step);
    }
    for (const auto premise : step.premises) open_.push_back(premise);
    steps_.emplace(fact.var(), std::move(step));
  }

  /// The release of a fluent from inertia, if it is behind the choice of the fluent's value.
  std::optional<Literal> release_of(Literal fact) const {
    const auto atom = model_.atom(fact.var());
    if (atom.kind != AtomKind::kHoldsAt || atom.time.value_or(0) == 0) return std::nullopt;
    const auto fluent = index_.fluent(fact.var());
    const auto released = fluent ? model_.released_at(*fluent, *atom.time) : std::nullopt;
    const bool known = released && derivation_.is_known(*released) &&
                       derivation_.rank(released->var()) < derivation_.rank(fact.var());
    return known ? released : std::nullopt;
  }

  WhyKind kind_of(std::size_t reason, const WhyStep& step) const {
    if (is_effect(reason)) return WhyKind::kEffect;
    if (kind(reason) == OriginKind::kCompletion) return WhyKind::kCompletion;
    return step.premises.empty() ? WhyKind::kStated : WhyKind::kAxiom;
  }

  /// Goes back to where the fact began, over timepoints at which nothing but inertia kept it.
  void follow_inertia(Literal fact, WhyStep& step) {
    step.kind = WhyKind::kInertia;
    step.origin = model_.clause_origins[derivation_.reason(fact.var())];
    const auto fluent = index_.fluent(fact.var());
    auto at = fact;
    auto time = *model_.atom(fact.var()).time;
    while (time > 0 && is_inertia(at)) {
      std::optional<Literal> before;
      for (const auto premise : premises(derivation_.reason(at.var()), at)) {
        const auto other = model_.atom(premise.var());
        if (other.kind == AtomKind::kHoldsAt && index_.fluent(premise.var()) == fluent &&
            other.time == time - 1) {
          before = premise;
        } else if (other.kind == AtomKind::kHappens && !premise.is_positive()) {
          step.absent.push_back(premise);
        } else if (other.kind != AtomKind::kReleasedAt) {
          step.premises.push_back(premise);
        }
      }
      note_others(at, step);
      if (!before) break;
      at = *before;
      --time;
    }
    step.since = time;
    if (at != fact) step.premises.push_back(at);
  }

  void note_others(Literal fact, WhyStep& step) {
    for (const auto clause : derivation_.other_reasons(fact)) {
      if (!is_effect(clause) && !(options_.alternatives && kind(clause) == OriginKind::kFrameAxiom))
        continue;
      step.also.push_back(clause);
      if (!options_.alternatives) continue;
      for (const auto premise : premises(clause, fact)) open_.push_back(premise);
    }
  }

  /// Does the model, with the choices made before, admit no other value? One solver call.
  WhyKind kind_of_choice(Literal fact) {
    if (solver_ == nullptr) {
      solver_ = make_cadical_solver(options_.stop);
      for (std::size_t i = 0; i < model_.clauses.size(); ++i) {
        if (model_.clause_timepoints[i] <= n_) solver_->add_clause(model_.clauses[i]);
      }
    }
    for (const auto choice : derivation_.choices_before(fact)) solver_->assume(choice);
    solver_->assume(~fact);
    switch (solver_->solve()) {
      case SolveStatus::kUnsatisfiable:
        return WhyKind::kForced;
      case SolveStatus::kSatisfiable:
        return WhyKind::kChosen;
      case SolveStatus::kUnknown:
        break;
    }
    return WhyKind::kUndecided;
  }

  const CompiledModel& model_;
  Timepoint n_;
  const WhyOptions& options_;
  compiler::AtomIndex index_;
  Derivation derivation_;
  std::unique_ptr<SatSolver> solver_;  // made for the first choice
  std::vector<Literal> open_;
  std::map<std::int32_t, WhyStep> steps_;  // by variable
};

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

/// Chooses true variables before false ones: an event rather than the absence of the others.
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

std::vector<WhyStep> explain_fact(const CompiledModel& model, Timepoint n,
                                  const std::vector<bool>& values, Literal fact,
                                  const WhyOptions& options) {
  return Explainer(model, n, values, options).run(fact);
}

}  // namespace parallax::runtime
