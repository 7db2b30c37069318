#include <algorithm>
#include <array>
#include <numeric>

#include "harness/calibration/calibration.h"
#include "harness/confidence/criterion.h"
#include "harness/sampling/sampler.h"

namespace parallax::harness {
namespace {

constexpr std::int64_t kLeastRuns = 300;  // as campaigns have where nothing is said

constexpr std::uint64_t kOrderOfStates = 100, kOneState = 10'000;  // numbers of draws

/// The initial state of a run, from 0, as StartStates draws it: in random orders of all states
/// until a run was lost, then by itself; by its weight where they have weights.
std::size_t state_of_run(SyntheticKind kind, std::uint64_t campaign_seed, std::int64_t run,
                         bool independent) {
  const auto states = static_cast<std::uint64_t>(kSyntheticStates);
  const auto position = static_cast<std::uint64_t>(run) - 1;
  const auto chosen = [&](const CounterRng& rng, std::uint64_t draw, std::uint64_t of) {
    return std::min(static_cast<std::uint64_t>(rng.uniform(draw) * static_cast<double>(of)),
                    of - 1);
  };
  const auto stream = [&](std::uint64_t key, std::uint64_t number) {
    return CounterRng({.campaign_seed = campaign_seed, .trace_key = key, .sample = number});
  };
  if (kind == SyntheticKind::kWeightedStates) {
    const auto& weights = kSyntheticWeights;
    double left = stream(kOneState, position).uniform(0) *
                  std::accumulate(weights.begin(), weights.end(), 0.0);
    std::size_t state = 0;
    while (state + 1 < weights.size() && (left -= weights[state]) >= 0.0) ++state;
    return state;
  }
  if (independent) {
    return static_cast<std::size_t>(chosen(stream(kOneState, position), 0, states));
  }
  std::array<std::size_t, kSyntheticStates> order{};
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto rng = stream(kOrderOfStates, position / states);
  for (std::uint64_t left = states; left > 1; --left) {
    std::swap(order[left - 1], order[chosen(rng, left, left)]);
  }
  return order[position % states];
}

/// Runs of one trace, as a campaign takes them.
struct TraceLoop {
  const CalibratedCriterion& criterion;
  const CalibratedWorld& world;
  std::uint64_t campaign_seed;
  int trace;
  double share;  // of the error, where another trace is left out
  std::int64_t runs = 0;

  bool is_lost_instead() const {
    return world.kind == SyntheticKind::kLosing || world.kind == SyntheticKind::kCrashFirst ||
           world.kind == SyntheticKind::kLosingStates;
  }

  CalibratedTrace end() {
    const auto& spec = criterion.spec;
    CalibratedTrace out;
    out.probability = calibrated_probability(criterion, world, trace);
    const auto rule = criterion.make ? criterion.make(spec) : make_criterion(spec);
    const bool looks_once = spec.kind == CriterionKind::kClopperPearson;
    const auto planned = planned_runs(spec);
    const auto most = looks_once ? planned : std::max(kLeastRuns, 2 * planned);
    const Interval cell{kSyntheticStart_m, kSyntheticStart_m + 1.0};
    Tally tally(
        {{"box.x"}, {cell}, {"box.x"}, {Interval{kSyntheticGoal_m, kSyntheticGoal_m + 1.0}}, {}});
    for (runs = 0; runs < most && !out.passed && !out.is_discrepancy;) {
      // One number decides whether the run goes wrong; both traces share it where there are two.
      const CounterRng rng({.campaign_seed = campaign_seed,
                            .trace_key = static_cast<std::uint64_t>(world.kind),
                            .sample = static_cast<std::uint64_t>(++runs)});
      for (std::uint64_t attempt = 2;
           world.kind == SyntheticKind::kRefusing && rng.uniform(attempt) < 0.5; ++attempt) {
        tally.add_rejected();
      }
      const double draw = rng.uniform(0), x = rng.uniform(1);
      double p = out.probability;
      if (has_states(world.kind)) {
        const bool independent = looks_once || tally.lost() > 0;
        p *= synthetic_factor(world.kind,
                              state_of_run(world.kind, campaign_seed, runs, independent));
      }
      if (trace == 2 ? draw >= 1.0 - p : draw < p) {
        out.is_discrepancy = !is_lost_instead();
        if (!out.is_discrepancy) tally.add_lost();
      } else if (has_states(world.kind)) {
        tally.add_clean_of_many();
      } else {
        tally.add_clean(std::vector<double>{kSyntheticStart_m + x},
                        std::vector<double>{synthetic_end_m(x)});
      }
      out.passed = !out.is_discrepancy && rule->decide(tally).stop;
    }
    auto shared = spec;
    shared.share = share;
    out.stated = stated_bound(tally, spec);
    out.shared = stated_bound(tally, shared);
    return out;
  }
};

}  // namespace

CalibrationCell in_process_cell(const CalibratedCriterion& criterion, const CalibratedWorld& world,
                                const CalibrationOptions& options, std::int64_t loops) {
  CalibrationCell cell{world.name, criterion.name, 0, 0, 0.0, allowed_share(criterion, world)};
  const int count = world.family ? 2 : 1;
  const SpendingRule rule(world.is_counted ? std::optional<std::int64_t>(count) : std::nullopt);
  std::int64_t runs = 0;
  while (cell.loops < loops && (options.stop == nullptr || !options.stop->load())) {
    std::vector<CalibratedTrace> traces;
    for (int trace = 1; trace <= count; ++trace) {
      const auto seed = options.seed * 1'000'003U + static_cast<std::uint64_t>(cell.loops);
      TraceLoop loop{criterion, world, seed, trace, rule.share(trace)};
      traces.push_back(loop.end());
      runs += loop.runs;
    }
    ++cell.loops;
    cell.false_claims += is_false_claim(criterion, world, traces) ? 1 : 0;
  }
  if (cell.loops > 0) cell.mean_runs = static_cast<double>(runs) / static_cast<double>(cell.loops);
  return cell;
}

}  // namespace parallax::harness
