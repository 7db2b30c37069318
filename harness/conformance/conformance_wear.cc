#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "harness/conformance/conformance_run.h"

// Whether runs depend on those before them. Where a run can be repeated, the first one is made
// again after many resets. Where it cannot, the ranges of the results of eight early and eight late
// runs are compared: if they do not overlap, and the gap between them is wider than both ranges
// together, something drifts. By chance eight draws all lie below eight others once in 6435 times,
// and with such a gap far more rarely. A drift that is small beside the spread is not seen.

namespace parallax::harness {
namespace {

using WearClock = std::chrono::steady_clock;

// More resets than a campaign of one trace makes by default; fewer where they take long.
constexpr int kWearResets = 120;
constexpr std::chrono::seconds kWearTime{20};
/// Runs before and after, where one cannot be repeated.
constexpr std::size_t kComparedRuns = 8;
constexpr std::chrono::seconds kComparedRunsTime{60};

struct ResultRange {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double width() const { return high - low; }
};

/// The range of a number after the actions so far; none: some run does not have it.
std::optional<ResultRange> range_of(const std::vector<RunRecord>& runs, std::size_t at,
                                    const std::string& name) {
  ResultRange out;
  for (const auto& run : runs) {
    if (at >= run.states.size()) return std::nullopt;
    const auto found = run.states[at].find(name);
    const auto value = found == run.states[at].end() ? std::nullopt : numeric(found->second);
    if (!value) return std::nullopt;
    out.add(*value);
  }
  return out;
}

/// How each action ended, where all runs have the same; empty: they differ.
std::string common_endings(const std::vector<RunRecord>& runs) {
  std::string all;
  for (const auto& run : runs) {
    std::string own;
    for (const auto& outcome : run.outcomes) own += std::string(to_string(outcome.status)) + ' ';
    if (!all.empty() && own != all) return {};
    all = own;
  }
  return all;
}

}  // namespace

/// Runs from the first start with the first seed, fewer where they take long.
std::vector<RunRecord> Conformance::several_runs(std::chrono::steady_clock::time_point until) {
  std::vector<RunRecord> out;
  while (out.size() < kComparedRuns && WearClock::now() < until) {
    auto run = record(starts_.front(), kTriedSeeds[0]);
    if (!run) break;
    out.push_back(*std::move(run));
  }
  return out;
}

/// Warns of results that early and late runs do not share.
bool Conformance::tell_drift(const std::vector<RunRecord>& early,
                             const std::vector<RunRecord>& late) {
  const auto before = common_endings(early), after = common_endings(late);
  if (!before.empty() && !after.empty() && before != after) {
    warn(fmt::format("runs end otherwise after many resets: all ended {}before, and all {}after",
                     before, after));
    return true;
  }
  for (std::size_t at = 0; at < early.front().states.size(); ++at) {
    for (const auto& [name, value] : early.front().states[at]) {
      const auto first = range_of(early, at, name), last = range_of(late, at, name);
      if (!first || !last) continue;
      const double gap = std::max(last->low - first->high, first->low - last->high);
      if (gap <= options_.tolerance || gap <= first->width() + last->width()) continue;
      warn(
          fmt::format("`{}` {} drifts: from {:g} to {:g} in {} runs, and from {:g} to {:g} after "
                      "many resets",
                      name,
                      at == 0 ? std::string("at the start")
                              : fmt::format("after `{}`", actions_[at - 1].controller),
                      first->low, first->high, early.size(), last->low, last->high));
      return true;
    }
  }
  return false;
}

/// Is a start after many others still what it was, and what it is in a process that made none?
void Conformance::check_wear() {
  now_ = CheckKind::kWear;
  if (!first_) return skip(now_, "no run came to its end");
  const bool repeats = report_.repeatability != Repeatability::kNone;
  const auto early =
      repeats ? std::vector<RunRecord>() : several_runs(WearClock::now() + kComparedRunsTime);
  const auto until = WearClock::now() + kWearTime;
  int resets = 0;
  for (; resets < kWearResets && WearClock::now() < until; ++resets) {
    const auto begun = reset(starts_[static_cast<std::size_t>(resets) % starts_.size()],
                             kTriedSeeds[static_cast<std::size_t>(resets) % 3]);
    if (!begun) return skip(now_, fmt::format("it was lost in reset {}", resets + 1));
  }
  if (!repeats) {
    const auto late = several_runs(WearClock::now() + kComparedRunsTime);
    if (early.size() < kComparedRuns || late.size() < kComparedRuns) {
      return skip(now_, fmt::format("runs are not repeatable, and fewer than {} ended in time "
                                    "before and after {} resets",
                                    kComparedRuns, resets));
    }
    wears_ = tell_drift(early, late);
    looks_alike_ = !wears_;
    return say(
        now_,
        fmt::format("runs are not repeatable; {} runs before and {} after {} resets {}",
                    early.size(), late.size(), resets, wears_ ? "are told apart" : "look alike"));
  }
  const auto compare = [&](const std::string& place) {
    const auto again = record(starts_.front(), kTriedSeeds[0]);
    if (!again) return fmt::format("did not come to its end {}", place);
    const auto difference = difference_of(*first_, *again, actions_, time_slack_s());
    const bool is_same = difference.kind == RunDifference::Kind::kNone ||
                         (difference.kind == RunDifference::Kind::kNumbers &&
                          report_.repeatability == Repeatability::kTolerance &&
                          difference.largest <= options_.tolerance);
    return is_same ? std::string()
                   : fmt::format("gives another result {}: {}", place, difference.where);
  };
  auto worn = compare(fmt::format("after {} resets", resets));
  probe_.reset();
  auto fresh = compare("in a process that was started for it");
  for (const auto& what : {worn, fresh}) {
    if (what.empty()) continue;
    wears_ = true;
    fault("the first run, made again, " + what);
  }
  say(now_, fmt::format("{} after {} resets, and in a new process",
                        wears_ ? "not the same" : "the same", resets));
}

}  // namespace parallax::harness
