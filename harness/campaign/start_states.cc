// The initial states that lead to a trace's events, and which of them a sample begins in.
//
// Up to kMostStates are listed, told apart by the fluents that a start can show. Samples go through
// them in random orders, each state once before any comes twice. For clean runs this is as good as
// independent draws: the chance that n of them are all clean is a symmetric mean of products of the
// states' chances, at most the n-th power of their mean (Maclaurin's inequality). Once a run was
// lost, draws are independent, as the bound for runs with failures asks for
// (docs/internals/statistics.md).
//
// A trace with more states has them drawn: each group of fluents gets one of the values that it can
// have by itself, until the model has an execution from the whole. The draws are uniform over all
// initial states of the trace. Drawing ends where hardly any candidate is one.
//
// Cost: one solver call a state to list them, and a few for the prediction of each one simulated.
// Drawn ones take at most 1000 calls each, on the average.

#include "harness/campaign/start_states.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

#include "compiler/base/contract.h"
#include "compiler/base/hash.h"
#include "compiler/base/sha256.h"
#include "harness/campaign/loop_stream.h"
#include "harness/campaign/trial.h"

namespace parallax::harness {
namespace {

// Names of random streams, mixed into a trace's key.
constexpr std::string_view kOrderStream = "initial states: order";
constexpr std::string_view kDrawnStream = "initial states: draw";

/// Drawing ends when more candidates were refused than this for each accepted one and one more:
/// fewer than a thousandth are initial states of the trace.
constexpr std::int64_t kMostRefused = 1000;

std::uint64_t stream_key(std::uint64_t trace_key, std::string_view stream) {
  return mix64(trace_key ^ base::fnv1a64(stream));
}

std::set<std::string> names_of(const std::vector<compiler::FluentId>& state,
                               const compiler::SymbolTable& symbols) {
  std::set<std::string> out;
  for (const auto id : state) out.emplace(symbols.name(id));
  return out;
}

}  // namespace

base::Result<StartStates> StartStates::make(const StartSources& sources, CampaignTrace trace) {
  StartStates out(sources);
  out.trace_key_ = base::fnv1a64(trace.key);
  out.trace_ = std::make_shared<const CampaignTrace>(std::move(trace));
  out.fluents_ = compared_fluents(sources.scenario, sources.fluents);
  std::sort(out.fluents_.begin(), out.fluents_.end());
  if (!out.list()) return sources.sink.already_reported();
  auto first = out.prepared(out.is_single() ? 0 : 1);
  if (!first) return sources.sink.already_reported();
  if (!*first) {  // stopped
    out.more_ = false;
    out.states_ = {out.own()};
    first = out.prepared(0);
    if (!first) return sources.sink.already_reported();
  }
  return out;
}

/// The initial state of the trace, as far as states are told apart.
StartStates::State StartStates::own() const {
  State out;
  for (const auto fluent : fluents_) {
    if (runtime::contains(trace_->points.front().holds, fluent)) out.push_back(fluent);
  }
  return out;
}

base::Status StartStates::list() {
  states_ = {own()};
  if (trace_->other_initial_states != base::Known::kYes) return base::Unit{};
  auto starts = sources_.feed.starts(*trace_, fluents_);
  if (!starts) return sources_.sink.already_reported();
  if (!*starts) return base::Unit{};
  const bool more = (*starts)->more;
  if (sources_.scenario.initial == Initial::kFirst) {
    others_ = more ? -1 : static_cast<std::int64_t>((*starts)->states.size()) - 1;
    return base::Unit{};
  }
  if (!more) {
    states_ = std::move((*starts)->states);
    weights_ = std::move((*starts)->weights);
    common_ = common_fluents(states_);
    leave_out_unrealisable();
    return base::Unit{};
  }
  more_ = true;
  parts_ = std::move((*starts)->parts);
  numbers_.emplace(own(), 1);
  return base::Unit{};
}

/// Can a start of the world be in the state?
bool StartStates::can_begin(const State& state) const {
  return !why_no_start(sources_.scenario, sources_.fluents.ground(),
                       names_of(state, *trace_->symbols));
}

void StartStates::leave_out_unrealisable() {
  if (states_.size() == 1) return;
  std::vector<State> kept;
  std::vector<double> weights;
  std::vector<std::string> reasons;
  const auto all = states_;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto why = why_no_start(sources_.scenario, sources_.fluents.ground(),
                                  names_of(all[i], *trace_->symbols));
    if (why) {
      reasons.push_back(fmt::format("{}: {}", text(static_cast<std::int64_t>(i) + 1), *why));
      continue;
    }
    kept.push_back(all[i]);
    if (!weights_.empty()) weights.push_back(weights_[i]);
  }
  if (kept.empty()) return;  // what is wrong with the first is reported when it is prepared
  states_ = std::move(kept);
  common_ = common_fluents(states_);
  weights_ = std::move(weights);
  unrealisable_ = std::move(reasons);
}

