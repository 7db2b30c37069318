// The first step at which model and simulation part, and the axioms to blame for each fluent.
//
// Up to the step before, the model admits what was observed. At the step, the axioms are groups
// of clauses, and so is each observed value, its opposite, and the outcome of the perform. A
// fluent differs if its value contradicts all axioms with the earlier observations; what is
// blamed is an unsatisfiable core, shrunk until every group in it is needed. Cores from the
// axioms about this step alone are preferred to those that go through inertia. If no fluent
// differs by itself, the values contradict the model together, or only with the outcome, and a
// core names those that are needed.
//
// Differences are ordered: effects of the action first, what should hold and does not before
// what should not and does, then by the size of the core. One that follows from the first by
// axioms about single states is told as its consequence. Cost: a few solver calls for each
// fluent, and one for each group of a core.

#include "tools/app/blame.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include "compiler/base/codes/campaigns.h"
#include "runtime/session/solver_session.h"

namespace parallax::tools {
namespace {

using compiler::CompiledModel;
using compiler::Literal;
using compiler::OriginKind;
using runtime::IndexSet;
using runtime::SolveStatus;

bool is_effect(OriginKind kind) {
  return kind == OriginKind::kEffectAxiom || kind == OriginKind::kTrajectoryAxiom;
}

/// Search at one timepoint: the model's axioms in groups, and further groups that state one fluent
/// each, in both ways, and one that states how the last perform ended.
class PartingSearch {
 public:
  PartingSearch(const CompiledModel& model, const ObservedPath& path, std::size_t after,
                Context& context)
      : model_(model),
        path_(path),
        facts_(model),
        axioms_(runtime::group_axioms(model)),
        all_(axioms_.size()) {
    std::iota(all_.begin(), all_.end(), 0U);
    for (const auto group : all_) {
      const bool of_plan = has_origin(group, OriginKind::kPlanStep);
      if (of_plan) of_plan_.push_back(group);
      if (!of_plan && !has_origin(group, OriginKind::kFrameAxiom)) direct_.push_back(group);
    }
    parting_.after = after;
    auto& observed = parting_.observed;
    observed.length = static_cast<compiler::Timepoint>(after);
    const auto steps = std::span(path.states).first(after);
    observed.facts = facts_.facts(path, after, after == 0 ? 0 : after - 1, steps)
                         .value_or(std::vector<Literal>());
    for (const auto& [fluent, holds] : path.states[after]) state(fluent, holds, false);
    for (const auto fluent : path.points[after].neither) state(fluent, true, true);
    runtime::ExecutionFormula formula(model, observed);
    const auto more = 2 * stated_.size() + 1;
    solver_.emplace(runtime::load_axioms(formula, axioms_,
                                         runtime::make_cadical_solver(&context.stop()), more));
    for (std::size_t i = 0; i < stated_.size(); ++i) {
      const auto literal = stated_[i].literal;
      const auto other = ~literal;
      solver_->add(std::span(&literal, 1), as_seen(i));
      solver_->add(std::span(&other, 1), otherwise(i));
    }
    // The facts that the last outcome adds go into a group of their own.
    const auto told = facts_.facts(path, after, after, steps).value_or(observed.facts);
    for (const auto literal : told) {
      if (std::find(observed.facts.begin(), observed.facts.end(), literal) ==
          observed.facts.end()) {
        outcome_.push_back(literal);
        solver_->add(std::span(&literal, 1), outcome_group());
      }
    }
  }

  /// None if the solver was stopped.
  std::optional<Parting> find() {
    if (contradicts({})) {
      parting_.kind = Parting::Kind::kImpossible;
      return done();
    }
    for (std::size_t i = 0; i < stated_.size(); ++i) look_at(i);
    if (parting_.differences.empty()) {
      parting_.kind = joint_kind();
      for (const auto& stated : stated_) {
        if (!stated.neither) parting_.observed.facts.push_back(stated.literal);
      }
      if (parting_.kind == Parting::Kind::kOutcome) {
        parting_.observed.facts.insert(parting_.observed.facts.end(), outcome_.begin(),
                                       outcome_.end());
      }
      return done();
    }
    for (std::size_t i = 0; i < stated_.size(); ++i) {
      const auto differs = difference(i);
      if (!stated_[i].neither || differs != nullptr) {
        const auto literal = stated_[i].literal;
        const bool turned = stated_[i].neither && !differs->observed;
        parting_.observed.facts.push_back(turned ? ~literal : literal);
      }
    }
    rank();
    return done();
  }

