#include "runtime/monitor/belief.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "compiler/base/contract.h"

namespace parallax::runtime {
namespace {

using compiler::EventId;
using compiler::FluentId;

constexpr std::size_t kBits = 64;

void set_bit(std::vector<std::uint64_t>& words, std::size_t place) {
  words[1 + place / kBits] |= std::uint64_t{1} << (place % kBits);
}

std::vector<Literal> state_literals(const LayeredModel& model, std::int32_t offset) {
  std::vector<Literal> out;
  for (const auto* slots : {&model.observed, &model.hidden}) {
    for (const auto slot : *slots) {
      out.push_back(Literal::positive(offset + static_cast<std::int32_t>(slot) + 1));
    }
  }
  return out;
}

/// Further variables of a step: `assumed` makes one of `any` true.
std::vector<Literal> one_of(std::int32_t assumed, std::vector<Literal> any) {
  any.push_back(~Literal::positive(assumed));
  return any;
}

}  // namespace

std::size_t Belief::WordsHash::operator()(const Words& words) const {
  std::uint64_t hash = 0xCBF29CE484222325U;
  for (const auto word : words) {
    hash = (hash ^ word) * 0x9E3779B97F4A7C15U;
    hash ^= hash >> 29U;
  }
  return hash;
}

bool Belief::Filter::admits(const Words& state) const {
  for (std::size_t i = 1; i < mask.size(); ++i) {
    if (((state[i] ^ value[i]) & mask[i]) != 0) return false;
  }
  return possible;
}

Belief::Belief(const StepWindows& windows, const BeliefOptions& options)
    : windows_(windows), options_(options) {
  const auto& layered = windows.layered;
  const auto& model = windows.model;
  observed_count_ = layered.observed.size();
  word_count_ = 1 + (observed_count_ + layered.hidden.size() + kBits - 1) / kBits;
  std::size_t next = 0;
  for (const auto& fluent : model.fluents) {
    fluent_bit_.push_back(fluent.slot ? std::optional(next++) : std::nullopt);
  }
  PARALLAX_REQUIRE(next == observed_count_, "the observed slots are those of the fluents");
  for (const auto slot : windows.locations) {
    const auto found = std::find(layered.hidden.begin(), layered.hidden.end(), slot);
    plan_bit_.push_back(found == layered.hidden.end()
                            ? std::nullopt
                            : std::optional(observed_count_ + static_cast<std::size_t>(
                                                                  found - layered.hidden.begin())));
  }
  is_unobserved_.assign(model.events.size(), false);
  for (const auto event : options.unobserved) is_unobserved_[event.index()] = true;
  known_ = filter_of(Observation(model.fluents.size(), 0));

  start_ = std::make_unique<WindowQuery>(layered.start, std::vector<std::vector<Literal>>{}, 0,
                                         state_literals(layered, 0), options.stop);
  const auto slots = static_cast<std::int32_t>(layered.state_slots);
  std::vector<Literal> untold, succeeded;
  for (const auto event : options.unobserved) {
    const auto slot = model.events[event.index()].slot;
    if (slot) untold.push_back(Literal::positive(slots + static_cast<std::int32_t>(*slot) + 1));
  }
  for (const auto slot : windows.outcomes) {
    succeeded.push_back(Literal::positive(slots + static_cast<std::int32_t>(slot) + 1));
  }
  for (const auto& window : layered.steps) {
    std::vector<std::vector<Literal>> more = {one_of(window.variables + 1, untold),
                                              one_of(window.variables + 2, succeeded)};
    steps_.push_back(std::make_unique<WindowQuery>(window, std::move(more), window.variables + 2,
                                                   state_literals(layered, slots), options.stop));
  }
  labels_.emplace_back();  // kUntold
}

bool Belief::bit(const Words& state, std::size_t place) const {
  return (state[1 + place / kBits] >> (place % kBits) & 1U) != 0;
}

Belief::Filter Belief::filter_of(const Observation& observed) const {
  PARALLAX_REQUIRE(observed.size() == fluent_bit_.size(), "an observation is about all fluents");
  Filter out{Words(word_count_, 0), Words(word_count_, 0), true};
  for (std::size_t f = 0; f < observed.size(); ++f) {
    if (observed[f] == 0) continue;
    const auto place = fluent_bit_[f];
    if (!place) {
      out.possible = out.possible && observed[f] < 0;
      continue;
    }
    set_bit(out.mask, *place);
    if (observed[f] > 0) set_bit(out.value, *place);
  }
  return out;
}

Admission Belief::give_up(const std::string& why) {
  if (undecided_.empty()) {
    undecided_ = options_.stop != nullptr && options_.stop->load() ? "it was stopped" : why;
  }
  return Admission::kUndecided;
}

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

/// Only what is possible now stays known.
void Belief::forget() {
  if (states_.size() <= options_.remembered && labels_.size() <= options_.remembered) return;
  std::vector<Words> kept;
  for (const auto state : possible_) kept.push_back(std::move(states_[state]));
  states_.clear();
  state_ids_.clear();
  labels_.resize(1);
  label_ids_.clear();
  ways_.clear();
  last_closed_ = {};
  possible_.clear();
  for (auto& words : kept) possible_.push_back(intern(std::move(words)));
  std::sort(possible_.begin(), possible_.end());
}

void Belief::take(std::vector<StateId> states) {
  possible_ = std::move(states);
  largest_ = std::max(largest_, possible_.size());
}

/// None: there are too many, or it was stopped.
std::optional<std::vector<Belief::StateId>> Belief::initial_states(const Filter& known) {
  std::vector<Literal> assumptions;
  const auto& observed = windows_.layered.observed;
  for (std::size_t i = 0; i < observed.size(); ++i) {
    if (!bit(known.mask, i)) continue;
    const auto literal = Literal::positive(static_cast<std::int32_t>(observed[i]) + 1);
    assumptions.push_back(bit(known.value, i) ? literal : ~literal);
  }
  const auto answer = start_->ask(assumptions, options_.max_states);
  if (!answer.complete) return std::nullopt;
  std::vector<StateId> out;
  for (const auto& found : answer.found) {
    Words words(word_count_, 0);
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (found[i]) set_bit(words, i);
    }
    out.push_back(intern(std::move(words)));
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// From what is known of the start to the states that it leaves. Refused: there are none.
Admission Belief::settle() {
  if (is_settled_) return Admission::kAdmitted;
  auto states = initial_states(known_);
  if (states) states = closed(*std::move(states));
  if (!states) {
    return give_up(fmt::format("more than {} initial states are possible", options_.max_states));
  }
  if (states->empty()) return Admission::kRefused;
  is_settled_ = true;
  take(*std::move(states));
  return Admission::kAdmitted;
}

Admission Belief::observe(const Observation& observed) {
  if (!undecided_.empty()) return Admission::kUndecided;
  forget();
  const auto filter = filter_of(observed);
  if (!is_settled_ && !options_.unobserved.empty()) {
    // Something may have happened before: what is seen is not the start.
    const auto settled = settle();
    if (settled != Admission::kAdmitted) return settled;
  }
  if (!is_settled_) {
    // All that is seen before the first step is seen of one state.
    if (!filter.possible) return Admission::kRefused;
    auto known = known_;
    bool agrees = true;
    for (std::size_t i = 1; i < word_count_; ++i) {
      agrees = agrees && ((known.value[i] ^ filter.value[i]) & known.mask[i] & filter.mask[i]) == 0;
      known.mask[i] |= filter.mask[i];
      known.value[i] |= filter.value[i];
    }
    if (!agrees) return Admission::kRefused;
    auto states = initial_states(known);
    if (states && states->empty()) return Admission::kRefused;
    known_ = std::move(known);
    if (!states) {
      if (options_.stop != nullptr && options_.stop->load()) return give_up("");
      return Admission::kAdmitted;  // too many to be kept, so there are some
    }
    is_settled_ = true;
    take(*std::move(states));
    return Admission::kAdmitted;
  }
  std::vector<StateId> left;
  for (const auto state : possible_) {
    if (filter.admits(states_[state])) left.push_back(state);
  }
  if (left.empty()) return Admission::kRefused;
  if (left.size() == possible_.size()) return Admission::kAdmitted;
  auto states = closed(std::move(left));
  if (!states) return give_up(obstacle_);
  take(*std::move(states));
  return Admission::kAdmitted;
}

void Belief::assume_state(const Words& state, std::vector<Literal>& assumptions) const {
  const auto& layered = windows_.layered;
  std::size_t place = 0;
  for (const auto* slots : {&layered.observed, &layered.hidden}) {
    for (const auto slot : *slots) {
      const auto literal = Literal::positive(static_cast<std::int32_t>(slot) + 1);
      assumptions.push_back(bit(state, place++) ? literal : ~literal);
    }
  }
}

/// False: one of the events never happens.
bool Belief::assume_events(const ToldStep& told, bool is_told,
                           std::vector<Literal>& assumptions) const {
  const auto& events = windows_.model.events;
  const auto slots = static_cast<std::int32_t>(windows_.layered.state_slots);
  std::size_t seen = 0;
  for (std::uint32_t e = 0; e < events.size(); ++e) {
    const bool happens =
        is_told && std::binary_search(told.events.begin(), told.events.end(), EventId(e));
    if (happens) ++seen;
    if (!events[e].slot) {
      if (happens) return false;
      continue;
    }
    if (!happens && is_unobserved_[e]) continue;
    const auto literal = Literal::positive(slots + static_cast<std::int32_t>(*events[e].slot) + 1);
    assumptions.push_back(happens ? literal : ~literal);
  }
  PARALLAX_REQUIRE(seen == told.events.size(), "events of the model, sorted, each once");
  return true;
}

bool Belief::is_at_perform(const Words& state) const {
  return std::any_of(plan_bit_.begin(), plan_bit_.end(),
                     [&](const auto& place) { return place && bit(state, *place); });
}

/// None: there are too many, it was stopped, or nothing is known of what follows.
std::optional<std::vector<Belief::StateId>> Belief::ask_step(StateId state, std::uint32_t label) {
  const auto before = states_[state];
  const auto phase = static_cast<std::uint32_t>(before[0]);
  const auto next = windows_.next(phase);
  if (phase >= windows_.window_of.size()) {
    if (windows_.ends) return std::vector<StateId>();
    obstacle_ = fmt::format(
        "the log goes on beyond timepoint {}, and what the model says does not repeat itself "
        "before "
        "it: a larger horizon is needed",
        windows_.layered.horizon);
    return std::nullopt;
  }
  const auto window = windows_.window_of[phase];
  const auto variables = windows_.layered.steps[window].variables;
  const auto& told = labels_[label];
  std::vector<Literal> assumptions;
  assume_state(before, assumptions);
  if (!assume_events(told, label != kUntold, assumptions)) return std::vector<StateId>();
  if (label == kUntold) assumptions.push_back(Literal::positive(variables + 1));
  if (told.succeeded && is_at_perform(before)) {
    if (*told.succeeded) {
      assumptions.push_back(Literal::positive(variables + 2));
    } else {
      const auto slots = static_cast<std::int32_t>(windows_.layered.state_slots);
      for (const auto slot : windows_.outcomes) {
        assumptions.push_back(~Literal::positive(slots + static_cast<std::int32_t>(slot) + 1));
      }
    }
  }
  const auto answer = steps_[window]->ask(assumptions, options_.max_states);
  if (!answer.complete) {
    obstacle_ = fmt::format("more than {} states are possible", options_.max_states);
    return std::nullopt;
  }
  std::vector<StateId> out;
  for (const auto& found : answer.found) {
    Words words(word_count_, 0);
    words[0] = next.value_or(static_cast<std::uint32_t>(windows_.window_of.size()));
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (found[i]) set_bit(words, i);
    }
    out.push_back(intern(std::move(words)));
  }
  return out;
}

const std::vector<Belief::StateId>* Belief::successors(StateId state, std::uint32_t label) {
  const auto key = (std::uint64_t{label} << 32U) | state;
  const auto known = ways_.find(key);
  if (known != ways_.end()) return &known->second;
  auto found = ask_step(state, label);
  if (!found) return nullptr;
  return &ways_.emplace(key, *std::move(found)).first->second;
}

/// Everything that unobserved steps lead to as well.
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
    const auto* next = successors(state, kUntold);
    if (next == nullptr) return std::nullopt;
    for (const auto to : *next) {
      if (!seen.try_emplace(to, true).second) continue;
      out.push_back(to);
      todo.push_back(to);
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

Admission Belief::step(const ToldStep& told) {
  if (!undecided_.empty()) return Admission::kUndecided;
  const auto settled = settle();
  if (settled != Admission::kAdmitted) return settled;
  forget();
  auto states = after(possible_, told);
  if (states && states->empty()) return Admission::kRefused;
  if (states) states = closed(*std::move(states));
  if (!states) return give_up(obstacle_);
  take(*std::move(states));
  return Admission::kAdmitted;
}

bool Belief::admits(const ToldStep& told) {
  if (!undecided_.empty() || !is_settled_) return false;
  const auto states = after(possible_, told);
  return states && !states->empty();
}

std::optional<std::size_t> Belief::size() const {
  if (!is_settled_) return std::nullopt;
  return possible_.size();
}

std::vector<Disagreement> Belief::disagreement(const Observation& observed) {
  std::vector<StateId> states = possible_;
  if (!is_settled_) states = initial_states(known_).value_or(std::vector<StateId>());
  std::vector<Disagreement> none_has, nearest, never;
  std::optional<std::size_t> distance;
  for (std::size_t f = 0; f < observed.size(); ++f) {
    if (observed[f] == 0) continue;
    const Disagreement entry{FluentId(static_cast<std::uint32_t>(f)), observed[f] > 0};
    const auto place = fluent_bit_[f];
    const auto agrees = [&](StateId state) {
      return place ? bit(states_[state], *place) == entry.observed : !entry.observed;
    };
    if (std::none_of(states.begin(), states.end(), agrees)) none_has.push_back(entry);
  }
  if (!none_has.empty()) return none_has;
  for (const auto state : states) {
    std::vector<Disagreement> differing;
    for (std::size_t f = 0; f < observed.size(); ++f) {
      const auto place = fluent_bit_[f];
      if (observed[f] == 0 || !place || bit(states_[state], *place) == (observed[f] > 0)) continue;
      differing.push_back({FluentId(static_cast<std::uint32_t>(f)), observed[f] > 0});
    }
    if (distance && differing.size() >= *distance) continue;
    distance = differing.size();
    nearest = std::move(differing);
  }
  return nearest;
}

std::vector<std::size_t> Belief::plan_steps() const {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < plan_bit_.size(); ++i) {
    const auto place = plan_bit_[i];
    if (place && std::any_of(possible_.begin(), possible_.end(),
                             [&](StateId state) { return bit(states_[state], *place); })) {
      out.push_back(i);
    }
  }
  return out;
}

bool Belief::plan_may_be_over() const {
  return !windows_.locations.empty() &&
         std::any_of(possible_.begin(), possible_.end(),
                     [&](StateId state) { return !is_at_perform(states_[state]); });
}

}  // namespace parallax::runtime
