#include "harness/discrete/model_simulator.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "compiler/base/contract.h"
#include "compiler/base/hash.h"
#include "harness/sampling/sampler.h"

namespace parallax::harness {
namespace {

using runtime::Literal;
using runtime::WindowEnd;

constexpr std::int64_t kNoEvent = -1;
constexpr double kTimepoint_s = 1.0;

/// The truth value of a fluent in a start; none if it is neither true nor false.
std::optional<bool> truth_value(const Value& value) {
  if (const auto* boolean = std::get_if<bool>(&value)) return *boolean;
  if (const auto* whole = std::get_if<std::int64_t>(&value)) {
    if (*whole == 0 || *whole == 1) return *whole == 1;
  }
  if (const auto* real = std::get_if<double>(&value)) {
    if (*real == 0.0 || *real == 1.0) return *real == 1.0;
  }
  return std::nullopt;
}

std::uint64_t hash_of(const runtime::Bits& bits, std::uint64_t hash) {
  for (const bool bit : bits) hash = base::fnv1a64_word(hash, bit ? 2 : 1);
  return hash;
}

std::map<std::string, std::uint32_t, std::less<>> numbers_of(
    const std::vector<compiler::GroundName>& names) {
  std::map<std::string, std::uint32_t, std::less<>> out;
  for (std::uint32_t i = 0; i < names.size(); ++i) out.emplace(names[i].name, i);
  return out;
}

}  // namespace

ModelSimulator::ModelSimulator(std::shared_ptr<const SteppedModel> world,
                               const std::atomic<bool>* stop, ModelWorldLimits limits)
    : world_(std::move(world)),
      limits_(limits),
      fluents_(numbers_of(world_->model.fluents)),
      events_(numbers_of(world_->model.events)),
      before_(world_->layered.state_before()),
      start_(world_->layered.start, before_, stop),
      whole_(world_->model, runtime::make_cadical_solver(stop)) {
  std::int64_t place = 0;
  for (const auto& event : world_->model.events) {
    event_places_.push_back(event.slot ? place++ : kNoEvent);
  }
  for (const auto slot : world_->layered.hidden) {
    is_release_.push_back(world_->model.slots[slot].kind == compiler::AtomKind::kReleasedAt);
  }
  for (const auto slot : world_->layered.events) {
    event_literals_.push_back(world_->layered.after(slot));
  }
  for (const auto& step : world_->layered.steps) {
    next_states_.emplace_back(step, world_->layered.state_after(), stop);
    next_events_.emplace_back(step, event_literals_, stop);
  }
}

SimulatorInfo ModelSimulator::info_of(const SteppedModel& world) {
  SimulatorInfo info;
  info.name = "model";
  info.version = world.model.producer;
  info.determinism = "bitwise";
  info.seeds = true;
  for (const auto& fluent : world.model.fluents)
    info.parameters.push_back({fluent.name, "1", true});
  for (const auto& event : world.model.events) info.actions.push_back(event.name);
  info.timestep_s = kTimepoint_s;
  return info;
}

Outcome ModelSimulator::no_list(const Answer& answer, const std::string& what) const {
  if (answer.end == WindowEnd::kStopped) return {SimStatus::kLost, "stopped", 0.0, {}};
  return {SimStatus::kUnsupported,
          fmt::format("found more than {} {} in `{}`; say more of what is open", answer.limit, what,
                      world_->name),
          0.0,
          {}};
}

void ModelSimulator::move_to(const std::vector<WorldState>& states) {
  const CounterRng rng(DrawKey{.campaign_seed = seed_});
  auto index = std::size_t{0};
  if (states.size() > 1) {
    // A product below 2^53 of a number below 1: never the size itself.
    index = static_cast<std::size_t>(rng.uniform(draws_++) * static_cast<double>(states.size()));
  }
  state_ = states[index];
  digest_ = hash_of(state_.released, hash_of(state_.observed, digest_));
}

Outcome ModelSimulator::reset(const State& initial, std::uint64_t seed) {
  timepoint_ = -1;
  std::vector<Literal> given;
  std::vector<std::string> said;
  bool possible = true;
  for (const auto& [name, value] : initial) {
    const auto found = fluents_.find(name);
    if (found == fluents_.end()) {
      return {SimStatus::kUnsupported,
              fmt::format("no fluent `{}` in `{}`", name, world_->name),
              0.0,
              {}};
    }
    const auto wanted = truth_value(value);
    if (!wanted) {
      return {SimStatus::kUnsupported, fmt::format("`{}` takes true or false", name), 0.0, {}};
    }
    said.push_back((*wanted ? "" : "!") + name);
    const auto& slot = world_->model.fluents[found->second].slot;
    if (slot) {
      const auto literal = world_->layered.before(*slot);
      given.push_back(*wanted ? literal : ~literal);
    } else {
      possible = possible && !*wanted;  // it never holds
    }
  }
  seed_ = seed;
  draws_ = 0;
  digest_ = base::kFnvStart;
  const auto found =
      possible ? start_.ask(given, {limits_.states}) : runtime::WindowSolver::Answer();
  const auto starts =
      found.is_complete() ? grouped(found.found, 0) : Answer{found.end, {}, limits_.states};
  if (starts.end != WindowEnd::kComplete) return no_list(starts, "initial states that fit a start");
  if (starts.states.empty()) return {SimStatus::kInvalidStart, no_start(given, said), 0.0, {}};
  move_to(starts.states);
  timepoint_ = 0;
  return {};
}

/// Why the world has no such start: facts of it that no execution has together, none too many.
std::string ModelSimulator::no_start(std::vector<Literal> given, std::vector<std::string> said) {
  const auto& model = world_->model;
  const bool known = given.size() == said.size();  // a fluent that never holds has no literal
  std::vector<Literal> at_start;
  for (const auto literal : given) {
    const auto slot = static_cast<std::uint32_t>(literal.var()) - 1;
    const auto first = Literal::positive(model.variable(slot, 0));
    at_start.push_back(literal.is_positive() ? first : ~first);
  }
  for (std::size_t i = 0; known && i < at_start.size();) {
    auto without = at_start;
    without.erase(without.begin() + static_cast<std::ptrdiff_t>(i));
    if (whole_.solve(model.horizon, without) == runtime::SolveStatus::kUnsatisfiable) {
      at_start = std::move(without);
      said.erase(said.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      ++i;
    }
  }
  return fmt::format("`{}` has no execution that starts with {}", world_->name,
                     fmt::join(said, ", "));
}

runtime::SolveStatus ModelSimulator::goes_on(const runtime::Bits& state, compiler::Timepoint t) {
  const auto& model = world_->model;
  std::vector<Literal> at;
  for (const auto literal : before_) {
    at.push_back(
        Literal::positive(model.variable(static_cast<std::uint32_t>(literal.var()) - 1, t)));
  }
  std::vector<Literal> given;
  runtime::assume(at, state, given);
  return whole_.solve(model.horizon, given);
}

/// Valuations of one state become one, so that each state counts once where one is drawn.
ModelSimulator::Answer ModelSimulator::grouped(const std::vector<runtime::Bits>& valuations,
                                               compiler::Timepoint t) {
  std::map<std::pair<runtime::Bits, runtime::Bits>, std::vector<runtime::Bits>> states;
  for (const auto& valuation : valuations) {
    // Each window by itself does not see that the axioms of the next ones leave nothing.
    const auto status =
        t < world_->model.horizon ? goes_on(valuation, t) : runtime::SolveStatus::kSatisfiable;
    if (status == runtime::SolveStatus::kUnsatisfiable) continue;
    if (status == runtime::SolveStatus::kUnknown) return {WindowEnd::kStopped, {}, 0};
    auto move = runtime::move_of(world_->layered, valuation);
    runtime::Bits released;
    for (std::size_t i = 0; i < move.hidden.size(); ++i) {
      if (is_release_[i]) released.push_back(move.hidden[i]);
    }
    states[{std::move(move.observed), std::move(released)}].push_back(std::move(move.hidden));
  }
  Answer answer{WindowEnd::kComplete, {}, limits_.states};
  for (auto& [shown, hidden] : states) {
    answer.states.push_back({shown.first, shown.second, std::move(hidden)});
  }
  if (answer.states.size() > limits_.states) answer.end = WindowEnd::kTooMany;
  return answer;
}

std::vector<Literal> ModelSimulator::before(const runtime::Bits& hidden) const {
  std::vector<Literal> out;
  runtime::assume(before_, state_.observed, out);
  runtime::assume(std::span(before_).subspan(state_.observed.size()), hidden, out);
  return out;
}

ModelSimulator::Answer ModelSimulator::find_steps(std::size_t step, std::int64_t event) {
  const auto& at = world_->layered.step_at;
  const auto window = at[std::min(step, at.size() - 1)];
  // Which events go with it: no more than the model demands.
  std::set<runtime::Bits> sets;
  for (const auto& hidden : state_.hidden) {
    auto given = before(hidden);
    if (event != kNoEvent) given.push_back(event_literals_[static_cast<std::size_t>(event)]);
    const auto least = next_events_[window].least(given, limits_.event_sets);
    if (!least.is_complete()) return {least.end, {}, limits_.event_sets};
    sets.insert(least.found.begin(), least.found.end());
  }
  std::set<runtime::Bits> valuations;
  for (const auto& set : sets) {
    const bool is_least = std::none_of(sets.begin(), sets.end(), [&](const auto& other) {
      return other != set && std::equal(other.begin(), other.end(), set.begin(),
                                        [](bool in_other, bool in) { return in || !in_other; });
    });
    if (!is_least) continue;
    for (const auto& hidden : state_.hidden) {
      auto given = before(hidden);
      runtime::assume(event_literals_, set, given);
      const auto next = next_states_[window].ask(given, {limits_.states});
      if (!next.is_complete()) return {next.end, {}, limits_.states};
      valuations.insert(next.found.begin(), next.found.end());
    }
  }
  return grouped({valuations.begin(), valuations.end()},
                 static_cast<compiler::Timepoint>(step) + 1);
}

const ModelSimulator::Answer& ModelSimulator::steps(std::int64_t event) {
  // All steps beyond the horizon are alike.
  const auto step = std::min(static_cast<std::size_t>(timepoint_), world_->layered.step_at.size());
  Question question{step, event, state_};
  const auto found = known_.find(question);
  if (found != known_.end()) return found->second;
  auto answer = find_steps(step, event);
  const auto states = answer.states.size() + 1;
  if (known_states_ + states > limits_.remembered) {
    known_.clear();
    known_states_ = 0;
  }
  known_states_ += states;
  return known_.emplace(std::move(question), std::move(answer)).first->second;
}

Outcome ModelSimulator::act(std::string_view action, const State& /*arguments*/,
                            double /*sim_time_limit_s*/) {
  PARALLAX_REQUIRE(timepoint_ >= 0, "a successful reset before act");
  const auto event = events_.find(action);
  if (event == events_.end()) {
    return {SimStatus::kUnsupported,
            fmt::format("no event `{}` in `{}`", action, world_->name),
            0.0,
            {}};
  }
  // Steps beyond the horizon are as the last one, if what the model says of time ends before it.
  const auto& at = world_->layered.step_at;
  const auto last = at.size() - 1;
  if (static_cast<std::size_t>(timepoint_) > last && at[last] != at[last - 1]) {
    return {SimStatus::kUnsupported,
            fmt::format("`{}` speaks of timepoint {}, and was not read beyond it", world_->name,
                        at.size()),
            0.0,
            {}};
  }
  const auto place = event_places_[event->second];
  const auto taken_s = kTimepoint_s;
  if (place != kNoEvent) {
    const auto& answer = steps(place);
    if (answer.end != WindowEnd::kComplete) {
      return no_list(answer, fmt::format("outcomes of `{}`", action));
    }
    if (!answer.states.empty()) {
      move_to(answer.states);
      ++timepoint_;
      return {SimStatus::kOk, {}, taken_s, {}};
    }
  }
  const auto& idle = steps(kNoEvent);
  if (idle.end != WindowEnd::kComplete) return no_list(idle, "outcomes of a step without an event");
  if (!idle.states.empty()) move_to(idle.states);
  ++timepoint_;
  return {SimStatus::kFailed,
          fmt::format("not-possible: `{}` has no next state in which `{}` has happened",
                      world_->name, action),
          taken_s,
          {}};
}

State ModelSimulator::observe() {
  PARALLAX_REQUIRE(timepoint_ >= 0, "a successful reset before observe");
  State out;
  std::size_t place = 0;
  for (const auto& fluent : world_->model.fluents) {
    out.emplace(fluent.name, fluent.slot ? state_.observed[place++] : false);
  }
  out["digest"] = fmt::format("{:016x}", digest_);
  return out;
}

}  // namespace parallax::harness