 private:
  struct Stated {
    compiler::FluentId fluent;
    Literal literal;  // as observed; if it neither holds nor does not: that it holds
    bool neither;
  };

  void state(compiler::FluentId fluent, bool holds, bool neither) {
    const auto atom = model_.holds_at(fluent, parting_.observed.length);
    if (atom) stated_.push_back({fluent, holds ? *atom : ~*atom, neither});
  }
  std::uint32_t as_seen(std::size_t i) const {
    return static_cast<std::uint32_t>(axioms_.size() + i);
  }
  std::uint32_t otherwise(std::size_t i) const {
    return static_cast<std::uint32_t>(axioms_.size() + stated_.size() + i);
  }
  std::uint32_t outcome_group() const {
    return static_cast<std::uint32_t>(axioms_.size() + 2 * stated_.size());
  }

  bool has_origin(std::uint32_t group, OriginKind kind) const {
    const auto& origins = axioms_.origins[group];
    return std::any_of(origins.begin(), origins.end(),
                       [&](std::uint32_t origin) { return model_.origins[origin].kind == kind; });
  }
  SolveStatus solve(const IndexSet& groups) {
    const auto status = solver_->solve(groups);
    stopped_ = stopped_ || status == SolveStatus::kUnknown;
    return status;
  }
  /// With all axioms.
  bool contradicts(const IndexSet& more) {
    auto groups = all_;
    groups.insert(groups.end(), more.begin(), more.end());
    return solve(groups) == SolveStatus::kUnsatisfiable;
  }

  void look_at(std::size_t i) {
    const auto& stated = stated_[i];
    const bool excluded = contradicts({as_seen(i)});
    bool observed = stated.literal.is_positive();
    if (!excluded) {
      if (!stated.neither || !contradicts({otherwise(i)})) return;
      observed = false;
    }
    // Prefers a core from the axioms about this step alone to one that involves earlier states.
    auto axioms_only = direct_;
    axioms_only.push_back(excluded ? as_seen(i) : otherwise(i));
    if (solve(axioms_only) != SolveStatus::kUnsatisfiable) {
      excluded ? contradicts({as_seen(i)}) : contradicts({otherwise(i)});
    }
    auto blamed = solver_->core();
    stopped_ = !runtime::shrink(*solver_, blamed) || stopped_;
    std::erase_if(blamed, [&](std::uint32_t group) { return group >= axioms_.size(); });
    parting_.differences.push_back({stated.fluent, model_.fluents[stated.fluent.index()].name,
                                    observed, stated.neither, Difference::Role::kFurther,
                                    std::move(blamed)});
    numbers_.push_back(i);
  }

  Parting::Kind joint_kind() {
    IndexSet seen;
    for (std::size_t i = 0; i < stated_.size(); ++i) {
      if (!stated_[i].neither) seen.push_back(as_seen(i));
    }
    auto kind = Parting::Kind::kTogether;
    if (!contradicts(seen)) {
      seen.push_back(outcome_group());
      if (!contradicts(seen)) return Parting::Kind::kNoState;
      kind = Parting::Kind::kOutcome;
    }
    // Prefers a core from the observed fluents to one that follows from the preceding state. The
    // plan decides how a perform ended, from what was observed.
    auto few = kind == Parting::Kind::kTogether ? direct_ : of_plan_;
    few.insert(few.end(), seen.begin(), seen.end());
    if (solve(few) != SolveStatus::kUnsatisfiable) contradicts(seen);
    auto core = solver_->core();
    stopped_ = !runtime::shrink(*solver_, core) || stopped_;
    for (std::size_t i = 0; i < stated_.size(); ++i) {
      if (!std::binary_search(core.begin(), core.end(), as_seen(i))) continue;
      parting_.needed.emplace_back(stated_[i].fluent, stated_[i].literal.is_positive());
    }
    return kind;
  }

  const Difference* difference(std::size_t i) const {
    const auto at = std::find(numbers_.begin(), numbers_.end(), i);
    return at == numbers_.end()
               ? nullptr
               : &parting_.differences[static_cast<std::size_t>(at - numbers_.begin())];
  }

