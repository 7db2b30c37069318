#include "harness/conformance/conformance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "harness/conformance/protocol_probe.h"
#include "harness/conformance/units.h"

namespace parallax::harness {
namespace {

constexpr int kLossesToGiveUp = 3;
constexpr double kExact = 1e-6;  // starts keep at least so far from borders
constexpr int kStartTries = 12;
constexpr int kRoundTrips = 20;
constexpr std::uint64_t kSeeds[] = {1, 2, 3, (std::uint64_t{1} << 53U) - 1};
constexpr double kActOverhead_s = 5.0;

std::optional<double> numeric(const Value& value) {
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return static_cast<double>(*integer);
  if (const auto* number = std::get_if<double>(&value)) return *number;
  return std::nullopt;
}

/// Boolean, number or text: what must not change between observations.
int kind_of(const Value& value) {
  if (std::holds_alternative<bool>(value)) return 0;
  return std::holds_alternative<std::string>(value) ? 2 : 1;
}

bool is_ready(const Outcome& outcome) { return outcome.status == SimStatus::kOk; }

/// All of a check, from the first process to the claims.
class Conformance {
 public:
  explicit Conformance(const ConformanceOptions& options)
      : options_(options), starts_(options.starts), actions_(options.actions) {}

  ConformanceReport run();

 private:
  // Asking.
  bool connect();
  ProtocolProbe& probe() { return *probe_; }
  bool given_up() const { return losses_ >= kLossesToGiveUp || stopped(); }
  bool stopped() const { return options_.process.stop != nullptr && *options_.process.stop; }
  std::optional<ReplyBody> ask(RequestBody body, double timeout_s, bool unknown_field = false);
  /// None: it was lost. A refusal by an error is kUnsupported.
  std::optional<Outcome> outcome_of(RequestBody body, double timeout_s, bool unknown_field = false);
  std::optional<Outcome> reset(const State& start, std::uint64_t seed);
  std::optional<Outcome> act(const TriedAction& action, double limit_s);
  std::optional<State> observe();
  std::optional<RunRecord> record(const State& start, std::uint64_t seed);
  /// The same run by one request.
  std::optional<RunRecord> performed(const State& start, std::uint64_t seed);
  double act_timeout_s(double limit_s) const;
  void lost(const std::string& trouble);
  double time_slack_s() const { return 2.0 * report_.info.timestep_s; }

  // Saying.
  void fault(std::string text) { find(true, std::move(text)); }
  void warn(std::string text) { find(false, std::move(text)); }
  void find(bool is_fault, std::string text);
  void say(CheckKind kind, std::string what) { note(kind, true, std::move(what)); }
  void skip(CheckKind kind, std::string why) { note(kind, false, std::move(why)); }
  void note(CheckKind kind, bool was_made, std::string what);

  // The checks.
  bool check_handshake();
  void choose_starts();
  void choose_actions();
  void check_resets();
  void check_start(const State& start, const State& seen);
  void check_actions();
  void check_determinism();
  void check_seeds();
  void check_invalid_starts();
  void check_refused(const char* what, const State& start, bool may_be_invalid);
  void check_unknown();
  void check_time_limit();
  void check_timing();
  void check_units();
  void check_end();
  void add_claims();