std::optional<std::int64_t> StartStates::count() const {
  if (more_) return std::nullopt;
  return static_cast<std::int64_t>(states_.size());
}

std::string StartStates::text(std::int64_t state) const {
  if (more_) {
    for (const auto& [holds, number] : numbers_) {
      if (number == state)
        return fmt::format("{}", fmt::join(names_of(holds, *trace_->symbols), " "));
    }
    return {};
  }
  const auto& holds = states_[static_cast<std::size_t>(std::max<std::int64_t>(state, 1) - 1)];
  return state_text(holds, common_, *trace_->symbols);
}

base::Result<std::optional<std::int64_t>> StartStates::state_of(std::int64_t sample,
                                                                bool independent) {
  if (is_single()) return std::optional<std::int64_t>(0);
  if (more_) return accepted(sample);
  if (weights_.empty() && !independent) {
    return std::optional(permuted(sample - offset_ - 1));
  }
  const DrawKey key{sources_.campaign_seed, stream_key(trace_key_, kDrawnStream),
                    DrawPhase::kCertify, static_cast<std::uint64_t>(sample), 0};
  return std::optional(state_at(CounterRng(key).uniform(0)));
}

/// The state at this position, from 0, of random orders one after the other (Fisher and Yates).
std::int64_t StartStates::permuted(std::int64_t position) {
  const auto states = static_cast<std::int64_t>(states_.size());
  const auto block = position / states;
  if (block != block_) {
    block_ = block;
    order_.resize(states_.size());
    std::iota(order_.begin(), order_.end(), std::int64_t{1});
    const CounterRng random({sources_.campaign_seed, stream_key(trace_key_, kOrderStream),
                             DrawPhase::kCertify, static_cast<std::uint64_t>(block), 0});
    for (std::size_t left = order_.size(); left > 1; --left) {
      const auto chosen =
          static_cast<std::size_t>(random.uniform(left) * static_cast<double>(left));
      std::swap(order_[left - 1], order_[std::min(chosen, left - 1)]);
    }
  }
  return order_[static_cast<std::size_t>(position % states)];
}

std::int64_t StartStates::state_at(double u) const {
  return is_single() ? 0 : harness::state_at(u, states_.size(), weights_);
}

std::set<std::string> StartStates::holds(std::int64_t state) const {
  return names_of(states_[static_cast<std::size_t>(state - 1)], *trace_->symbols);
}

/// Draws candidates until one is an initial state of the trace. Its number is that of the first
/// sample that begins in it.
base::Result<std::optional<std::int64_t>> StartStates::accepted(std::int64_t sample) {
  if (const auto known = drawn_.find(sample); known != drawn_.end()) {
    const auto state = known->second.state;
    return state == 0 ? std::nullopt : std::optional(state);
  }
  if (parts_.empty()) return std::optional<std::int64_t>(1);  // nothing can be drawn
  const DrawKey key{sources_.campaign_seed, stream_key(trace_key_, kDrawnStream),
                    DrawPhase::kCertify, static_cast<std::uint64_t>(sample), 0};
  const CounterRng random(key);
  std::uint64_t next = 0;
  const bool is_first = drawn_.empty();
  const auto most = kMostRefused * (std::ssize(drawn_) + 1) - refused_;
  for (std::int64_t attempt = 0; attempt < most; ++attempt) {
    State state;
    for (const auto& part : parts_) {
      const auto chosen =
          static_cast<std::size_t>(random.uniform(next++) * static_cast<double>(part.size()));
      const auto& value = part[std::min(chosen, part.size() - 1)];
      state.insert(state.end(), value.begin(), value.end());
    }
    std::sort(state.begin(), state.end());
    auto number = numbers_.find(state);
    if (number == numbers_.end()) {
      auto found = sources_.feed.from(*trace_, fluents_, state);
      if (!found) return sources_.sink.already_reported();
      if (found->first == base::Known::kUndecided) return std::optional<std::int64_t>();
      if (found->first == base::Known::kNo || !can_begin(state)) continue;
      const auto fresh = static_cast<std::int64_t>(numbers_.size()) + 1;
      auto start = prepare(*std::move(found->second), fresh);
      if (!start) return sources_.sink.already_reported();
      prepared_.emplace(fresh, *std::move(start));
      number = numbers_.emplace(std::move(state), fresh).first;
    }
    drawn_.emplace(sample, Drawn{number->second, attempt});
    refused_ += attempt;
    return std::optional(number->second);
  }
  if (is_first) {
    parts_.clear();
    return std::optional<std::int64_t>(1);
  }
  drawn_.emplace(sample, Drawn{0, most});
  return std::optional<std::int64_t>();
}

