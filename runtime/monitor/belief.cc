// The states that a log leaves possible, kept as an exact set.
//
// A state is a valuation of the model's state atoms, the place of the plan's control included,
// and a phase of the windows (step_windows.cc). A reported step replaces the set by all
// successors under these events (belief_steps.cc), closed under steps of unobserved events; an
// observation keeps the states that agree. An empty set would mean that no trace fits: the
// report is refused, and the set before stays. Before the first step observations are collected
// as long as more initial states agree with them than can be kept, so that a model with very
// many need not list them. Beyond `max_states` nothing is said any more: a part of the set could
// refuse wrongly.
//
// Cost: for each report a look-up for each state and label, and solver calls for those not met
// before.

#include "runtime/monitor/belief.h"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/base/contract.h"

namespace parallax::runtime {
namespace {

using compiler::EventId;

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
  for (const auto& set : one_of) {
    bool has_one = false;
    for (std::size_t i = 1; i < set.size(); ++i) has_one = has_one || (state[i] & set[i]) != 0;
    if (!has_one) return false;
  }
  return possible;
}

Belief::Belief(const StepWindows& windows, const BeliefOptions& options)
    : windows_(windows),
      options_(options),
      start_(windows.layered.start, windows.layered.state_before(), options.stop) {
  const auto& layered = windows.layered;
  const auto& model = windows.model;
  observed_count_ = layered.observed.size();
  word_count_ = 1 + (observed_count_ + layered.hidden.size() + kBits - 1) / kBits;
  std::size_t next = 0;
  for (const auto& fluent : model.fluents) {
    fluent_bit_.push_back(fluent.slot ? std::optional(next++) : std::nullopt);
  }
  PARALLAX_REQUIRE(next == observed_count_, "the observed slots are those of the fluents");
  const auto bit_of = [&](std::uint32_t slot) {
    const auto found = std::find(layered.hidden.begin(), layered.hidden.end(), slot);
    return found == layered.hidden.end()
               ? std::nullopt
               : std::optional(observed_count_ +
                               static_cast<std::size_t>(found - layered.hidden.begin()));
  };
  for (const auto slot : windows.locations) plan_bit_.push_back(bit_of(slot));
  for (const auto slot : windows.cuts) cut_bit_.push_back(bit_of(slot));
  for (auto slot = windows.first_plan_slot; slot < windows.last_plan_slot; ++slot) {
    if (const auto place = bit_of(slot)) control_bits_.push_back(*place);
  }
  unseen_.assign(model.events.size(), Unseen::kNever);
  for (const auto event : options.unobserved) unseen_[event.index()] = Unseen::kUnobserved;
  for (const auto event : options.performed) {
    auto& unseen = unseen_[event.index()];
    if (unseen == Unseen::kUnobserved) unseen = Unseen::kPerformed;
  }
  for (const auto event : options.demanded) {
    PARALLAX_REQUIRE(unseen_[event.index()] == Unseen::kNever, "demanded, or unobserved");
    if (!model.events[event.index()].slot) continue;
    unseen_[event.index()] = Unseen::kDemanded;
  }
  known_ = filter_of(Observation(model.fluents.size(), 0));

  literals_.after = layered.state_after();
  literals_.demanded = event_literals(options.demanded);
  literals_.unobserved = event_literals(options.unobserved);
  std::vector<EventId> alone;
  for (const auto event : options.unobserved) {
    if (unseen_[event.index()] == Unseen::kUnobserved) alone.push_back(event);
  }
  literals_.alone = event_literals(alone);
  for (const auto slot : windows.outcomes) literals_.succeeded.push_back(layered.after(slot));
  labels_.resize(kToldFrom);
}

/// Literals of those events that can happen at all.
std::vector<Literal> Belief::event_literals(const std::vector<EventId>& events) const {
  std::vector<Literal> out;
  for (const auto event : events) {
    const auto slot = windows_.model.events[event.index()].slot;
    if (slot) out.push_back(windows_.layered.after(*slot));
  }
  return out;
}

Belief::Filter Belief::filter_of(const Observation& observed,
                                 const std::vector<OneOfFluents>& one_of) const {
  PARALLAX_REQUIRE(observed.size() == fluent_bit_.size(), "an observation is about all fluents");
  Filter out{Words(word_count_, 0), Words(word_count_, 0), true, {}};
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
  for (const auto& fluents : one_of) {
    Words set(word_count_, 0);
    for (const auto fluent : fluents) {
      // A fluent without a place never holds.
      if (const auto place = fluent_bit_[fluent.index()]) set_bit(set, *place);
    }
    out.one_of.push_back(std::move(set));
  }
  return out;
}

/// Adds an observation to what is known of one state. False: they contradict each other.
bool Belief::add_known(const Filter& filter, Filter& known) const {
  bool agrees = filter.possible;
  for (std::size_t i = 1; i < word_count_; ++i) {
    agrees = agrees && ((known.value[i] ^ filter.value[i]) & known.mask[i] & filter.mask[i]) == 0;
    known.mask[i] |= filter.mask[i];
    known.value[i] |= filter.value[i];
  }
  for (const auto& set : filter.one_of) {
    const auto& sets = known.one_of;
    if (std::find(sets.begin(), sets.end(), set) == sets.end()) known.one_of.push_back(set);
  }
  return agrees;
}

Admission Belief::give_up(const std::string& why) {
  if (undecided_.empty()) {
    undecided_ = options_.stop != nullptr && options_.stop->load() ? "it was stopped" : why;
  }
  return Admission::kUndecided;
}

void Belief::take(std::vector<StateId> states) {
  possible_ = std::move(states);
  largest_ = std::max(largest_, possible_.size());
}

/// None: there are too many, or it was stopped.
std::optional<std::vector<Belief::StateId>> Belief::initial_states(const Filter& known,
                                                                   bool* some_admitted) {
  std::vector<Literal> assumptions;
  const auto& observed = windows_.layered.observed;
  for (std::size_t i = 0; i < observed.size(); ++i) {
    if (!bit(known.mask, i)) continue;
    const auto literal = windows_.layered.before(observed[i]);
    assumptions.push_back(bit(known.value, i) ? literal : ~literal);
  }
  const auto answer = start_.ask(assumptions, {options_.max_states});
  if (!answer.is_complete() && (some_admitted == nullptr || known.one_of.empty())) {
    if (some_admitted != nullptr) *some_admitted = true;
    return std::nullopt;
  }
  std::vector<StateId> out;
  for (const auto& found : answer.found) {
    Words words(word_count_, 0);
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (found[i]) set_bit(words, i);
    }
    if (!known.admits(words)) continue;
    if (!answer.is_complete()) {
      *some_admitted = true;
      return std::nullopt;
    }
    out.push_back(intern(std::move(words)));
  }
  if (!answer.is_complete()) return std::nullopt;
  std::sort(out.begin(), out.end());
  return out;
}

