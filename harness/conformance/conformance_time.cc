#include <fmt/format.h>

#include <algorithm>

#include "harness/conformance/conformance_run.h"
#include "harness/simulator/protocol_check.h"

// Checks of time: limits, what `sim_time` means, and how long a start takes.

namespace parallax::harness {
namespace {

/// A first reset may take this part of its limit, and so many times what later ones take.
constexpr double kShareOfLimit = 0.5, kTimesSlower = 10.0;
constexpr double kLongReset_s = 1.0;

double middle_of(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

/// Is `sim_time` the time on a clock, instead of the time that the request took? The first action
/// that takes time is made twice, the second time with half of that time as its limit. Where it
/// keeps that limit at the start of a run, and then says as much as the clock would show, it tells
/// the time. A clock that no reset puts back shows in the runs before.
bool Conformance::shows_a_clock() {
  std::size_t first = 1;
  while (first < first_->outcomes.size() && first_->outcomes[first].sim_time_s <= 0.0) ++first;
  if (first == first_->outcomes.size()) return false;
  const auto& action = actions_[first - 1];
  const double whole = first_->outcomes[first].sim_time_s, limit = 0.5 * whole;
  // Without `act`, which calls more than the limit a fault of its own.
  const auto time_of = [&](double limit_s) -> std::optional<double> {
    const auto done = outcome_of(ActRequest{action.controller, action.arguments, limit_s},
                                 act_timeout_s(limit_s));
    return done ? std::optional(done->sim_time_s) : std::nullopt;
  };
  const auto begin = [&] {
    const auto begun = reset(starts_.front(), kTriedSeeds[0]);
    if (!begun || !is_ready(*begun)) return false;
    for (std::size_t i = 0; i + 1 < first; ++i) {
      if (!outcome_of(
              ActRequest{actions_[i].controller, actions_[i].arguments, actions_[i].time_limit_s},
              act_timeout_s(actions_[i].time_limit_s))) {
        return false;
      }
    }
    return true;
  };
  const double said_before = most_sim_time_said_s_;
  if (!begin()) return false;
  const auto again = time_of(action.time_limit_s);
  if (again && *again > 2.0 * whole && *again >= said_before) {
    fault(
        fmt::format("`sim_time` has to be the time that a request took, and looks like a clock "
                    "that no reset puts back: `{}` took {:g} s at first and {:g} s later",
                    action.controller, whole, *again));
    return true;
  }
  const auto second = again ? time_of(limit) : std::nullopt;
  if (!second || *second < *again) return false;
  if (!begin()) return false;
  const auto limited = time_of(limit);
  if (!limited || *limited > most_sim_time_s(limit, report_.info)) return false;
  fault(
      fmt::format("`sim_time` has to be the time that a request took, and looks like a clock "
                  "since the reset: `{}` took {:g} s, and right after it, with a limit of {:g} s, "
                  "{:g} s",
                  action.controller, *again, limit, *second));
  return true;
}

void Conformance::check_time_limit() {
  now_ = CheckKind::kTimeLimit;
  if (!first_) return skip(now_, "no run came to its end");
  std::size_t longest = 0;
  for (std::size_t i = 1; i < first_->outcomes.size(); ++i) {
    if (first_->outcomes[i].sim_time_s > first_->outcomes[longest].sim_time_s) longest = i;
  }
  const double whole = first_->outcomes[longest].sim_time_s;
  if (longest == 0 || whole <= 0.0) {
    const bool all_instant = std::all_of(
        actions_.begin(), actions_.end(),
        [&](const TriedAction& one) { return report_.info.is_instant(one.controller); });
    if (all_instant && !actions_.empty()) {
      return say(now_, "none to keep: every action that was tried is said to be instant");
    }
    return skip(now_,
                "no action takes simulated time; where none does, say `instant` in `actions`");
  }
  if (shows_a_clock()) return say(now_, "not told apart from a clock");
  const auto begun = reset(starts_.front(), kTriedSeeds[0]);
  if (!begun || !is_ready(*begun)) return skip(now_, "the start was not taken again");
  for (std::size_t i = 0; i + 1 < longest; ++i) {
    if (!act(actions_[i], actions_[i].time_limit_s)) return skip(now_, "it was lost on the way");
  }
  const auto& action = actions_[longest - 1];
  const double limit = 0.5 * whole;
  const auto done = act(action, limit);
  if (!done) return skip(now_, "it was lost");
  const bool is_over = done->sim_time_s > most_sim_time_s(limit, report_.info);  // `act` told it
  if (!is_over && done->status == SimStatus::kOk) {
    fault(fmt::format("`{}` takes {:g} s and is ok at a limit of {:g} s: it has to be truncated",
                      action.controller, whole, limit));
  }
  say(now_, fmt::format("`{}`, {:g} s, with a limit of {:g} s: {} after {:g} s", action.controller,
                        whole, limit, to_string(done->status), done->sim_time_s));
}

/// Time until the first run can begin, in each process.
void Conformance::check_start_up() {
  now_ = CheckKind::kStartUp;
  if (first_reset_walls_s_.empty()) return skip(now_, "no start is known");
  const double first = middle_of(first_reset_walls_s_), later = middle_of(later_reset_walls_s_);
  const auto& limits = options_.process;
  if (hello_wall_s_ > kShareOfLimit * limits.hello_timeout_s) {
    warn(
        fmt::format("the reply to `hello` took {:.2g} s of the {:g} s that it may take; "
                    "`hello_timeout_s` gives it more",
                    hello_wall_s_, limits.hello_timeout_s));
  }
  const bool is_slow = first > kLongReset_s && first > kTimesSlower * later;
  if (first > kShareOfLimit * limits.reset_timeout_s || is_slow) {
    warn(
        fmt::format("the first `reset` of a process took {:.2g} s of the {:g} s that it may take, "
                    "later ones {:.2g} s: what takes long at the start belongs before the reply to "
                    "`hello`",
                    first, limits.reset_timeout_s, later));
  }
  say(now_, fmt::format("`hello` {:.2g} s; first `reset` {:.2g} s in {} processes, later ones "
                        "{:.2g} s",
                        hello_wall_s_, first, first_reset_walls_s_.size(), later));
}

}  // namespace parallax::harness
