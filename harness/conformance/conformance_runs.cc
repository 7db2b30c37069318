#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "harness/conformance/conformance_run.h"

// Checks of runs: actions, repetition, seeds, and how fast they are.

namespace parallax::harness {
namespace {

constexpr int kRoundTrips = 20;

/// Boolean, number or text: what must not change between observations.
int kind_of(const Value& value) {
  if (std::holds_alternative<bool>(value)) return 0;
  return std::holds_alternative<std::string>(value) ? 2 : 1;
}

}  // namespace

void Conformance::check_actions() {
  now_ = CheckKind::kActions;
  if (actions_.empty()) {
    return skip(now_, "it is not known how to call any; name some with --act, or a --scenario");
  }
  first_ = record(starts_.front(), kTriedSeeds[0]);
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
    if (moved.kind != RunDifference::Kind::kNone && outcome.sim_time_s == 0.0 &&
        !report_.info.is_instant(name)) {
      warn(
          fmt::format("`{}` changed something in no simulated time; say `sim_time`, or `instant` "
                      "in `actions` where it takes none",
                      name));
    }
  }
  say(now_, said);
}

void Conformance::check_determinism() {
  now_ = CheckKind::kDeterminism;
  if (starts_.empty()) return skip(now_, "no start is known");
  if (!first_) first_ = record(starts_.front(), kTriedSeeds[0]);
  if (!first_) return skip(now_, "no run came to its end");
  RunDifference difference;
  // After another run, in the same process: is anything left of that one?
  const bool between = record(starts_.back(), kTriedSeeds[1]).has_value();
  const auto after_other = between ? record(starts_.front(), kTriedSeeds[0]) : std::nullopt;
  if (!after_other) return skip(now_, "no second run came to its end");
  const auto in_process = difference_of(*first_, *after_other, actions_, time_slack_s());
  difference.add(in_process);
  // The same by one request. Poses and reasons aside, nothing may differ but what always does.
  if (report_.info.can("perform") && report_.info.determinism == "bitwise") {
    const auto at_once = performed(starts_.front(), kTriedSeeds[0]);
    const auto other =
        at_once ? difference_of(*first_, *at_once, actions_, time_slack_s()) : RunDifference{};
    if (other.kind != RunDifference::Kind::kNone) {
      fault("`perform` gives another result than its requests one by one: " + other.where);
    }
  }
  // In another process, while the first one lives and stands at a start.
  const auto begun = reset(starts_.back(), kTriedSeeds[0]);
  const auto standing = begun && is_ready(*begun) ? observe() : std::nullopt;
  auto kept = std::move(probe_);
  const int losses_before = losses_;
  const auto elsewhere = record(starts_.front(), kTriedSeeds[0]);
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
  for (const auto seed : kTriedSeeds) {
    const auto run = seed == kTriedSeeds[0] ? first_ : record(starts_.front(), seed);
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

void Conformance::check_timing() {
  now_ = CheckKind::kTiming;
  if (!connect() || starts_.empty()) return skip(now_, "no start is known");
  const auto begun = reset(starts_.front(), kTriedSeeds[0]);
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

}  // namespace parallax::harness
