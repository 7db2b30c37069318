// Prioritized circumscription by a solver (McCarthy 1986; Lifschitz 1985).
//
// A trace's choice is the set of its true literals of each level. From any trace the search goes
// down: it asks for one whose set of the first level is a proper subset, until there is none, keeps
// that set as an upper bound and does the same with the next level. What it arrives at is minimal.
// Then it excludes what is worse or equal: with all literals of the sets up to some level, others
// of that level; and all literals of all sets. As being better is transitive, what is minimal among
// the remaining traces is minimal among all, and the search goes on until none remains.
//
// Traces that are no worse than a choice are those in which all other literals of the levels are
// false, so a few clauses over one auxiliary for each choice select them.
//
// Cost: for each choice one call, and at most one more for each literal; choices can be
// exponentially many.

#include "runtime/optimize/minimal_choice.h"

#include <algorithm>
#include <optional>

#include "compiler/artifact/extended_model.h"

namespace parallax::runtime {
namespace {

using compiler::CompiledModel;

bool contains(const std::vector<Literal>& set, Literal literal) {
  return std::find(set.begin(), set.end(), literal) != set.end();
}

/// Solvers find choices in orders of their own.
bool comes_before(const Levels& a, const Levels& b) {
  return std::lexicographical_compare(
      a.begin(), a.end(), b.begin(), b.end(),
      [](const std::vector<Literal>& x, const std::vector<Literal>& y) {
        return std::lexicographical_compare(
            x.begin(), x.end(), y.begin(), y.end(),
            [](Literal p, Literal q) { return p.dimacs() < q.dimacs(); });
      });
}

class ChoiceSearch {
 public:
  ChoiceSearch(SolverSession& session, const Levels& levels) : session_(session), levels_(levels) {}

  SolveStatus next(Levels& choice) {
    const auto status = session_.solve(horizon(), {});
    if (status != SolveStatus::kSatisfiable) return status;
    choice.clear();
    denied_.clear();
    for (const auto& level : levels_) {
      auto set = true_of(level);
      if (!shrink(level, set)) return SolveStatus::kUnknown;
      deny_others(level, set, denied_);
      choice.push_back(std::move(set));
    }
    exclude(choice);
    return SolveStatus::kSatisfiable;
  }
  /// Nothing but the last choice is minimal: it has no literal at all.
  bool exhausted() const { return exhausted_; }

 private:
  Timepoint horizon() const { return session_.model().horizon; }

  std::vector<Literal> true_of(const std::vector<Literal>& level) const {
    std::vector<Literal> out;
    for (const auto literal : level) {
      if (session_.value(literal)) out.push_back(literal);
    }
    return out;
  }
  static void deny_others(const std::vector<Literal>& level, const std::vector<Literal>& set,
                          std::vector<Literal>& out) {
    for (const auto literal : level) {
      if (!contains(set, literal)) out.push_back(~literal);
    }
  }

  /// Goes down to a minimal set; the valuation at hand has it. False: stopped.
  bool shrink(const std::vector<Literal>& level, std::vector<Literal>& set) {
    while (!set.empty()) {
      const auto guard = session_.new_variable();
      std::vector<Literal> fewer = {~guard};
      for (const auto literal : set) fewer.push_back(~literal);
      session_.add_clause(fewer);
      auto assumptions = denied_;
      assumptions.push_back(guard);
      deny_others(level, set, assumptions);
      const auto status = session_.solve(horizon(), assumptions);
      const Literal done[] = {~guard};
      session_.add_clause(done);
      if (status == SolveStatus::kUnknown) return false;
      if (status == SolveStatus::kUnsatisfiable) return true;
      set = true_of(level);
    }
    return true;
  }

  void exclude(const Levels& choice) {
    std::vector<Literal> all;  // some literal of the sets so far is false
    for (std::size_t i = 0; i < choice.size(); ++i) {
      for (const auto literal : choice[i]) all.push_back(~literal);
      if (i + 1 == choice.size()) break;
      for (const auto literal : levels_[i]) {
        if (contains(choice[i], literal)) continue;
        all.push_back(~literal);
        session_.add_clause(all);
        all.pop_back();
      }
    }
    if (all.empty()) {
      exhausted_ = true;
    } else {
      session_.add_clause(all);
    }
  }

  SolverSession& session_;
  const Levels& levels_;
  std::vector<Literal> denied_;  // literals of the levels before that are false
  bool exhausted_ = false;
};

}  // namespace

MinimalChoices minimal_choices(SolverSession& session, const Levels& levels, std::size_t most) {
  MinimalChoices out;
  ChoiceSearch search(session, levels);
  while (!search.exhausted()) {
    Levels choice;
    const auto status = search.next(choice);
    if (status == SolveStatus::kUnsatisfiable) break;
    if (status == SolveStatus::kUnknown || out.choices.size() == most) return out;
    out.choices.push_back(std::move(choice));
  }
  out.complete = true;
  std::sort(out.choices.begin(), out.choices.end(), comes_before);
  return out;
}

CompiledModel with_choices(const CompiledModel& model, const Levels& levels,
                           const std::vector<Levels>& choices) {
  const auto horizon = model.horizon;
  std::vector<compiler::Atom> atoms;
  std::vector<compiler::AddedClause> clauses;
  std::vector<Literal> some;
  for (const auto& choice : choices) {
    std::optional<Literal> made;  // none: there is no other
    if (choices.size() > 1) {
      atoms.push_back({compiler::AtomKind::kAuxiliary, "", horizon, {}});
      made = Literal::positive(model.variable_count() + static_cast<std::int32_t>(atoms.size()));
      some.push_back(*made);
    }
    std::vector<Literal> others;
    for (std::size_t i = 0; i < levels.size(); ++i) {
      for (const auto literal : levels[i]) {
        if (!contains(choice[i], literal)) others.push_back(literal);
      }
    }
    for (const auto literal : others) {
      std::vector<Literal> denied = {~literal};
      if (made) denied.push_back(~*made);
      clauses.push_back({std::move(denied), horizon, made.has_value()});
    }
    if (!made) continue;
    others.push_back(*made);
    clauses.push_back({std::move(others), horizon, true});
  }
  if (!some.empty()) clauses.push_back({std::move(some), horizon, false});
  return compiler::extended_model(
      model, atoms, clauses,
      {{}, compiler::OriginKind::kObjective, "preference", {}, "preference"});
}

}  // namespace parallax::runtime
