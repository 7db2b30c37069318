#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/base/words.h"
#include "harness/conformance/conformance_run.h"

// Checks of starts: those that must be taken, and those that must be refused.

namespace parallax::harness {
namespace {

constexpr double kExact = 1e-6;  // starts keep at least so far from borders
constexpr int kStartTries = 12;

/// " of 6 of 6 initial states"; empty where there is one only.
std::string states_words(const std::optional<TriedStates>& states) {
  if (!states) return {};
  return fmt::format(" of {} of {} initial states", states->tried,
                     states->all ? std::to_string(*states->all) : std::string("many more"));
}

}  // namespace

std::optional<double> numeric(const Value& value) {
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return static_cast<double>(*integer);
  if (const auto* number = std::get_if<double>(&value)) return *number;
  return std::nullopt;
}

/// Two starts that it takes, from bounds where it says any, else near to where it stands by itself.
void Conformance::choose_starts() {
  if (!starts_.empty()) return;
  const auto begun = reset({}, kTriedSeeds[0]);
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
    const auto outcome = reset(start, kTriedSeeds[0]);
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
    // A start says 0 or 1 of a flag that it sets.
    const auto* flag = std::get_if<bool>(&found->second);
    if (x && flag != nullptr && *x == (*flag ? 1.0 : 0.0)) continue;
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
  for (const auto& start : starts_) {
    if (given_up()) break;
    const auto begun = reset(start, kTriedSeeds[0]);
    if (!begun) continue;
    if (!is_ready(*begun)) {
      fault(fmt::format("the start is {}: {}", to_string(begun->status), begun->reason));
      continue;
    }
    const auto seen = observe();
    if (!seen) continue;
    check_start(start, *seen);
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
      fmt::format("{}{}, largest deviation {:.3g}", base::counted(std::ssize(starts_), "start"),
                  states_words(report_.states), report_.largest_deviation));
}

/// Checks that a start which the simulator cannot take is refused. check_invalid_starts tries a
/// good one afterwards.
void Conformance::check_refused(const char* what, const State& start, bool may_be_invalid) {
  const auto outcome = reset(start, kTriedSeeds[0]);
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
    const auto good = reset(starts_.front(), kTriedSeeds[0]);
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
    const auto begun = reset(starts_.front(), kTriedSeeds[0]);
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
  const auto again = outcome_of(ResetRequest{starts_.front(), kTriedSeeds[0]},
                                options_.process.reset_timeout_s, true);
  if (again && !is_ready(*again)) fault("a field that it does not know is not ignored");
  say(now_, "action, argument, method, field");
}

}  // namespace parallax::harness