  const ConformanceOptions& options_;
  ConformanceReport report_;
  CheckKind now_ = CheckKind::kHandshake;
  std::unique_ptr<ProtocolProbe> probe_;
  int losses_ = 0;
  bool connected_once_ = false;
  std::vector<State> starts_;
  std::vector<TriedAction> actions_;
  std::optional<RunRecord> first_;  // of the first start and seed
  std::vector<State> seen_;
  std::set<std::string> said_;
  bool noise_seen_ = false, seeds_fine_ = true;
  std::optional<bool> jobs_work_;  // none: not tried
  double hello_wall_s_ = 0.0;
  double acted_wall_s_ = 0.0, acted_sim_s_ = 0.0;
  bool has_margins_ = false;
};

void Conformance::find(bool is_fault, std::string text) {
  if (stopped() || !said_.insert(text).second) return;
  report_.findings.push_back({now_, is_fault, std::move(text)});
}

void Conformance::note(CheckKind kind, bool was_made, std::string what) {
  report_.checks.push_back({kind, was_made, std::move(what)});
}

void Conformance::lost(const std::string& trouble) {
  fault(trouble);
  ++losses_;
}

/// A process that has said hello. The faults of the handshake are those of the first one.
bool Conformance::connect() {
  if (probe_ && probe_->is_alive()) return true;
  if (given_up()) return false;
  probe_ = std::make_unique<ProtocolProbe>(options_.process);
  if (!probe_->is_alive()) {
    losses_ = kLossesToGiveUp;
    fault("it does not start: " + probe_->trouble());
    return false;
  }
  const auto reply = ask(HelloRequest{}, options_.process.hello_timeout_s);
  if (!reply) return false;
  hello_wall_s_ = probe_->wall_s();
  const auto* hello = std::get_if<HelloReply>(&*reply);
  if (hello == nullptr) {
    const auto* error = std::get_if<ErrorReply>(&*reply);
    lost("it refused `hello`: " + (error != nullptr ? error->message : std::string()));
    probe_.reset();
    return false;
  }
  if (connected_once_) return true;
  report_.info = hello->info;
  if (report_.info.can("describe")) {
    const auto described = ask(DescribeRequest{}, options_.process.hello_timeout_s);
    if (!described) return false;
    if (const auto* world = std::get_if<DescribeReply>(&*described)) {
      report_.info.parameters = world->info.parameters;
      report_.info.actions = world->info.actions;
      report_.info.arguments = world->info.arguments;
    } else {
      fault("it says that it can `describe` and refuses it");
    }
  }
  connected_once_ = true;
  return true;
}

std::optional<ReplyBody> Conformance::ask(RequestBody body, double timeout_s, bool unknown_field) {
  auto reply = probe_->ask(std::move(body), timeout_s, unknown_field);
  if (!reply) lost(probe_->trouble());
  return reply;
}

std::optional<Outcome> Conformance::outcome_of(RequestBody body, double timeout_s,
                                               bool unknown_field) {
  if (!connect()) return std::nullopt;
  auto reply = ask(std::move(body), timeout_s, unknown_field);
  if (!reply) return std::nullopt;
  if (auto* done = std::get_if<OutcomeReply>(&*reply)) return std::move(done->outcome);
  const auto& error = std::get<ErrorReply>(*reply);
  if (is_refusal(error)) return Outcome{SimStatus::kUnsupported, error.message, 0.0, {}};
  return Outcome{SimStatus::kLost, fmt::format("{}: {}", error.code, error.message), 0.0, {}};
}

std::optional<Outcome> Conformance::reset(const State& start, std::uint64_t seed) {
  return outcome_of(ResetRequest{start, seed}, options_.process.reset_timeout_s);
}

double Conformance::act_timeout_s(double limit_s) const {
  double factor = options_.process.min_real_time_factor;
  if (report_.info.min_real_time_factor > 0.0) {
    factor = std::min(factor, report_.info.min_real_time_factor);
  }
  const auto own = options_.process.act_timeout_s;
  return own > 0.0 ? own : kActOverhead_s + limit_s / factor;
}

std::optional<Outcome> Conformance::act(const TriedAction& action, double limit_s) {
  auto outcome =
      outcome_of(ActRequest{action.controller, action.arguments, limit_s}, act_timeout_s(limit_s));
  if (outcome && !outcome->margins.empty()) has_margins_ = true;
  return outcome;
}

std::optional<State> Conformance::observe() {
  if (!connect()) return std::nullopt;
  auto reply = ask(ObserveRequest{}, options_.process.observe_timeout_s);
  if (!reply) return std::nullopt;
  if (auto* observed = std::get_if<ObserveReply>(&*reply)) {
    seen_.push_back(observed->state);
    return std::move(observed->state);
  }
  const auto& error = std::get<ErrorReply>(*reply);
  fault(fmt::format("`observe` gave the error {}: {}", error.code, error.message));
  return std::nullopt;
}

std::optional<RunRecord> Conformance::record(const State& start, std::uint64_t seed) {
  RunRecord run;
  const auto begun = reset(start, seed);
  if (!begun) return std::nullopt;
  if (!is_ready(*begun)) {
    fault(fmt::format("a start that was fine before is {}: {}", to_string(begun->status),
                      begun->reason));
    return std::nullopt;
  }
  auto state = observe();
  if (!state) return std::nullopt;
  run.outcomes.push_back(*begun);
  run.states.push_back(*std::move(state));
  for (const auto& action : actions_) {
    const auto done = act(action, action.time_limit_s);
    if (!done) return std::nullopt;
    if (done->status == SimStatus::kLost) {
      fault(fmt::format("`{}` was lost: {}", action.controller, done->reason));
      return std::nullopt;
    }
    acted_wall_s_ += probe_->wall_s();
    acted_sim_s_ += done->sim_time_s;
    state = observe();
    if (!state) return std::nullopt;
    run.outcomes.push_back(*done);
    run.states.push_back(*std::move(state));
  }
  return run;
}

std::optional<RunRecord> Conformance::performed(const State& start, std::uint64_t seed) {
  if (!connect()) return std::nullopt;
  PerformRequest asked;
  double timeout_s = options_.process.reset_timeout_s + options_.process.observe_timeout_s;
  asked.requests.emplace_back(ResetRequest{start, seed});
  asked.requests.emplace_back(ObserveRequest{});
  for (const auto& action : actions_) {
    timeout_s += act_timeout_s(action.time_limit_s) + options_.process.observe_timeout_s;
    asked.requests.emplace_back(
        ActRequest{action.controller, action.arguments, action.time_limit_s});
    asked.requests.emplace_back(ObserveRequest{});
  }
  const auto reply = ask(asked, timeout_s);
  if (!reply) return std::nullopt;
  const auto* done = std::get_if<PerformReply>(&*reply);
  if (done == nullptr) {
    fault("it says that it can `perform` and refuses it");
    return std::nullopt;
  }
  RunRecord run;
  for (const auto& one : done->replies) {
    if (const auto* outcome = std::get_if<OutcomeReply>(&one)) {
      run.outcomes.push_back(outcome->outcome);
    } else if (const auto* state = std::get_if<ObserveReply>(&one)) {
      run.states.push_back(state->state);
    } else {
      fault("a `perform` of what was fine before gave the error " + std::get<ErrorReply>(one).code);
      return std::nullopt;
    }
  }
  if (done->replies.size() == asked.requests.size()) return run;
  fault("a `perform` of what was fine before breaks off");
  return std::nullopt;
}

bool Conformance::check_handshake() {
  now_ = CheckKind::kHandshake;
  if (!connect()) {
    skip(now_, "it did not come to an end");
    return false;
  }
  const auto& info = report_.info;
  if (info.name.empty()) fault("it has no name");
  if (info.determinism != "bitwise" && info.determinism != "tolerance" &&
      info.determinism != "none") {
    fault(fmt::format("`determinism` is `{}`, which is neither bitwise, tolerance nor none",
                      info.determinism));
  }
  std::set<std::string> names;
  std::size_t settable = 0;
  for (const auto& parameter : info.parameters) {
    if (!names.insert(parameter.name).second) {
      fault(fmt::format("`{}` is declared twice", parameter.name));
    }
    if (parameter.lower && parameter.upper && *parameter.lower > *parameter.upper) {
      fault(fmt::format("the bounds of `{}` are reversed", parameter.name));
    }
    if (parameter.settable) ++settable;
  }
  std::set<std::string> actions;
  for (const auto& action : info.actions) {
    if (!actions.insert(action).second) fault(fmt::format("`{}` is declared twice", action));
  }
  if (info.parameters.empty()) warn("it declares no variables, so no scenario can be checked");
  say(now_, fmt::format("{} variables ({} to be set), {} actions, {:.2f} s", info.parameters.size(),
                        settable, info.actions.size(), hello_wall_s_));
  return true;
}

/// Two starts that it takes, from bounds where it says any, else near to where it stands by itself.
void Conformance::choose_starts() {
  if (!starts_.empty()) return;
  const auto begun = reset({}, kSeeds[0]);
  if (!begun) return;
  if (!is_ready(*begun)) {
    warn(fmt::format("a `reset` without a state is {}: {}; what is not named takes its default",
                     to_string(begun->status), begun->reason));
  }
  const auto base = is_ready(*begun) ? observe().value_or(State{}) : State{};
  std::string why;
  for (int tried = 0; tried < kStartTries && starts_.size() < 2 && !given_up(); ++tried) {
    // 0.35, 0.65, then elsewhere between the bounds.
    const double share = tried < 2 ? 0.35 + 0.3 * tried : std::fmod(0.5 + 0.381966 * tried, 1.0);
    State start;
    for (const auto& parameter : report_.info.parameters) {
      const auto own = base.find(parameter.name);
      if (!parameter.settable || (own != base.end() && !numeric(own->second))) continue;
      if (parameter.lower && parameter.upper) {
        start[parameter.name] = *parameter.lower + share * (*parameter.upper - *parameter.lower);
      } else if (own != base.end()) {
        start[parameter.name] = *numeric(own->second) + 0.02 * (share - 0.5);
      }
    }
    const auto outcome = reset(start, kSeeds[0]);
    if (!outcome) return;
    if (is_ready(*outcome)) {
      starts_.push_back(std::move(start));
    } else {
      why = outcome->reason;
    }
    if (starts_.size() == 1 && starts_[0].empty()) break;
  }
  if (starts_.empty()) fault("no start was found that it takes: " + why);
}

void Conformance::choose_actions() {
  if (!actions_.empty()) return;
  for (const auto& name : report_.info.actions) {
    TriedAction action{name, {}, 60.0};
    const auto told = report_.info.arguments.find(name);
    bool is_known = true;
    if (told != report_.info.arguments.end()) {
      for (const auto& argument : told->second) {
        if (!argument.required) continue;
        if (argument.example) action.arguments[argument.name] = *argument.example;
        is_known = is_known && argument.example.has_value();
      }
    }
    if (is_known) actions_.push_back(std::move(action));
  }
}

void Conformance::check_start(const State& start, const State& seen) {
  for (const auto& [name, asked] : start) {
    const auto found = seen.find(name);
    if (found == seen.end()) {
      fault(fmt::format("`{}` was set and is not observed", name));
      continue;
    }
    const auto x = numeric(asked), y = numeric(found->second);
    if (!x || !y) {
      if (asked == found->second) continue;
      fault(fmt::format("the start asks for `{}` {}, observed is {}", name, text_of(asked),
                        text_of(found->second)));
      continue;
    }
    const double deviation = std::abs(*x - *y);
    report_.largest_deviation = std::max(report_.largest_deviation, deviation);
    if (deviation <= kExact) continue;
    find(deviation > options_.tolerance, fmt::format("the start asks for `{}` {}, observed is {}",
                                                     name, text_of(asked), text_of(found->second)));
  }
}

void Conformance::check_resets() {
  now_ = CheckKind::kReset;
  for (std::size_t i = 0; i < starts_.size() && i < 2; ++i) {
    const auto begun = reset(starts_[i], kSeeds[0]);
    if (!begun) continue;
    if (!is_ready(*begun)) {
      fault(fmt::format("the start is {}: {}", to_string(begun->status), begun->reason));
      continue;
    }
    const auto seen = observe();
    if (!seen) continue;
    check_start(starts_[i], *seen);
    for (const auto& parameter : report_.info.parameters) {
      if (!seen->contains(parameter.name)) {
        fault(fmt::format("`{}` is declared and not observed", parameter.name));
      }
    }
    for (const auto& [name, value] : *seen) {
      const auto& known = report_.info.parameters;
      const bool declared = std::any_of(known.begin(), known.end(),
                                        [&](const Parameter& one) { return one.name == name; });
      if (!declared && name != "digest") {
        warn(fmt::format("`{}` is observed and not declared, so no scenario can use it", name));
      }
    }
    const auto again = observe();
    if (!again) continue;
    const auto drift = difference_of(*seen, *again, "when observed twice");
    if (drift.kind == RunDifference::Kind::kNone) continue;
    find(drift.kind == RunDifference::Kind::kDiscrete || drift.largest > options_.tolerance,
         "time passes between requests, or observing changes something: " + drift.where);
  }
  if (starts_.empty()) return skip(now_, "no start is known");
  say(now_,
      fmt::format("{} start{}, largest deviation {:.3g}", std::min<std::size_t>(2, starts_.size()),
                  starts_.size() == 1 ? "" : "s", report_.largest_deviation));
}

void Conformance::check_actions() {
  now_ = CheckKind::kActions;
  if (actions_.empty()) {
    return skip(now_, "it is not known how to call any; name some with --act, or a --scenario");
  }
  first_ = record(starts_.front(), kSeeds[0]);
  if (!first_) return skip(now_, "the run did not come to its end");
  std::map<std::string, int> kinds;
  for (const auto& state : first_->states) {
    for (const auto& [name, value] : state) {
      const auto known = kinds.emplace(name, kind_of(value));
      if (known.first->second == kind_of(value)) continue;
      fault(fmt::format("`{}` is now a boolean or text, now a number", name));
    }
  }
  std::string said;
  for (std::size_t i = 1; i < first_->outcomes.size(); ++i) {
    const auto& outcome = first_->outcomes[i];
    const auto& name = actions_[i - 1].controller;
    said += fmt::format("{}{} {}", said.empty() ? "" : ", ", name, to_string(outcome.status));
    if (outcome.status == SimStatus::kUnsupported) {
      fault(fmt::format("`{}` is refused: {}", name, outcome.reason));
    }
    if (outcome.status == SimStatus::kInvalidStart) {
      fault(fmt::format("`{}` answers invalid_start, which is for `reset` alone", name));
    }
    if (outcome.status == SimStatus::kFailed && outcome.reason.empty()) {
      warn(fmt::format("`{}` failed without a reason, so causes cannot be told apart", name));
    }
    const auto moved = difference_of(first_->states[i - 1], first_->states[i], "");
    if (moved.kind != RunDifference::Kind::kNone && outcome.sim_time_s == 0.0) {
      warn(fmt::format("`{}` changed something in no simulated time; say `sim_time`", name));
    }
  }
  say(now_, said);
}

void Conformance::check_determinism() {
  now_ = CheckKind::kDeterminism;
  if (starts_.empty()) return skip(now_, "no start is known");
  if (!first_) first_ = record(starts_.front(), kSeeds[0]);
  if (!first_) return skip(now_, "no run came to its end");
  RunDifference difference;
  // After another run, in the same process: is anything left of that one?
  const bool between = record(starts_.back(), kSeeds[1]).has_value();
  const auto after_other = between ? record(starts_.front(), kSeeds[0]) : std::nullopt;
  if (!after_other) return skip(now_, "no second run came to its end");
  const auto in_process = difference_of(*first_, *after_other, actions_, time_slack_s());
  difference.add(in_process);
  // The same by one request. Poses and reasons aside, nothing may differ but what always does.
  if (report_.info.can("perform") && report_.info.determinism == "bitwise") {
    const auto at_once = performed(starts_.front(), kSeeds[0]);
    const auto other =
        at_once ? difference_of(*first_, *at_once, actions_, time_slack_s()) : RunDifference{};
    if (other.kind != RunDifference::Kind::kNone) {
      fault("`perform` gives another result than its requests one by one: " + other.where);
    }
  }
  // In another process, while the first one lives and stands at a start.
  const auto begun = reset(starts_.back(), kSeeds[0]);
  const auto standing = begun && is_ready(*begun) ? observe() : std::nullopt;
  auto kept = std::move(probe_);
  const int losses_before = losses_;
  const auto elsewhere = record(starts_.front(), kSeeds[0]);
  if (elsewhere) {
    jobs_work_ = true;
    difference.add(difference_of(*first_, *elsewhere, actions_, time_slack_s()));
  } else if (losses_ > losses_before) {
    jobs_work_ = false;
    fault("a second process beside the first one does not work: no --jobs above 1");
  }
  probe_ = std::move(kept);
  const auto left = elsewhere && standing ? observe() : std::nullopt;
  if (left) {
    const auto moved = difference_of(*standing, *left, "of one process, while another one ran");
    if (moved.kind == RunDifference::Kind::kDiscrete || moved.largest > options_.tolerance) {
      jobs_work_ = false;
      warn("two processes share one world, so only --jobs 1 is right: " + moved.where);
    }
  }
  report_.largest_difference = difference.largest;
  report_.repeatability = Repeatability::kBitwise;
  if (difference.kind == RunDifference::Kind::kNumbers) {
    report_.repeatability =
        difference.largest <= options_.tolerance ? Repeatability::kTolerance : Repeatability::kNone;
  }
  if (difference.kind == RunDifference::Kind::kDiscrete) {
    report_.repeatability = Repeatability::kNone;
  }
  const auto place = in_process.kind != RunDifference::Kind::kNone
                         ? "in one process, after another run"
                         : "in another process";
  const auto measured = report_.repeatability;
  const auto& declared = report_.info.determinism;
  if (measured != Repeatability::kBitwise) {
    const bool broken =
        declared == "bitwise" || (declared == "tolerance" && measured == Repeatability::kNone);
    const auto text =
        fmt::format("the same start and seed gave another result {}: {}", place, difference.where);
    if (broken) fault(fmt::format("it is said to be `{}`, but {}", declared, text));
    if (!broken && declared == "none") warn(text);
  } else if (declared != "bitwise") {
    warn(fmt::format("it is said to be `{}` and was bitwise in all runs: if it always is, say so",
                     declared));
  }
  say(now_, fmt::format("{} in 3 runs of 2 processes, as said: {}", to_string(measured), declared));
}

void Conformance::check_seeds() {
  now_ = CheckKind::kSeeds;
  if (!first_) return skip(now_, "no run came to its end");
  RunDifference difference;
  for (const auto seed : kSeeds) {
    const auto run = seed == kSeeds[0] ? first_ : record(starts_.front(), seed);
    if (!run) {
      seeds_fine_ = false;
      return skip(now_, fmt::format("the run with seed {} did not come to its end", seed));
    }
    difference.add(difference_of(*first_, *run, actions_, time_slack_s(), false));
  }
  noise_seen_ = difference.kind != RunDifference::Kind::kNone;
  const bool repeats = report_.repeatability != Repeatability::kNone;
  if (report_.info.seeds && !repeats) {
    seeds_fine_ = false;
    fault("it says that it uses seeds, but the same one gives other results");
  }
  if (report_.info.can("noise") && report_.info.seeds && !noise_seen_) {
    seeds_fine_ = false;
    fault("it says that results vary with the seed, but four seeds give the same result");
  }
  if (!report_.info.seeds && repeats && noise_seen_) {
    warn("it is said to use no seed, and seems to use it");
  }
  say(now_, fmt::format("{}; said: {}",
                        noise_seen_ ? "four seeds give different results: " + difference.where
                                    : "four seeds give the same result",
                        report_.info.seeds ? "seeds are used" : "no seed is used"));
}

/// What cannot be started with must be refused, and leave it fit for the next start.
void Conformance::check_refused(const char* what, const State& start, bool may_be_invalid) {
  const auto outcome = reset(start, kSeeds[0]);
  if (!outcome) return;
  const auto name = start.begin()->first;
  if (outcome->status == SimStatus::kUnsupported) return;
  if (may_be_invalid && outcome->status == SimStatus::kInvalidStart) return;
  if (outcome->status == SimStatus::kOk) {
    fault(fmt::format("{} is taken: `{}` {}", what, name, text_of(start.begin()->second)));
  } else {
    fault(fmt::format("{} (`{}` {}) gives {} instead of {}", what, name,
                      text_of(start.begin()->second), to_string(outcome->status),
                      may_be_invalid ? "invalid_start" : "unsupported"));
  }
}

void Conformance::check_invalid_starts() {
  now_ = CheckKind::kInvalidStart;
  int tried = 1;
  check_refused("a variable that there is not", {{"no.such.variable", 1.0}}, false);
  for (const auto& parameter : report_.info.parameters) {
    const auto& base = first_ ? first_->states.front() : State{};
    const auto own = base.find(parameter.name);
    if (!parameter.settable || own == base.end() || !numeric(own->second)) continue;
    if (tried == 1) {
      check_refused("a text in the place of a number", {{parameter.name, std::string("left")}},
                    true);
      ++tried;
    }
    if (parameter.upper) {
      check_refused("a start beyond its bounds", {{parameter.name, *parameter.upper + 1.0}}, true);
      ++tried;
    }
    if (parameter.lower) {
      check_refused("a start beyond its bounds", {{parameter.name, *parameter.lower - 1.0}}, true);
      ++tried;
    }
    if (given_up()) break;
  }
  if (!starts_.empty()) {
    const auto good = reset(starts_.front(), kSeeds[0]);
    if (good && !is_ready(*good)) {
      fault(
          fmt::format("after a start that it refused, a good one is {}", to_string(good->status)));
    }
  }
  say(now_, fmt::format("{} starts that cannot be", tried));
}

void Conformance::check_unknown() {
  now_ = CheckKind::kUnknown;
  if (starts_.empty()) return skip(now_, "no start is known");
  const auto refused = [&](const char* what, const TriedAction& action) {
    const auto begun = reset(starts_.front(), kSeeds[0]);
    if (!begun || !is_ready(*begun)) return;
    const auto outcome = act(action, 1.0);
    if (!outcome || outcome->status == SimStatus::kUnsupported) return;
    fault(
        fmt::format("{} is {} instead of unsupported: what is misspelt in a scenario would count "
                    "as an observation",
                    what, to_string(outcome->status)));
  };
  refused("an unknown action", {"no-such-action", {}, 1.0});
  if (!actions_.empty()) {
    auto odd = actions_.front();
    odd.arguments["no_such_argument"] = 1.0;
    refused("an unknown argument", odd);
  }
  if (connect()) {
    const auto reply = ask(UnknownRequest{"no-such-method"}, options_.process.observe_timeout_s);
    const auto* done = reply ? std::get_if<OutcomeReply>(&*reply) : nullptr;
    if (done != nullptr && done->outcome.status != SimStatus::kUnsupported) {
      fault("an unknown method is answered as if it were one");
    }
  }
  const auto again =
      outcome_of(ResetRequest{starts_.front(), kSeeds[0]}, options_.process.reset_timeout_s, true);
  if (again && !is_ready(*again)) fault("a field that it does not know is not ignored");
  say(now_, "action, argument, method, field");
}

void Conformance::check_time_limit() {
  now_ = CheckKind::kTimeLimit;
  if (!first_) return skip(now_, "no run came to its end");
  std::size_t longest = 0;
  for (std::size_t i = 1; i < first_->outcomes.size(); ++i) {
    if (first_->outcomes[i].sim_time_s > first_->outcomes[longest].sim_time_s) longest = i;
  }
  const double whole = first_->outcomes[longest].sim_time_s;
  if (longest == 0 || whole <= 0.0) return skip(now_, "no action takes simulated time");
  const auto begun = reset(starts_.front(), kSeeds[0]);
  if (!begun || !is_ready(*begun)) return skip(now_, "the start was not taken again");
  for (std::size_t i = 0; i + 1 < longest; ++i) {
    if (!act(actions_[i], actions_[i].time_limit_s)) return skip(now_, "it was lost on the way");
  }
  const auto& action = actions_[longest - 1];
  const double limit = 0.5 * whole;
  const double allowed = limit + std::max(2.0 * report_.info.timestep_s, 0.05 * whole);
  const auto done = act(action, limit);
  if (!done) return skip(now_, "it was lost");
  if (done->sim_time_s > allowed) {
    fault(fmt::format("`{}` ran {:g} s with a limit of {:g} s", action.controller, done->sim_time_s,
                      limit));
  } else if (done->status == SimStatus::kOk) {
    fault(fmt::format("`{}` takes {:g} s and is ok at a limit of {:g} s: it has to be truncated",
                      action.controller, whole, limit));
  }
  say(now_, fmt::format("`{}`, {:g} s, with a limit of {:g} s: {} after {:g} s", action.controller,
                        whole, limit, to_string(done->status), done->sim_time_s));
}

void Conformance::check_timing() {
  now_ = CheckKind::kTiming;
  if (!connect() || starts_.empty()) return skip(now_, "no start is known");
  const auto begun = reset(starts_.front(), kSeeds[0]);
  std::vector<double> walls;
  for (int i = 0; i < kRoundTrips && begun && is_ready(*begun) && observe(); ++i) {
    walls.push_back(probe().wall_s());
  }
  if (walls.empty()) return skip(now_, "it was not observed");
  std::nth_element(walls.begin(), walls.begin() + static_cast<std::ptrdiff_t>(walls.size() / 2),
                   walls.end());
  report_.round_trip_s = walls[walls.size() / 2];
  if (acted_sim_s_ > 0.0 && acted_wall_s_ > 0.0) {
    report_.real_time_factor = acted_sim_s_ / acted_wall_s_;
  }
  const double factor = report_.real_time_factor, said = report_.info.min_real_time_factor;
  if (factor > 0.0 && said > 0.0 && factor < said) {
    fault(
        fmt::format("it simulates at {:.3g} times real time and says {:g} at least", factor, said));
  } else if (factor > 0.0 && said == 0.0 && factor < 1.0) {
    warn("it is slower than real time; say `min_real_time_factor`, or its actions will be ended");
  }
  say(now_,
      fmt::format("round trip {:.2g} ms{}", 1e3 * report_.round_trip_s,
                  factor > 0.0 ? fmt::format(", {:.3g} times real time", factor) : std::string()));
}

void Conformance::check_units() {
  now_ = CheckKind::kUnits;
  for (auto& finding : unit_findings(report_.info, seen_)) {
    find(finding.is_fault, std::move(finding.text));
  }
  say(now_, fmt::format("{} variables in {} states", report_.info.parameters.size(), seen_.size()));
}

void Conformance::check_end() {
  now_ = CheckKind::kEnd;
  if (!connect()) return skip(now_, "it was given up");
  const double limit = options_.process.close_timeout_s;
  if (ask(CloseRequest{}, limit) && !probe().ended_by_itself(limit)) {
    fault(fmt::format("it does not end within {:g} s of `close`", limit));
  }
  probe_.reset();
  if (!connect()) return skip(now_, "it was given up");
  if (!probe().ended_by_itself(limit)) {
    fault(
        fmt::format("it does not end within {:g} s of the end of its input, so it stays behind "
                    "when the program that started it is killed",
                    limit));
  }
  probe_.reset();
  say(now_, "by `close`, and by the end of its input");
}

void Conformance::add_claims() {
  const auto& info = report_.info;
  auto& claims = report_.claims;
  const auto measured = report_.repeatability;
  const bool known = measured != Repeatability::kUnknown;
  claims.replay = !known                                  ? "unknown: no run came to its end"
                  : measured == Repeatability::kBitwise   ? "bitwise"
                  : measured == Repeatability::kTolerance ? "not to the bit; within the tolerance"
                                                          : "no: repeated runs end differently";
  const bool retries = info.seeds && info.determinism == "bitwise";
  claims.retries = !retries ? "no: the first loss counts"
                   : !known ? "yes, as it promises; unknown whether it keeps that"
                   : measured == Repeatability::kBitwise
                       ? "yes: a lost run is made again with its start and seed"
                       : "yes, and wrongly: a run that is made again is another one";
  claims.independence =
      !known                                     ? "unknown"
      : measured == Repeatability::kNone         ? "only if its own randomness is independent "
                                                   "from run to run, which no seed controls"
      : noise_seen_ && info.seeds && seeds_fine_ ? "yes: starts and seeds are drawn independently"
      : noise_seen_                              ? "only if it really uses the seed"
                                                 : "yes: starts are drawn independently, and "
                                                   "nothing else varies";
  claims.jobs = !jobs_work_ ? "unknown"
                : *jobs_work_
                    ? "yes"
                    : "no: two processes do not work side by side, each in a world of its own";
  claims.search = has_margins_ ? "yes: it gives margins"
                  : first_     ? "blind: it gives no margins"
                               : "unknown";
  claims.recordings = !connected_once_ ? "unknown"
                      : info.scene     ? "yes: it gives poses"
                                       : "no: it gives no poses";
  if (!connected_once_) claims.retries = "unknown";
}

ConformanceReport Conformance::run() {
  if (check_handshake() && (!options_.on_info || options_.on_info(report_.info))) {
    now_ = CheckKind::kReset;
    choose_starts();
    choose_actions();
    check_resets();
    if (starts_.empty()) {
      skip(CheckKind::kActions, "no start is known");
    } else {
      check_actions();
    }
    check_determinism();
    check_seeds();
    check_invalid_starts();
    check_unknown();
    check_time_limit();
    check_timing();
    check_units();
    check_end();
    report_.complete = !given_up();
  }
  add_claims();
  return std::move(report_);
}

}  // namespace

std::size_t ConformanceReport::faults() const {
  return static_cast<std::size_t>(
      std::count_if(findings.begin(), findings.end(),
                    [](const ConformanceFinding& finding) { return finding.is_fault; }));
}

ConformanceReport check_conformance(const ConformanceOptions& options) {
  return Conformance(options).run();
}

}  // namespace parallax::harness
