#include "runtime/explain/why.h"

#include <algorithm>
#include <map>
#include <memory>
#include <set>

#include "runtime/solver/sat_solver.h"

namespace parallax::runtime {
namespace {

using compiler::AtomKind;
using compiler::CompiledModel;
using compiler::Literal;
using compiler::OriginKind;
using compiler::Timepoint;

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

  /// The facts that make the other literals of a clause false; auxiliaries give way to what decided
  /// them.
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

  /// What decided an auxiliary. That an event did not happen is a better reason than that it would
  /// have had no effect.
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

  /// What takes a fluent out of inertia is behind the choice of its value.
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

std::vector<WhyStep> explain_fact(const CompiledModel& model, Timepoint n,
                                  const std::vector<bool>& values, Literal fact,
                                  const WhyOptions& options) {
  return Explainer(model, n, values, options).run(fact);
}

}  // namespace parallax::runtime
