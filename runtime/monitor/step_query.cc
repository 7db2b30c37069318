// The states that one step leads to, with as few demanded events as possible.
//
// A demanded event happens only where axioms force it, so for a given state, given events and
// each choice of the unobserved ones, the demanded events of a step have to be a subset-minimal
// set among those possible. One such set is found by taking events out of a possible one as long
// as a step remains. For the others a tree is searched as for minimal diagnoses (Reiter 1987): a
// node denies some events, the minimal set found without them has a child for each of its
// events, which denies that one too. A further minimal set contains no known one, so it lacks an
// event of each and is met below. Observations of the state after the step are no reasons for
// events; they select states only after the sets are known.
//
// Cost: for each node, one call and one more for each event of the set found. The nodes are
// limited; beyond that the answer is incomplete.

#include "runtime/monitor/step_query.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

namespace parallax::runtime {
namespace {

/// `assumed` makes one of `any` true.
std::vector<Literal> one_of(Literal assumed, std::vector<Literal> any) {
  any.push_back(~assumed);
  return any;
}

bool has_event(const DemandedEvents& events, std::uint32_t event) {
  return std::binary_search(events.begin(), events.end(), event);
}

}  // namespace

StepQuery::StepQuery(WindowClauses window, const StepLiterals& literals,
                     const std::atomic<bool>* stop)
    : window_(std::move(window)), literals_(literals), stop_(stop), after_(query(literals.after)) {}

std::unique_ptr<WindowQuery> StepQuery::query(const std::vector<Literal>& projection) const {
  std::vector<std::vector<Literal>> more = {one_of(some_unobserved(), literals_.unobserved),
                                            one_of(some_alone(), literals_.alone),
                                            one_of(some_succeeded(), literals_.succeeded)};
  return std::make_unique<WindowQuery>(window_, std::move(more), window_.variables + 3, projection,
                                       stop_);
}

WindowQuery::Answer StepQuery::ask(const StepQuestion& question, std::size_t limit) {
  if (question.demanded.empty()) {
    auto given = question.given;
    given.insert(given.end(), question.after.begin(), question.after.end());
    return after_->ask(given, limit);
  }
  WindowQuery::Answer answer;
  if (literals_.unobserved.empty()) {
    answer.complete = add_least(question.given, question, limit, answer);
    return answer;
  }
  // Demanded events depend on the other events, so each choice of the others is considered
  // separately.
  if (unobserved_ == nullptr) unobserved_ = query(literals_.unobserved);
  const auto choices = unobserved_->ask(question.given, limit);
  answer.complete = choices.complete;
  for (const auto& choice : choices.found) {
    if (!answer.complete) break;
    auto given = question.given;
    for (std::size_t i = 0; i < choice.size(); ++i) {
      given.push_back(choice[i] ? literals_.unobserved[i] : ~literals_.unobserved[i]);
    }
    answer.complete = add_least(given, question, limit, answer);
  }
  return answer;
}

/// Demanded events of some possible step, all of them `allowed`. None: there is none, or it is not
/// known.
std::optional<DemandedEvents> StepQuery::some(const std::vector<Literal>& given,
                                              const DemandedEvents& demanded,
                                              const DemandedEvents& allowed, bool& is_complete) {
  if (demanded_ == nullptr) demanded_ = query(literals_.demanded);
  auto assumptions = given;
  for (const auto event : demanded) {
    if (!has_event(allowed, event)) assumptions.push_back(~literals_.demanded[event]);
  }
  const auto answer = demanded_->ask(assumptions, 1);
  if (answer.found.empty()) {
    is_complete = is_complete && answer.complete;
    return std::nullopt;
  }
  DemandedEvents out;
  for (const auto event : allowed) {
    if (answer.found.front()[event]) out.push_back(event);
  }
  return out;
}

/// One of the subset-minimal sets without the `denied` events.
std::optional<DemandedEvents> StepQuery::least_within(const std::vector<Literal>& given,
                                                      const DemandedEvents& demanded,
                                                      const DemandedEvents& denied,
                                                      bool& is_complete) {
  DemandedEvents allowed;
  std::set_difference(demanded.begin(), demanded.end(), denied.begin(), denied.end(),
                      std::back_inserter(allowed));
  auto least = some(given, demanded, allowed, is_complete);
  if (!least) return least;
  for (const auto event : DemandedEvents(*least)) {
    auto fewer = *least;
    if (std::erase(fewer, event) == 0) continue;
    if (auto found = some(given, demanded, fewer, is_complete)) least = std::move(found);
  }
  return least;
}

/// Adds the states for all subset-minimal sets. False: there are too many, or it was stopped.
bool StepQuery::add_least(const std::vector<Literal>& given, const StepQuestion& question,
                          std::size_t limit, WindowQuery::Answer& answer) {
  const auto& demanded = question.demanded;
  bool is_complete = true;
  std::set<DemandedEvents> least, seen;
  // A further least set lacks some event of each that is known (Reiter 1987).
  std::vector<DemandedEvents> todo = {{}};
  while (!todo.empty() && is_complete) {
    const auto denied = std::move(todo.back());
    todo.pop_back();
    const auto found = least_within(given, demanded, denied, is_complete);
    if (!found) continue;
    for (const auto event : *found) {
      auto more = denied;
      more.insert(std::lower_bound(more.begin(), more.end(), event), event);
      if (seen.insert(more).second) todo.push_back(std::move(more));
    }
    least.insert(*found);
    if (seen.size() > limit) return false;
  }
  for (const auto& events : least) {
    if (!is_complete || answer.found.size() >= limit) return false;
    auto assumptions = given;
    assumptions.insert(assumptions.end(), question.after.begin(), question.after.end());
    for (const auto event : demanded) {
      const auto literal = literals_.demanded[event];
      assumptions.push_back(has_event(events, event) ? literal : ~literal);
    }
    auto states = after_->ask(assumptions, limit - answer.found.size());
    is_complete = states.complete;
    std::move(states.found.begin(), states.found.end(), std::back_inserter(answer.found));
  }
  return is_complete;
}

}  // namespace parallax::runtime
