// Successor states of a belief's states: asked of the clauses once, and remembered.

#include <fmt/format.h>

#include <algorithm>

#include "compiler/base/contract.h"
#include "runtime/monitor/belief.h"

namespace parallax::runtime {

using compiler::EventId;

namespace {

constexpr std::size_t kWaysPerState = 10;

}  // namespace

Belief::StateId Belief::intern(Words words) {
  const auto [entry, added] =
      state_ids_.try_emplace(std::move(words), static_cast<StateId>(states_.size()));
  if (added) states_.push_back(entry->first);
  return entry->second;
}

std::uint32_t Belief::label_of(const ToldStep& told) {
  std::string key(1, told.succeeded ? (*told.succeeded ? '+' : '-') : ' ');
  for (const auto event : told.events) key += fmt::format("{} ", event.index());
  const auto [entry, added] =
      label_ids_.try_emplace(std::move(key), static_cast<std::uint32_t>(labels_.size()));
  if (added) labels_.push_back(told);
  return entry->second;
}

/// Forgets everything but the possible states, once too much is remembered.
void Belief::forget() {
  if (states_.size() <= options_.remembered && labels_.size() <= options_.remembered &&
      way_count_ <= kWaysPerState * options_.remembered) {
    return;
  }
  std::vector<Words> kept;
  for (const auto state : possible_) kept.push_back(std::move(states_[state]));
  states_.clear();
  state_ids_.clear();
  labels_.resize(kToldFrom);
  label_ids_.clear();
  ways_.clear();
  way_count_ = 0;
  steps_.clear();  // with everything that their solvers have learned
  last_closed_ = {};
  possible_.clear();
  for (auto& words : kept) possible_.push_back(intern(std::move(words)));
  std::sort(possible_.begin(), possible_.end());
}

void Belief::assume_state(const Words& state, std::vector<Literal>& assumptions) const {
  const auto& layered = windows_.layered;
  std::size_t place = 0;
  for (const auto* slots : {&layered.observed, &layered.hidden}) {
    for (const auto slot : *slots) {
      const auto literal = layered.before(slot);
      assumptions.push_back(bit(state, place++) ? literal : ~literal);
    }
  }
}

/// Assumes the plan's control after a step that the plan does not take: as it was, or nowhere.
void Belief::assume_plan_after(const Words* as_before, std::vector<Literal>& assumptions) const {
  for (const auto place : control_bits_) {
    const bool stays = as_before != nullptr && bit(*as_before, place);
    assumptions.push_back(stays ? literals_.after[place] : ~literals_.after[place]);
  }
}

/// Adds the events of a step to the question. False: one of them never happens.
bool Belief::assume_events(const ToldStep& told, std::uint32_t label,
                           StepQuestion& question) const {
  const auto& events = windows_.model.events;
  std::size_t seen = 0;
  for (std::uint32_t e = 0; e < events.size(); ++e) {
    const bool happens = label >= kToldFrom &&
                         std::binary_search(told.events.begin(), told.events.end(), EventId(e));
    if (happens) ++seen;
    if (!events[e].slot) {
      if (happens) return false;
      continue;
    }
    if (!happens && unseen_[e] == Unseen::kDemanded) {
      question.is_least = true;
      continue;
    }
    if (!happens && unseen_[e] == Unseen::kUnobserved) continue;
    if (!happens && unseen_[e] == Unseen::kPerformed && label != kAlone) continue;
    const auto literal = windows_.layered.after(*events[e].slot);
    question.given.push_back(happens ? literal : ~literal);
  }
  PARALLAX_REQUIRE(seen == told.events.size(), "events of the model, sorted, each once");
  return true;
}

bool Belief::is_at_perform(const Words& state) const {
  return std::any_of(plan_bit_.begin(), plan_bit_.end(),
                     [&](const auto& place) { return place && bit(state, *place); });
}

bool Belief::is_at_cut(const Words& state) const {
  return std::any_of(cut_bit_.begin(), cut_bit_.end(),
                     [&](const auto& place) { return place && bit(state, *place); });
}

/// Query for the steps that axioms and plan admit in these phases; without a phase of the plan, for
/// the axioms alone.
StepQuery& Belief::query(std::uint32_t axioms, std::optional<std::uint32_t> plan) {
  const auto axiom_window = windows_.axioms.window_of[axioms];
  const auto plan_window =
      plan ? static_cast<std::int64_t>(windows_.plan.window_of[*plan]) : std::int64_t{-1};
  auto& out = steps_[{axiom_window, plan_window}];
  if (out == nullptr) {
    out = std::make_unique<StepQuery>(
        plan ? windows_.joined(axioms, *plan) : windows_.axioms.windows[axiom_window], literals_,
        options_.stop);
  }
  return *out;
}

/// The states after a step. None: there are too many, it was stopped, or nothing is known of what
/// follows.
std::optional<std::vector<Belief::StateId>> Belief::ask_step(StateId state, std::uint32_t label) {
  const auto before = states_[state];
  const auto axioms = axiom_phase(before), plan = plan_phase(before);
  if (!windows_.axioms.knows(axioms) && windows_.ends) return std::vector<StateId>();
  const bool is_unknown = plan == kUnknownPlan || (is_at_cut(before) && label != kAlone);
  const bool is_of_plan = !is_unknown && label != kAlone;
  if (!windows_.axioms.knows(axioms) || (is_of_plan && !windows_.plan.knows(plan))) {
    obstacle_ = fmt::format(
        "the log goes on beyond timepoint {}, and what the model says does not repeat itself "
        "before it: a larger horizon is needed",
        windows_.layered.horizon);
    return std::nullopt;
  }
  auto& step = query(axioms, is_of_plan ? std::optional(plan) : std::nullopt);
  const auto& told = labels_[label];
  StepQuestion question;
  assume_state(before, question.given);
  if (!assume_events(told, label, question)) return std::vector<StateId>();
  if (label == kUntold) question.given.push_back(step.some_unobserved());
  if (label == kAlone) question.given.push_back(step.some_alone());
  if (!is_of_plan) assume_plan_after(is_unknown ? nullptr : &before, question.after);
  if (told.succeeded && is_of_plan && is_at_perform(before)) {
    if (*told.succeeded) {
      question.after.push_back(step.some_succeeded());
    } else {
      for (const auto succeeded : literals_.succeeded) question.after.push_back(~succeeded);
    }
  }
  const auto answer = step.ask(question, options_.max_states);
  if (!answer.is_complete()) {
    obstacle_ = fmt::format("more than {} states are possible", options_.max_states);
    return std::nullopt;
  }
  const auto plan_after = is_unknown ? kUnknownPlan : is_of_plan ? windows_.plan.next(plan) : plan;
  std::vector<StateId> out;
  for (const auto& found : answer.found) {
    Words words(word_count_, 0);
    words[0] = phases(windows_.axioms.next(axioms), plan_after);
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (found[i]) set_bit(words, i);
    }
    out.push_back(intern(std::move(words)));
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

const std::vector<Belief::StateId>* Belief::successors(StateId state, std::uint32_t label) {
  const auto key = (std::uint64_t{label} << 32U) | state;
  const auto known = ways_.find(key);
  if (known != ways_.end()) return &known->second;
  auto found = ask_step(state, label);
  if (!found) return nullptr;
  way_count_ += 1 + found->size();
  return &ways_.emplace(key, *std::move(found)).first->second;
}

/// Adds all states that unobserved steps lead to.
std::optional<std::vector<Belief::StateId>> Belief::closed(std::vector<StateId> states) {
  if (options_.unobserved.empty()) return states;
  if (last_closed_.first == states) return last_closed_.second;
  auto out = states;
  std::vector<StateId> todo = states;
  std::unordered_map<StateId, bool> seen;
  for (const auto state : states) seen[state] = true;
  while (!todo.empty()) {
    const auto state = todo.back();
    todo.pop_back();
    // The plan takes part in a step if it performs an unobserved event, or is over.
    const bool waits =
        is_known(state) && (is_at_perform(states_[state]) || is_at_cut(states_[state]));
    for (const auto label : {kUntold, kAlone}) {
      if (label == kAlone && !waits) continue;
      const auto* next = successors(state, label);
      if (next == nullptr) return std::nullopt;
      for (const auto to : *next) {
        if (!seen.try_emplace(to, true).second) continue;
        out.push_back(to);
        todo.push_back(to);
      }
    }
    if (out.size() > options_.max_states) {
      obstacle_ = fmt::format("more than {} states are possible", options_.max_states);
      return std::nullopt;
    }
  }
  std::sort(out.begin(), out.end());
  last_closed_ = {std::move(states), out};
  return out;
}

std::optional<std::vector<Belief::StateId>> Belief::after(const std::vector<StateId>& states,
                                                          const ToldStep& told) {
  const auto label = label_of(told);
  std::vector<StateId> out;
  for (const auto state : states) {
    const auto* next = successors(state, label);
    if (next == nullptr) return std::nullopt;
    out.insert(out.end(), next->begin(), next->end());
    if (out.size() <= 2 * options_.max_states) continue;
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    if (out.size() <= options_.max_states) continue;
    obstacle_ = fmt::format("more than {} states are possible", options_.max_states);
    return std::nullopt;
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  if (out.size() > options_.max_states) {
    obstacle_ = fmt::format("more than {} states are possible", options_.max_states);
    return std::nullopt;
  }
  return out;
}

}  // namespace parallax::runtime