bool StartStates::ran_out(std::int64_t sample) const {
  const auto found = drawn_.find(sample);
  return found != drawn_.end() && found->second.state == 0;
}

base::Result<PreparedStart> StartStates::prepare(CampaignTrace trace, std::int64_t state) {
  const auto& scenario = sources_.scenario;
  auto parts =
      prepare_trace(scenario, sources_.fluents.ground(), sources_.simulator, trace, sources_.sink);
  if (!parts) return sources_.sink.already_reported();
  PreparedStart out;
  out.plan = std::make_shared<const TracePlan>(
      TracePlan{std::make_shared<const CampaignTrace>(std::move(trace)), std::move(parts->calls),
                std::move(parts->sampler), sources_.campaign_seed, trace_key_,
                scenario.limits.max_rejected_starts, may_repeat_losses(sources_.simulator), state});
  out.state = state;
  out.samples = std::make_shared<const TraceSamples>(out.plan);
  return out;
}

base::Result<std::optional<PreparedStart>> StartStates::prepared(std::int64_t state) {
  if (const auto found = prepared_.find(state); found != prepared_.end()) {
    return std::optional(found->second);
  }
  PARALLAX_REQUIRE(has(state), "a state of the trace");
  CampaignTrace trace = *trace_;
  const auto& wanted = states_[static_cast<std::size_t>(std::max<std::int64_t>(state, 1) - 1)];
  if (!is_single() || wanted != own()) {
    auto found = sources_.feed.from(*trace_, fluents_, wanted);
    if (!found) return sources_.sink.already_reported();
    if (found->first != base::Known::kYes) return std::optional<PreparedStart>();
    trace = *std::move(found->second);
  }
  auto made = prepare(std::move(trace), state);
  if (!made) return sources_.sink.already_reported();
  return std::optional(prepared_.emplace(state, *std::move(made)).first->second);
}

const PreparedStart& StartStates::known(std::int64_t state) const {
  const auto found = prepared_.find(state);
  PARALLAX_REQUIRE(found != prepared_.end(), "a state that was asked for");
  return found->second;
}

bool StartStates::has(std::int64_t state) const {
  if (is_single()) return state == 0;
  const auto all = more_ ? numbers_.size() : states_.size();
  return state >= 1 && state <= static_cast<std::int64_t>(all);
}

std::string StartStates::law_text() const {
  if (is_single()) return {};
  const auto all = count();
  return fmt::format("{} of {}", law_word(sources_.scenario.initial),
                     all ? std::to_string(*all) : std::string("more than are listed"));
}

std::string StartStates::digest() const {
  const auto text_of = [&](const State& state) {
    return fmt::format("{}", fmt::join(names_of(state, *trace_->symbols), " "));
  };
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < states_.size() && !more_; ++i) {
    lines.push_back(fmt::format("{} {}", text_of(states_[i]),
                                weights_.empty() ? std::string() : fmt::format("{}", weights_[i])));
  }
  for (const auto& part : parts_) {
    std::vector<std::string> values;
    for (const auto& value : part) values.push_back(text_of(value));
    std::sort(values.begin(), values.end());
    lines.push_back(fmt::format("{}", fmt::join(values, " | ")));
  }
  // With `more_` and without parts the trace's own state stands for all.
  if (lines.empty()) lines.push_back(text_of(own()));
  std::sort(lines.begin(), lines.end());
  return base::sha256_hex(fmt::format("{}", fmt::join(lines, "\n"))).substr(0, 16);
}

void StartStates::describe(StartResult& result, std::int64_t last) const {
  result.law = sources_.scenario.initial;
  result.unrealisable = unrealisable_;
  result.candidates = result.refused = 0;
  result.ran_out = false;
  for (const auto& [sample, drawn] : drawn_) {
    if (sample > last) break;
    result.candidates += drawn.refused + (drawn.state == 0 ? 0 : 1);
    result.refused += drawn.refused;
    result.ran_out = drawn.state == 0;
  }
  result.only_first = more_ && parts_.empty();
  result.all = count();
  if (result.all) *result.all += std::ssize(unrealisable_) + std::max<std::int64_t>(others_, 0);
  if (others_ < 0) result.all.reset();
}

}  // namespace parallax::harness