/// Finds the initial states that agree with the known facts. Refused: there are none.
Admission Belief::settle() {
  if (is_settled_) return Admission::kAdmitted;
  auto states = initial_states(known_);
  if (states) states = closed(*std::move(states));
  if (!states) {
    return give_up(fmt::format("more than {} initial states are possible", options_.max_states));
  }
  if (states->empty()) return Admission::kRefused;
  is_settled_ = true;
  return admit(*std::move(states));
}

std::string Belief::cut_text() const {
  const auto& cuts = windows_.model.plan_cuts;
  std::string where;
  for (const auto& cut : cuts) {
    if (!where.empty()) where += ", ";
    where += fmt::format("`{}`", cut.form);
    if (!cut.place.file.empty()) {
      where += fmt::format(" at {}:{}", cut.place.file, cut.place.begin.line);
    }
  }
  return fmt::format(
      "the plan goes on where its unrolling was cut ({}): nothing is known of what it does there",
      where);
}

/// Takes the possible states, of which there must be some.
Admission Belief::admit(std::vector<StateId> states) {
  take(std::move(states));
  if (std::any_of(possible_.begin(), possible_.end(),
                  [&](StateId state) { return is_known(state); })) {
    return Admission::kAdmitted;
  }
  return give_up(cut_text());
}

void Belief::restart() {
  is_settled_ = known_is_open_ = false;
  known_ = filter_of(Observation(fluent_bit_.size(), 0));
  possible_.clear();
  largest_ = 0;
  undecided_.clear();
  obstacle_.clear();
}

Admission Belief::observe(const Observation& observed, const std::vector<OneOfFluents>& one_of) {
  if (!undecided_.empty()) return Admission::kUndecided;
  forget();
  const auto filter = filter_of(observed, one_of);
  if (!is_settled_ && !options_.unobserved.empty()) {
    // Something may have happened before: the observation is not of the start.
    const auto settled = settle();
    if (settled != Admission::kAdmitted) return settled;
  }
  if (!is_settled_) {
    // All that is seen before the first step is seen of one state.
    auto known = known_;
    if (!add_known(filter, known)) return Admission::kRefused;
    if (known_is_open_ && known == known_) return Admission::kAdmitted;
    bool some_admitted = false;
    auto states = initial_states(known, &some_admitted);
    if (states && states->empty()) return Admission::kRefused;
    known_ = std::move(known);
    known_is_open_ = !states;
    if (!states) {
      if (options_.stop != nullptr && options_.stop->load()) return give_up("");
      if (some_admitted) return Admission::kAdmitted;  // too many to be kept, so there are some
      return give_up(fmt::format("more than {} initial states are possible", options_.max_states));
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
  return admit(*std::move(states));
}

bool Belief::agrees(const Observation& observed) {
  if (!undecided_.empty()) return true;
  const auto filter = filter_of(observed);
  if (!is_settled_ && !options_.unobserved.empty()) {
    const auto settled = settle();
    if (settled != Admission::kAdmitted) return settled == Admission::kUndecided;
  }
  if (is_settled_) {
    return std::any_of(possible_.begin(), possible_.end(),
                       [&](StateId state) { return filter.admits(states_[state]); });
  }
  auto known = known_;
  if (!add_known(filter, known)) return false;
  const auto states = initial_states(known);
  return !states || !states->empty();
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
  return admit(*std::move(states));
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

}  // namespace parallax::runtime
