// The states that one step leads to, with as few demanded events as possible.
//
// A demanded event happens only where axioms force it, so for a given state, given events and
// each choice of the unobserved ones, the demanded events of a step have to be a subset-minimal
// set among those possible (WindowSolver::least). Observations of the state after the step are no
// reasons for events; they select states only after the sets are known.
//
// Cost: for each choice of the unobserved events the search for the minimal sets, and one question
// for each set. Choices, sets and states are limited; beyond that the answer is incomplete.

#include "runtime/monitor/step_query.h"

#include <iterator>
#include <utility>

namespace parallax::runtime {
namespace {

/// The window with three further variables, each of which makes a literal of a list true.
WindowClauses with_lists(WindowClauses window, const StepLiterals& literals) {
  for (const auto* list : {&literals.unobserved, &literals.alone, &literals.succeeded}) {
    auto& clause = window.clauses.emplace_back();
    for (const auto literal : *list) clause.push_back(literal.dimacs());
    clause.push_back(-++window.variables);
  }
  return window;
}

}  // namespace

StepQuery::StepQuery(WindowClauses window, const StepLiterals& literals,
                     const std::atomic<bool>* stop)
    : window_(with_lists(std::move(window), literals)),
      literals_(literals),
      stop_(stop),
      after_(window_, literals.after, stop) {}

WindowSolver::Answer StepQuery::ask(const StepQuestion& question, std::size_t limit) {
  if (!question.is_least) {
    auto given = question.given;
    given.insert(given.end(), question.after.begin(), question.after.end());
    return after_.ask(given, {limit});
  }
  // Demanded events depend on the other events, so each choice of the others is considered
  // separately.
  WindowSolver::Answer choices{{Bits()}};
  if (!literals_.unobserved.empty()) {
    if (!unobserved_) unobserved_.emplace(window_, literals_.unobserved, stop_);
    choices = unobserved_->ask(question.given, {limit});
  }
  WindowSolver::Answer answer{{}, choices.end};
  for (const auto& choice : choices.found) {
    if (!answer.is_complete()) break;
    auto given = question.given;
    assume(literals_.unobserved, choice, given);
    answer.end = add_least(std::move(given), question, limit, answer.found);
  }
  return answer;
}

/// Adds the states for all subset-minimal sets.
WindowEnd StepQuery::add_least(std::vector<Literal> given, const StepQuestion& question,
                               std::size_t limit, std::vector<Bits>& found) {
  if (!demanded_) demanded_.emplace(window_, literals_.demanded, stop_);
  const auto least = demanded_->least(given, limit);
  if (!least.is_complete()) return least.end;
  given.insert(given.end(), question.after.begin(), question.after.end());
  for (const auto& events : least.found) {
    if (found.size() >= limit) return WindowEnd::kTooMany;
    auto assumptions = given;
    assume(literals_.demanded, events, assumptions);
    auto states = after_.ask(assumptions, {limit - found.size()});
    std::move(states.found.begin(), states.found.end(), std::back_inserter(found));
    if (!states.is_complete()) return states.end;
  }
  return WindowEnd::kComplete;
}

}  // namespace parallax::runtime