  /// Orders the differences. Effects of the action come first: fluents that should hold and do not,
  /// then fluents that should not hold and do. Fluents that no axiom of the event explains follow
  /// in the same order.
  void rank() {
    const auto of_event = groups_of_event(model_, axioms_, path_, parting_);
    const auto is_caused = [&](const Difference& difference) {
      return std::any_of(difference.blamed.begin(), difference.blamed.end(), [&](auto group) {
        return std::binary_search(of_event.begin(), of_event.end(), group);
      });
    };
    std::vector<std::size_t> order(parting_.differences.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      const auto key = [&](std::size_t i) {
        const auto& difference = parting_.differences[i];
        return std::tuple(!is_caused(difference), difference.observed, difference.blamed.size());
      };
      return key(a) < key(b);
    });
    const auto first = numbers_[order.front()];
    std::vector<Difference> ranked;
    for (const auto i : order) {
      auto& difference = ranked.emplace_back(parting_.differences[i]);
      using Role = Difference::Role;
      if (numbers_[i] == first) {
        difference.role = Role::kFirst;
      } else if (!difference.neither && follows(numbers_[i], first)) {
        difference.role = Role::kFollows;
      } else if (is_caused(difference) && is_caused(ranked.front())) {
        difference.role = Role::kSameAction;
      }
    }
    parting_.differences = std::move(ranked);
  }

  /// Do axioms about single states alone imply this difference, given the first one and everything
  /// that the model predicts correctly?
  bool follows(std::size_t i, std::size_t first) {
    IndexSet groups;
    for (const auto group : all_) {
      const auto& origins = axioms_.origins[group];
      if (std::all_of(origins.begin(), origins.end(), [&](std::uint32_t origin) {
            return model_.origins[origin].kind == OriginKind::kAxiom;
          })) {
        groups.push_back(group);
      }
    }
    for (std::size_t j = 0; j < stated_.size(); ++j) {
      if (!stated_[j].neither && (j == first || difference(j) == nullptr)) {
        groups.push_back(as_seen(j));
      }
    }
    groups.push_back(otherwise(i));
    return solve(groups) == SolveStatus::kUnsatisfiable;
  }

  std::optional<Parting> done() {
    if (stopped_) return std::nullopt;
    return std::move(parting_);
  }

  const CompiledModel& model_;
  const ObservedPath& path_;
  PathFacts facts_;
  runtime::AxiomGroups axioms_;
  IndexSet all_, of_plan_, direct_;  // direct_: neither inertia nor of the plan
  std::vector<Stated> stated_;
  std::vector<Literal> outcome_;
  std::optional<runtime::GroupSolver> solver_;
  std::vector<std::size_t> numbers_;  // of the differences, as they were found
  bool stopped_ = false;
  Parting parting_;
};

}  // namespace

IndexSet groups_of_event(const CompiledModel& model, const runtime::AxiomGroups& axioms,
                         const ObservedPath& path, const Parting& parting) {
  IndexSet out;
  if (parting.after == 0) return out;
  const auto event = path.steps[parting.after - 1].event;
  const auto slot = model.events[event.index()].slot;
  if (!slot) return out;
  const auto happens =
      Literal::positive(model.variable(*slot, static_cast<compiler::Timepoint>(parting.after) - 1));
  for (std::size_t c = 0; c < model.clauses.size(); ++c) {
    const auto origin = model.clause_origins[c];
    const auto group = axioms.group_of[origin];
    if (!is_effect(model.origins[origin].kind) || group == runtime::AxiomGroups::kNone) continue;
    const auto clause = model.clauses[c];
    if (std::find(clause.begin(), clause.end(), ~happens) != clause.end()) out.push_back(group);
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

base::Result<std::optional<Parting>> find_parting(const CompiledModel& model,
                                                  const ObservedPath& path, Context& context) {
  runtime::SolverSession session(model, runtime::make_cadical_solver(&context.stop()));
  const auto where = parting_of(path, PathFacts(model), session);
  if (!where.undecided && !where.after) return std::optional<Parting>();
  if (!where.undecided) {
    if (auto parting = PartingSearch(model, path, *where.after, context).find()) {
      return std::optional(*std::move(parting));
    }
  }
  return context.sink().error_about(codes::kExplanationCutShort, "",
                                    "where model and simulation part is not known");
}

}  // namespace parallax::tools
